#include "physics/vessel_wall_pressure.h"

#include <map>

namespace filum {
namespace {

constexpr double kGauss = 0.57735026918962576451;
using Quad = Eigen::Matrix<double, 3, 4>;

Quad gather(const VesselMesh& m, const WallFace& f, const Points& x) noexcept {
  Quad q;
  for (int c = 0; c < 4; ++c) q.col(c) = x.col(m.elements[static_cast<std::size_t>(f.element)][static_cast<std::size_t>(f.corner[static_cast<std::size_t>(c)])]);
  return q;
}

struct QuadPoint {
  Eigen::Vector4d n, ds, dt;  // weights and their derivatives
  QuadPoint(double s, double t) noexcept
      : n(0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t), 0.25 * (1 + s) * (1 + t), 0.25 * (1 - s) * (1 + t)),
        ds(0.25 * (t - 1), 0.25 * (1 - t), 0.25 * (1 + t), -0.25 * (1 + t)),
        dt(0.25 * (s - 1), -0.25 * (1 + s), 0.25 * (1 + s), 0.25 * (1 - s)) {}
};

template <class Use>
void each_point(Use use) noexcept {
  for (const double s : {-kGauss, kGauss})
    for (const double t : {-kGauss, kGauss}) use(QuadPoint(s, t));
}

Mat3 cross_matrix(const Vec3& a) noexcept {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace

// An inner face turns about the normal that points out of the tissue, into the lumen: the push is against it.
void add_pressure_forces(const VesselMesh& mesh, std::span<const double> pressure, const Points& x, Points& force) noexcept {
  for (const WallFace& f : mesh.faces) {
    const double p = pressure[static_cast<std::size_t>(mesh.part[static_cast<std::size_t>(f.element)])];
    if (f.surface != WallSurface::inner || p == 0.0) continue;
    const Quad q = gather(mesh, f, x);
    Quad push = Quad::Zero();
    each_point([&](const QuadPoint& g) { push -= p * Vec3(q * g.ds).cross(Vec3(q * g.dt)) * g.n.transpose(); });
    for (int c = 0; c < 4; ++c)
      force.col(mesh.elements[static_cast<std::size_t>(f.element)][static_cast<std::size_t>(f.corner[static_cast<std::size_t>(c)])]) += push.col(c);
  }
}

Eigen::Matrix<double, 12, 12> pressure_stiffness(const VesselMesh& mesh, const WallFace& face, double p, const Points& x) noexcept {
  const Quad q = gather(mesh, face, x);
  Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();
  each_point([&](const QuadPoint& g) {
    const Mat3 around = cross_matrix(q * g.ds), along = cross_matrix(q * g.dt);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) K.block<3, 3>(3 * a, 3 * b) += p * g.n[a] * (g.dt[b] * around - g.ds[b] * along);
  });
  return K;
}

double lumen_volume(const VesselMesh& mesh, int part, const Points& x) {
  std::map<std::pair<int, int>, int> rim;  // directed sides of inner faces that no other inner face shares
  Vec3 middle = Vec3::Zero();
  int count = 0;
  for (const WallFace& f : mesh.faces) {
    if (f.surface != WallSurface::inner || mesh.part[static_cast<std::size_t>(f.element)] != part) continue;
    const auto& nodes = mesh.elements[static_cast<std::size_t>(f.element)];
    for (std::size_t c = 0; c < 4; ++c) {
      const int a = nodes[static_cast<std::size_t>(f.corner[c])], b = nodes[static_cast<std::size_t>(f.corner[(c + 1) % 4])];
      if (rim.erase({b, a}) == 0) rim[{a, b}] = 1;
      middle += x.col(a);
      ++count;
    }
  }
  middle /= count;
  double volume = 0.0;
  for (const WallFace& f : mesh.faces) {
    if (f.surface != WallSurface::inner || mesh.part[static_cast<std::size_t>(f.element)] != part) continue;
    const Quad q = gather(mesh, f, x);
    each_point([&](const QuadPoint& g) { volume -= Vec3(q * g.n - middle).dot(Vec3(q * g.ds).cross(Vec3(q * g.dt))) / 3.0; });
  }
  // each rim is a closed loop: fans from its middle, told apart by their direction along the tube
  for (int end = 0; end < 2 && !rim.empty(); ++end) {
    std::vector<std::pair<int, int>> loop = {rim.begin()->first};
    rim.erase(rim.begin());
    for (bool grew = true; grew;) {
      grew = false;
      for (auto it = rim.begin(); it != rim.end(); ++it)
        if (it->first.first == loop.back().second) {
          loop.push_back(it->first);
          rim.erase(it);
          grew = true;
          break;
        }
    }
    Vec3 hub = Vec3::Zero();
    for (const auto& side : loop) hub += x.col(side.first) / static_cast<double>(loop.size());
    for (const auto& [a, b] : loop) volume += (hub - middle).dot((Vec3(x.col(a)) - hub).cross(Vec3(x.col(b)) - hub)) / 6.0;
  }
  return volume;
}

}  // namespace filum
