#include "base/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>

#include "base/error.h"

namespace filum {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
constexpr std::array<Triangle, 4> kFaces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};  // outward; face i lacks corner i
constexpr double kFlat = 1e-10;  // volume over (longest edge)^3 below which an element counts as flat

double longest_edge_of(const TetMesh& m, const Tetrahedron& t) {
  double longest = 0.0;
  for (const auto& [a, b] : kEdges)
    longest = std::max(longest, (m.nodes.col(t[static_cast<std::size_t>(a)]) - m.nodes.col(t[static_cast<std::size_t>(b)])).norm());
  return longest;
}

/// 3 r_in / r_circum, from Cayley-Menger quantities: r_in = 3V/A, r_circum = |w| / (12 V).
double radius_ratio(const TetMesh& m, int e) {
  const Tetrahedron& t = m.tets[static_cast<std::size_t>(e)];
  const Vec3 p = m.nodes.col(t[0]), a = m.nodes.col(t[1]) - p, b = m.nodes.col(t[2]) - p, c = m.nodes.col(t[3]) - p;
  const double V = tet_volume(m, e);
  const double area =
      0.5 * (a.cross(b).norm() + b.cross(c).norm() + c.cross(a).norm() + (b - a).cross(c - a).norm());
  const Vec3 w = a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  return w.norm() > 0.0 ? 108.0 * V * V / (area * w.norm()) : 0.0;
}

[[noreturn]] void refuse_element(const std::string& file, int e, const std::string& found, const std::string& expected) {
  throw InputError(file, "element " + std::to_string(e), found, expected);
}

void check_element(const TetMesh& m, int e, const std::string& file) {
  Tetrahedron t = m.tets[static_cast<std::size_t>(e)];
  for (const int i : t)
    if (i < 0 || i >= m.n_nodes()) refuse_element(file, e, "node " + std::to_string(i), "0 to " + std::to_string(m.n_nodes() - 1));
  const double V = tet_volume(m, e), size = std::pow(longest_edge_of(m, t), 3);
  std::sort(t.begin(), t.end());
  if (std::adjacent_find(t.begin(), t.end()) != t.end()) refuse_element(file, e, "a node twice", "four different nodes");
  if (!(std::abs(V) > kFlat * size)) refuse_element(file, e, "no volume", "four nodes that are not in one plane");
  if (V < 0.0) refuse_element(file, e, "inverted", "positive volume: corner 3 on the side that 0, 1, 2 turn right-handed about");
}

}  // namespace

double tet_volume(const TetMesh& m, int e) noexcept {
  const Tetrahedron& t = m.tets[static_cast<std::size_t>(e)];
  const Vec3 p = m.nodes.col(t[0]);
  return (m.nodes.col(t[1]) - p).cross(m.nodes.col(t[2]) - p).dot(m.nodes.col(t[3]) - p) / 6.0;
}

