#pragma once
// The exception for a bad file or argument: it names where, what was found and what was expected (exit code 2).

#include <stdexcept>
#include <string>

namespace filum {

/// Bad input. what() reads "FILE: FIELD: found VALUE, expected EXPECTED".
class InputError : public std::runtime_error {
 public:
  InputError(std::string file, std::string field, std::string value, std::string expected)
      : std::runtime_error(file + ": " + field + ": found " + value + ", expected " + expected),
        file(std::move(file)),
        field(std::move(field)),
        value(std::move(value)),
        expected(std::move(expected)) {}
  std::string file, field, value, expected;
};

}  // namespace filum
