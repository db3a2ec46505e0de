#include "physics/vessel_mesh.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

namespace filum {
namespace {

/// Grid of n[0] x n[1] x n[2] elements in (xi, eta, zeta); closed: xi runs round, and there may be a gap of elements about xi = 0.
class Grid {
 public:
  explicit Grid(const std::array<int, 3>& n_, bool closed_ = false, int half_ = 0, int from_ = 0, int to_ = 0)
      : n(n_), closed(closed_), half(half_), from(from_), to(to_), line_(static_cast<std::size_t>(rows() * (n[1] + 1)), -1) {
    int next = 0;
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i < rows(); ++i)
        if (!in_gap(i, j)) line_[index(i, j)] = next++;
    lines = next;
  }
  std::array<int, 3> n;
  bool closed;
  int half, from, to;  // the gap: half of its elements in xi, and those from `from` up to `to` in eta
  int lines = 0;       // of nodes through the wall
  int rows() const { return closed ? n[0] : n[0] + 1; }  // of nodes in xi
  bool opened() const { return half > 0; }
  /// Is the node inside the gap? Its border is not.
  bool in_gap(int i, int j) const { return opened() && j > from && j < to && (i < half || i > n[0] - half); }
  bool has(int i, int j) const {
    if (j < 0 || j >= n[1] || (!closed && (i < 0 || i >= n[0]))) return false;
    const int round = (i + n[0]) % n[0];
    return !opened() || j < from || j >= to || (round >= half && round < n[0] - half);
  }
  int node(int i, int j, int k) const { return line_[index(i, j)] * (n[2] + 1) + k; }
  /// Lines of the cut edge in turn: of the far end, or round the gap from the middle of its far side.
  std::vector<std::array<int, 2>> edge() const {
    std::vector<std::array<int, 2>> list;
    if (!opened())
      for (int i = 0; i < rows(); ++i) list.push_back({i, n[1]});
    for (int i = 0; i < half; ++i) list.push_back({i, to});
    for (int j = to; j > from && opened(); --j) list.push_back({half, j});
    for (int i = half; i > -half; --i) list.push_back({i, from});
    for (int j = from; j < to && opened(); ++j) list.push_back({-half, j});
    for (int i = -half; i < 0; ++i) list.push_back({i, to});
    return list;
  }

 private:
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j * rows() + (closed ? (i + n[0]) % n[0] : i)); }
  std::vector<int> line_;
};

void add_faces(VesselMesh& m, const Grid& g, int e, int i, int j, int k) {
  const auto add = [&](int side, WallSurface s) { m.faces.push_back({e, s, kElementSides[static_cast<std::size_t>(side)]}); };
  const auto border = [&](int side, int ii, int jj) {
    if (g.has(ii, jj)) return;
    const bool within = jj >= 0 && jj < g.n[1] && (g.closed || (ii >= 0 && ii < g.n[0]));
    add(side, (g.opened() ? within : jj == g.n[1]) ? WallSurface::edge : WallSurface::end);
  };
  if (k == 0) add(5, WallSurface::inner);
  if (k == g.n[2] - 1) add(4, WallSurface::outer);
  border(2, i, j + 1);
  border(3, i, j - 1);
  border(0, i + 1, j);
  border(1, i - 1, j);
}

/// The ring of the cut edge's inner rim. Evenly made rings are told so: no rounding moves their nodes from sector to sector.
void add_edge(VesselMesh& m, const Grid& g, bool even) {
  std::vector<int>& ring = m.edge_ring.emplace_back();
  std::vector<double>& share = m.edge_share.emplace_back();
  for (const auto& [i, j] : g.edge()) ring.push_back(g.node(i, j, 0));
  double arc = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    share.push_back(even ? static_cast<double>(k) / static_cast<double>(ring.size()) : arc);
    arc += (m.nodes.col(ring[(k + 1) % ring.size()]) - m.nodes.col(ring[k])).norm();
  }
  if (!even)
    for (double& s : share) s /= arc;
}