TetMesh box_mesh(const Vec3& low, const Vec3& high, int nx, int ny, int nz) {
  TetMesh m;
  m.nodes.resize(3, (nx + 1) * (ny + 1) * (nz + 1));
  const auto node = [&](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        m.nodes.col(node(i, j, k)) = low + (high - low).cwiseProduct(Vec3(double(i) / nx, double(j) / ny, double(k) / nz));
  constexpr std::array<std::array<int, 3>, 6> kOrders = {{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (std::size_t o = 0; o < 6; ++o) {
          std::array<int, 3> at = {i, j, k};
          Tetrahedron t{node(i, j, k), 0, 0, 0};
          for (std::size_t s = 0; s < 3; ++s) {
            ++at[static_cast<std::size_t>(kOrders[o][s])];
            t[s + 1] = node(at[0], at[1], at[2]);
          }
          if (o >= 3) std::swap(t[1], t[2]);  // odd orders walk a left-handed path
          m.tets.push_back(t);
        }
  return m;
}

std::vector<Triangle> surface_triangles(const TetMesh& m) {
  std::map<Triangle, int> uses;
  const auto sorted = [](Triangle f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  std::vector<Triangle> faces;
  for (const Tetrahedron& t : m.tets)
    for (const Triangle& local : kFaces) {
      Triangle f;
      for (std::size_t c = 0; c < 3; ++c) f[c] = t[static_cast<std::size_t>(local[c])];
      faces.push_back(f);
      ++uses[sorted(f)];
    }
  std::erase_if(faces, [&](const Triangle& f) { return uses[sorted(f)] != 1; });
  return faces;
}

MeshQuality mesh_quality(const TetMesh& m) {
  MeshQuality q;
  q.smallest_volume = q.shortest_edge = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (int e = 0; e < m.n_tets(); ++e) {
    const Tetrahedron& t = m.tets[static_cast<std::size_t>(e)];
    const double shape = radius_ratio(m, e);
    sum += shape;
    q.worst_shape = std::min(q.worst_shape, shape);
    q.smallest_volume = std::min(q.smallest_volume, tet_volume(m, e));
    for (const auto& [a, b] : kEdges) {
      const double l = (m.nodes.col(t[static_cast<std::size_t>(a)]) - m.nodes.col(t[static_cast<std::size_t>(b)])).norm();
      q.shortest_edge = std::min(q.shortest_edge, l);
      q.longest_edge = std::max(q.longest_edge, l);
    }
  }
  q.mean_shape = sum / std::max(1, m.n_tets());
  return q;
}

void check_mesh(const TetMesh& m, const std::string& file) {
  if (m.n_tets() == 0) throw InputError(file, "elements", "none", "at least one");
  if (!m.region.empty() && m.region.size() != m.tets.size())
    throw InputError(file, "regions", std::to_string(m.region.size()), std::to_string(m.n_tets()));
  for (int i = 0; i < m.n_nodes(); ++i)
    if (!m.nodes.col(i).allFinite()) throw InputError(file, "node " + std::to_string(i), "not a number", "three coordinates [m]");
  std::vector<bool> used(static_cast<std::size_t>(m.n_nodes()), false);
  for (int e = 0; e < m.n_tets(); ++e) {
    check_element(m, e, file);
    if (m.region_of(e) < 0) refuse_element(file, e, "region " + std::to_string(m.region_of(e)), "0 or more");
    for (const int i : m.tets[static_cast<std::size_t>(e)]) used[static_cast<std::size_t>(i)] = true;
  }
  const auto lonely = std::find(used.begin(), used.end(), false);
  if (lonely != used.end())
    throw InputError(file, "node " + std::to_string(lonely - used.begin()), "in no element", "every node in an element");
}

TetMesh load_mesh(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw InputError(path, "file", "nothing", "a mesh that can be read");
  std::string format;
  long nodes = 0, tets = 0;
  if (!(in >> format) || format != "filum-mesh/1") throw InputError(path, "format", format, "filum-mesh/1");
  constexpr long kMost = 5'000'000;
  if (!(in >> nodes >> tets) || nodes < 4 || tets < 1 || nodes > kMost || tets > kMost)
    throw InputError(path, "counts", std::to_string(nodes) + " " + std::to_string(tets), "nodes (4 or more) and elements (1 or more), 5 million at most");
  constexpr long kNodeBytes = 6, kTetBytes = 10;  // "0 0 0\n", "0 0 0 0 0\n": before room is made for what a few bytes promise
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  if (!none && static_cast<std::uintmax_t>(kNodeBytes * nodes + kTetBytes * tets) > bytes + 1)
    throw InputError(path, "counts", std::to_string(nodes) + " " + std::to_string(tets), "as many as the file's " + std::to_string(bytes) + " bytes can hold");
  TetMesh m;
  m.nodes.resize(3, nodes);
  for (long i = 0; i < nodes; ++i)
    if (!(in >> m.nodes(0, i) >> m.nodes(1, i) >> m.nodes(2, i))) throw InputError(path, "node " + std::to_string(i), "end or text", "three numbers [m]");
  m.tets.resize(static_cast<std::size_t>(tets));
  m.region.resize(m.tets.size());
  for (std::size_t e = 0; e < m.tets.size(); ++e) {
    Tetrahedron& t = m.tets[e];
    if (!(in >> t[0] >> t[1] >> t[2] >> t[3] >> m.region[e]))
      throw InputError(path, "element " + std::to_string(e), "end or text", "four nodes and a region");
  }
  check_mesh(m, path);
  return m;
}

void save_mesh(const TetMesh& m, const std::string& path) {
  std::ofstream out(path);
  out << "filum-mesh/1\n" << m.n_nodes() << ' ' << m.n_tets() << '\n' << std::setprecision(9);
  for (int i = 0; i < m.n_nodes(); ++i) out << m.nodes(0, i) << ' ' << m.nodes(1, i) << ' ' << m.nodes(2, i) << '\n';
  for (int e = 0; e < m.n_tets(); ++e) {
    for (const int i : m.tets[static_cast<std::size_t>(e)]) out << i << ' ';
    out << m.region_of(e) << '\n';
  }
  if (!out.flush()) throw InputError(path, "file", "an error while writing", "a file that can be written");
}

}  // namespace filum
