// Geometry, energy, force and stiffness of the rod. What belongs to an edge or a node is computed for four neighbours at once.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "physics/elastic_rod.h"
#include "physics/vessel_wall_lanes.h"

namespace filum {
namespace {

using Four = Lanes<double>;
constexpr int kWidth = Four::kWidth;
using Vec4 = Eigen::Vector4d;

/// A vector of each of four neighbours.
struct Vec3x4 {
  Four x, y, z;
  Four operator[](int r) const noexcept { return r == 0 ? x : r == 1 ? y : z; }
};
Vec3x4 operator+(const Vec3x4& a, const Vec3x4& b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3x4 operator-(const Vec3x4& a, const Vec3x4& b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3x4 operator-(const Vec3x4& a) noexcept { return {-a.x, -a.y, -a.z}; }
Vec3x4 operator*(const Four& s, const Vec3x4& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
Four dot(const Vec3x4& a, const Vec3x4& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3x4 cross(const Vec3x4& a, const Vec3x4& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Four load(const double* from) noexcept {
  Four to;
  std::memcpy(&to.v, from, sizeof to.v);
  return to;
}
void store(const Four& v, double* to) noexcept { std::memcpy(to, &v.v, sizeof v.v); }
Vec3x4 load(const RodRows& m, int i) noexcept { return {load(&m(0, i)), load(&m(1, i)), load(&m(2, i))}; }
void store(const Vec3x4& v, RodRows& m, int i) noexcept {
  store(v.x, &m(0, i));
  store(v.y, &m(1, i));
  store(v.z, &m(2, i));
}

double node_length(const RodState& s, int i) noexcept { return 0.5 * (s.rest_length[i - 1] + s.rest_length[i]); }

bool joined(const RodState& s, int i) noexcept { return s.alive[i - 1] != 0 && s.alive[i] != 0; }

/// As parallel_transport(); half a turn keeps the director.
Vec3x4 transport(const Vec3x4& d, const Vec3x4& a, const Vec3x4& b) noexcept {
  const Vec3x4 axis = cross(a, b), once = cross(axis, d), twice = cross(axis, once);
  const Four c = Four(1.0) + dot(a, b);
  const auto turned = c.v < 1e-12;
  const Four share(turned ? Four(0.0).v : Four(1.0).v), over(turned ? Four(0.0).v : 1.0 / c.v);
  return d + share * once + over * twice;
}

/// atan2, by its series where the angle is small, as it is from one trial shape to the next: to rounding below 0.02 rad.
Four angle_of(const Four& sine, const Four& cosine) noexcept {
  const Four x = sine / cosine, xx = x * x;
  Four angle = x * (Four(1.0) - xx * (Four(1.0 / 3) - xx * (Four(1.0 / 5) - xx * (Four(1.0 / 7) - xx * Four(1.0 / 9)))));
  for (int k = 0; k < kWidth; ++k)
    if (!(std::abs(sine[k]) < 0.02 * cosine[k])) angle.set(k, std::atan2(sine[k], cosine[k]));
  return angle;
}

void follow_edges(int j, RodGeometry& g) noexcept {
  const Vec3x4 e = load(g.x, j + 1) - load(g.x, j);
  const Four length = root_of(dot(e, e));
  const Vec3x4 t = (Four(1.0) / length) * e;
  Vec3x4 d = transport(load(g.reference_d1, j), load(g.reference_t, j), t);
  d = d - dot(d, t) * t;
  d = (Four(1.5) - Four(0.5) * dot(d, d)) * d;  // Newton's step to unit length, from which rounding alone has led it
  const Vec3x4 d2 = cross(t, d);
  Four c, s;
  for (int k = 0; k < kWidth; ++k) {
    c.set(k, std::cos(g.theta[j + k]));
    s.set(k, std::sin(g.theta[j + k]));
  }
  store(length, &g.length[j]);
  store(t, g.t, j);
  store(d, g.d1, j);
  store(c * d + s * d2, g.m1, j);
  store(c * d2 - s * d, g.m2, j);
}

void follow_nodes(int i, RodGeometry& g) noexcept {
  const Vec3x4 te = load(g.t, i - 1), tf = load(g.t, i);
  Four chi = Four(1.0) + dot(te, tf);
  chi = Four(chi.v < 1e-9 ? Four(1e-9).v : chi.v);
  const Vec3x4 kb = (Four(2.0) / chi) * cross(te, tf);
  store(chi, &g.chi[i]);
  store(kb, g.kb, i);
  store(dot(kb, load(g.m2, i - 1)), &g.kappa(0, i));
  store(-dot(kb, load(g.m1, i - 1)), &g.kappa(1, i));
  store(dot(kb, load(g.m2, i)), &g.kappa(2, i));
  store(-dot(kb, load(g.m1, i)), &g.kappa(3, i));
  // Reference twist: what parallel transport in space leaves between neighbouring directors, continuous in time.
  const Vec3x4 u = transport(load(g.d1, i - 1), te, tf), d = load(g.d1, i);
  const Vec3x4 v = load(&g.reference_cos[i]) * u + load(&g.reference_sin[i]) * cross(tf, u);
  const Four twist = load(&g.reference_twist[i]) + angle_of(dot(cross(v, d), tf), dot(v, d));
  store(twist, &g.ref_twist[i]);
  store(load(&g.theta[i]) - load(&g.theta[i - 1]) + twist, &g.twist[i]);
}

/// Four columns of four numbers, by row.
struct Turned {
  Turned(const Four& a, const Four& b, const Four& c, const Four& d) noexcept {
    const auto ab = __builtin_shufflevector(a.v, b.v, 0, 4, 2, 6), AB = __builtin_shufflevector(a.v, b.v, 1, 5, 3, 7);
    const auto cd = __builtin_shufflevector(c.v, d.v, 0, 4, 2, 6), CD = __builtin_shufflevector(c.v, d.v, 1, 5, 3, 7);
    row[0] = Four(__builtin_shufflevector(ab, cd, 0, 1, 4, 5));
    row[1] = Four(__builtin_shufflevector(AB, CD, 0, 1, 4, 5));
    row[2] = Four(__builtin_shufflevector(ab, cd, 2, 3, 6, 7));
    row[3] = Four(__builtin_shufflevector(AB, CD, 2, 3, 6, 7));
  }
  Four row[4];
};

/// What four inner nodes from node `first` on need for force and stiffness. Names as in Bergou et al. 2008 and 2010: e and f are the edges
/// before and behind a node, tt the tilde tangent.
struct Nodes {
  Nodes(const RodMaterial& m, const RodState& s, const RodGeometry& g, int first) noexcept;

  int count;                 // of the four, those that are there
  Four e, f, c;              // 1/|e|, 1/|f|, 2/chi
  Vec3x4 te, tf, kb, tt;
  Vec3x4 w[4];               // kappa[k] = kb.w[k]: the directors are carried along
  Four kappa[4], moment[4];  // [-], [N m]
  Four torque, bending, twisting;  // [N m]; EI/(2 l), GJ/l, 0 where the thread has parted
};

Nodes::Nodes(const RodMaterial& m, const RodState& s, const RodGeometry& g, int first) noexcept
    : count(std::min(kWidth, s.n - 1 - first)), e(Four(1.0) / load(&g.length[first - 1])), f(Four(1.0) / load(&g.length[first])),
      c(Four(2.0) / load(&g.chi[first])), te(load(g.t, first - 1)), tf(load(g.t, first)), kb(load(g.kb, first)),
      tt((Four(0.5) * c) * (te + tf)),
      w{load(g.m2, first - 1), -load(g.m1, first - 1), load(g.m2, first), -load(g.m1, first)}, torque(0.0), bending(0.0), twisting(0.0) {
  for (int r = 0; r < 4; ++r) {
    kappa[r] = load(&g.kappa(r, first));
    moment[r] = Four(0.0);
  }
  if (count == kWidth && joined(s, first) && joined(s, first + 1) && joined(s, first + 2) && joined(s, first + 3)) {
    // numbers set one by one are slow to be read as four
    const Four over = Four(1.0) / (Four(0.5) * (load(&s.rest_length[first - 1]) + load(&s.rest_length[first])));
    bending = Four(0.5 * m.EI) * over;
    twisting = Four(m.GJ) * over;
    torque = twisting * (load(&g.twist[first]) - load(&s.rest_twist[first]));
    const double* const rest = s.rest_kappa.data() + 4 * first;
    const Turned kappa_0(load(rest), load(rest + 4), load(rest + 8), load(rest + 12));
    for (int r = 0; r < 4; ++r) moment[r] = bending * (kappa[r] - kappa_0.row[r]);
    return;
  }
  for (int k = 0; k < count; ++k) {
    const int i = first + k;
    if (!joined(s, i)) continue;
    const double over = 1.0 / node_length(s, i);
    bending.set(k, 0.5 * m.EI * over);
    twisting.set(k, m.GJ * over);
    torque.set(k, twisting[k] * (g.twist[i] - s.rest_twist[i]));
    for (int r = 0; r < 4; ++r) moment[r].set(k, bending[k] * (kappa[r][k] - s.rest_kappa(r, i)));
  }
}

/// First derivatives of the four curvatures and of the twist by the edge vector before the node and by the one behind it. By the angles theta^{i-1}, theta^i
/// they are: of kappa 0 and 1 kappa[1] and -kappa[0] before, of kappa 2 and 3 kappa[3] and -kappa[2] behind (turning the directors
/// by dtheta turns the curvature by -dtheta), of the twist -1 and 1.
struct Gradients {
  explicit Gradients(const Nodes& n) noexcept {
    for (int k = 0; k < 4; ++k) {
      const Vec3x4 along = (-n.kappa[k]) * n.tt, cw = n.c * n.w[k];
      before[k] = n.e * (along + cross(n.tf, cw));
      behind[k] = n.f * (along - cross(n.te, cw));
    }
    before[4] = (Four(0.5) * n.e) * n.kb;
    behind[4] = (Four(0.5) * n.f) * n.kb;
  }
  Vec3x4 before[5], behind[5];  // kappa 0 ... 3, twist
};

/// A 4 x 4 block of each of four nodes: three coordinates and an angle.
struct Block {
  Four at[4][4];  // row, column
  Block() noexcept {
    for (auto& row : at)
      for (Four& v : row) v = Four(0.0);
  }
  void add_outer(const Vec3x4& a, const Vec3x4& b) noexcept {
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k) at[r][k] += a[r] * b[k];
  }
  void add_column(const Vec3x4& a) noexcept {
    for (int r = 0; r < 3; ++r) at[r][3] += a[r];
  }
  void add_row(const Vec3x4& a) noexcept {
    for (int k = 0; k < 3; ++k) at[3][k] += a[k];
  }
  void add_unit(const Four& a) noexcept {
    for (int r = 0; r < 3; ++r) at[r][r] += a;
  }
  void add_transpose() noexcept {
    for (int r = 0; r < 4; ++r) {
      at[r][r] += at[r][r];
      for (int k = 0; k < r; ++k) at[r][k] = at[k][r] = at[r][k] + at[k][r];
    }
  }
};

/// Second derivatives by (edge vector before, theta^{i-1}) = e and (edge vector behind, theta^i) = f. Of `ee` and `ff`, which are
/// symmetric, half is collected and the transpose added at the end.
struct Hessian {
  Block ee, ef, ff;
};

/// sum_k bending grad kappa_k grad kappa_k^T + twisting grad twist grad twist^T.
void add_squares(const Nodes& n, const Gradients& d, Hessian& h) noexcept {
  for (int k = 0; k < 5; ++k) {
    const Four stiffness = k < 4 ? n.bending : n.twisting, half = Four(0.5) * stiffness;
    h.ee.add_outer(half * d.before[k], d.before[k]);
    h.ff.add_outer(half * d.behind[k], d.behind[k]);
    h.ef.add_outer(stiffness * d.before[k], d.behind[k]);
  }
  const Vec3x4 e_turn = n.kappa[1] * d.before[0] - n.kappa[0] * d.before[1], f_turn = n.kappa[3] * d.behind[2] - n.kappa[2] * d.behind[3];
  h.ee.add_column(n.bending * e_turn - n.twisting * d.before[4]);
  h.ff.add_column(n.bending * f_turn + n.twisting * d.behind[4]);
  h.ef.add_row(n.bending * (n.kappa[1] * d.behind[0] - n.kappa[0] * d.behind[1]) - n.twisting * d.behind[4]);
  h.ef.add_column(n.bending * (n.kappa[3] * d.before[2] - n.kappa[2] * d.before[3]) + n.twisting * d.before[4]);
  h.ee.at[3][3] += Four(0.5) * (n.bending * (n.kappa[0] * n.kappa[0] + n.kappa[1] * n.kappa[1]) + n.twisting);
  h.ff.at[3][3] += Four(0.5) * (n.bending * (n.kappa[2] * n.kappa[2] + n.kappa[3] * n.kappa[3]) + n.twisting);
  h.ef.at[3][3] -= n.twisting;
}

/// sum_k moment_k d2(kappa_k) + torque d2(twist).
void add_second_derivatives(const Nodes& n, Hessian& h) noexcept {
  // With me, mf the weighted directors the sum is kb.(me + mf), and all four curvatures share one set of formulas.
  const Vec3x4 me = n.moment[0] * n.w[0] + n.moment[1] * n.w[1], mf = n.moment[2] * n.w[2] + n.moment[3] * n.w[3];
  const Vec3x4 d = n.c * (me + mf), tf_d = cross(n.tf, d), te_d = cross(n.te, d);
  const Four k = n.moment[0] * n.kappa[0] + n.moment[1] * n.kappa[1] + n.moment[2] * n.kappa[2] + n.moment[3] * n.kappa[3];
  const Four kc = Four(0.5) * k * n.c, half = Four(0.5), quarter = Four(0.25) * n.torque;
  const Four ee = n.e * n.e, ff = n.f * n.f, ef = n.e * n.f;
  h.ee.add_outer(ee * n.tt, k * n.tt - tf_d);
  h.ee.add_outer(ee * n.kb, half * me - quarter * (n.te + n.tt));
  h.ee.add_outer((half * ee * kc) * n.te, n.te);
  h.ee.add_unit(-(half * ee * kc));
  h.ff.add_outer(ff * n.tt, k * n.tt + te_d);
  h.ff.add_outer(ff * n.kb, half * mf - quarter * (n.tf + n.tt));
  h.ff.add_outer((half * ff * kc) * n.tf, n.tf);
  h.ff.add_unit(-(half * ff * kc));
  h.ef.add_outer(ef * (Four(2.0) * k * n.tt - tf_d - (half * n.torque) * n.kb), n.tt);
  h.ef.add_outer(ef * n.tt, te_d);
  h.ef.add_outer(-(ef * kc) * n.te, n.tf);
  h.ef.add_unit(-(ef * kc));
  const Vec3x4 r = ef * ((half * n.torque * n.c) * n.te - d);  // + [r]x
  h.ef.at[1][0] += r.z, h.ef.at[0][2] += r.y, h.ef.at[2][1] += r.x;
  h.ef.at[0][1] -= r.z, h.ef.at[2][0] -= r.y, h.ef.at[1][2] -= r.x;

  // Mixed with the angles: kappa1 pairs with m1, kappa2 with m2.
  const Vec3x4 be = n.moment[1] * n.w[0] - n.moment[0] * n.w[1], bf = n.moment[3] * n.w[2] - n.moment[2] * n.w[3];
  const Vec3x4 along_e = dot(n.kb, be) * n.tt, along_f = dot(n.kb, bf) * n.tt;
  h.ee.add_column(n.e * (along_e - n.c * cross(n.tf, be)));
  h.ef.add_row(n.f * (along_e + n.c * cross(n.te, be)));
  h.ef.add_column(n.e * (along_f - n.c * cross(n.tf, bf)));
  h.ff.add_column(n.f * (along_f + n.c * cross(n.te, bf)));
  h.ee.at[3][3] -= half * dot(n.kb, me);
  h.ff.at[3][3] -= half * dot(n.kb, mf);
}

/// The blocks of four nodes, each a matrix.
void unpack(const Block& b, Mat4* to) noexcept {
  for (int c = 0; c < 4; ++c) {
    const Turned column(b.at[0][c], b.at[1][c], b.at[2][c], b.at[3][c]);
    store(column.row[0], to[0].data() + 4 * c);
    store(column.row[1], to[1].data() + 4 * c);
    store(column.row[2], to[2].data() + 4 * c);
    store(column.row[3], to[3].data() + 4 * c);
  }
}

/// Of edge vectors and angles (e, theta^{i-1}, f, theta^i) to those of nodes: e = x_i - x_{i-1}, f = x_{i+1} - x_i, theta^{i-1} belongs to node i-1.
/// The first node of an edge takes its vector with -1 and its angle, the second its vector alone.
void scatter(const Hessian& h, int first, int count, const ChainSlots& slots, BlockCholesky& matrix) noexcept {
  Block before, middle, behind, before_middle, middle_behind, before_behind;
  for (int r = 0; r < 4; ++r) {
    const auto by_first = [&](const Four& v) { return r < 3 ? -v : v; };
    for (int c = 0; c < 4; ++c) {
      const Four ee = h.ee.at[r][c], ff = h.ff.at[r][c], ef = h.ef.at[r][c], fe = h.ef.at[c][r];
      before.at[r][c] = (r < 3) == (c < 3) ? ee : -ee;
      middle.at[r][c] = r < 3 ? (c < 3 ? ee - ef - fe + ff : ef - ff) : c < 3 ? fe - ff : ff;
      before_middle.at[r][c] = by_first(c < 3 ? ee - ef : ef);
      if (c == 3) continue;
      if (r < 3) behind.at[r][c] = ff;
      middle_behind.at[r][c] = r < 3 ? ef - ff : ff;
      before_behind.at[r][c] = by_first(ef);
    }
  }
  std::array<std::array<Mat4, kWidth>, 6> each;
  std::size_t n = 0;
  for (const Block* b : {&before, &middle, &behind, &before_middle, &middle_behind, &before_behind}) unpack(*b, each[n++].data());
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const int i = first + static_cast<int>(k);
    matrix.add_diagonal(i - 1, each[0][k]);
    matrix.add_diagonal(i, each[1][k]);
    matrix.add_diagonal(i + 1, each[2][k]);
    matrix.add(slots.next[i - 1], each[3][k]);
    matrix.add(slots.next[i], each[4][k]);
    matrix.add(slots.second[i - 1], each[5][k]);
  }
}

void add_stretch_hessian(const RodMaterial& m, const RodState& s, const RodGeometry& g, int j, Stiffness kind,
                         const ChainSlots& slots, BlockCholesky& matrix) noexcept {
  const double force = m.EA * (g.length[j] / s.rest_length[j] - 1.0);
  const double k = m.EA / s.rest_length[j];
  const Vec3 t = g.t.col(j);
  double across = force / g.length[j];  // geometric stiffness: a stretched string resists sideways motion
  if (kind == Stiffness::gauss_newton) across = std::max(0.0, across);
  const double more = k - across;
  const Four along(Four::Vector{more * t.x(), more * t.y(), more * t.z(), 0.0});
  Mat4 block;
  for (int c = 0; c < 3; ++c) {  // column by column: what is written number by number is slow to be read as a whole
    Four unit(0.0);
    unit.set(c, across);
    store(along * Four(t[c]) + unit, block.data() + 4 * c);
  }
  store(Four(0.0), block.data() + 12);
  matrix.add_diagonal(j, block);
  matrix.add_diagonal(j + 1, block);
  matrix.add(slots.next[j], -block);
}

}  // namespace

RodGeometry::RodGeometry(int capacity)
    : length(RodRow::Zero(capacity + kWidth)), t(RodRows::Zero(3, capacity + kWidth)), d1(t), m1(t), m2(t), kb(t),
      kappa(decltype(kappa)::Zero(4, capacity + kWidth)), chi(length), ref_twist(length), twist(length), x(t), reference_t(t),
      reference_d1(t), theta(length), reference_twist(length), reference_cos(length), reference_sin(length) {}

void set_reference(const RodState& s, RodGeometry& g) noexcept {
  for (int j = 0; j + 1 < s.n; ++j) g.t.col(j) = (s.x.col(j + 1) - s.x.col(j)).normalized();
  g.d1.leftCols(s.n) = s.d1.leftCols(s.n);
  g.ref_twist.head(s.n) = s.ref_twist.head(s.n);
  take_reference(s.n, g);
}

void take_reference(int n, RodGeometry& g) noexcept {
  g.reference_t.leftCols(n) = g.t.leftCols(n);
  g.reference_d1.leftCols(n) = g.d1.leftCols(n);
  g.reference_twist.head(n) = g.ref_twist.head(n);
  for (int i = 1; i + 1 < n; ++i) {
    g.reference_cos[i] = std::cos(g.ref_twist[i]);
    g.reference_sin[i] = std::sin(g.ref_twist[i]);
  }
}

void follow_reference(int n, const Points& x, const Eigen::VectorXd& theta, RodGeometry& g) noexcept {
  g.x.leftCols(n) = x.leftCols(n);
  g.theta.head(n) = theta.head(n);
  for (int j = 0; j + 1 < n; j += kWidth) follow_edges(j, g);
  for (int i = 1; i + 1 < n; i += kWidth) follow_nodes(i, g);
}

void update_geometry(const RodState& reference, const Points& x, const Eigen::VectorXd& theta, RodGeometry& g) noexcept {
  set_reference(reference, g);
  follow_reference(reference.n, x, theta, g);
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
  for (int first = 1; first + 1 < s.n; first += kWidth) {
    const Nodes n(m, s, g, first);
    const Gradients d(n);
    Vec3x4 before = n.torque * d.before[4], behind = n.torque * d.behind[4];
    for (int k = 0; k < 4; ++k) {
      before = before + n.moment[k] * d.before[k];
      behind = behind + n.moment[k] * d.behind[k];
    }
    const Four before_angle = n.moment[0] * n.kappa[1] - n.moment[1] * n.kappa[0] - n.torque;
    const Four behind_angle = n.moment[2] * n.kappa[3] - n.moment[3] * n.kappa[2] + n.torque;
    for (int k = 0; k < n.count; ++k) {  // as in scatter()
      const int i = first + k;
      const Vec3 e(before.x[k], before.y[k], before.z[k]), f(behind.x[k], behind.y[k], behind.z[k]);
      gradient.col(i - 1).head<3>() -= e;
      gradient.col(i).head<3>() += e - f;
      gradient.col(i + 1).head<3>() += f;
      gradient(3, i - 1) += before_angle[k];
      gradient(3, i) += behind_angle[k];
    }
  }
}

void add_elastic_hessian(const RodMaterial& m, const RodState& s, const RodGeometry& g, Stiffness kind,
                         const ChainSlots& slots, BlockCholesky& matrix) noexcept {
  for (int j = 0; j + 1 < s.n; ++j)
    if (s.alive[j]) add_stretch_hessian(m, s, g, j, kind, slots, matrix);
  for (int first = 1; first + 1 < s.n; first += kWidth) {
    const Nodes n(m, s, g, first);
    Hessian h;
    add_squares(n, Gradients(n), h);
    if (kind == Stiffness::exact) add_second_derivatives(n, h);
    h.ee.add_transpose();
    h.ff.add_transpose();
    scatter(h, first, n.count, slots, matrix);
  }
}

}  // namespace filum
