#include "physics/needle.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "collision/segment_distance.h"

namespace filum {
namespace {

constexpr int kMostHalvings = 12;
constexpr double kRollGive = 0.05;    // [rad], by which a wire turns between the pads before it slips
constexpr double kLongestTurn = 0.3;  // [rad], in one iteration
constexpr double kStuck = 1e-4;       // [N], imbalance left by moves that turn it about its middle, with which it is not where it belongs

Mat3 cross_matrix(const Vec3& r) noexcept {
  Mat3 m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

Vec3 rotation_vector(const Quat& q) noexcept {
  const Eigen::AngleAxisd a(q.w() < 0.0 ? Quat(-q.coeffs()) : q);
  return a.angle() * a.axis();
}

Quat turned(const Vec3& phi, const Quat& q) noexcept {
  const double angle = phi.norm();
  if (angle < 1e-16) return q;
  return (Quat(Eigen::AngleAxisd(angle, phi / angle)) * q).normalized();
}

/// Force f and stiffness k at a point r from the centre of mass.
void add_point(const Vec3& r, const Vec3& f, const Mat3& k, Vec6& gradient, Mat6& stiffness) noexcept {
  gradient.head<3>() -= f;
  gradient.tail<3>() -= r.cross(f);
  const Mat3 rx = cross_matrix(r), krx = k * rx;  // dx = dp + dphi x r = dp - rx dphi
  stiffness.topLeftCorner<3, 3>() += k;
  stiffness.topRightCorner<3, 3>() -= krx;
  stiffness.bottomLeftCorner<3, 3>() -= krx.transpose();
  stiffness.bottomRightCorner<3, 3>() += rx.transpose() * krx;
}

/// Coulomb's law on a line: force, energy and stiffness of a displacement u.
struct LinePoint {
  double force, energy, stiffness, elastic;
};
LinePoint on_line(double u, double limit, double k) noexcept {
  if (k * std::abs(u) <= limit) return {-k * u, 0.5 * k * u * u, k, u};
  return {-std::copysign(limit, u), limit * (std::abs(u) - 0.5 * limit / k), 0.0, std::copysign(limit / k, u)};
}

}  // namespace

NeedleBody::NeedleBody(NeedleShape shape, int n_tools) : tools(static_cast<std::size_t>(n_tools)), shape_(std::move(shape)), inertia_N_(shape_.inertia()) {
  tethers.reserve(128);
  bars.reserve(InstrumentContact::kMostBars);
  for (int k = 0; k < kNeedleSamples; ++k) sample_arc_[static_cast<std::size_t>(k)] = shape_.length() * k / (kNeedleSamples - 1);
}

double NeedleBody::roll_limit(const NeedleTool& tool) const noexcept {
  return tool.grip_force * (2.0 * shape_.pad_friction * shape_.wire_radius + 0.5 * shape_.flat_width);
}

void NeedleBody::begin(const NeedleState& s, const NeedleOptions& o) noexcept {
  predicted_ = {s.X_WN.p + o.dt * s.v, turned(o.dt * s.w, s.X_WN.q)};
  const Mat3 r = s.X_WN.q.toRotationMatrix();
  inertia_W_ = r * inertia_N_.asDiagonal() * r.transpose();
  load_.fill(0.0);
  now_.X = predicted_;
  for (std::size_t i = 0; i < tools.size(); ++i)  // held: goes with the hand
    if (s.grips[i].held != 0) now_.X = tools[i].X_end * tools[i].X_start.inverse() * s.X_WN;
  now_.X.q.normalize();
}

void NeedleBody::add_inertia(const NeedleState&, const NeedleOptions& o, Trial& t) const noexcept {
  const double m = shape_.mass(), h2 = o.dt * o.dt;
  const Vec3 d = t.X.p - predicted_.p, phi = rotation_vector(t.X.q * predicted_.q.conjugate());
  const Vec3 turn = inertia_W_ * phi;
  t.energy += 0.5 * m / h2 * d.squaredNorm() + 0.5 / h2 * phi.dot(turn) - m * o.gravity.dot(t.X.p);
  t.gradient.head<3>() += m / h2 * d - m * o.gravity;
  t.gradient.tail<3>() += turn / h2;
  t.stiffness.topLeftCorner<3, 3>().diagonal().array() += m / h2;
  t.stiffness.bottomRightCorner<3, 3>() += inertia_W_ / h2;
}

void NeedleBody::add_grips(const NeedleState& s, Trial& t) noexcept {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const NeedleGrip& g = s.grips[i];
    NeedleTool& tool = tools[i];
    tool.force.setZero();
    tool.torque.setZero();
    if (g.held == 0) continue;
    const Vec3 n = tool.X_end.q * Vec3::UnitX();
    const double k = shape_.grip_stiffness, share = tool.grip_force / 3.0;
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3 r = t.X.q * shape_.point(g.arc + (static_cast<double>(j) - 1.0) * 0.75 * g.half);
      const Vec3 anchor = tool.X_end * g.anchor_T[j], xi = t.X.p + r - anchor;
      const double across = xi.dot(n);
      const LinePoint a = on_line(across, 2.0 * share, k);
      FrictionPoint& f = held_[i][j];
      f = coulomb(xi - across * n, n, 2.0 * share, shape_.pad_friction, k);
      slid_[i][j] = xi - across * n - f.xi + (across - a.elastic) * n;
      const Vec3 force = f.force + a.force * n;
      t.energy += f.energy + a.energy;
      add_point(r, force, f.stiffness + a.stiffness * n * n.transpose(), t.gradient, t.stiffness);
      tool.force -= force;
      tool.torque -= (anchor - tool.X_end.p).cross(force);
    }
    const Vec3 axis = t.X.q * shape_.tangent(g.arc);
    const Vec3 turn = rotation_vector(t.X.q * s.X_WN.q.conjugate()) - rotation_vector(tool.X_end.q * tool.X_start.q.conjugate());
    const double roll_most = roll_limit(tool);
    const LinePoint p = on_line(g.roll + turn.dot(axis), roll_most, std::max(roll_most, 1e-12) / kRollGive);
    roll_[i] = p.elastic;
    t.energy += p.energy;
    t.gradient.tail<3>() -= p.force * axis;
    t.stiffness.bottomRightCorner<3, 3>() += p.stiffness * axis * axis.transpose();
    tool.torque -= p.force * axis;
  }
}

