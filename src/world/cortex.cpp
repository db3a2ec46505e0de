#include "world/cortex.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace filum {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

void check(const CortexShape& s, const std::string& file) {
  const auto refuse = [&](const char* field, double value, const char* expected) { throw InputError(file, field, std::to_string(value), expected); };
  if (!(s.size.array() > 5e-3).all() || !(s.size.array() < 0.3).all()) refuse("size", s.size.minCoeff(), "5 mm to 300 mm each way");
  for (const int c : s.cells)
    if (c < 2 || c > 100) refuse("cells", c, "2 to 100 each way");
  constexpr int kMostCells = 50000;  // six elements each: ten times what runs in real time
  if (const int all = s.cells[0] * s.cells[1] * s.cells[2]; all > kMostCells) refuse("cells", all, "at most 50,000 in all");
  if (s.cells[1] % 2 != 0) refuse("cells", s.cells[1], "an even number across, so that the fissure has nodes");
  if (!(s.gyrus > 1e-3)) refuse("gyrus", s.gyrus, "more than 1 mm");
  if (!(s.sulcus >= 0.0 && s.sulcus < 0.2 * s.size.z())) refuse("sulcus", s.sulcus, "less than a fifth of the depth");
  if (!(s.lean >= 0.0 && s.lean < 0.3 * s.size.y())) refuse("lean", s.lean, "less than three tenths of the width");
  if (s.open_side && s.fissure_depth > 0.0) refuse("open_side", 1.0, "no fissure beside it");
  if (!(s.fissure_depth >= 0.0 && s.fissure_depth < 0.9 * s.size.z())) refuse("fissure_depth", s.fissure_depth, "less than nine tenths of the depth");
}

/// Height of the surface [m], 0 on the crest of a gyrus: bands that wind, as gyri do.
double furrow(const CortexShape& s, double x, double y) {
  const double bend = 0.35 * s.gyrus * std::sin(kTurn * x / (2.7 * s.gyrus)) + 0.2 * s.gyrus * std::sin(kTurn * y / (3.9 * s.gyrus) + 1.0);
  const double across = std::cos(kTurn * (y + bend) / (2.0 * s.gyrus)), along = std::cos(kTurn * (x + 0.5 * bend) / (3.1 * s.gyrus));
  const double crest = std::max(std::abs(across), 0.8 * std::abs(along));
  return -s.sulcus * std::pow(1.0 - crest, 2);
}

/// Cells are thinner near the top, where blades touch.
void grade(const CortexShape& s, TetMesh& mesh) {
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const double t = -mesh.nodes(2, i) / s.size.z();
    mesh.nodes(2, i) = -s.size.z() * (0.55 * t + 0.45 * t * t);
  }
}

/// Doubles the nodes of the plane y = 0 from the top down to the fissure's depth for the elements on its positive side.
void open_fissure(const CortexShape& s, TetMesh& mesh) {
  std::vector<int> twin(static_cast<std::size_t>(mesh.n_nodes()), -1);
  const double end = 0.5 * s.size.x() - 1e-9;
  std::vector<Vec3> fresh;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 x = mesh.nodes.col(i);
    if (std::abs(x.y()) > 1e-9 || x.z() < -s.fissure_depth + 1e-9 || std::abs(x.x()) > end) continue;
    twin[static_cast<std::size_t>(i)] = mesh.n_nodes() + static_cast<int>(fresh.size());
    fresh.push_back(x);
  }
  for (Tetrahedron& t : mesh.tets) {
    double y = 0.0;
    for (const int i : t) y += mesh.nodes(1, i);
    if (y > 0.0)
      for (int& i : t)
        if (twin[static_cast<std::size_t>(i)] >= 0) i = twin[static_cast<std::size_t>(i)];
  }
  const int n = mesh.n_nodes();
  mesh.nodes.conservativeResize(3, n + static_cast<int>(fresh.size()));
  for (int i = 0; i < n; ++i) {
    if (twin[static_cast<std::size_t>(i)] < 0) continue;
    Vec3 x = mesh.nodes.col(i);
    const double open = 0.5 * s.fissure_gap * (0.1 + 0.9 * (1.0 + x.z() / s.fissure_depth)) * std::cos(0.5 * kTurn * x.x() / s.size.x());
    mesh.nodes(1, i) = -open;
    mesh.nodes.col(twin[static_cast<std::size_t>(i)]) = Vec3(x.x(), open, x.z());
  }
}

