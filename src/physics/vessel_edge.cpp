#include "physics/vessel_edge.h"

#include <algorithm>
#include <array>
#include <limits>

#include "physics/vessel_leak.h"

namespace filum {
namespace {

constexpr double kNearest = 1.0, kFarthest = 4.0;  // wall thicknesses, of the ring behind from the edge [P]

Vec3 middle_of(const std::vector<int>& ring, const Points& x) {
  Vec3 m = Vec3::Zero();
  for (const int i : ring) m += x.col(i) / static_cast<double>(ring.size());
  return m;
}

/// A ring seen along its normal.
struct Outline {
  Vec3 middle, normal, right, up;  // [m], unit vectors
  std::vector<Eigen::Vector2d> corners;

  Outline(const std::vector<int>& ring, const Points& x) : middle(middle_of(ring, x)), normal(Vec3::Zero()) {
    for (std::size_t k = 0; k < ring.size(); ++k) normal += (x.col(ring[k]) - middle).cross(x.col(ring[(k + 1) % ring.size()]) - middle);
    normal.normalize();
    const Vec3 first = x.col(ring[0]) - middle;
    right = (first - first.dot(normal) * normal).normalized();
    up = normal.cross(right);
    for (const int i : ring) corners.push_back(flat(x.col(i) - middle));
  }
  Eigen::Vector2d flat(const Vec3& r) const { return {r.dot(right), r.dot(up)}; }

  /// Distance of a place (from the middle) to the line, if it is within.
  double depth(const Vec3& r) const {
    const Eigen::Vector2d q = flat(r);
    bool inside = false;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Eigen::Vector2d a = corners[k], run = corners[(k + 1) % corners.size()] - a;
      if ((a.y() > q.y()) != (a.y() + run.y() > q.y()) && q.x() < a.x() + run.x() * (q.y() - a.y()) / run.y()) inside = !inside;
      const double t = std::clamp((q - a).dot(run) / std::max(run.squaredNorm(), 1e-30), 0.0, 1.0);
      least = std::min(least, (a + t * run - q).norm());
    }
    return inside ? least : 0.0;
  }
};

double cut_roll(const std::vector<std::vector<int>>& rings, const std::vector<int>& rim, double thickness, const VesselMesh& mesh, const Points& x) {
  const Vec3 middle = middle_of(rim, x), edge_at = middle_of(rings.back(), mesh.nodes);
  double most = 0.0;
  for (std::size_t k = rings.size() - 1; k-- > 0;) {
    const double back = (middle_of(rings[k], mesh.nodes) - edge_at).norm() / thickness;
    const bool next = k + 2 == rings.size();  // however coarse the mesh is
    if (!next && back > kFarthest) break;
    if (!next && back < kNearest) continue;
    const Outline behind(rings[k], x);
    for (const int i : rim) most = std::max(most, behind.depth(x.col(i) - middle));
  }
  return most;
}

double opening_roll(const std::vector<std::vector<int>>& rings, const std::vector<int>& rim, const VesselMesh& mesh, const Points& x) {
  int least = std::numeric_limits<int>::max(), most_slab = 0;
  for (const int i : rim) {
    least = std::min(least, mesh.slab[static_cast<std::size_t>(i)]);
    most_slab = std::max(most_slab, mesh.slab[static_cast<std::size_t>(i)]);
  }
  const auto slab = [&](const std::vector<int>& ring) { return mesh.slab[static_cast<std::size_t>(ring.front())]; };
  const auto behind = std::find_if(rings.rbegin(), rings.rend(), [&](const auto& r) { return slab(r) < least; });
  const auto ahead = std::find_if(rings.begin(), rings.end(), [&](const auto& r) { return slab(r) > most_slab; });
  if (behind == rings.rend() || ahead == rings.end()) return 0.0;
  const std::array<Outline, 2> ends = {Outline(*behind, x), Outline(*ahead, x)};
  const Vec3 way = ends[1].middle - ends[0].middle;
  double most = 0.0;
  for (const int i : rim) {
    const double share = (x.col(i) - ends[0].middle).dot(way) / way.squaredNorm();
    most = std::max(most, ends[share < 0.5 ? 0 : 1].depth(x.col(i) - ends[0].middle - share * way));
  }
  return most;
}

}  // namespace

double edge_roll(const VesselMesh& mesh, const Points& x, int part) {
  std::vector<int> rim;
  double thickness = 0.0;
  for (const int inner : mesh.edge_ring[static_cast<std::size_t>(part)]) {
    rim.push_back(outer_of(mesh, inner));
    thickness += (mesh.nodes.col(rim.back()) - mesh.nodes.col(inner)).norm();
  }
  thickness /= static_cast<double>(rim.size());
  const std::vector<std::vector<int>> rings = inner_rings(mesh, part);
  const bool cut_through = std::find(rings.back().begin(), rings.back().end(), mesh.edge_ring[static_cast<std::size_t>(part)][0]) != rings.back().end();
  return cut_through ? cut_roll(rings, rim, thickness, mesh, x) : opening_roll(rings, rim, mesh, x);
}

}  // namespace filum
