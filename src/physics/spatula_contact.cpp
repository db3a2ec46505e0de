#include "physics/spatula_contact.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kPresliding = 50e-6;  // [m], by which a light contact gives before it slips (see stick_stiffness)

Vec3 place(const LinearFem& fem, const Points& u, int node) { return fem.mesh().nodes.col(node) + u.col(node); }

}  // namespace

void SpatulaContact::reserve(std::size_t contacts) { moved_.reserve(contacts); }

void SpatulaContact::set_surface(const TetMesh& mesh, std::span<const Triangle> surface) {
  outward_ = Points::Zero(3, mesh.n_nodes());
  for (const Triangle& t : surface) {
    const Vec3 a = mesh.nodes.col(t[0]), area = (mesh.nodes.col(t[1]) - a).cross(mesh.nodes.col(t[2]) - a);
    for (const int i : t) outward_.col(i) += area;
  }
  for (int i = 0; i < outward_.cols(); ++i)
    if (const double length = outward_.col(i).norm(); length > 0.0) outward_.col(i) /= length;
}

/// Under the blade the tissue may face it at any slant; beside its border it must lie clearly on the side that is pressed.
bool SpatulaContact::from_outside(const MovingBlade& blade, const BladeContact& c, const Vec3& normal_T, double beyond) const noexcept {
  if (outward_.cols() == 0) return true;
  constexpr double kUnder = 0.5, kBeside = -0.2;  // cosine between the push and the outward normal, at most
  const double cosine = (blade.X_now.q * (c.side * normal_T)).dot(outward_.col(c.node));
  return cosine < (beyond > 0.0 ? kBeside : kUnder);
}

double SpatulaContact::share_at(double beyond) const noexcept {
  if (!parameters_.partial) return beyond > 0.0 ? 0.0 : 1.0;
  return std::pow(std::clamp(1.0 - beyond / parameters_.reach, 0.0, 1.0), parameters_.power);  // Eq. 9, and a power of it
}

/// Where the node lies beside its blade now; false if the blade has left it.
bool SpatulaContact::keep(const LinearFem& fem, const Points& u, std::span<const MovingBlade> blades, BladeContact& c) const noexcept {
  const MovingBlade& blade = blades[static_cast<std::size_t>(c.blade)];
  const SurfacePoint p = nearest_point(*blade.surface, blade.X_now.inverse() * place(fem, u, c.node), c.triangle);
  c.triangle = p.triangle;
  c.share = share_at(p.beyond);
  return c.share > 0.0 && (c.normal_force > 0.0 || c.side * p.gap < 0.0);
}

void SpatulaContact::find(const Vec3& q0, const Vec3& q1, const MovingBlade& blade, BladeContact c, std::vector<BladeContact>& contacts) const noexcept {
  const SurfacePoint start = nearest_point(*blade.surface, q0), end = nearest_point(*blade.surface, q1, start.triangle);
  if ((start.gap >= 0.0) == (end.gap >= 0.0)) return;  // same side, or it came round the border
  const double t = start.gap / (start.gap - end.gap);
  const SurfacePoint hit = nearest_point(*blade.surface, q0 + t * (q1 - q0), end.triangle);
  c.share = share_at(hit.beyond);
  if (c.share <= 0.0 || share_at(end.beyond) <= 0.0) return;
  c.triangle = end.triangle;
  c.side = start.gap >= 0.0 ? 1 : -1;
  if (!from_outside(blade, c, end.normal, end.beyond)) return;
  c.anchor_T = q1 - end.gap * end.normal;
  if (contacts.size() < contacts.capacity()) contacts.push_back(c);
}