void shape_surface(const CortexShape& s, TetMesh& mesh) {
  const double half = 0.5 * s.size.y();
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    Vec3 x = mesh.nodes.col(i);
    const double up = 1.0 + x.z() / s.size.z(), inside = 1.0 - std::pow(x.y() / half, 2);
    x.z() += furrow(s, x.x(), x.y()) * up * up;
    if (s.fissure_depth > 0.0) x.y() += s.fissure_wave * std::sin(kTurn * x.x() / (0.8 * s.size.x())) * inside * std::cos(0.5 * kTurn * x.x() / s.size.x());
    mesh.nodes.col(i) = x;
  }
}

/// The block beside y = 0, its free side leaning over towards the bone; returns where that begins.
double open_side(const CortexShape& s, TetMesh& mesh) {
  constexpr double kGap = 1e-3;  // [m], between bone and what hangs over furthest
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 x = mesh.nodes.col(i);
    const double near = 0.5 - x.y() / s.size.y(), up = std::max(0.0, 1.0 + x.z() / s.size.z());
    mesh.nodes(1, i) = x.y() + 0.5 * s.size.y() - s.lean * near * up;
  }
  return -s.lean - kGap;
}

std::vector<int> nodes_of(const std::vector<Triangle>& surface) {
  std::vector<int> list;
  for (const Triangle& t : surface) list.insert(list.end(), t.begin(), t.end());
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

}  // namespace

Cortex make_cortex(const CortexShape& s, const std::string& file) {
  check(s, file);
  Cortex c;
  const Vec3 half(0.5 * s.size.x(), 0.5 * s.size.y(), 0.0);
  TetMesh& mesh = c.mesh;
  mesh = box_mesh(-half - Vec3(0, 0, s.size.z()), half, s.cells[0], s.cells[1], s.cells[2]);
  grade(s, mesh);
  if (s.fissure_depth > 0.0) open_fissure(s, mesh);
  std::vector<char> border(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 x = mesh.nodes.col(i);
    const bool side = x.y() > half.y() - 1e-9 || (x.y() < -half.y() + 1e-9 && !s.open_side);
    border[static_cast<std::size_t>(i)] = x.z() < -s.size.z() + 1e-9 || std::abs(x.x()) > half.x() - 1e-9 || side;
    if (border[static_cast<std::size_t>(i)]) c.held.push_back(i);
  }
  for (const Tetrahedron& t : mesh.tets) {
    double depth = 0.0;
    for (const int i : t) depth -= 0.25 * mesh.nodes(2, i);
    mesh.region.push_back(depth < s.grey ? 0 : 1);
  }
  for (const Triangle& t : surface_triangles(mesh)) {
    const bool outer = border[static_cast<std::size_t>(t[0])] && border[static_cast<std::size_t>(t[1])] && border[static_cast<std::size_t>(t[2])];
    if (!outer) c.surface.push_back(t);
  }
  shape_surface(s, mesh);
  if (s.open_side) c.bone_y = open_side(s, mesh);
  c.surface_nodes = nodes_of(c.surface);
  check_mesh(mesh, file);
  return c;
}

Cortex cortex_from_mesh(TetMesh mesh, double held_below, double held_beyond) {
  Cortex c;
  c.mesh = std::move(mesh);
  const auto is_held = [&](int i) { return c.mesh.nodes(2, i) < held_below || c.mesh.nodes.col(i).head<2>().norm() > held_beyond; };
  for (int i = 0; i < c.mesh.n_nodes(); ++i)
    if (is_held(i)) c.held.push_back(i);
  for (const Triangle& t : surface_triangles(c.mesh))
    if (!is_held(t[0]) || !is_held(t[1]) || !is_held(t[2])) c.surface.push_back(t);
  c.surface_nodes = nodes_of(c.surface);
  return c;
}

}  // namespace filum