/// `rest` gives the stress-free and `first` the first place of the grid point (i, j, k). Rows of zeta come one after the other,
/// so that neighbours in the list of elements share their layers. `even`: the edge's nodes are evenly spaced, and closed rings alike all round.
VesselMesh fill(const Grid& g, const std::function<Vec3(int, int, int)>& rest, const std::function<Vec3(int, int, int)>& first, bool even = true) {
  VesselMesh m;
  const int n = g.lines * (g.n[2] + 1);
  m.nodes.resize(3, n);
  m.slab.resize(static_cast<std::size_t>(n));
  m.node_part.assign(static_cast<std::size_t>(n), 0);
  for (int j = 0; j <= g.n[1]; ++j)
    for (int i = 0; i < g.rows(); ++i)
      for (int k = 0; k <= g.n[2] && !g.in_gap(i, j); ++k) {
        m.nodes.col(g.node(i, j, k)) = first(i, j, k);
        m.slab[static_cast<std::size_t>(g.node(i, j, k))] = j;
      }
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j)
      for (int i = 0; i < g.n[0]; ++i) {
        if (!g.has(i, j)) continue;
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
  m.sectors.push_back(g.closed && even ? g.n[0] : 0);
  add_edge(m, g, even);
  return m;
}

/// Share of the length at grid line j when cells shrink evenly towards the edge.
double graded(int j, int n, double grading) {
  const double t = static_cast<double>(j) / n;
  const double slope = 2.0 * (grading - 1.0) / (grading + 1.0);  // cell length ~ 1 + slope (1/2 - t)
  return t * (1.0 + 0.5 * slope * (1.0 - t));
}

/// A tube's radii and angles without stress and as first made.
struct TubeMap {
  explicit TubeMap(const TubeShape& shape) : s(shape), turn(kTurn / (kTurn - s.opening_angle)) {
    const double middle = s.inner_radius + 0.5 * s.thickness;
    first2 = s.first_inner_radius > 0.0 ? s.first_inner_radius * s.first_inner_radius : middle * middle / (turn * turn) - area(middle);
  }
  static constexpr double kTurn = 2.0 * std::numbers::pi;
  const TubeShape& s;
  double turn, first2 = 0.0;  // first2: square of the first inner radius
  double area(double r) const { return (r * r - s.inner_radius * s.inner_radius) / (turn * s.stretch); }
  double radius(int k) const { return s.inner_radius + s.thickness * k / s.through; }
  double first_radius(double r) const { return std::sqrt(first2 + area(r)); }
  /// `i` in steps round the tube, whole or not; z [m], stress-free.
  Vec3 rest(double i, double z, int k) const { return point(radius(k), kTurn / turn * i / s.around, z); }
  Vec3 first(double i, double z, int k) const { return point(first_radius(radius(k)), kTurn * i / s.around, s.stretch * z); }
  static Vec3 point(double r, double angle, double z) { return {r * std::cos(angle), r * std::sin(angle), z}; }
};

/// Moves of grid points in the unrolled middle of the wall [m], around and along, that bring the border of a gap onto its ellipse.
class HarmonicMap {
 public:
  HarmonicMap(const Grid& g, const SideOpening& o, double step, double row) : g_(g), move_(static_cast<std::size_t>(g.n[0] * (g.n[1] + 1)), {0.0, 0.0}) {
    const std::vector<std::array<int, 2>> edge = g.edge();
    std::vector<char> fixed(move_.size(), 0);
    const double a = 0.5 * o.length, b = 0.5 * o.width;
    for (std::size_t k = 0; k < edge.size(); ++k) {
      const double psi = angle(4.0 * static_cast<double>(k) / static_cast<double>(edge.size()), o);
      const auto& [i, j] = edge[k];
      at(i, j) = {b * std::sin(psi) - step * i, a * std::cos(psi) - row * (j - 0.5 * g.n[1])};
      fixed[index(i, j)] = 1;
    }
    double most = row;  // [m], move of the last sweep (Gauss-Seidel)
    for (int sweep = 0; sweep < kMostSweeps && most > kSettled * row; ++sweep) {
      most = 0.0;
      for (int j = 1; j < g.n[1]; ++j)
        for (int i = 0; i < g.n[0]; ++i)
          for (std::size_t c = 0; c < 2 && !fixed[index(i, j)] && !g.in_gap(i, j); ++c) {
            const double mean = 0.25 * (at(i - 1, j)[c] + at(i + 1, j)[c] + at(i, j - 1)[c] + at(i, j + 1)[c]);
            most = std::max(most, std::abs(mean - at(i, j)[c]));
            at(i, j)[c] = mean;
          }
    }
  }
  const std::array<double, 2>& operator()(int i, int j) const { return move_[index(i, j)]; }