void NeedleBody::add_sheet(const NeedleState& s, const NeedleOptions& o, Trial& t) noexcept {
  const double k = o.contact_stiffness;
  const Vec3 up = Vec3::UnitZ();
  for (std::size_t j = 0; j < kNeedleSamples; ++j) {
    const Vec3 p_N = shape_.point(sample_arc_[j]), r = t.X.q * p_N;
    const double over = o.sheet + shape_.wire_radius - (t.X.p.z() + r.z());
    on_sheet_[j] = {};
    if (over > 0.0) {
      t.energy += 0.5 * k * over * over;
      add_point(r, k * over * up, k * up * up.transpose(), t.gradient, t.stiffness);
    }
    if (load_[j] <= 0.0) continue;
    Vec3 xi = s.sheet_bristle.col(static_cast<Eigen::Index>(j)) + t.X.p + r - s.X_WN * p_N;
    xi.z() = 0.0;
    on_sheet_[j] = coulomb(xi, up, load_[j], shape_.sheet_friction, stick_stiffness(k, shape_.sheet_friction, load_[j], o.presliding));
    t.energy += on_sheet_[j].energy;
    add_point(r, on_sheet_[j].force, on_sheet_[j].stiffness, t.gradient, t.stiffness);
  }
}

void NeedleBody::add_jaws(const NeedleOptions& o, Trial& t) noexcept {
  const double k = o.contact_stiffness;
  for (NeedleTool& tool : tools) {
    if (!tool.bars_touch) continue;
    for (int b = 0; b < 2; ++b) {
      const Vec3 a = tool.X_end * tool.bars.a_T[b], e = tool.X_end * tool.bars.b_T[b] - a;
      const double ee = e.squaredNorm();
      if ((t.X.p - a).norm() > tool.bars.r_b[b] + 2.0 * shape_.bend_radius + std::sqrt(ee)) continue;
      for (const double arc : sample_arc_) {
        const Vec3 r = t.X.q * shape_.point(arc), x = t.X.p + r;
        const double f = std::clamp((x - a).dot(e) / ee, 0.0, 1.0);
        const Vec3 d = x - a - f * e;
        const double distance = d.norm();
        const double over = tool.bars.r_a[b] + f * (tool.bars.r_b[b] - tool.bars.r_a[b]) + shape_.radius_at(arc) - distance;
        if (over <= 0.0 || distance < 1e-9) continue;
        const Vec3 n = d / distance, force = k * over * n;
        t.energy += 0.5 * k * over * over;
        add_point(r, force, k * n * n.transpose(), t.gradient, t.stiffness);
        tool.force -= force;
        tool.torque -= (x - tool.X_end.p).cross(force);
      }
    }
  }
}

