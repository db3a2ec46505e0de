// Threads never pass through each other, however they are thrown about.

#include <cmath>
#include <string>

#include "evidence/linked_strands.h"
#include "evidence/problem_list.h"

namespace filum {
namespace {

constexpr int kSteps = 1'000'000;

/// The linking number furthest from that at the start, looked at after every step.
void throw_about(ValidationProblem& r) {
  LinkedStrands hooks;
  const double start = hooks.linking();
  int touching = 0, steps = 0;
  r.got = start;
  for (; steps < kSteps && std::isfinite(r.got); ++steps) {
    if (!hooks.advance().sound) r.got = std::nan("");
    const double now = hooks.linking();
    if (!(std::abs(now - start) <= std::abs(r.got - start))) r.got = now;
    touching += hooks.touching() ? 1 : 0;
  }
  r.quantity += ", " + std::to_string(steps) + " steps run, in contact in " + std::to_string(touching);
}

}  // namespace

void list_passages(ProblemList& list) {
  ValidationProblem p;
  p.name = "linking-number";
  p.source = "Gauss 1833: the linking number of two loops does not change unless one passes through the other";
  p.quantity = "linking number, where furthest from 1, of two clasped hooks of 10-0 thrown about at up to 2 m/s";
  p.expected = 1.0;
  p.tolerance = 1e-9;
  p.note = "no order: a whole number on any mesh; the tests run the same for 10,000 steps (linked_strands_test)";
  list.push_back({p, throw_about});
}

}  // namespace filum