/// The spring that Eq. 8 amounts to, and the bristle of the friction after return mapping with the last normal force.
MovedNode SpatulaContact::pull(const LinearFem& fem, const Points& u, const MovingBlade& blade, BladeContact& c) const noexcept {
  const Vec3 x = place(fem, u, c.node), q = blade.X_now.inverse() * x;
  const SurfacePoint p = nearest_point(*blade.surface, q, c.triangle);
  const Vec3 n = blade.X_now.q * p.normal;
  const double own = fem.nodal_stiffness(c.node);
  const double k = own * std::min(c.share / std::max(1.0 - c.share, 1e-12), kRigid);
  const double k_t = std::min(std::min(k, own), parameters_.friction * c.normal_force / kPresliding);
  const Mat3 along = Mat3::Identity() - n * n.transpose();
  Vec3 bristle = along * (blade.X_now * c.anchor_T - x);
  const double limit = k_t > 0.0 ? parameters_.friction * c.normal_force / k_t : 0.0, length = bristle.norm();
  c.slipping = length > limit ? 1 : 0;
  if (length > limit) {
    bristle *= limit / length;
    c.anchor_T = blade.X_now.inverse() * (x + bristle);
  }
  MovedNode m;
  m.node = c.node;
  m.prescribed = false;
  m.stiffness = k * n * n.transpose() + k_t * along;
  m.target = u.col(c.node) - p.gap * n + bristle;
  m.outward = c.side * n;
  m.speed = (x - blade.X_before * q).dot(m.outward) / fem.options().dt;
  return m;
}

void SpatulaContact::update(const LinearFem& fem, const Points& u, const Points& seen, std::span<const MovingBlade> blades, std::span<const int> candidates,
                            std::vector<BladeContact>& contacts) noexcept {
  std::erase_if(contacts, [&](BladeContact& c) { return !keep(fem, u, blades, c); });
  for (int b = 0; b < static_cast<int>(blades.size()); ++b) {
    const MovingBlade& blade = blades[static_cast<std::size_t>(b)];
    const Pose before = blade.X_before.inverse(), now = blade.X_now.inverse();
    const Vec3 low = blade.surface->low.array() - parameters_.reach, high = blade.surface->high.array() + parameters_.reach;
    for (const int i : candidates) {
      if (fem.held()[static_cast<std::size_t>(i)]) continue;
      const Vec3 q0 = before * place(fem, seen, i), q1 = now * place(fem, u, i);
      const bool far = (q0.cwiseMax(q1).array() < low.array()).any() || (q0.cwiseMin(q1).array() > high.array()).any();
      if (far || std::any_of(contacts.begin(), contacts.end(), [&](const BladeContact& c) { return c.node == i; })) continue;
      BladeContact c;
      c.node = i;
      c.blade = b;
      find(q0, q1, blade, c, contacts);
    }
  }
  moved_.clear();
  for (BladeContact& c : contacts) moved_.push_back(pull(fem, u, blades[static_cast<std::size_t>(c.blade)], c));
}

void SpatulaContact::read(const LinearFem& fem, const Points& u, std::span<MovingBlade> blades, std::vector<BladeContact>& contacts) const noexcept {
  for (MovingBlade& b : blades) b.force = b.torque = Vec3::Zero();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    BladeContact& c = contacts[k];
    MovingBlade& blade = blades[static_cast<std::size_t>(c.blade)];
    const Vec3 n = c.side * (blade.X_now.q * blade.surface->normals[static_cast<std::size_t>(c.triangle)]);
    const Vec3& force = moved_[k].force;
    c.normal_force = std::max(0.0, force.dot(n));
    c.friction = c.normal_force > 0.0 ? Vec3(force - force.dot(n) * n) : Vec3::Zero();
    const Vec3 on_blade = -(c.normal_force * n + c.friction);
    blade.force += on_blade;
    blade.torque += (place(fem, u, c.node) - blade.X_now.p).cross(on_blade);
  }
}

PivotForce pivot_force(const Vec3& tip_W, const Vec3& pivot_W, const Vec3& force, const Vec3& torque) noexcept {
  const Vec3 lever = tip_W - pivot_W;
  const double length = lever.norm();
  if (length < 1e-9) return {force, Vec3::Zero()};
  const Vec3 along = lever / length, moment = torque + lever.cross(force);
  return {along * along.dot(force), moment.cross(along) / length};
}

}  // namespace filum
