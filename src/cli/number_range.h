#pragma once
// A range for an argument's number. CLI::Range takes what is not a number: it is neither below nor above.

#include <CLI/CLI.hpp>
#include <string>

namespace filum {

inline CLI::Validator between(double low, double high) {
  const auto shown = [](double v) { return CLI::detail::to_string(v); };
  const std::string range = shown(low) + " to " + shown(high);
  return {[low, high, range](std::string& text) {
            double value = 0.0;
            const bool read = CLI::detail::lexical_cast(text, value);
            return read && value >= low && value <= high ? std::string() : "found " + text + ", expected a number from " + range;
          },
          "FLOAT in [" + shown(low) + " - " + shown(high) + "]"};
}

}  // namespace filum