/// A point that is past the axis, seen from where it began the step, is pushed back the way it came.
void NeedleBody::add_bars(const NeedleState& s, const NeedleOptions& o, Trial& t) const noexcept {
  for (const RoundBar& bar : bars) {
    const Vec3 e = bar.b - bar.a;
    const double ee = e.squaredNorm(), thickest = std::max(bar.r_a, bar.r_b), wire = 2.0 * shape_.bend_radius + shape_.wire_radius;
    const auto along = [&](const Vec3& x) { return std::clamp((x - bar.a).dot(e) / ee, 0.0, 1.0); };
    const auto away = [&](const Vec3& x) { return (x - bar.a - along(x) * e).norm(); };
    if (std::min(away(t.X.p), away(s.X_WN.p)) > thickest + wire + (t.X.p - s.X_WN.p).norm()) continue;
    for (const double arc : sample_arc_) {
      const Vec3 r = t.X.q * shape_.point(arc), x = t.X.p + r, before = s.X_WN * shape_.point(arc);
      const double f = along(x);
      const Vec3 came = before - bar.a - along(before) * e, d = x - bar.a - f * e;
      const double reach = bar.r_a + f * (bar.r_b - bar.r_a) + shape_.radius_at(arc), distance = d.norm();
      if (distance < 1e-9 || came.norm() < 1e-9) continue;
      const Vec3 back = came.normalized();
      const double past = d.dot(back);
      const bool through = past < 0.0 && (d - past * back).norm() < reach;
      const Vec3 n = through ? back : Vec3(d / distance);
      const double over = reach - (through ? past : distance);
      if (over <= 0.0) continue;
      t.energy += 0.5 * o.bar_stiffness * over * over;
      add_point(r, o.bar_stiffness * over * n, o.bar_stiffness * n * n.transpose(), t.gradient, t.stiffness);
    }
  }
}

void NeedleBody::add_tethers(const NeedleOptions& o, Trial& t) noexcept {
  for (RodTether& c : tethers) {
    const Vec3 r = t.X.q * shape_.point(c.arc), d = t.X.p + r - c.anchor;
    if (c.across != Vec3::Zero()) {
      add_surface(c, d, r, t);
      continue;
    }
    c.force = -(c.stiffness * d);
    Mat3 k = c.stiffness;
    t.energy += 0.5 * d.dot(c.stiffness * d);
    c.slid = 0.0;
    if (const double u = d.dot(c.along); c.stick > 0.0 && !(c.one_way && u < 0.0)) {
      const double speed = (u - c.start) / o.dt;
      const LinePoint f = on_line(u, c.limit, c.stick);
      c.force += (f.force - c.drag * speed) * c.along;
      k += (f.stiffness + c.drag / o.dt) * c.along * c.along.transpose();
      c.slid = u - f.elastic;
      t.energy += f.energy + 0.5 * c.drag * speed * speed * o.dt;
    }
    add_point(r, c.force, k, t.gradient, t.stiffness);
  }
}

/// A tether that is a surface (rod_tether.h): it pushes only, with friction in its plane.
void NeedleBody::add_surface(RodTether& c, const Vec3& d, const Vec3& r, Trial& t) noexcept {
  const Vec3 normal = c.along.cross(c.across), slip = d - d.dot(normal) * normal;
  const bool lifted = d.dot(normal) > 0.0;
  const FrictionPoint f = coulomb(slip, normal, c.limit, 1.0, c.stick);
  c.force = lifted ? f.force : Vec3(f.force - c.stiffness * d);
  c.slid = (slip - f.xi).norm();
  t.energy += f.energy + (lifted ? 0.0 : 0.5 * d.dot(c.stiffness * d));
  add_point(r, c.force, lifted ? f.stiffness : Mat3(f.stiffness + c.stiffness), t.gradient, t.stiffness);
}

