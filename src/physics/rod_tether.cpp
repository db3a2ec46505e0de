#include "physics/rod_tether.h"

#include <algorithm>
#include <cmath>

#include "physics/thread_grasp.h"

namespace filum {
namespace {

Vec3 offset(const RodTether& t, const Points& x) noexcept {
  return (1.0 - t.s) * x.col(t.edge) + t.s * x.col(t.edge + 1) - t.anchor;
}

bool resists(const RodTether& t, double u) noexcept { return t.stick > 0.0 && !(t.one_way && u < 0.0); }
bool slips(const RodTether& t, double u) noexcept { return t.stick * std::abs(u) > t.limit; }
bool in_plane(const RodTether& t) noexcept { return t.across != Vec3::Zero(); }
Vec3 slip_of(const RodTether& t, const Vec3& d) noexcept { return d.dot(t.along) * t.along + d.dot(t.across) * t.across; }

bool lifted(const RodTether& t, const Vec3& d) noexcept { return in_plane(t) && d.dot(t.along.cross(t.across)) > 0.0; }

Mat3 plane_stiffness(const RodTether& t, const Vec3& d) noexcept {
  const Vec3 slip = slip_of(t, d);
  const Mat3 plane = t.along * t.along.transpose() + t.across * t.across.transpose();
  const double length = slip.norm();
  if (!slips(t, length)) return t.stick * plane;
  if (t.turned) return t.limit / length * plane;
  return t.limit / length * (plane - slip * slip.transpose() / (length * length));
}

}  // namespace

void RodTethers::locate(const RodState& s) noexcept {
  for (RodTether& t : list) {
    t.edge = s.n - 2;
    t.s = 1.0;
    if (!t.at_end) std::tie(t.edge, t.s) = locate_arc(s, t.arc);
    t.force.setZero();
    t.slid = 0.0;
    t.slip.setZero();
    t.turned = false;
  }
}

double RodTethers::energy(const Points& x, double dt) const noexcept {
  double sum = 0.0;
  for (const RodTether& t : list) {
    const Vec3 d = offset(t, x);
    if (!lifted(t, d)) sum += 0.5 * d.dot(t.stiffness * d);
    const double u = in_plane(t) ? slip_of(t, d).norm() : d.dot(t.along), bend = t.stick > 0.0 ? t.limit / t.stick : 0.0;
    if (!resists(t, u)) continue;
    sum += slips(t, u) ? t.limit * (std::abs(u) - 0.5 * bend) : 0.5 * t.stick * u * u;
    sum += 0.5 * t.drag / dt * (u - t.start) * (u - t.start);
  }
  return sum;
}

void RodTethers::add_gradient(const Points& x, double dt, Eigen::Matrix4Xd& gradient) noexcept {
  for (RodTether& t : list) {
    const Vec3 d = offset(t, x);
    t.force = lifted(t, d) ? Vec3(Vec3::Zero()) : Vec3(-(t.stiffness * d));
    if (in_plane(t)) {
      const Vec3 slip = slip_of(t, d);
      const double length = slip.norm();
      t.turned = t.turned || slip.dot(t.slip) < 0.0;
      t.slip = slip;
      t.force -= slips(t, length) ? Vec3(t.limit / length * slip) : Vec3(t.stick * slip);
      t.slid = std::max(0.0, length - t.limit / t.stick);
    } else if (const double u = d.dot(t.along); resists(t, u)) {
      const double dry = slips(t, u) ? std::copysign(t.limit, u) : t.stick * u;
      t.force -= (dry + t.drag / dt * (u - t.start)) * t.along;
      t.slid = u - dry / t.stick;
    }
    gradient.col(t.edge).head<3>() -= (1.0 - t.s) * t.force;
    gradient.col(t.edge + 1).head<3>() -= t.s * t.force;
  }
}

void RodTethers::add_stiffness(const Points& x, double dt, const ChainSlots& chain, BlockCholesky& matrix) const noexcept {
  for (const RodTether& t : list) {
    const Vec3 d = offset(t, x);
    Mat3 k = lifted(t, d) ? Mat3(Mat3::Zero()) : t.stiffness;
    if (in_plane(t)) {
      k += plane_stiffness(t, d);
    } else if (const double u = d.dot(t.along); resists(t, u)) {
      const double along = (slips(t, u) ? 0.0 : t.stick) + t.drag / dt;
      k += along * t.along * t.along.transpose();
    }
    matrix.add_diagonal(t.edge, pad((1.0 - t.s) * (1.0 - t.s) * k));
    matrix.add_diagonal(t.edge + 1, pad(t.s * t.s * k));
    matrix.add(chain.next[static_cast<std::size_t>(t.edge)], pad(t.s * (1.0 - t.s) * k));
  }
}

}  // namespace filum
