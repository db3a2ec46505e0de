#include "physics/wall_meeting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/point_triangle.h"
#include "physics/vessel_leak.h"

namespace filum {
namespace {

constexpr int kRows = 2;         // of elements behind the cut
constexpr double kAcross = 0.5;  // of a ring's radius, that the wall across may be away
constexpr double kFriction = 0.3;  // [-], of wet tissue on tissue [P]
constexpr double kStick = 0.5;     // of the stiffness: what friction gives by before it slips
constexpr double kAside = 0.5;    // of the reach, by which a node may stand beside a cut face that it meets

Box around(const std::vector<int>& nodes, const Points& x, double reach) noexcept {
  Box b{x.col(nodes.front()), x.col(nodes.front())};
  for (const int i : nodes) {
    b.low = b.low.cwiseMin(x.col(i));
    b.high = b.high.cwiseMax(x.col(i));
  }
  b.low.array() -= reach;
  b.high.array() += reach;
  return b;
}

double ring_area(const std::vector<int>& ring, const Points& x) noexcept {
  Vec3 twice = Vec3::Zero();
  for (std::size_t k = 0; k < ring.size(); ++k) twice += Vec3(x.col(ring[k])).cross(Vec3(x.col(ring[(k + 1) % ring.size()])));
  return 0.5 * twice.norm();
}

/// Nodes of the cut edges and of kRows rows of elements behind them.
std::vector<char> near_cut(const VesselMesh& mesh) {
  std::vector<char> near(mesh.slab.size(), 0);
  for (const WallFace& f : mesh.faces)
    if (f.surface == WallSurface::edge)
      for (const int c : f.corner) near[static_cast<std::size_t>(mesh.elements[static_cast<std::size_t>(f.element)][static_cast<std::size_t>(c)])] = 1;
  for (int row = 0; row < kRows; ++row) {
    const std::vector<char> before = near;
    for (const auto& nodes : mesh.elements)
      if (std::any_of(nodes.begin(), nodes.end(), [&](int i) { return before[static_cast<std::size_t>(i)] != 0; }))
        for (const int i : nodes) near[static_cast<std::size_t>(i)] = 1;
  }
  return near;
}

bool holds(const Box& b, const Vec3& q) noexcept { return (q.array() >= b.low.array()).all() && (q.array() <= b.high.array()).all(); }

}  // namespace

WallMeetings::WallMeetings(const VesselMesh& mesh, double reach, double stiffness) : reach_(reach), stiffness_(stiffness) {
  const std::size_t parts = mesh.edge_ring.size();
  rim_.resize(parts);
  const std::vector<char> near = near_cut(mesh);
  std::vector<char> on_surface(mesh.slab.size(), 0);
  for (const WallFace& f : mesh.faces)
    for (const int c : f.corner) on_surface[static_cast<std::size_t>(mesh.elements[static_cast<std::size_t>(f.element)][static_cast<std::size_t>(c)])] = 1;
  for (std::size_t i = 0; i < mesh.slab.size(); ++i)
    if (on_surface[i] && near[i]) rim_[static_cast<std::size_t>(mesh.node_part[i])].push_back(static_cast<int>(i));
  std::size_t all = 0;
  for (const auto& nodes : rim_) all += nodes.size();
  around_.assign(mesh.slab.size(), -1);
  turn_.assign(parts, 0);
  for (std::size_t part = 0; part < parts; ++part)
    for (const auto& nodes : inner_rings(mesh, static_cast<int>(part))) {
      const double area = ring_area(nodes, mesh.nodes), side = (mesh.nodes.col(nodes[1]) - mesh.nodes.col(nodes[0])).norm();
      if (area < side * side) continue;  // a row of a card
      rings_.push_back({nodes, area});
      turn_[part] = std::max(turn_[part], static_cast<int>(nodes.size()));
      across_ = std::max(across_, kAcross * std::sqrt(rings_.back().area / std::numbers::pi));
      for (std::size_t k = 0; k < nodes.size(); ++k) around_[static_cast<std::size_t>(nodes[k])] = static_cast<int>(k);
      all += nodes.size();
    }
  list_.resize(all);
  found_.reserve(256);
}

void WallMeetings::find(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x) noexcept {
  n_ = 0;
  for (std::size_t a = 0; a < rim_.size(); ++a)
    for (std::size_t b = 0; b < rim_.size(); ++b) {
      if (a == b || rim_[a].empty() || rim_[b].empty()) continue;
      const Box other = around(rim_[b], x, reach_);
      for (const int i : rim_[a]) {
        if (static_cast<std::size_t>(n_) == list_.size()) return;
        if (holds(other, x.col(i)) && meet(mesh, tree, x, i, list_[static_cast<std::size_t>(n_)])) ++n_;
      }
    }
  close_lumen(mesh, tree, x);
  for (int k = 0; k < n_; ++k) {
    WallMeeting& m = list_[static_cast<std::size_t>(k)];
    m.from = apart(m, x);
    m.limit = kFriction * stiffness_ * std::max(0.0, -m.normal.dot(m.from));
  }
}

void WallMeetings::close_lumen(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x) noexcept {
  for (const Ring& ring : rings_) {
    if (ring_area(ring.nodes, x) > kNearlyShut * ring.area) continue;
    for (const int i : ring.nodes) {
      if (static_cast<std::size_t>(n_) == list_.size()) return;
      if (meet_across(mesh, tree, x, i, list_[static_cast<std::size_t>(n_)])) ++n_;
    }
  }
}

/// The nearest inner face of the node's own part that is not beside it.
bool WallMeetings::meet_across(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x, int node, WallMeeting& m) noexcept {
  const Vec3 q = x.col(node);
  const auto own = static_cast<std::size_t>(node);
  const int turn = turn_[static_cast<std::size_t>(mesh.node_part[own])];
  const auto beside = [&](int other) {
    const int apart = std::abs(around_[static_cast<std::size_t>(other)] - around_[own]);
    return 8 * std::min(apart, turn - apart) <= turn;
  };
  found_.clear();
  tree.overlaps({q - Vec3::Constant(across_), q + Vec3::Constant(across_)}, found_);
  double least = across_;
  bool met = false;
  for (const int k : found_) {
    if (mesh.faces[static_cast<std::size_t>(k / 2)].surface != WallSurface::inner) continue;
    const Triangle& t = tree.triangles()[static_cast<std::size_t>(k)];
    if (mesh.node_part[static_cast<std::size_t>(t[0])] != mesh.node_part[own] || beside(t[0]) || beside(t[1]) || beside(t[2])) continue;
    const Vec3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
    const TrianglePoint p = closest_on_triangle(q, a, b, c);
    const double distance = (q - p.point).norm();
    if (distance >= least) continue;
    least = distance;
    met = true;
    m = {node, t, p.weights, (b - a).cross(c - a).normalized()};
  }
  return met;
}

/// A cut face of another part that the node stands before or in, if there is one; else the nearest face. Edges of one shape meet rim on rim, where
/// the nearest face of a node that has gone in may be the outer one, and no help.
bool WallMeetings::meet(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x, int node, WallMeeting& m) noexcept {
  const Vec3 q = x.col(node);
  const int part = mesh.node_part[static_cast<std::size_t>(node)];
  found_.clear();
  tree.overlaps({q - Vec3::Constant(reach_), q + Vec3::Constant(reach_)}, found_);
  double least = reach_, facing = 0.0, least_aside = kAside * reach_;
  bool met = false, cut = false;
  for (const int k : found_) {
    const Triangle& t = tree.triangles()[static_cast<std::size_t>(k)];
    if (mesh.node_part[static_cast<std::size_t>(t[0])] == part) continue;
    const Vec3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]), n = (b - a).cross(c - a).normalized();
    const TrianglePoint p = closest_on_triangle(q, a, b, c);
    const Vec3 way = q - p.point;
    const double distance = way.norm(), face = std::abs(way.dot(n));
    if (mesh.faces[static_cast<std::size_t>(k / 2)].surface == WallSurface::edge && face < reach_) {
      const double aside = (way - way.dot(n) * n).norm();
      if (aside > 1e-9 && aside + std::max(0.0, -way.dot(n)) > kAside * reach_) continue;  // behind the face's plane, but past its rim
      if (aside > least_aside || (cut && aside == least_aside)) continue;
      least_aside = aside;
      met = cut = true;
      m = {node, t, p.weights, n};
    } else if (!cut) {
      if (distance > least + 1e-12 || (met && distance > least - 1e-12 && face <= facing)) continue;  // of ties the face that q faces most tells
      least = std::min(least, distance);
      facing = face;
      met = true;
      m = {node, t, p.weights, n};
    }
  }
  return met;
}

