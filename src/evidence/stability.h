#pragma once
// Stability of an equilibrium of a rod: is its elastic energy a minimum with some coordinates held?

#include <functional>

#include "evidence/rod_probe.h"

namespace filum {

using HeldCoordinates = Eigen::Array<bool, 4, Eigen::Dynamic>;

/// Second derivative of the elastic energy of an equilibrium with some coordinates held, and springs [N/m] on others (4 x n), factorised.
class HeldStiffness {
 public:
  HeldStiffness(const RodMaterial& m, const RodState& s, const HeldCoordinates& held, const Eigen::Matrix4Xd& springs);
  bool positive() const noexcept { return positive_; }
  /// What the loads (4 x n) move; only where it is positive.
  Eigen::Matrix4Xd moves(Eigen::Matrix4Xd loads) const;

 private:
  BlockCholesky matrix_;
  bool positive_ = false;
};

/// True if the second derivative of the elastic energy of `s`, held as in `held`, is positive definite.
bool is_stable(const RodMaterial& m, const RodState& s, const HeldCoordinates& held);

/// The same for a straight rod along x between pins that is twisted by moments M [N m] at its ends, along -x at the first and along x at the
/// last node whatever their edges do (Greenhill's ends; such moments have no energy). The second derivative of the energy with the twist angles
/// held goes with end moments that turn by half the angle of their edges (semitangential: Ziegler, Principles of Structural Stability, 1968),
/// so half of M's part normal to an edge of length l is still to be loaded: in w = y + iz, at the last node but one with i M w/(2 l^2), the
/// other force of the couple going into the pin, and at the second node with the opposite sign. With G the flexibility of these two nodes while
/// both are held by springs k as well, which keep the rod stable, and K the stiffness,
///   det(K - load)/det(K + k) = det(1 - G diag(k - i M/(2 l^2), k + i M/(2 l^2))) ,
/// which is returned: 0 at the critical moment. The rod looks the same from both ends, which makes it real. NaN where the springs do not suffice.
double pinned_determinant(const RodMaterial& m, const RodState& s, const HeldCoordinates& held, double M);

/// Largest load below `high` for which `stable` holds, by bisection; `stable(low)` must hold and
/// `stable(high)` must not, else NaN.
double critical_load(double low, double high, const std::function<bool(double)>& stable);

}  // namespace filum
