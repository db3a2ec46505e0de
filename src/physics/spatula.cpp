#include "physics/spatula.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "collision/point_triangle.h"

namespace filum {
namespace {

/// Angle [rad] of the middle line at distance s from the tip.
double angle_at(const BladeShape& shape, double s) {
  double angle = 0.0;
  for (const BladeBend& b : shape.bends) angle += b.angle * std::clamp((s - b.at) / b.length, 0.0, 1.0);
  return angle;
}

double width_at(const BladeShape& shape, double s) {
  if (shape.taper <= 0.0 || s >= shape.taper) return shape.width;
  const double t = s / shape.taper;
  return shape.tip_width + (shape.width - shape.tip_width) * t * (2.0 - t);
}

SurfacePoint beside(const RigidSurface& s, int triangle, const TrianglePoint& nearest, const Vec3& q) {
  SurfacePoint p;
  p.triangle = triangle;
  p.point = nearest.point;
  p.normal = s.normals[static_cast<std::size_t>(triangle)];
  const Vec3 off = q - nearest.point;
  p.gap = p.normal.dot(off);
  const double past = (off - p.gap * p.normal).norm();
  for (std::size_t k = 0; k < 3; ++k) {  // a corner of the border is that of triangles with no side on it, too
    const double weight = nearest.weights[static_cast<int>(k)];
    const bool side = weight < 1e-9 && s.neighbours[static_cast<std::size_t>(triangle)][k] < 0;
    const bool corner = weight > 1.0 - 1e-9 && s.on_border[static_cast<std::size_t>(s.triangles[static_cast<std::size_t>(triangle)][k])] != 0;
    if (side || corner) p.beyond = past;
  }
  return p;
}

TrianglePoint closest_in(const RigidSurface& s, int t, const Vec3& q) {
  const Triangle& c = s.triangles[static_cast<std::size_t>(t)];
  return closest_on_triangle(q, s.vertices.col(c[0]), s.vertices.col(c[1]), s.vertices.col(c[2]));
}

/// Of every triangle; balls about blocks and triangles spare most of them.
int nearest_triangle(const RigidSurface& s, const Vec3& q) {
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity(), reach = least;  // squared distance of the nearest so far, distance
  const auto look = [&](std::size_t block) {
    const std::size_t first = block * RigidSurface::kBlock, last = std::min(s.triangles.size(), first + RigidSurface::kBlock);
    for (std::size_t t = first; t < last; ++t) {
      const double far = s.radii[t] + reach;
      if ((s.centres[t] - q).squaredNorm() >= far * far) continue;
      const double d = (closest_in(s, static_cast<int>(t), q).point - q).squaredNorm();
      if (d >= least) continue;
      least = d;
      reach = std::sqrt(d);
      nearest = static_cast<int>(t);
    }
  };
  std::size_t start = 0;
  double near = least;
  for (std::size_t b = 0; b < s.block_centres.size(); ++b)
    if (const double d = (s.block_centres[b] - q).squaredNorm(); d < near) {
      near = d;
      start = b;
    }
  look(start);
  for (std::size_t b = 0; b < s.block_centres.size(); ++b) {
    const double far = s.block_radii[b] + reach;
    if (b != start && (s.block_centres[b] - q).squaredNorm() < far * far) look(b);
  }
  return nearest;
}

}  // namespace

void check_blade(const BladeShape& b, const std::string& file) {
  const auto text = [](double metres) { return std::to_string(1e3 * metres) + " mm"; };
  for (const auto& [field, width] : {std::pair("width", b.width), std::pair("tip_width", b.tip_width)})
    if (!(width >= 1.999e-3 && width <= 25.001e-3)) throw InputError(file, field, text(width), "2 mm to 25 mm");
  if (!(b.length > 0.0 && b.taper >= 0.0 && b.taper <= b.length)) throw InputError(file, "taper", text(b.taper), "0 up to the length");
  if (!(b.grip > 0.0)) throw InputError(file, "grip", text(b.grip), "a distance above 0");
  for (const BladeBend& k : b.bends) {
    if (!(k.at >= 0.0 && k.at <= b.length && k.length > 0.0)) throw InputError(file, "bends", text(k.at), "a place on the blade");
    if (!(std::abs(k.angle) < 2.0)) throw InputError(file, "bends", std::to_string(k.angle) + " rad", "less than 2 rad");
  }
}

RigidSurface rigid_surface(Points vertices, std::vector<Triangle> triangles) {
  RigidSurface s;
  s.vertices = std::move(vertices);
  s.triangles = std::move(triangles);
  std::map<std::pair<int, int>, std::pair<int, int>> sides;  // nodes -> triangle, corner opposite
  s.neighbours.assign(s.triangles.size(), {-1, -1, -1});
  for (int t = 0; t < static_cast<int>(s.triangles.size()); ++t) {
    const Triangle& c = s.triangles[static_cast<std::size_t>(t)];
    const Vec3 a = s.vertices.col(c[0]), b = s.vertices.col(c[1]), d = s.vertices.col(c[2]);
    s.normals.push_back((b - a).cross(d - a).normalized());
    s.centres.push_back((a + b + d) / 3.0);
    s.radii.push_back(std::sqrt(std::max({(a - s.centres.back()).squaredNorm(), (b - s.centres.back()).squaredNorm(), (d - s.centres.back()).squaredNorm()})));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto side = std::minmax(c[(k + 1) % 3], c[(k + 2) % 3]);
      const auto [at, fresh] = sides.emplace(std::pair(side.first, side.second), std::pair(t, static_cast<int>(k)));
      if (fresh) continue;
      s.neighbours[static_cast<std::size_t>(t)][k] = at->second.first;
      s.neighbours[static_cast<std::size_t>(at->second.first)][static_cast<std::size_t>(at->second.second)] = t;
    }
  }
  s.on_border.assign(static_cast<std::size_t>(s.vertices.cols()), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (s.neighbours[t][k] < 0)
        for (const std::size_t end : {(k + 1) % 3, (k + 2) % 3}) s.on_border[static_cast<std::size_t>(s.triangles[t][end])] = 1;
  for (std::size_t first = 0; first < s.triangles.size(); first += RigidSurface::kBlock) {
    const std::size_t last = std::min(s.triangles.size(), first + RigidSurface::kBlock);
    Vec3 middle = Vec3::Zero();
    for (std::size_t t = first; t < last; ++t) middle += s.centres[t] / static_cast<double>(last - first);
    double radius = 0.0;
    for (std::size_t t = first; t < last; ++t) radius = std::max(radius, (s.centres[t] - middle).norm() + s.radii[t]);
    s.block_centres.push_back(middle);
    s.block_radii.push_back(radius);
  }
  s.low = s.vertices.rowwise().minCoeff();
  s.high = s.vertices.rowwise().maxCoeff();
  return s;
}

RigidSurface blade_surface(const BladeShape& shape, int along, int across) {
  Points v(3, (along + 1) * (across + 1));
  Vec3 middle = Vec3::Zero();
  constexpr int kFine = 50;  // points of the middle line in each cell
  const double ds = shape.length / (along * kFine);
  for (int i = 0; i <= along; ++i) {
    const double s = shape.length * i / along;
    for (int j = 0; j <= across; ++j) v.col(i * (across + 1) + j) = middle + Vec3((double(j) / across - 0.5) * width_at(shape, s), 0, 0);
    for (int k = 0; k < kFine; ++k) {
      const double angle = angle_at(shape, s + (k + 0.5) * ds);
      middle += ds * Vec3(0, std::sin(angle), std::cos(angle));
    }
  }
  std::vector<Triangle> triangles;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const int a = i * (across + 1) + j, b = a + 1, c = a + across + 1, d = c + 1;
      triangles.push_back({a, d, b});  // normals along +y where the blade is flat
      triangles.push_back({a, c, d});
    }
  return rigid_surface(std::move(v), std::move(triangles));
}

SurfacePoint nearest_point(const RigidSurface& s, const Vec3& q, int hint) noexcept {
  if (hint < 0) hint = nearest_triangle(s, q);
  TrianglePoint best = closest_in(s, hint, q);
  double least = (best.point - q).squaredNorm();
  for (int from = -1; from != hint;) {  // downhill from triangle to triangle
    from = hint;
    for (const int t : s.neighbours[static_cast<std::size_t>(from)]) {
      if (t < 0) continue;
      const TrianglePoint p = closest_in(s, t, q);
      const double d = (p.point - q).squaredNorm();
      if (d >= least) continue;
      least = d;
      best = p;
      hint = t;
    }
  }
  return beside(s, hint, best, q);
}

}  // namespace filum
