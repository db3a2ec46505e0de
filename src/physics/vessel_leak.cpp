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

/// The outer end of the line through the wall that starts at an inner rim node.
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

}  // namespace

double slit_speed(double gap, double depth, const BloodOptions& o) noexcept {
  if (gap <= o.seal || o.pressure <= 0.0) return 0.0;
  const double a = 0.5 * o.density / (o.discharge * o.discharge), b = 12.0 * o.viscosity * depth / (gap * gap);
  return 2.0 * o.pressure / (b + std::sqrt(b * b + 4.0 * a * o.pressure));
}

EdgeGap edge_gap(const VesselMesh& mesh, const Points& x, int a, int b, std::size_t k) noexcept {
  const std::vector<int>& ring = mesh.edge_ring[static_cast<std::size_t>(a)];
  const int inner = ring[k], next = ring[(k + 1) % ring.size()], outer = outer_of(mesh, inner);
  EdgeGap g{std::numeric_limits<double>::infinity(), (x.col(outer) - x.col(inner)).norm(), (x.col(next) - x.col(inner)).norm(), Vec3::Zero()};
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
    const std::size_t number = k * sectors.size() / gaps.size();
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
    LumenRing r;
    for (const int i : ring) r.middle += x.col(i) / static_cast<double>(ring.size());
    Vec3 area = Vec3::Zero();
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec3 p = x.col(ring[k]), q = x.col(ring[(k + 1) % ring.size()]);
      area += 0.5 * (p - r.middle).cross(q - r.middle);
    }
    r.area = area.norm();
    rings.push_back(r);
  }
  return rings;
}

Patency assess_lumen(const std::vector<LumenRing>& rings, double usual_area, const BloodOptions& blood, double most_narrowing) {
  Patency p;
  double least = usual_area;
  for (std::size_t k = 0; k < rings.size(); ++k) {
    least = std::min(least, rings[k].area);
    if (k == 0) continue;
    const double area = 0.5 * (rings[k].area + rings[k - 1].area);
    p.resistance += 8.0 * std::numbers::pi * blood.viscosity * (rings[k].middle - rings[k - 1].middle).norm() / std::max(area * area, 1e-24);
  }
  p.narrowing = 1.0 - least / usual_area;
  p.flow = blood.pressure / (p.resistance + blood.rest);
  p.patent = p.narrowing < most_narrowing;
  return p;
}

}  // namespace filum