Vec3 WallMeetings::apart(const WallMeeting& m, const Points& x) const noexcept {
  return x.col(m.node) - m.weight[0] * x.col(m.face[0]) - m.weight[1] * x.col(m.face[1]) - m.weight[2] * x.col(m.face[2]);
}

double WallMeetings::overlap(int k, const Points& x) const noexcept { return -(*this)[k].normal.dot(apart((*this)[k], x)); }

double WallMeetings::add_forces(const Points& x, Points& force) const noexcept {
  double energy = 0.0;
  for (int k = 0; k < n_; ++k) {
    const WallMeeting& m = (*this)[k];
    const Vec3 d = apart(m, x);
    const double o = std::max(0.0, -m.normal.dot(d));
    if (o == 0.0 && m.limit == 0.0) continue;
    energy += 0.5 * stiffness_ * o * o;
    Vec3 f = stiffness_ * o * m.normal;
    if (m.limit > 0.0) {
      const Vec3 moved = d - m.from, slip = moved - moved.dot(m.normal) * m.normal;
      const double length = slip.norm(), stick = kStick * stiffness_, give = m.limit / stick;
      energy += length < give ? 0.5 * stick * length * length : m.limit * (length - 0.5 * give);
      f -= (length < give ? stick : m.limit / length) * slip;
    }
    force.col(m.node) += f;
    for (int c = 0; c < 3; ++c) force.col(m.face[static_cast<std::size_t>(c)]) -= m.weight[c] * f;
  }
  return energy;
}

}  // namespace filum
