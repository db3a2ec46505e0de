#pragma once
// Two hooks of thread clasped into each other, held at their four ends and thrown about: taut against each other, slack, turned round each other,
// sheared, and struck at random. Closed by the line between its ends, each is a loop, and the loops are linked once. A hook cannot reach the other's
// closing line (it is too short by 0.3 mm at least), so the linking number may change only where the threads pass through each other.

#include <random>

#include "physics/implicit_rod.h"

namespace filum {

class LinkedStrands {
 public:
  LinkedStrands();

  RodStepSummary advance();       // one step of 1 ms
  double linking() const;         // of the two closed hooks
  bool touching() const noexcept { return rod.contact().n_touching(rod.material.radius) > 0; }

  ImplicitRod rod;
  RodState state;

 private:
  void drive(double t) noexcept;
  void strike();

  RodMemory memory_;
  RodStepOptions options_;
  std::mt19937 random_{1};
  int step_ = 0;
};

}  // namespace filum
