#include "physics/vessel_leak.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "collision/point_triangle.h"

namespace filum {
namespace {

/// Distance from q to the wall of a part, its held end left out; 0 within the wall: edges pressed together are closed.
double distance_to(const VesselMesh& mesh, const Points& x, int part, const Vec3& q, Vec3& nearest) noexcept {
  double least = std::numeric_limits<double>::infinity(), facing = 0.0;
  bool inside = false;
  for (const WallFace& f : mesh.faces) {
    if (mesh.part[static_cast<std::size_t>(f.element)] != part || f.surface == WallSurface::end) continue;
    const auto& nodes = mesh.elements[static_cast<std::size_t>(f.element)];
    const auto at = [&](std::size_t c) { return Vec3(x.col(nodes[static_cast<std::size_t>(f.corner[c])])); };
    for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{1, 2}, {2, 3}}) {
      const Vec3 p = closest_on_triangle(q, at(0), at(i), at(j)).point;
      const double distance = (p - q).norm(), out = (q - p).dot((at(i) - at(0)).cross(at(j) - at(0)).normalized());
      if (distance > least + 1e-12 || (distance > least - 1e-12 && std::abs(out) <= facing)) continue;  // of ties the face that q faces most tells
      least = std::min(least, distance);
      facing = std::abs(out);
      inside = out < 0.0;
      nearest = p;
    }
  }
  return inside ? 0.0 : least;
}

struct RingSpan {
  Vec3 middle, area;  // [m], [m2]: vector area
};
RingSpan span_of(const std::vector<int>& ring, const Points& x) noexcept {
  RingSpan s{Vec3::Zero(), Vec3::Zero()};
  for (const int i : ring) s.middle += x.col(i) / static_cast<double>(ring.size());
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec3 p = x.col(ring[k]), q = x.col(ring[(k + 1) % ring.size()]);
    s.area += 0.5 * (p - s.middle).cross(q - s.middle);
  }
  return s;
}

}  // namespace

int outer_of(const VesselMesh& mesh, int inner) noexcept {
  int node = inner;
  for (bool moved = true; moved;) {
    moved = false;
    for (const auto& nodes : mesh.elements)
      for (std::size_t a = 0; a < 4 && !moved; ++a)
        if (nodes[a] == node) {
          node = nodes[a + 4];
          moved = true;
        }
  }
  return node;
}

double slit_speed(double gap, double depth, const BloodOptions& o) noexcept {
  if (gap <= o.seal || o.pressure <= 0.0) return 0.0;
  const double a = 0.5 * o.density / (o.discharge * o.discharge), b = 12.0 * o.viscosity * depth / (gap * gap);
  return 2.0 * o.pressure / (b + std::sqrt(b * b + 4.0 * a * o.pressure));
}

EdgeGap edge_gap(const VesselMesh& mesh, const Points& x, int a, int b, std::size_t k) noexcept {
  const std::vector<int>& ring = mesh.edge_ring[static_cast<std::size_t>(a)];
  const int inner = ring[k], next = ring[(k + 1) % ring.size()], outer = outer_of(mesh, inner);
  EdgeGap g{std::numeric_limits<double>::infinity(), (x.col(outer) - x.col(inner)).norm(), (x.col(next) - x.col(inner)).norm(), Vec3::Zero(),
            mesh.edge_share[static_cast<std::size_t>(a)][k]};
  for (const double share : {0.0, 0.5, 1.0}) {
    const Vec3 q = (1.0 - share) * x.col(inner) + share * x.col(outer);
    Vec3 nearest = q;
    const double d = distance_to(mesh, x, b, q, nearest);
    if (d >= g.gap) continue;
    g.gap = d;
    g.place = 0.5 * (q + nearest);
  }
  return g;
}

double leak_through(std::span<const EdgeGap> gaps, std::span<LeakSector> sectors, const BloodOptions& blood) noexcept {
  std::fill(sectors.begin(), sectors.end(), LeakSector{});
  LeakSector nowhere;
  double whole = 0.0, widest = -1.0;
  std::size_t last = sectors.size();
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const EdgeGap &here = gaps[k], &next = gaps[(k + 1) % gaps.size()];
    const auto number = std::min(static_cast<std::size_t>(here.share * static_cast<double>(sectors.size())), std::max<std::size_t>(sectors.size(), 1) - 1);
    LeakSector& s = sectors.empty() ? nowhere : sectors[number];
    const double gap = 0.5 * (here.gap + next.gap), depth = 0.5 * (here.depth + next.depth), flow = slit_speed(gap, depth, blood) * gap * here.length;
    s.length += here.length;
    s.gap += gap * here.length;
    if (gap > blood.seal) s.area += gap * here.length;
    s.flow += flow;
    whole += flow;
    if (number == last && gap <= widest) continue;
    last = number;
    widest = gap;
    s.place = 0.5 * (here.place + next.place);
  }
  for (LeakSector& s : sectors) s.gap /= std::max(s.length, 1e-30);
  return whole;
}

