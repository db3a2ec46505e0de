#pragma once
// Rigid poses and the short vector names used everywhere. SI units, right-handed frames.
// Naming: p_WN is the position of N in frame W; X_WT maps coordinates of frame T into frame W.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace filum {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Points = Eigen::Matrix3Xd;  // 3 x n, one point a column

/// Position and orientation of a frame T in a frame W.
struct Pose {
  Vec3 p = Vec3::Zero();       // [m], origin of T in W
  Quat q = Quat::Identity();   // unit quaternion, rotates T into W

  /// Coordinates in W of the point whose coordinates in T are p_T [m].
  Vec3 operator*(const Vec3& p_T) const { return p + q * p_T; }
  Pose operator*(const Pose& X_TS) const { return {p + q * X_TS.p, q * X_TS.q}; }
  Pose inverse() const { return {q.conjugate() * (-p), q.conjugate()}; }
  bool finite() const { return p.allFinite() && q.coeffs().allFinite(); }
};

}  // namespace filum
