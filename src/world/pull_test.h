#pragma once
// Security of a finished knot: the loop is pulled open from within, as knots are tested on a tensile machine (two rods in the loop,
// drawn apart, until the loop has opened by a limit: Lo, Burkhart, Chan, Athanasiou, Arthroscopy 20:489, 2004).
//
// Instruments and post are taken away; two round bars stand in the post's place, inside the loop, side by side so that the knot lies between
// them, and are moved apart slowly. The pull is the force of the thread on a bar. The knot holds if the pull reaches `most_pull`
// before the loop, once it is taut (`taut_pull`), has opened by `allowed`; else it slips at the largest pull reached until then.
// Everything else is the rod's physics: bending, self-contact, friction, strength, the adaptive resolution of the scene.
// Valid: quasi-static (inertia at 1 mm/s is negligible). Neglects: plastic set of the thread, gravity (0.1 uN on the whole thread).
// Test: pull_test_test (square knot holds, single throw and unknotted thread slip).

#include <functional>

#include "world/model.h"
#include "world/state.h"

namespace filum {

struct PullTestOptions {
  double most_pull = 60e-3;   // [N], on a bar; a fifth more than what the tasks give full marks for
  double taut_pull = 0.5e-3;  // [N], from which the opening is measured
  double allowed = 1.0e-3;    // [m], opening of the loop that counts as slipped (a proposal)
  double slow = 1.0e-3;       // [m/s], of each bar under load
  double fast = 4e-3;         // [m/s], of each bar while the loop is slack
  double most_travel = 8e-3;  // [m], of each bar
  std::function<bool(double)> go_on;  // told after every step how much is done, 0 to 1; false abandons the test
};

struct PullTestReport {
  bool held = false;
  bool parted = false;      // the thread broke
  double force = 0.0;       // [N], at which it slipped or broke; most_pull if it held
  double most_pull = 0.0;   // [N], as asked for
  double opening = 0.0;     // [m], of the loop since it was taut, at the end
  bool abandoned = false;   // not pulled to the end: the figures say nothing
  int steps = 0;
  double residual = 0.0;    // [N], largest unbalanced force left by the solver in a step
};

/// Pulls the knot in `state`. Deterministic; does not change `state`.
PullTestReport pull_test(const Model& model, const State& state, const PullTestOptions& options = {});

}  // namespace filum
