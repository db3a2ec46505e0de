#include "training/knot_diagram.h"

#include <algorithm>
#include <numeric>

#include "base/rng.h"
#include "training/exact_predicates.h"
#include "training/knot_simplify.h"

namespace filum {
namespace {

struct Hit {
  std::size_t edge;  // polygon edge that is crossed here
  double parameter;  // along that edge, 0..1
  int crossing;
  bool over;
};

enum class Meeting { none, crossing, degenerate };

/// Do the edges p0p1 and q0q1 cross in the picture? Fills the sign and which one is on top.
Meeting meet(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, const Vec3& d, int& sign,
             bool& p_over) {
  const Vec3 u = p1 - p0, v = q1 - q0, w = q0 - p0;
  const int q0_side = sign_det(u, w, d), q1_side = sign_det(u, q1 - p0, d);
  if (q0_side * q1_side > 0) return Meeting::none;
  const int p0_side = sign_det(v, -w, d), p1_side = sign_det(v, p1 - q0, d);
  if (p0_side * p1_side > 0) return Meeting::none;
  if (q0_side == 0 || q1_side == 0 || p0_side == 0 || p1_side == 0) return Meeting::degenerate;
  const int turn = sign_det(u, v, d), lift = sign_det(u, v, w);
  if (turn == 0 || lift == 0) return Meeting::degenerate;
  p_over = lift * turn < 0;
  sign = p_over ? turn : -turn;
  return Meeting::crossing;
}

double crossing_parameter(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, const Vec3& d) {
  const Vec3 normal = (q1 - q0).cross(d);
  return normal.dot(q0 - p0) / normal.dot(p1 - p0);
}

bool adjacent(std::size_t i, std::size_t j, std::size_t n) {
  return j == i + 1 || (i == 0 && j == n - 1);
}

/// Sorts the hits along the curve; false when two of them on an edge are too close to be ordered with
/// certainty.
bool order_along_curve(std::vector<Hit>& hits) {
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.parameter < b.parameter;
  });
  for (std::size_t k = 1; k < hits.size(); ++k) {
    if (hits[k].edge == hits[k - 1].edge && hits[k].parameter - hits[k - 1].parameter < 1e-10) return false;
  }
  return true;
}

}  // namespace

int KnotDiagram::writhe() const {
  return std::accumulate(sign.begin(), sign.end(), 0);
}

std::optional<KnotDiagram> project(const GridPolygon& polygon, const Vec3& direction) {
  const std::size_t n = polygon.size();
  std::vector<Hit> hits;
  KnotDiagram diagram;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Vec3 &p0 = polygon[i], &p1 = polygon[i + 1];
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vec3 &q0 = polygon[j], &q1 = polygon[(j + 1) % n];
      if (adjacent(i, j, n)) {
        // Neighbours share a corner: fold-backs in the picture would hide a crossing.
        if (sign_det(p1 - p0, q1 - q0, direction) == 0) return std::nullopt;
        continue;
      }
      int sign = 0;
      bool p_over = false;
      const Meeting meeting = meet(p0, p1, q0, q1, direction, sign, p_over);
      if (meeting == Meeting::none) continue;
      if (meeting == Meeting::degenerate) return std::nullopt;
      const int crossing = diagram.crossings();
      diagram.sign.push_back(sign);
      hits.push_back({i, crossing_parameter(p0, p1, q0, q1, direction), crossing, p_over});
      hits.push_back({j, crossing_parameter(q0, q1, p0, p1, direction), crossing, !p_over});
    }
  }
  if (!order_along_curve(hits)) return std::nullopt;
  for (const Hit& hit : hits) diagram.code.push_back({hit.crossing, hit.over});
  return diagram;
}

KnotDiagram project_best(const GridPolygon& polygon, std::uint64_t seed, int tries) {
  Rng random(seed);
  const auto component = [&random] { return static_cast<double>(random.below(8191)) - 4095.0; };
  KnotDiagram best;
  bool found = false;
  // A degenerate direction is improbable (the grid points are jittered), so ten times the tries is never used
  // up.
  for (int attempt = 0, good = 0; good < tries && attempt < 10 * tries + 100; ++attempt) {
    Vec3 d;
    do {
      d = Vec3(component(), component(), component());
    } while (d.squaredNorm() < 1e6 || d.squaredNorm() > 16.7e6);
    std::optional<KnotDiagram> diagram = project(polygon, d);
    if (!diagram) continue;
    ++good;
    reduce(*diagram);
    if (!found || diagram->crossings() < best.crossings()) best = *diagram;
    found = true;
    if (best.crossings() == 0) break;
  }
  return best;
}

}  // namespace filum
