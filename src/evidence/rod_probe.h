#pragma once
// A rod with its solver for problems with known answers: clamped, loaded, brought to rest, measured.

#include "physics/implicit_rod.h"

namespace filum {

/// Slender rod of bending stiffness `EI` [N m2] and twisting stiffness `GJ` [N m2] that hardly stretches:
/// `thinness` is its length over its radius. Without drag and internal friction.
RodMaterial slender_rod(double EI, double GJ, double length, double thinness, double mass_per_length);

/// n nodes [m] on the x axis from `from`, `edge` apart.
Points nodes_on_x(int n, double from, double edge);

struct RodProbe {
  RodProbe(const RodMaterial& material, const Points& nodes);

  ImplicitRod rod;
  RodState state;
  RodMemory memory;
  RodStepOptions options;  // no gravity, tight tolerance

  /// Holds all four coordinates of node i (and of the edge behind it) where they are.
  void hold(int i);
  void hold_position(int i);
  void hold_angle(int j);
  /// Backward Euler steps from rest, so long that inertia no longer counts, until nothing moves any more by
  /// `still` [m].
  bool come_to_rest(double step_seconds, int most_steps, double still);
  double moment_at(int i) const;  // [N m], twisting moment at node i
};

/// Order of convergence from results at edge lengths 4 l, 2 l and l.
double observed_order(double coarse, double middle, double fine);
/// The same where the answer is known: from the errors of two resolutions whose edge lengths have this ratio.
double order_of_errors(double coarse, double fine, double ratio = 2.0);

}  // namespace filum
