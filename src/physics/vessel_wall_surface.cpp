// Questions about places on and in the wall.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "collision/point_triangle.h"
#include "physics/vessel_wall.h"

namespace filum {
namespace {

Vec3 corner_local(int a) noexcept { return {a & 1 ? 1.0 : -1.0, a & 2 ? 1.0 : -1.0, a & 4 ? 1.0 : -1.0}; }

/// Unit, of a triangle whose corners lie `at`; none of one that has no area.
template <class At>
Vec3 normal_of(const Triangle& t, const At& at) noexcept {
  const Vec3 p = at(t[0]);
  return Vec3(at(t[1]) - p).cross(Vec3(at(t[2]) - p)).normalized();
}

/// Fraction of the segment where it meets the triangle and the weights of the corners; false if it does not.
bool meets(const Vec3& a, const Vec3& d, const Vec3& p, const Vec3& q, const Vec3& r, double& fraction, Vec3& weights) noexcept {
  const Vec3 e1 = q - p, e2 = r - p, h = d.cross(e2);
  const double det = e1.dot(h);
  if (std::abs(det) < 1e-12 * e1.norm() * e2.norm() * d.norm()) return false;
  const Vec3 s = a - p, k = s.cross(e1);
  const double u = s.dot(h) / det, v = d.dot(k) / det;
  constexpr double kRim = 1e-9;
  if (u < -kRim || v < -kRim || u + v > 1.0 + kRim) return false;
  fraction = e2.dot(k) / det;
  weights = {1.0 - u - v, u, v};
  return fraction >= 0.0 && fraction <= 1.0;
}

}  // namespace

Vec3 VesselWall::position(const WallState& state, const WallPoint& at) const noexcept {
  const auto& nodes = mesh_.elements[static_cast<std::size_t>(at.element)];
  const auto w = corner_weights(at.local);
  Vec3 p = Vec3::Zero();
  for (int a = 0; a < 8; ++a) p += w[a] * state.x.col(nodes[static_cast<std::size_t>(a)]);
  return p;
}

Vec3 VesselWall::velocity(const WallState& state, const WallPoint& at) const noexcept {
  const auto& nodes = mesh_.elements[static_cast<std::size_t>(at.element)];
  const auto w = corner_weights(at.local);
  Vec3 p = Vec3::Zero();
  for (int a = 0; a < 8; ++a) p += w[a] * state.v.col(nodes[static_cast<std::size_t>(a)]);
  return p;
}

VesselWall::OnTriangle VesselWall::triangle_of(const WallPoint& at) const noexcept {
  int axis = 0;
  at.local.cwiseAbs().maxCoeff(&axis);
  const auto& side = kElementSides[static_cast<std::size_t>(2 * axis + (at.local[axis] < 0.0))];
  const auto& nodes = mesh_.elements[static_cast<std::size_t>(at.element)];
  const auto corner = [&](std::size_t c) { return nodes[static_cast<std::size_t>(side[c])]; };
  const auto share = [&](std::size_t c) {  // of the way from corner 0 to c, by the local coordinates
    const Vec3 from = corner_local(side[0]), way = corner_local(side[c]) - from;
    return (at.local - from).dot(way) / way.squaredNorm();
  };
  const double u = share(1), v = share(3);  // a side is cut from corner 0 to 2, see face_triangles()
  return u >= v ? OnTriangle{{corner(0), corner(1), corner(2)}, {1.0 - u, u - v, v}} : OnTriangle{{corner(0), corner(2), corner(3)}, {1.0 - v, u, v - u}};
}

Vec3 VesselWall::on_triangle(const WallState& state, const WallPoint& at) const noexcept {
  const OnTriangle t = triangle_of(at);
  return t.weights[0] * state.x.col(t.nodes[0]) + t.weights[1] * state.x.col(t.nodes[1]) + t.weights[2] * state.x.col(t.nodes[2]);
}

VesselWall::SideNormals VesselWall::side_normals(const WallState& state, const WallPoint& at) const noexcept {
  const Triangle t = triangle_of(at).nodes;
  return {normal_of(t, [&](int i) -> Vec3 { return was(state, i); }), normal_of(t, [&](int i) -> Vec3 { return state.x.col(i); })};
}

Mat3 VesselWall::directions(const WallState& state, const WallPoint& at) const noexcept {
  const auto& nodes = mesh_.elements[static_cast<std::size_t>(at.element)];
  Mat3 g = Mat3::Zero();
  for (int a = 0; a < 8; ++a) {
    const Vec3 c = corner_local(a), w = 0.5 * (Vec3::Ones() + c.cwiseProduct(at.local));
    const Vec3 d = 0.5 * Vec3(c.x() * w.y() * w.z(), c.y() * w.x() * w.z(), c.z() * w.x() * w.y());
    g += state.x.col(nodes[static_cast<std::size_t>(a)]) * d.transpose();
  }
  return g;
}

double VesselWall::depth_at(const WallPoint& at) const noexcept {
  const auto& span = mesh_.span[static_cast<std::size_t>(at.element)];
  return 1.0 - (span[0] + 0.5 * (at.local.z() + 1.0) * (span[1] - span[0]));
}

void VesselWall::refit(const WallState& state) noexcept { tree_.refit(state.x); }

namespace {

/// The crossing or nearest point at `weights` of a triangle whose corners lie `at`.
template <class At>
void describe(const VesselMesh& mesh, const std::vector<Triangle>& triangles, const At& at, int triangle, const Vec3& weights, WallCrossing& c) noexcept {
  const WallFace& face = mesh.faces[static_cast<std::size_t>(triangle / 2)];
  const std::array<std::size_t, 3> corner = triangle % 2 ? std::array<std::size_t, 3>{0, 2, 3} : std::array<std::size_t, 3>{0, 1, 2};
  c.found = true;
  c.triangle = triangle;
  c.weights = weights;
  c.surface = face.surface;
  c.point.element = face.element;
  c.point.local.setZero();
  for (int k = 0; k < 3; ++k) c.point.local += weights[k] * corner_local(face.corner[corner[static_cast<std::size_t>(k)]]);
  c.normal = normal_of(triangles[static_cast<std::size_t>(triangle)], at);
}

/// From the place that is nearest to q, at `distance`.
Vec3 away_from(const WallCrossing& c, const Vec3& place, const Vec3& q, double distance) noexcept {
  constexpr double kOnSurface = 1e-9;  // [m], distance that is none
  return distance > kOnSurface ? Vec3((q - place) / std::copysign(distance, c.fraction)) : c.normal;
}

}  // namespace

bool VesselWall::near(const Vec3& low, const Vec3& high) const noexcept {
  return tree_.overlaps({low, high});
}

WallCrossing VesselWall::crossing(const WallState& state, const Vec3& a, const Vec3& b, double from, double until) const noexcept {
  WallCrossing best;
  found_.clear();
  const Vec3 end = until < 1.0 ? Vec3(a + until * (b - a)) : b;
  tree_.overlaps({a.cwiseMin(end), a.cwiseMax(end)}, found_);
  int triangle = -1;
  Vec3 weights = Vec3::Zero();
  for (const int k : found_) {
    const Triangle& t = triangles()[static_cast<std::size_t>(k)];
    if (state.soundness[static_cast<std::size_t>(mesh_.faces[static_cast<std::size_t>(k / 2)].element)] == 0.0) continue;
    double fraction = 0.0;
    Vec3 w;
    if (!meets(a, b - a, state.x.col(t[0]), state.x.col(t[1]), state.x.col(t[2]), fraction, w)) continue;
    if (fraction < from || fraction > until || (best.found && fraction >= best.fraction)) continue;
    best.found = true;
    best.fraction = fraction;
    triangle = k;
    weights = w;
  }
  if (!best.found) return best;
  describe(mesh_, triangles(), [&](int i) -> Vec3 { return state.x.col(i); }, triangle, weights, best);
  best.layer = layer_at(best.point);
  return best;
}

WallCrossing VesselWall::nearest(const WallState& state, const Vec3& q, double reach) const noexcept {
  return nearest_of(state, q, reach, reach, [&](int i) -> Vec3 { return state.x.col(i); });
}

WallCrossing VesselWall::nearest_before(const WallState& state, const Vec3& q, double reach, double farthest) const noexcept {
  return nearest_of(state, q, reach, reach + farthest, [&](int i) -> Vec3 { return was(state, i); });
}

template <class At>
WallCrossing VesselWall::nearest_of(const WallState& state, const Vec3& q, double reach, double search, const At& at) const noexcept {
  WallCrossing best;
  found_.clear();
  tree_.overlaps({q - Vec3::Constant(search), q + Vec3::Constant(search)}, found_);
  int triangle = -1;
  double least = reach;
  TrianglePoint place;
  double facing = -1.0;  // of ties at shared sides the triangle that q faces most tells inside from outside; -1: not asked yet
  const auto face = [&](int k, const TrianglePoint& c) {
    return std::abs((q - c.point).dot(normal_of(triangles()[static_cast<std::size_t>(k)], at)));
  };
  for (const int k : found_) {
    const Triangle& t = triangles()[static_cast<std::size_t>(k)];
    if (state.soundness[static_cast<std::size_t>(mesh_.faces[static_cast<std::size_t>(k / 2)].element)] == 0.0) continue;
    const TrianglePoint c = closest_on_triangle(q, at(t[0]), at(t[1]), at(t[2]));
    const double distance = (q - c.point).norm();
    if (distance > least + 1e-12) continue;
    double own = -1.0;
    if (triangle >= 0 && distance > least - 1e-12) {
      if (facing < 0.0) facing = face(triangle, place);
      own = face(k, c);
      if (own <= facing) continue;
    }
    least = std::min(least, distance);
    facing = own;
    triangle = k;
    place = c;
  }
  if (triangle < 0) return best;
  describe(mesh_, triangles(), at, triangle, place.weights, best);
  const double distance = (q - place.point).norm();
  best.fraction = (q - place.point).dot(best.normal) >= 0.0 ? distance : -distance;
  best.away = away_from(best, place.point, q, distance);
  best.layer = layer_at(best.point);
  return best;
}

int VesselWall::around(const WallState& state, const Vec3& q, double radius, WallCrossing* places, int room) const noexcept {
  if (room == 0) return 0;
  places[0] = nearest(state, q, radius);
  if (!places[0].found || places[0].fraction < 0.0) return places[0].found ? 1 : 0;
  int n = 1;
  for (const int k : found_) {
    const Triangle& t = triangles()[static_cast<std::size_t>(k)];
    if (k == places[0].triangle || state.soundness[static_cast<std::size_t>(mesh_.faces[static_cast<std::size_t>(k / 2)].element)] == 0.0) continue;
    const TrianglePoint c = closest_on_triangle(q, state.x.col(t[0]), state.x.col(t[1]), state.x.col(t[2]));
    const double distance = (c.point - q).norm();
    if (distance > radius || (n == room && distance >= places[n - 1].fraction)) continue;
    n = std::min(n + 1, room);
    int j = n - 1;
    for (; j > 1 && places[j - 1].fraction > distance; --j) places[j] = places[j - 1];  // the nearest first
    describe(mesh_, triangles(), [&](int i) -> Vec3 { return state.x.col(i); }, k, c.weights, places[j]);
    places[j].fraction = distance;
    places[j].away = away_from(places[j], c.point, q, distance);
    places[j].layer = layer_at(places[j].point);
  }
  return n;
}

WallPoint VesselWall::locate(const WallState& state, const Vec3& q, const WallPoint& guess) const noexcept {
  WallPoint p = guess;
  for (int k = 0; k < 20; ++k) {
    const Vec3 miss = q - position(state, p);
    const Vec3 d = directions(state, p).partialPivLu().solve(miss);
    if (!d.allFinite()) break;
    p.local += d.cwiseMax(-1.0).cwiseMin(1.0);
    p.local = p.local.cwiseMax(-3.0).cwiseMin(3.0);
    if (d.cwiseAbs().maxCoeff() < 1e-10) break;
  }
  return p;
}

int VesselWall::settle(WallState& state, int most_steps, double speed) {
  int k = 0;
  while (k < most_steps) {
    ++k;
    const WallSummary r = step(state);
    if (!r.sound || state.v.colwise().norm().maxCoeff() < speed) break;
  }
  state.v.setZero();
  return k;
}

}  // namespace filum