void NeedleBody::evaluate(const NeedleState& s, const NeedleOptions& o, Trial& t) noexcept {
  t.gradient.setZero();
  t.stiffness.setZero();
  t.energy = 0.0;
  add_inertia(s, o, t);
  add_grips(s, t);
  add_sheet(s, o, t);
  add_jaws(o, t);
  if (!bars.empty()) add_bars(s, o, t);
  add_tethers(o, t);
  if (dead_load_.isZero(0.0)) return;
  const Vec3 r = t.X.q * shape_.point(dead_arc_);
  t.energy -= dead_load_.dot(t.X.p + r);
  add_point(r, dead_load_, Mat3::Zero(), t.gradient, t.stiffness);
}

/// Friction on the sheet goes by the normal forces of the present pose.
void NeedleBody::fix_loads(const NeedleOptions& o) noexcept {
  for (std::size_t j = 0; j < kNeedleSamples; ++j) {
    const double z = (now_.X * shape_.point(sample_arc_[j])).z();
    load_[j] = o.contact_stiffness * std::max(0.0, o.sheet + shape_.wire_radius - z);
  }
}

NeedleSummary NeedleBody::minimise(const NeedleState& s, const NeedleOptions& o) noexcept {
  begin(s, o);
  return descend(s, o, Turn::about_middle);
}

NeedleSummary NeedleBody::descend(const NeedleState& s, const NeedleOptions& o, Turn turn) noexcept {
  NeedleSummary summary;
  const double lever = shape_.bend_radius;
  for (;; ++summary.iterations) {
    if (summary.iterations < 6) fix_loads(o);
    evaluate(s, o, now_);
    summary.residual = std::max(now_.gradient.head<3>().cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
                                now_.gradient.tail<3>().cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / lever);
    summary.sound = std::isfinite(summary.residual);
    if (!summary.sound || summary.residual < o.force_tolerance || summary.iterations == o.max_iterations) break;
    if (!advance(s, o, turn)) break;
  }
  return summary;
}

/// One step of Newton's method with line search. Where the thread holds the swage, stiffly, and jaws turn the needle by far, turns about its middle leave
/// the spring's valley at once and are cut to nothing; a swage that goes straight on as the needle turns about it stays there. False if it leads no
/// further down; now_ is evaluated then.
bool NeedleBody::advance(const NeedleState& s, const NeedleOptions& o, Turn turn) noexcept {
  Vec6 move = now_.stiffness.ldlt().solve(-now_.gradient);
  const double slope = move.dot(now_.gradient);
  if (!(slope < 0.0)) return false;
  double fraction = std::min(1.0, kLongestTurn / std::max(move.tail<3>().norm(), 1e-12));
  const double before = now_.energy;
  for (int k = 0; k < kMostHalvings; ++k, fraction *= 0.5) {
    trial_.X = {now_.X.p + fraction * move.head<3>(), turned(fraction * move.tail<3>(), now_.X.q)};
    if (turn == Turn::about_swage) {
      const Vec3 swage_N = shape_.point(0.0), r = now_.X.q * swage_N;
      trial_.X.p += r + fraction * move.tail<3>().cross(r) - trial_.X.q * swage_N;
    }
    evaluate(s, o, trial_);
    if (trial_.energy <= before + 1e-4 * fraction * slope) {
      now_.X = trial_.X;
      return true;
    }
  }
  evaluate(s, o, now_);
  return false;
}

