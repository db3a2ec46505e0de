#include "physics/elastic_rod.h"

#include <cmath>
#include <numbers>

#include "base/ensure.h"

namespace filum {
namespace {

using Mat12 = Eigen::Matrix<double, 12, 12>;
using Vec12 = Eigen::Matrix<double, 12, 1>;

double node_length(const RodState& s, int i) noexcept { return 0.5 * (s.rest_length[i - 1] + s.rest_length[i]); }

bool joined(const RodState& s, int i) noexcept { return s.alive[i - 1] != 0 && s.alive[i] != 0; }

double signed_angle(const Vec3& u, const Vec3& v, const Vec3& axis) noexcept {
  return std::atan2(u.cross(v).dot(axis), u.dot(v));
}

Mat3 skew(const Vec3& v) noexcept {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// First derivatives of the four curvatures and the twist of node i by (x_{i-1}, theta^{i-1}, x_i, theta^i, x_{i+1}).
struct NodeGradient {
  Eigen::Matrix<double, 12, 4> kappa = Eigen::Matrix<double, 12, 4>::Zero();
  Vec12 twist = Vec12::Zero();
};

template <typename Column>
void scatter_edges(const Vec3& de, const Vec3& df, Column&& out) noexcept {
  out.template segment<3>(0) = -de;
  out.template segment<3>(4) = de - df;
  out.template segment<3>(8) = df;
}

/// Shorthand of one inner node: tangents, directors and the tilde tangent of Bergou 2010.
struct NodeFrame {
  NodeFrame(const RodGeometry& g, int i)
      : e(g.length[i - 1]), f(g.length[i]), chi(g.chi[i]), te(g.t.col(i - 1)), tf(g.t.col(i)), m1e(g.m1.col(i - 1)),
        m2e(g.m2.col(i - 1)), m1f(g.m1.col(i)), m2f(g.m2.col(i)), kb(g.kb.col(i)), kappa(g.kappa.col(i)), tt((te + tf) / chi) {}
  double e, f, chi;
  Vec3 te, tf, m1e, m2e, m1f, m2f, kb;
  Eigen::Vector4d kappa;
  Vec3 tt;
};

NodeGradient node_gradient(const NodeFrame& n) noexcept {
  NodeGradient d;
  // kb.w for a director w that is carried along: kappa is kb.m2, kb.(-m1) on the edge before and on the edge behind.
  const Vec3 w[4] = {n.m2e, -n.m1e, n.m2f, -n.m1f};
  const double c = 2.0 / n.chi;
  for (int k = 0; k < 4; ++k) {
    const Vec3 along = -n.kappa[k] * n.tt, cw = c * w[k];
    scatter_edges((along + n.tf.cross(cw)) / n.e, (along - n.te.cross(cw)) / n.f, d.kappa.col(k));
  }
  d.kappa(3, 0) = n.kappa[1];  // turning the directors by dtheta turns (kappa1, kappa2) by -dtheta
  d.kappa(3, 1) = -n.kappa[0];
  d.kappa(7, 2) = n.kappa[3];
  d.kappa(7, 3) = -n.kappa[2];
  d.twist.segment<3>(0) = -0.5 / n.e * n.kb;
  d.twist.segment<3>(8) = 0.5 / n.f * n.kb;
  d.twist.segment<3>(4) = -d.twist.segment<3>(0) - d.twist.segment<3>(8);
  d.twist[3] = -1.0;
  d.twist[7] = 1.0;
  return d;
}

/// Adds sum_k c_k d2(kappa_k) + ct d2(twist) of one node to h (lower and upper half).
void add_second_derivative(const NodeFrame& n, const Eigen::Vector4d& c, double ct, Mat12& h) noexcept {
  const Mat3 I = Mat3::Identity();
  const Mat3 tt_tt = n.tt * n.tt.transpose();
  const Mat3 pe = I - n.te * n.te.transpose();
  const Mat3 pf = I - n.tf * n.tf.transpose();
  const double ee = 1.0 / (n.e * n.e), ff = 1.0 / (n.f * n.f), ef = 1.0 / (n.e * n.f);
  const double k = c.dot(n.kappa);
  // With me, mf the weighted directors the sum is kb.(me + mf), and all four curvatures share one set of formulas.
  const Vec3 me = c[0] * n.m2e - c[1] * n.m1e;
  const Vec3 mf = c[2] * n.m2f - c[3] * n.m1f;
  const Vec3 d = 2.0 / n.chi * (me + mf);
  const Mat3 tf_d = n.tf.cross(d) * n.tt.transpose();
  const Mat3 te_d = n.te.cross(d) * n.tt.transpose();
  const Mat3 kb_e = n.kb * me.transpose();
  const Mat3 kb_f = n.kb * mf.transpose();
  Mat3 Hee = ee * (2.0 * k * tt_tt - tf_d - tf_d.transpose() - k / n.chi * pe + 0.5 * (kb_e + kb_e.transpose()));
  Mat3 Hff = ff * (2.0 * k * tt_tt + te_d + te_d.transpose() - k / n.chi * pf + 0.5 * (kb_f + kb_f.transpose()));
  Mat3 Hef = ef * (-k / n.chi * (I + n.te * n.tf.transpose()) + 2.0 * k * tt_tt - tf_d + te_d.transpose() - skew(d));
  const Mat3 kb_te = n.kb * (n.te + n.tt).transpose();
  const Mat3 kb_tf = n.kb * (n.tf + n.tt).transpose();
  Hee -= 0.25 * ct * ee * (kb_te + kb_te.transpose());
  Hff -= 0.25 * ct * ff * (kb_tf + kb_tf.transpose());
  Hef += 0.5 * ct * ef * (2.0 / n.chi * skew(n.te) - n.kb * n.tt.transpose());

  h.block<3, 3>(0, 0) += Hee;
  h.block<3, 3>(0, 4) += Hef - Hee;
  h.block<3, 3>(0, 8) -= Hef;
  h.block<3, 3>(4, 0) += Hef.transpose() - Hee;
  h.block<3, 3>(4, 4) += Hee - Hef - Hef.transpose() + Hff;
  h.block<3, 3>(4, 8) += Hef - Hff;
  h.block<3, 3>(8, 0) -= Hef.transpose();
  h.block<3, 3>(8, 4) += Hef.transpose() - Hff;
  h.block<3, 3>(8, 8) += Hff;

  // Mixed with the angles: kappa1 pairs with m1, kappa2 with m2.
  const Vec3 be = c[0] * n.m1e + c[1] * n.m2e;
  const Vec3 bf = c[2] * n.m1f + c[3] * n.m2f;
  const double over = 2.0 / n.chi;
  Vec12 column = Vec12::Zero();
  scatter_edges((n.kb.dot(be) * n.tt - over * n.tf.cross(be)) / n.e, (n.kb.dot(be) * n.tt + over * n.te.cross(be)) / n.f, column);
  h.col(3) += column;
  h.row(3) += column.transpose();
  scatter_edges((n.kb.dot(bf) * n.tt - over * n.tf.cross(bf)) / n.e, (n.kb.dot(bf) * n.tt + over * n.te.cross(bf)) / n.f, column);
  h.col(7) += column;
  h.row(7) += column.transpose();
  h(3, 3) -= n.kb.dot(me);
  h(7, 7) -= n.kb.dot(mf);
}

void scatter_node_block(const Mat12& h, int i, const ChainSlots& slots, BlockCholesky& matrix) noexcept {
  matrix.add_diagonal(i - 1, h.block<4, 4>(0, 0));
  matrix.add_diagonal(i, h.block<4, 4>(4, 4));
  matrix.add_diagonal(i + 1, h.block<4, 4>(8, 8));
  matrix.add(slots.next[i - 1], h.block<4, 4>(0, 4));
  matrix.add(slots.next[i], h.block<4, 4>(4, 8));
  matrix.add(slots.second[i - 1], h.block<4, 4>(0, 8));
}

void add_stretch_hessian(const RodMaterial& m, const RodState& s, const RodGeometry& g, int j, Stiffness kind,
                         const ChainSlots& slots, BlockCholesky& matrix) noexcept {
  const double force = m.EA * (g.length[j] / s.rest_length[j] - 1.0);
  const double k = m.EA / s.rest_length[j];
  const Vec3 t = g.t.col(j);
  double across = force / g.length[j];  // geometric stiffness: a stretched string resists sideways motion
  if (kind == Stiffness::gauss_newton) across = std::max(0.0, across);
  Mat4 block = Mat4::Zero();
  block.topLeftCorner<3, 3>() = (k - across) * t * t.transpose() + across * Mat3::Identity();
  matrix.add_diagonal(j, block);
  matrix.add_diagonal(j + 1, block);
  matrix.add(slots.next[j], -block);
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

RodGeometry::RodGeometry(int capacity)
    : length(Eigen::VectorXd::Zero(capacity)), t(Points::Zero(3, capacity)), d1(t), m1(t), m2(t), kb(t),
      kappa(Eigen::Matrix4Xd::Zero(4, capacity)), chi(length), ref_twist(length), twist(length) {}

void update_geometry(const RodState& reference, const Points& x, const Eigen::VectorXd& theta, RodGeometry& g) noexcept {
  const int n = reference.n;
  for (int j = 0; j + 1 < n; ++j) {
    const Vec3 e = x.col(j + 1) - x.col(j);
    g.length[j] = e.norm();
    const Vec3 t = e / g.length[j];
    const Vec3 t0 = (reference.x.col(j + 1) - reference.x.col(j)).normalized();
    Vec3 d = parallel_transport(reference.d1.col(j), t0, t);
    d = (d - d.dot(t) * t).normalized();
    const Vec3 d2 = t.cross(d);
    const double c = std::cos(theta[j]), s = std::sin(theta[j]);
    g.t.col(j) = t;
    g.d1.col(j) = d;
    g.m1.col(j) = c * d + s * d2;
    g.m2.col(j) = -s * d + c * d2;
  }
  for (int i = 1; i + 1 < n; ++i) {
    const Vec3 te = g.t.col(i - 1), tf = g.t.col(i);
    g.chi[i] = std::max(1e-9, 1.0 + te.dot(tf));
    const Vec3 kb = 2.0 * te.cross(tf) / g.chi[i];
    g.kb.col(i) = kb;
    g.kappa.col(i) << kb.dot(g.m2.col(i - 1)), -kb.dot(g.m1.col(i - 1)), kb.dot(g.m2.col(i)), -kb.dot(g.m1.col(i));
    // Reference twist: what parallel transport in space leaves between neighbouring directors, continuous in time.
    g.ref_twist[i] = reference_twist(g.d1.col(i - 1), te, g.d1.col(i), tf, reference.ref_twist[i]);
    g.twist[i] = theta[i] - theta[i - 1] + g.ref_twist[i];
  }
}

double elastic_energy(const RodMaterial& m, const RodState& s, const RodGeometry& g) noexcept {
  double u = 0.0;
  for (int j = 0; j + 1 < s.n; ++j) {
    if (!s.alive[j]) continue;
    const double strain = g.length[j] / s.rest_length[j] - 1.0;
    u += 0.5 * m.EA * strain * strain * s.rest_length[j];
  }
  for (int i = 1; i + 1 < s.n; ++i) {
    if (!joined(s, i)) continue;
    const double twist = g.twist[i] - s.rest_twist[i];
    u += 0.5 / node_length(s, i) * (0.5 * m.EI * (g.kappa.col(i) - s.rest_kappa.col(i)).squaredNorm() + m.GJ * twist * twist);
  }
  return u;
}

void add_elastic_gradient(const RodMaterial& m, const RodState& s, const RodGeometry& g, Eigen::Matrix4Xd& gradient) noexcept {
  for (int j = 0; j + 1 < s.n; ++j) {
    if (!s.alive[j]) continue;
    const Vec3 force = m.EA * (g.length[j] / s.rest_length[j] - 1.0) * g.t.col(j);
    gradient.col(j).head<3>() -= force;
    gradient.col(j + 1).head<3>() += force;
  }
  for (int i = 1; i + 1 < s.n; ++i) {
    if (!joined(s, i)) continue;
    const NodeFrame frame(g, i);
    const NodeGradient d = node_gradient(frame);
    const double l = node_length(s, i);
    const Eigen::Vector4d moment = 0.5 * m.EI / l * (g.kappa.col(i) - s.rest_kappa.col(i));
    const double torque = m.GJ / l * (g.twist[i] - s.rest_twist[i]);
    const Vec12 f = d.kappa * moment + torque * d.twist;
    gradient.col(i - 1) += f.segment<4>(0);
    gradient.col(i) += f.segment<4>(4);
    gradient.col(i + 1) += f.segment<4>(8);
  }
}

void add_elastic_hessian(const RodMaterial& m, const RodState& s, const RodGeometry& g, Stiffness kind,
                         const ChainSlots& slots, BlockCholesky& matrix) noexcept {
  for (int j = 0; j + 1 < s.n; ++j)
    if (s.alive[j]) add_stretch_hessian(m, s, g, j, kind, slots, matrix);
  for (int i = 1; i + 1 < s.n; ++i) {
    if (!joined(s, i)) continue;
    const NodeFrame frame(g, i);
    const NodeGradient d = node_gradient(frame);
    const double kb = 0.5 * m.EI / node_length(s, i), kt = m.GJ / node_length(s, i);
    Mat12 h;
    h.noalias() = (kt * d.twist) * d.twist.transpose();
    for (int k = 0; k < 4; ++k) h.noalias() += (kb * d.kappa.col(k)) * d.kappa.col(k).transpose();
    if (kind == Stiffness::exact)
      add_second_derivative(frame, kb * (g.kappa.col(i) - s.rest_kappa.col(i)), kt * (g.twist[i] - s.rest_twist[i]), h);
    scatter_node_block(h, i, slots, matrix);
  }
}

void accept_geometry(const RodGeometry& g, const Points& x, const Eigen::VectorXd& theta, RodState& s) noexcept {
  s.x.leftCols(s.n) = x.leftCols(s.n);
  s.theta.head(s.n) = theta.head(s.n);
  s.d1.leftCols(s.n) = g.d1.leftCols(s.n);
  s.ref_twist.head(s.n) = g.ref_twist.head(s.n);
}

double most_elastic_curvature(double yield_strain, double radius) noexcept {
  return 16.0 / (3.0 * std::numbers::pi) * yield_strain / radius;
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
