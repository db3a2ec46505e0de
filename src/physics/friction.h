#pragma once
// Dry friction at a point: Coulomb's law with an elastic stick range (bristle), integrated by return mapping.
//
//   trial  xi* = P (xi_n + du),   force on the first body  -k_t xi*           if k_t |xi*| <= mu N   (stick)
//                                                          -mu N xi*/|xi*|    otherwise              (slip)
// P removes the part along the normal, du is the relative tangential displacement of the step. This is the backward Euler
// step of elastoplastic Coulomb friction (Simo & Laursen, Comput. Struct. 42:97, 1992, eq. 31-36); for N held fixed it is the
// gradient of a convex Huber function, so it can be minimised together with the elastic energy. Unlike velocity
// regularisation it does not creep: a stuck point under constant load stays where it is.
// Neglects: rolling and spinning friction, history of N within a step. Test: friction_test.

#include <algorithm>

#include "base/pose.h"

namespace filum {

struct FrictionPoint {
  Vec3 force = Vec3::Zero();  // [N], on the first body
  double energy = 0.0;        // [J], pseudo-potential at fixed N
  Mat3 stiffness = Mat3::Zero();  // [N/m], positive semidefinite, d(-force)/d(du)
  Vec3 xi = Vec3::Zero();     // [m], bristle after return mapping
  bool slipping = false;
};

/// Stiffness of the stick range: no stiffer than lets the point give by `presliding` [m] before it slips. Lightly loaded contacts
/// of real surfaces do so by about a micrometre, and without it the law of a nearly weightless contact is a step function.
inline double stick_stiffness(double stiffest, double mu, double N, double presliding) noexcept {
  return std::min(stiffest, mu * N / presliding);
}

/// xi_trial [m] must already lie in the tangent plane of `normal` (unit).
inline FrictionPoint coulomb(const Vec3& xi_trial, const Vec3& normal, double N, double mu, double k_t) noexcept {
  FrictionPoint r;
  const double length = xi_trial.norm();
  const double limit = mu * N;
  const Mat3 P = Mat3::Identity() - normal * normal.transpose();
  if (k_t * length <= limit * (1.0 + 1e-12)) {
    r.force = -k_t * xi_trial;
    r.energy = 0.5 * k_t * length * length;
    r.stiffness = k_t * P;
    r.xi = xi_trial;
  } else {
    const Vec3 direction = xi_trial / length;
    r.force = -limit * direction;
    r.energy = limit * length - 0.5 * limit * limit / k_t;
    r.stiffness = limit / length * (P - direction * direction.transpose());
    r.xi = limit / k_t * direction;
    r.slipping = true;
  }
  return r;
}

}  // namespace filum
