#include "evidence/validation.h"

#include <chrono>
#include <cmath>

#include "evidence/name_choice.h"
#include "evidence/problem_list.h"

namespace filum {
namespace {

ProblemList all_problems() {
  ProblemList list;
  list_elastica(list);
  list_dynamics(list);
  list_twist(list);
  list_localized_helix(list);
  list_frames(list);
  list_friction(list);
  list_wall_capstan(list);
  list_knots(list);
  list_plectoneme(list);
  list_passages(list);
  list_tissue(list);
  list_spatula(list);
  list_vessel(list);
  list_needle_track(list);
  return list;
}

}  // namespace

void ValidationProblem::judge() {
  error = std::abs(got - expected);
  if (expected != 0.0) error /= std::abs(expected);
  passed = std::isfinite(got) && error <= tolerance;
  if (least_order) passed = passed && order && *order >= *least_order;
}

std::vector<std::string> validation_names() {
  std::vector<std::string> names;
  for (const ListedProblem& p : all_problems()) names.push_back(p.stated.name);
  return names;
}

std::vector<ValidationProblem> run_validation(const std::vector<std::string>& names,
                                              const ValidationProgress& progress) {
  const ProblemList list = all_problems();
  check_names("validate", names, validation_names());
  std::vector<ValidationProblem> results;
  for (const ListedProblem& p : list) {
    if (!is_wanted(names, p.stated.name)) continue;
    ValidationProblem r = p.stated;
    const auto start = std::chrono::steady_clock::now();
    p.solve(r);
    r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    r.judge();
    if (progress) progress(r);
    results.push_back(std::move(r));
  }
  return results;
}

}  // namespace filum
