#include "anatomy/brain_mesher.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/error.h"

namespace filum {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

namespace pa = CGAL::parameters;

constexpr double kMm = 1e-3;         // CGAL works in millimetres of the scene
constexpr double kExude = 20.0;      // [s], after which flat elements are left as they are
constexpr double kFlattest = 8.0;    // [deg], dihedral angle that is good enough

/// Element size by depth: one for faces, one for cells.
struct Sizing {
  using FT = Kernel::FT;
  using Point_3 = Kernel::Point_3;
  using Index = Domain::Index;
  double fine, coarse, depth;
  FT operator()(const Point_3& p, int, const Index&) const { return fine + (coarse - fine) * std::clamp(-p.z() / depth, 0.0, 1.0); }
};

/// First place on the way from outside to the brain's middle where half is brain.
Vec3 cortex_on_the_way(const BrainScan& s, const Vec3& out, const std::string& file) {
  const Mat3 back = s.grid.step.inverse();
  constexpr double kFar = 0.15, kPace = 2.5e-4;  // [m]
  for (double d = kFar; d > 0.0; d -= kPace) {
    const Vec3 p = s.middle + d * out;
    if (sample(s.grid, s.brain, back * (p - s.grid.first)) > 0.5) return p;
  }
  throw InputError(file, "window", "no brain below it", "a place above the brain");
}

/// Keeps the largest piece; returns how many elements were dropped.
int keep_largest(TetMesh& m) {
  std::vector<int> root(static_cast<std::size_t>(m.n_nodes()));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)] = root[static_cast<std::size_t>(root[static_cast<std::size_t>(i)])];
    return i;
  };
  for (const Tetrahedron& t : m.tets)
    for (const int i : t) root[static_cast<std::size_t>(find(i))] = find(t[0]);
  std::map<int, int> count;
  for (const Tetrahedron& t : m.tets) ++count[find(t[0])];
  const int main = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
  TetMesh kept;
  std::vector<int> number(static_cast<std::size_t>(m.n_nodes()), -1);
  std::vector<int> nodes;
  for (int e = 0; e < m.n_tets(); ++e) {
    Tetrahedron t = m.tets[static_cast<std::size_t>(e)];
    if (find(t[0]) != main) continue;
    for (int& i : t) {
      int& k = number[static_cast<std::size_t>(i)];
      if (k < 0) {
        k = static_cast<int>(nodes.size());
        nodes.push_back(i);
      }
      i = k;
    }
    kept.tets.push_back(t);
    kept.region.push_back(m.region_of(e));
  }
  kept.nodes.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k) kept.nodes.col(static_cast<Eigen::Index>(k)) = m.nodes.col(nodes[k]);
  const int dropped = m.n_tets() - kept.n_tets();
  m = std::move(kept);
  return dropped;
}

TetMesh mesh_of(const Complex& complex) {
  TetMesh m;
  std::map<Triangulation::Vertex_handle, int> number;
  std::vector<Vec3> nodes;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    Tetrahedron t{};
    for (int c = 0; c < 4; ++c) {
      const auto v = cell->vertex(c);
      const auto [at, fresh] = number.emplace(v, static_cast<int>(nodes.size()));
      if (fresh) nodes.push_back(kMm * Vec3(CGAL::to_double(v->point().x()), CGAL::to_double(v->point().y()), CGAL::to_double(v->point().z())));
      t[static_cast<std::size_t>(c)] = at->second;
    }
    m.tets.push_back(t);
  }
  m.nodes.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k) m.nodes.col(static_cast<Eigen::Index>(k)) = nodes[k];
  for (int e = 0; e < m.n_tets(); ++e)
    if (tet_volume(m, e) < 0.0) std::swap(m.tets[static_cast<std::size_t>(e)][2], m.tets[static_cast<std::size_t>(e)][3]);
  return m;
}

}  // namespace

BrainRegion mesh_region(const BrainScan& s, const Window& w, const std::string& file) {
  if (!(w.radius > 5e-3 && w.radius < 0.1)) throw InputError(file, "radius", std::to_string(1e3 * w.radius) + " mm", "5 to 100 mm");
  if (!(w.depth > 5e-3 && w.depth < 0.1)) throw InputError(file, "depth", std::to_string(1e3 * w.depth) + " mm", "5 to 100 mm");
  if (!(w.fine >= 1e-3 && w.fine <= w.coarse && w.coarse < 0.5 * w.depth)) throw InputError(file, "size", std::to_string(1e3 * w.fine) + " mm", "1 mm at least, no more than the coarse one, that no more than half the depth");
  BrainRegion r;
  const Vec3 way = w.at - s.middle;
  if (!(way.norm() > 1e-3)) throw InputError(file, "window", "the middle of the brain", "a place above the brain");
  const Vec3 z = way.normalized();
  const Vec3 front = std::abs(z.y()) < 0.95 ? Vec3::UnitY() : Vec3::UnitZ(), y = (front - front.dot(z) * z).normalized();
  r.axes << y.cross(z), y, z;
  r.origin = cortex_on_the_way(s, z, file);
  const Mat3 back = s.grid.step.inverse();
  const Mat3 turn = back * r.axes;
  const Vec3 start = back * (r.origin - s.grid.first);
  const auto voxel = [&](const Vec3& x) { return Vec3(start + turn * x); };
  const auto outside = [&](const Kernel::Point_3& p) {  // CGAL: below zero is inside
    const Vec3 x = kMm * Vec3(p.x(), p.y(), p.z());
    if (std::hypot(x.x(), x.y()) > w.radius || x.z() < -w.depth) return 1.0;
    return 0.5 - sample(s.grid, s.brain, voxel(x));
  };
  // bumps of the cortex may stand above the window's middle
  const double reach = (std::hypot(w.radius, w.depth) + 10e-3) / kMm;
  CGAL::Random random(1);
  Domain domain = Domain::create_implicit_mesh_domain(outside, Kernel::Sphere_3(Kernel::Point_3(0, 0, -0.5 * w.depth / kMm), reach * reach), pa::relative_error_bound = 1e-3, pa::p_rng = &random);
  const Sizing size{w.fine / kMm, w.coarse / kMm, w.depth / kMm};
  const Criteria criteria(pa::facet_angle = 25.0, pa::facet_size = size, pa::facet_distance = 0.25 * w.fine / kMm, pa::cell_radius_edge_ratio = 2.0, pa::cell_size = size);
  // flat elements are worked out of the interior by weights only: its points stay on the surface
  const Complex complex = CGAL::make_mesh_3<Complex>(domain, criteria, pa::no_perturb(), pa::exude(pa::time_limit = kExude, pa::sliver_bound = kFlattest));
  r.mesh = mesh_of(complex);
  if (r.mesh.n_tets() == 0) throw InputError(file, "window", "no brain in it", "a place above the brain");
  for (int e = 0; e < r.mesh.n_tets(); ++e) {
    Vec3 middle = Vec3::Zero();
    for (const int i : r.mesh.tets[static_cast<std::size_t>(e)]) middle += 0.25 * r.mesh.nodes.col(i);
    r.mesh.region.push_back(sample(s.grid, s.white, voxel(middle)) < 0.5 ? 0 : 1);
  }
  r.dropped = keep_largest(r.mesh);
  check_mesh(r.mesh, file);
  for (int e = 0; e < r.mesh.n_tets(); ++e) (r.mesh.region_of(e) == 0 ? r.grey : r.white) += tet_volume(r.mesh, e);
  return r;
}

}  // namespace filum