JoinLeak find_leak(const VesselMesh& mesh, const Points& x, int a, int b, int sectors, const BloodOptions& blood) {
  std::vector<EdgeGap> gaps;
  for (std::size_t k = 0; k < mesh.edge_ring[static_cast<std::size_t>(a)].size(); ++k) gaps.push_back(edge_gap(mesh, x, a, b, k));
  JoinLeak leak;
  leak.sectors.resize(static_cast<std::size_t>(sectors));
  leak.flow = leak_through(gaps, leak.sectors, blood);
  for (const LeakSector& s : leak.sectors) leak.area += s.area;
  return leak;
}

std::vector<std::vector<int>> inner_rings(const VesselMesh& mesh, int part) {
  std::vector<char> inner(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (const WallFace& f : mesh.faces)
    if (f.surface == WallSurface::inner && mesh.part[static_cast<std::size_t>(f.element)] == part)
      for (const int c : f.corner) inner[static_cast<std::size_t>(mesh.elements[static_cast<std::size_t>(f.element)][static_cast<std::size_t>(c)])] = 1;
  std::vector<std::vector<int>> rings;
  int slab = -1;
  for (int i = 0; i < mesh.n_nodes(); ++i) {  // of each slab, ascending: in the order of the ring
    if (!inner[static_cast<std::size_t>(i)]) continue;
    if (mesh.slab[static_cast<std::size_t>(i)] != slab) rings.emplace_back();
    slab = mesh.slab[static_cast<std::size_t>(i)];
    rings.back().push_back(i);
  }
  return rings;
}

std::vector<LumenRing> lumen_rings(const VesselMesh& mesh, const Points& x, int part) {
  std::vector<LumenRing> rings;
  for (const auto& ring : inner_rings(mesh, part)) {
    const RingSpan s = span_of(ring, x);
    rings.push_back({s.area.norm(), s.middle});
  }
  return rings;
}

Passage passage_of(const VesselMesh& mesh) {
  Passage p;
  int least = std::numeric_limits<int>::max(), most = 0;  // slabs of the first edge
  for (const int i : mesh.edge_ring[0]) {
    least = std::min(least, mesh.slab[static_cast<std::size_t>(i)]);
    most = std::max(most, mesh.slab[static_cast<std::size_t>(i)]);
  }
  for (const auto& ring : inner_rings(mesh, 0))
    if (2 * mesh.slab[static_cast<std::size_t>(ring.front())] <= least + most) p.rings.push_back(ring);
  p.second = p.rings.size();
  const std::vector<std::vector<int>> second = inner_rings(mesh, 1);
  p.rings.insert(p.rings.end(), second.rbegin(), second.rend());  // from its cut edge to its clamp
  for (std::size_t k = 0; k < p.rings.size(); ++k) {
    const std::size_t first = k < p.second ? 0 : p.second, end = k < p.second ? p.second : p.rings.size();
    const std::size_t from = k > first ? k - 1 : k, to = std::min(end - 1, k + 1);
    const Vec3 way = span_of(p.rings[to], mesh.nodes).middle - span_of(p.rings[from], mesh.nodes).middle;
    const double cosine = to > from ? std::abs(way.normalized().dot(span_of(p.rings[k], mesh.nodes).area.normalized())) : 1.0;
    p.across.push_back(cosine > 1.0 - 1e-9 ? 1.0 : cosine);
  }
  return p;
}

std::vector<LumenRing> lumen_rings(const Passage& way, const Points& x) {
  std::vector<LumenRing> rings;
  for (std::size_t k = 0; k < way.rings.size(); ++k) {
    const RingSpan s = span_of(way.rings[k], x);
    rings.push_back({s.area.norm() * way.across[k], s.middle});
  }
  return rings;
}

double narrowing_of(const std::vector<LumenRing>& rings, double usual_area) noexcept {
  double least = usual_area;
  for (const LumenRing& r : rings) least = std::min(least, r.area);
  return 1.0 - least / usual_area;
}

}  // namespace filum