/// Anchors follow what slid along the pads. Wire that has left the pads lengthwise is taken hold of anew further along.
void NeedleBody::finish_grips(NeedleState& s) const noexcept {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    NeedleGrip& g = s.grips[i];
    if (g.held == 0) continue;
    g.roll = roll_[i];
    double most = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      g.anchor_T[j] += tools[i].X_end.q.conjugate() * slid_[i][j];
      most = std::max(most, slid_[i][j].norm());
    }
    if (most < 1e-7) continue;
    const Stretch inside = stretch_between(static_cast<int>(i), 2.0 * shape_.wire_radius, s);
    if (inside.first < 0.0) {
      g.held = 0;
      continue;
    }
    const double middle = 0.5 * (inside.first + inside.last), half = 0.5 * (inside.last - inside.first);
    if (std::abs(middle - g.arc) < 0.1 * g.half && std::abs(half - g.half) < 0.1 * g.half) continue;
    const Vec3 give = tools[i].X_end.inverse() * (s.X_WN * shape_.point(g.arc)) - g.anchor_T[1];
    g.arc = middle;
    g.half = half;
    for (std::size_t j = 0; j < 3; ++j)
      g.anchor_T[j] = tools[i].X_end.inverse() * (s.X_WN * shape_.point(g.arc + (static_cast<double>(j) - 1.0) * 0.75 * g.half)) - give;
  }
}

NeedleSummary NeedleBody::step(NeedleState& s, const NeedleOptions& o) noexcept {
  NeedleSummary summary = minimise(s, o);
  if (summary.sound && summary.residual > kStuck) summary = descend(s, o, Turn::about_swage);
  if (!summary.sound) {
    s.v.setZero();
    s.w.setZero();
    return summary;
  }
  s.v = (now_.X.p - s.X_WN.p) / o.dt;
  s.w = rotation_vector(now_.X.q * s.X_WN.q.conjugate()) / o.dt;
  s.X_WN = now_.X;
  for (std::size_t j = 0; j < kNeedleSamples; ++j) s.sheet_bristle.col(static_cast<Eigen::Index>(j)) = on_sheet_[j].xi;
  finish_grips(s);
  return summary;
}

Mat3 NeedleBody::look_ahead(const NeedleState& s, const NeedleOptions& o, double arc, Vec3& point, const Vec3& load) noexcept {
  dead_load_ = load;
  dead_arc_ = arc;
  minimise(s, o);
  dead_load_.setZero();
  const Vec3 r = now_.X.q * shape_.point(arc);
  Eigen::Matrix<double, 6, 3> jt;  // J^T
  jt.topRows<3>() = Mat3::Identity();
  jt.bottomRows<3>() = cross_matrix(r);
  const Mat3 give = jt.transpose() * now_.stiffness.ldlt().solve(jt);
  point = now_.X.p + r - give * load;
  return give.inverse();
}

/// Stretch of wire inside the box between the pads.
NeedleBody::Stretch NeedleBody::stretch_between(int tool, double reach, const NeedleState& s) const noexcept {
  constexpr int kLook = 120;
  const NeedleTool& t = tools[static_cast<std::size_t>(tool)];
  const Pose X_TN = t.X_end.inverse() * s.X_WN;
  Stretch inside;
  for (int k = 0; k <= kLook; ++k) {
    const double arc = shape_.length() * k / kLook;
    const Vec3 p = X_TN * shape_.point(arc);
    if (std::abs(p.x()) > reach || std::abs(p.y()) > t.pads.half_width || p.z() < 0.0 || p.z() > t.pads.length) continue;
    if (inside.first < 0.0) inside.first = arc;
    inside.last = arc;
  }
  return inside;
}

bool NeedleBody::between(int tool, double reach, const NeedleState& s) const noexcept { return stretch_between(tool, reach, s).first >= 0.0; }

bool NeedleBody::take(int tool, double reach, NeedleState& s) const noexcept {
  const Stretch inside = stretch_between(tool, reach, s);
  if (inside.first < 0.0) return false;
  NeedleGrip& g = s.grips[static_cast<std::size_t>(tool)];
  const NeedleTool& t = tools[static_cast<std::size_t>(tool)];
  g.held = 1;
  g.roll = 0.0;
  g.arc = 0.5 * (inside.first + inside.last);
  g.half = std::max(0.5 * (inside.last - inside.first), 0.25 * t.pads.half_width);
  for (std::size_t j = 0; j < 3; ++j) {
    g.anchor_T[j] = t.X_end.inverse() * (s.X_WN * shape_.point(g.arc + (static_cast<double>(j) - 1.0) * 0.75 * g.half));
    g.anchor_T[j].x() = 0.0;  // the closed pads press the wire into their plane
  }
  return true;
}

}  // namespace filum
