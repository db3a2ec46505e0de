#include "physics/vessel_mesh.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace filum {
namespace {

/// Grid of n[0] x n[1] x n[2] elements in (xi, eta, zeta); closed: xi runs round.
struct Grid {
  std::array<int, 3> n;
  bool closed = false;
  int rows() const { return closed ? n[0] : n[0] + 1; }  // of nodes in xi
  int node(int i, int j, int k) const { return (j * rows() + (closed ? i % n[0] : i)) * (n[2] + 1) + k; }
};

constexpr std::array<std::array<int, 4>, 6> kSides = {{{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};

void add_faces(VesselMesh& m, const Grid& g, int e, int i, int j, int k) {
  const auto add = [&](int side, WallSurface s) { m.faces.push_back({e, s, kSides[static_cast<std::size_t>(side)]}); };
  if (k == 0) add(5, WallSurface::inner);
  if (k == g.n[2] - 1) add(4, WallSurface::outer);
  if (j == g.n[1] - 1) add(2, WallSurface::edge);
  if (j == 0) add(3, WallSurface::end);
  if (!g.closed && i == g.n[0] - 1) add(0, WallSurface::end);
  if (!g.closed && i == 0) add(1, WallSurface::end);
}

/// `rest` gives the stress-free and `first` the first place of the grid point (i, j, k). Rows of zeta come one after the other,
/// so that neighbours in the list of elements share their layers.
VesselMesh fill(const Grid& g, const std::function<Vec3(int, int, int)>& rest, const std::function<Vec3(int, int, int)>& first) {
  VesselMesh m;
  const int n = g.rows() * (g.n[1] + 1) * (g.n[2] + 1);
  m.nodes.resize(3, n);
  m.slab.resize(static_cast<std::size_t>(n));
  m.node_part.assign(static_cast<std::size_t>(n), 0);
  for (int j = 0; j <= g.n[1]; ++j)
    for (int i = 0; i < g.rows(); ++i)
      for (int k = 0; k <= g.n[2]; ++k) {
        m.nodes.col(g.node(i, j, k)) = first(i, j, k);
        m.slab[static_cast<std::size_t>(g.node(i, j, k))] = j;
      }
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j)
      for (int i = 0; i < g.n[0]; ++i) {
        std::array<int, 8> nodes;
        Corners corners;
        for (int a = 0; a < 8; ++a) {
          const int ii = i + (a & 1), jj = j + (a >> 1 & 1), kk = k + (a >> 2);
          nodes[static_cast<std::size_t>(a)] = g.node(ii, jj, kk);
          corners.col(a) = rest(ii, jj, kk);
        }
        m.elements.push_back(nodes);
        m.stress_free.push_back(corners);
        m.span.push_back({static_cast<double>(k) / g.n[2], static_cast<double>(k + 1) / g.n[2]});
        m.part.push_back(0);
        add_faces(m, g, m.n_elements() - 1, i, j, k);
      }
  m.sectors.push_back(g.closed ? g.n[0] : 0);
  m.edge_ring.emplace_back();
  for (int i = 0; i < g.rows(); ++i) m.edge_ring.back().push_back(g.node(i, g.n[1], 0));
  return m;
}

/// Share of the length at grid line j when cells shrink evenly towards the edge.
double graded(int j, int n, double grading) {
  const double t = static_cast<double>(j) / n;
  const double slope = 2.0 * (grading - 1.0) / (grading + 1.0);  // cell length ~ 1 + slope (1/2 - t)
  return t * (1.0 + 0.5 * slope * (1.0 - t));
}

}  // namespace

VesselMesh make_tube(const TubeShape& s) {
  const Grid g{{s.around, s.along, s.through}, true};
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double k = kTurn / (kTurn - s.opening_angle);
  const double middle = s.inner_radius + 0.5 * s.thickness;
  const auto area = [&](double r) { return (r * r - s.inner_radius * s.inner_radius) / (k * s.stretch); };
  const double first2 = s.first_inner_radius > 0.0 ? s.first_inner_radius * s.first_inner_radius : middle * middle / (k * k) - area(middle);
  const auto radius = [&](int kk) { return s.inner_radius + s.thickness * kk / s.through; };
  const auto height = [&](int j) { return s.length * graded(j, s.along, s.edge_grading); };
  const auto point = [&](double r, double angle, double z) { return Vec3(r * std::cos(angle), r * std::sin(angle), z); };
  VesselMesh m = fill(
      g, [&](int i, int j, int kk) { return point(radius(kk), kTurn / k * i / s.around, height(j)); },
      [&](int i, int j, int kk) { return point(std::sqrt(first2 + area(radius(kk))), kTurn * i / s.around, s.stretch * height(j)); });
  for (int i = 0; i < s.around; ++i)
    for (int kk = 0; kk <= s.through; ++kk) m.held.push_back(g.node(i, 0, kk));
  return m;
}

VesselMesh make_card(const CardShape& s) {
  const Grid g{{s.across, s.deep, s.through}, false};
  const auto place = [&](int i, int j, int k) {
    return Vec3(s.width * (static_cast<double>(i) / s.across - 0.5), s.depth * (static_cast<double>(j) / s.deep - 1.0),
                s.thickness * (static_cast<double>(k) / s.through - 0.5));
  };
  VesselMesh m = fill(g, place, place);
  for (int j = 0; j <= s.deep; ++j)
    for (int i = 0; i <= s.across; ++i)
      for (int k = 0; k <= s.through; ++k)
        if (j == 0 || i == 0 || i == s.across) m.held.push_back(g.node(i, j, k));
  return m;
}

void append(VesselMesh& mesh, const VesselMesh& more, const Pose& X) {
  const int n = mesh.n_nodes(), e = mesh.n_elements();
  const int parts = static_cast<int>(mesh.edge_ring.size());
  const int slabs = mesh.slab.empty() ? 0 : mesh.slab.back() + 1;
  mesh.nodes.conservativeResize(3, n + more.n_nodes());
  for (int i = 0; i < more.n_nodes(); ++i) mesh.nodes.col(n + i) = X * Vec3(more.nodes.col(i));
  for (const auto& nodes : more.elements) {
    mesh.elements.push_back(nodes);
    for (int& i : mesh.elements.back()) i += n;
  }
  mesh.stress_free.insert(mesh.stress_free.end(), more.stress_free.begin(), more.stress_free.end());
  mesh.span.insert(mesh.span.end(), more.span.begin(), more.span.end());
  for (const int p : more.part) mesh.part.push_back(p + parts);
  for (const int p : more.node_part) mesh.node_part.push_back(p + parts);
  for (const int s : more.slab) mesh.slab.push_back(s + slabs);
  for (const int i : more.held) mesh.held.push_back(i + n);
  mesh.sectors.insert(mesh.sectors.end(), more.sectors.begin(), more.sectors.end());
  for (WallFace f : more.faces) {
    f.element += e;
    mesh.faces.push_back(f);
  }
  for (const auto& ring : more.edge_ring) {
    mesh.edge_ring.push_back(ring);
    for (int& i : mesh.edge_ring.back()) i += n;
  }
}

std::vector<Triangle> face_triangles(const VesselMesh& mesh) {
  std::vector<Triangle> list;
  for (const WallFace& f : mesh.faces) {
    const auto& nodes = mesh.elements[static_cast<std::size_t>(f.element)];
    const auto at = [&](std::size_t c) { return nodes[static_cast<std::size_t>(f.corner[c])]; };
    list.push_back({at(0), at(1), at(2)});
    list.push_back({at(0), at(2), at(3)});
  }
  return list;
}

}  // namespace filum
