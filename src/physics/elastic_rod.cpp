#include "physics/elastic_rod.h"

#include <cmath>
#include <numbers>

#include "base/ensure.h"

namespace filum {
namespace {

double node_length(const RodState& s, int i) noexcept { return 0.5 * (s.rest_length[i - 1] + s.rest_length[i]); }

double signed_angle(const Vec3& u, const Vec3& v, const Vec3& axis) noexcept {
  return std::atan2(u.cross(v).dot(axis), u.dot(v));
}

}  // namespace

RodMaterial RodMaterial::round_wire(double radius, double youngs_modulus, double poissons_ratio, double density) {
  constexpr double pi = std::numbers::pi;
  RodMaterial m;
  m.radius = radius;
  m.density = density;
  m.EA = youngs_modulus * pi * radius * radius;
  m.EI = youngs_modulus * pi * std::pow(radius, 4) / 4.0;
  m.GJ = youngs_modulus / (2.0 * (1.0 + poissons_ratio)) * pi * std::pow(radius, 4) / 2.0;
  return m;
}

double RodMaterial::mass_per_length() const { return density * std::numbers::pi * radius * radius; }

Vec3 parallel_transport(const Vec3& d, const Vec3& a, const Vec3& b) noexcept {
  const Vec3 axis = a.cross(b);
  const double c = 1.0 + a.dot(b);
  if (c < 1e-12) return d;  // half a turn within one step: no shortest rotation exists, keep the director
  return d + axis.cross(d) + axis.cross(axis.cross(d)) / c;
}

double reference_twist(const Vec3& d0, const Vec3& t0, const Vec3& d1, const Vec3& t1, double previous) noexcept {
  Vec3 u = parallel_transport(d0, t0, t1);
  u = std::cos(previous) * u + std::sin(previous) * t1.cross(u);
  return previous + signed_angle(u, d1, t1);
}

RodState RodState::from_nodes(const Points& nodes, int capacity, bool naturally_straight) {
  RodState s;
  const int n = static_cast<int>(nodes.cols());
  ENSURE(n >= 2 && n <= capacity, "a rod of at least two nodes and no more than there is room for");
  s.n = n;
  s.x = Points::Zero(3, capacity);
  s.x.leftCols(n) = nodes;
  s.v = Points::Zero(3, capacity);
  s.theta = s.theta_dot = s.ref_twist = s.rest_length = s.rest_twist = Eigen::VectorXd::Zero(capacity);
  s.rest_kappa = Eigen::Matrix4Xd::Zero(4, capacity);
  s.d1 = Points::Zero(3, capacity);
  s.alive = Eigen::VectorXi::Ones(capacity);
  Vec3 t0 = (nodes.col(1) - nodes.col(0)).normalized();
  s.d1.col(0) = t0.unitOrthogonal();
  for (int j = 0; j + 1 < n; ++j) {
    const Vec3 e = nodes.col(j + 1) - nodes.col(j);
    s.rest_length[j] = e.norm();
    const Vec3 t = e / s.rest_length[j];
    if (j > 0) {
      const Vec3 d = parallel_transport(s.d1.col(j - 1), t0, t);
      s.d1.col(j) = (d - d.dot(t) * t).normalized();
    }
    t0 = t;
  }
  if (!naturally_straight) {
    RodGeometry g(capacity);
    update_geometry(s, s.x, s.theta, g);
    s.rest_kappa.leftCols(n) = g.kappa.leftCols(n);
    s.rest_twist.head(n) = g.twist.head(n);
  }
  return s;
}

void accept_geometry(const RodGeometry& g, const Points& x, const Eigen::VectorXd& theta, RodState& s) noexcept {
  s.x.leftCols(s.n) = x.leftCols(s.n);
  s.theta.head(s.n) = theta.head(s.n);
  s.d1.leftCols(s.n) = g.d1.leftCols(s.n);
  s.ref_twist.segment(1, s.n - 2) = g.ref_twist.segment(1, s.n - 2);
  s.ref_twist[0] = s.ref_twist[s.n - 1] = 0.0;  // lanes of nodes worked out together reach beyond the inner ones
}

void take_set(const RodMaterial& m, RodState& s, const RodGeometry& g) noexcept {
  for (int i = 1; i + 1 < s.n; ++i) {
    const double most = m.most_elastic_curvature * node_length(s, i);
    for (int row : {0, 2}) {  // seen from the edge before and from the edge behind
      const Eigen::Vector2d elastic = g.kappa.col(i).segment<2>(row) - s.rest_kappa.col(i).segment<2>(row);
      const double size = elastic.norm();
      if (size > most) s.rest_kappa.col(i).segment<2>(row) += (1.0 - most / size) * elastic;
    }
  }
}

double edge_tension(const RodMaterial& m, const RodState& s, int j) noexcept {
  if (!s.alive[j]) return 0.0;
  return m.EA * ((s.x.col(j + 1) - s.x.col(j)).norm() / s.rest_length[j] - 1.0);
}

}  // namespace filum