 private:
  static constexpr int kMostSweeps = 20000;
  static constexpr double kSettled = 1e-9;
  static constexpr double kCorner = 0.3;  // of a quarter of the ellipse, from its ends along the tube: where the gap's corners come (DECISIONS)
  /// psi at this number of quarters of the gap's border.
  static double angle(double quarters, const SideOpening& o) {
    const double corner = o.across / static_cast<double>(o.across + o.along), part = quarters - std::floor(quarters);
    const bool back = static_cast<int>(quarters) % 2 == 1;
    const double f = back ? 1.0 - part : part, g = f < corner ? f / corner * kCorner : kCorner + (f - corner) / (1.0 - corner) * (1.0 - kCorner);
    constexpr double kQuarter = 0.25 * TubeMap::kTurn;
    const double a = 0.5 * o.length, b = 0.5 * o.width, wanted = g * arc(a, b, kQuarter);
    double psi = g * kQuarter;
    for (int n = 0; n < 30; ++n) psi -= (arc(a, b, psi) - wanted) / std::hypot(b * std::cos(psi), a * std::sin(psi));  // Newton's method
    return kQuarter * (std::floor(quarters) + (back ? 1.0 : 0.0)) + (back ? -psi : psi);
  }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j * g_.n[0] + (i + g_.n[0]) % g_.n[0]); }
  std::array<double, 2>& at(int i, int j) { return move_[index(i, j)]; }
  /// Of the ellipse (b sin psi, a cos psi), from psi = 0.
  static double arc(double a, double b, double psi) {
    constexpr int kPieces = 400;
    double sum = 0.0;  // midpoint rule
    for (int k = 0; k < kPieces; ++k) {
      const double p = psi * (k + 0.5) / kPieces;
      sum += std::hypot(b * std::cos(p), a * std::sin(p)) * psi / kPieces;
    }
    return sum;
  }
  const Grid& g_;
  std::vector<std::array<double, 2>> move_;
};

}  // namespace

VesselMesh make_tube(const TubeShape& s) {
  const Grid g({s.around, s.along, s.through}, true);
  const TubeMap tube(s);
  const double slope = std::tan(s.bevel) / (s.stretch * s.length);
  const auto height = [&](int i, int j, int k) {
    const double z = s.length * graded(j, s.along, s.edge_grading);
    return s.bevel == 0.0 ? z : z * (1.0 + slope * tube.first(i, 0.0, k).x());
  };
  VesselMesh m = fill(
      g, [&](int i, int j, int k) { return tube.rest(i, height(i, j, k), k); }, [&](int i, int j, int k) { return tube.first(i, height(i, j, k), k); },
      s.bevel == 0.0);
  for (int i = 0; i < s.around; ++i)
    for (int kk = 0; kk <= s.through; ++kk) m.held.push_back(g.node(i, 0, kk));
  return m;
}

VesselMesh make_opened_tube(const TubeShape& s, const SideOpening& o) {
  const TubeMap tube(s);
  const double round = TubeMap::kTurn * tube.first_radius(s.inner_radius + 0.5 * s.thickness), length = s.stretch * s.length;
  const bool fits = o.across >= 2 && o.across % 2 == 0 && o.along >= 2 && o.across + 4 <= s.around && o.along + 4 <= s.along;
  if (!fits || o.width > 0.5 * round || o.length > 0.7 * length || o.width <= 0.0 || o.length <= 0.0)
    throw std::invalid_argument("an opening of half the way round a vessel, seven tenths of its length and all but four of its elements at most");
  const int from = (s.along - o.along) / 2;
  const Grid g({s.around, s.along, s.through}, true, o.across / 2, from, from + o.along);
  const double step = round / s.around, row = length / s.along;
  const HarmonicMap move(g, o, step, row);
  const auto turned = [&](int i, int j) { return i + move(i, j)[0] / step; };
  const auto height = [&](int i, int j) { return (row * j + move(i, j)[1]) / s.stretch; };
  VesselMesh m = fill(
      g, [&](int i, int j, int k) { return tube.rest(turned(i, j), height(i, j), k); },
      [&](int i, int j, int k) { return tube.first(turned(i, j), height(i, j), k); }, false);
  for (const int j : {0, s.along})
    for (int i = 0; i < s.around; ++i)
      for (int k = 0; k <= s.through; ++k) m.held.push_back(g.node(i, j, k));
  return m;
}

double scaled_jacobian(const Corners& c) noexcept {
  double least = 1.0;
  for (int a = 0; a < 8; ++a) {
    Mat3 sides;
    for (int d = 0; d < 3; ++d) {
      const int other = a ^ (1 << d);
      sides.col(d) = (c.col(std::max(a, other)) - c.col(std::min(a, other))).normalized();
    }
    least = std::min(least, sides.determinant());
  }
  return least;
}

VesselMesh make_card(const CardShape& s) {
  const Grid g({s.across, s.deep, s.through});
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
  mesh.edge_share.insert(mesh.edge_share.end(), more.edge_share.begin(), more.edge_share.end());
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
