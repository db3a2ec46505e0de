#pragma once
// Validation: problems whose answer is known from theory or experiment, solved with the same code that the
// trainer runs. The tolerance of each is stated with the problem, before it is solved; what misses it is
// reported as failed.

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace filum {

struct ValidationProblem {
  std::string name;
  std::string source;  // where `expected` comes from
  std::string quantity;
  std::string unit = "1";  // a pure number, unless said otherwise
  double expected = 0.0, got = 0.0;
  double error = 0.0;      // |got - expected|, relative to |expected| unless that is 0
  double tolerance = 0.0;  // on `error`
  std::optional<double>
      order;  // observed order of convergence in the edge length, where three resolutions were solved
  std::optional<double> least_order;  // that `order` must reach to pass
  std::string note;  // why there is no `order`, and what else the figure needs to be read; may be empty
  bool passed = false;
  double seconds = 0.0;  // it took to solve

  /// Fills error and passed from the rest.
  void judge();
};

using ValidationProgress = std::function<void(const ValidationProblem&)>;

std::vector<std::string> validation_names();

/// Solves the problems named (all if `names` is empty); a name also stands for every problem that begins with
/// it and a hyphen. Calls `progress` after each. Throws InputError for a name that is none.
std::vector<ValidationProblem> run_validation(const std::vector<std::string>& names,
                                              const ValidationProgress& progress = {});

}  // namespace filum
