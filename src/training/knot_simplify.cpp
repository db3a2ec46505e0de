#include "training/knot_simplify.h"

#include <cmath>

#include "base/rng.h"
#include "training/exact_predicates.h"

namespace filum {
namespace {

/// Does the segment pq meet the triangle abc? Anything degenerate counts as meeting: then the corner stays.
bool pierces(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Vec3& q) {
  const int side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 || side_q == 0) return true;
  const int ab = orientation(p, q, a, b), bc = orientation(p, q, b, c);
  if (ab * bc < 0) return false;
  const int ca = orientation(p, q, c, a);
  return ab * ca >= 0 && bc * ca >= 0;
}

struct Box {
  Eigen::Array3d low, high;
  Box(const Vec3& a, const Vec3& b) : low(a.array().min(b.array())), high(a.array().max(b.array())) {}
  void add(const Vec3& p) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  bool apart(const Vec3& p, const Vec3& q) const {
    return (p.x() < low.x() && q.x() < low.x()) || (p.x() > high.x() && q.x() > high.x()) ||
           (p.y() < low.y() && q.y() < low.y()) || (p.y() > high.y() && q.y() > high.y()) ||
           (p.z() < low.z() && q.z() < low.z()) || (p.z() > high.z() && q.z() > high.z());
  }
};

/// May corner i go? The two edges at its neighbours touch the triangle at a corner only, unless coplanar with
/// it.
bool removable(const GridPolygon& polygon, std::size_t i) {
  const std::size_t n = polygon.size();
  const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
  const Vec3 &a = polygon[before], &b = polygon[i], &c = polygon[after];
  if (n > 3) {
    if (orientation(a, b, c, polygon[(before + n - 1) % n]) == 0) return false;
    if (orientation(a, b, c, polygon[(after + 1) % n]) == 0) return false;
  }
  Box box(a, b);
  box.add(c);
  std::size_t from = after;
  for (std::size_t step = 2; step + 2 < n; ++step) {  // edges not touching a, b or c
    from = from + 1 == n ? 0 : from + 1;
    const Vec3 &p = polygon[from], &q = polygon[from + 1 == n ? 0 : from + 1];
    if (!box.apart(p, q) && pierces(a, b, c, p, q)) return false;
  }
  return true;
}

/// Drops two crossings (or one, twice named) from code and signs.
void drop(KnotDiagram& diagram, int first, int second) {
  std::vector<int> renamed(diagram.sign.size(), -1);
  std::vector<int> sign;
  for (int k = 0; k < diagram.crossings(); ++k) {
    if (k == first || k == second) continue;
    renamed[static_cast<std::size_t>(k)] = static_cast<int>(sign.size());
    sign.push_back(diagram.sign[static_cast<std::size_t>(k)]);
  }
  std::vector<KnotDiagram::Visit> code;
  for (const KnotDiagram::Visit& visit : diagram.code) {
    const int name = renamed[static_cast<std::size_t>(visit.crossing)];
    if (name >= 0) code.push_back({name, visit.over});
  }
  diagram.sign = std::move(sign);
  diagram.code = std::move(code);
}

bool remove_loop(KnotDiagram& diagram) {
  const std::size_t n = diagram.code.size();
  for (std::size_t k = 0; k < n; ++k) {
    const int crossing = diagram.code[k].crossing;
    if (crossing == diagram.code[(k + 1) % n].crossing) {
      drop(diagram, crossing, crossing);
      return true;
    }
  }
  return false;
}

bool remove_pair(KnotDiagram& diagram) {
  const std::size_t n = diagram.code.size();
  std::vector<std::size_t> under_at(diagram.sign.size());
  for (std::size_t k = 0; k < n; ++k) {
    if (!diagram.code[k].over) under_at[static_cast<std::size_t>(diagram.code[k].crossing)] = k;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const KnotDiagram::Visit &x = diagram.code[k], &y = diagram.code[(k + 1) % n];
    if (!x.over || !y.over || x.crossing == y.crossing) continue;
    const std::size_t ux = under_at[static_cast<std::size_t>(x.crossing)];
    const std::size_t uy = under_at[static_cast<std::size_t>(y.crossing)];
    const bool neighbours = (ux + 1) % n == uy || (uy + 1) % n == ux;
    // Opposite signs mean that the two edges bound a disc between them: the strands can be pulled apart.
    const bool opposite = diagram.sign[static_cast<std::size_t>(x.crossing)] !=
                          diagram.sign[static_cast<std::size_t>(y.crossing)];
    if (neighbours && opposite) {
      drop(diagram, x.crossing, y.crossing);
      return true;
    }
  }
  return false;
}

}  // namespace

GridPolygon to_grid(const Points& closed_curve, std::uint64_t seed) {
  Rng random(seed);
  const Vec3 low = closed_curve.rowwise().minCoeff(), high = closed_curve.rowwise().maxCoeff();
  const Vec3 centre = 0.5 * (low + high);
  const double half = std::max(0.5 * (high - low).maxCoeff(), 1e-300);
  const double steps = 0x1.0p26 / half;
  GridPolygon polygon;
  polygon.reserve(static_cast<std::size_t>(closed_curve.cols()));
  for (Eigen::Index k = 0; k < closed_curve.cols(); ++k) {
    Vec3 p = steps * (closed_curve.col(k) - centre);
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = std::round(p[axis]) + static_cast<double>(random.below(9)) - 4.0;
    polygon.push_back(p);
  }
  return polygon;
}

void shrink(GridPolygon& polygon) {
  std::size_t i = 0, kept = 0;
  while (polygon.size() > 3 && kept < polygon.size()) {
    i %= polygon.size();
    if (removable(polygon, i)) {
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
      kept = 0;
      ++i;  // skip the neighbour: corners thin out evenly instead of one run being eaten up
    } else {
      ++kept;
      ++i;
    }
  }
}

void reduce(KnotDiagram& diagram) {
  while (remove_loop(diagram) || remove_pair(diagram)) {
  }
}

}  // namespace filum
