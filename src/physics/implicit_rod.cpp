#include "physics/implicit_rod.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stage_clock.h"

namespace filum {
namespace {

constexpr int kMostHalvings = 14;
constexpr int kMostTethers = 640;
constexpr int kMoreToArrive = 3;  // times the iterations while a body is under way: whoever moves it has to leave it where it is if that is not enough
constexpr int kLoadsFall = 6;       // iterations of a step in which friction's loads follow the normal forces down
constexpr double kLongestReach = 16.0;  // [radii], of a move that is looked at for crossings: all pairs within it must be known
constexpr double kLeastReach = 0.05;    // [radii], of the search for near pairs
constexpr double kMostExtraInertia = 1e6;  // [1], times the nodes' own
constexpr double kLateGrowth = 1.6;         // [1], of the tolerance from one late iteration to the next
constexpr double kMostLate = 30.0;          // [1], times the tolerance
constexpr double kLeastLate = 3e-6;         // [N]
constexpr double kLargestLate = 1e-4;       // [N], what a step may be off by before it is called trouble
constexpr double kHeld = 1e24;  // added to the diagonal of held coordinates: their correction vanishes to rounding

double node_span(const RodState& s, int i) noexcept {
  double l = 0.0;
  if (i > 0) l += 0.5 * s.rest_length[i - 1];
  if (i + 1 < s.n) l += 0.5 * s.rest_length[i];
  return l;
}

/// [kg m2], of edge j about its axis.
double spin_inertia(const RodMaterial& m, const RodState& s, int j) noexcept {
  return 0.5 * m.mass_per_length() * m.radius * m.radius * s.rest_length[j];
}

double largest_move(const Eigen::Matrix4Xd& move, int n) noexcept {
  return std::sqrt(move.leftCols(n).topRows<3>().colwise().squaredNorm().maxCoeff());
}

}  // namespace

double late_tolerance(const RodStepOptions& o, int iterations, double scale) noexcept {
  const double strict = std::max(o.force_tolerance, o.relative_tolerance * scale);
  const int late = iterations - o.strict_iterations + 1;
  if (late <= 0) return strict;
  const double grown = strict * std::min(kMostLate, std::pow(kLateGrowth, late));
  return std::max(strict, std::clamp(grown, kLeastLate, kLargestLate));
}

RodBoundary::RodBoundary(int capacity)
    : load(Eigen::Matrix4Xd::Zero(4, capacity)),
      held(Eigen::Array<bool, 4, Eigen::Dynamic>::Constant(4, capacity, false)),
      target(Eigen::Matrix4Xd::Zero(4, capacity)) {}

ImplicitRod::ImplicitRod(const RodMaterial& m, const ContactMaterial& c, int capacity, int n_tools)
    : material(m), contact_material(c), boundary(capacity), obstacles(8 * capacity), grasps(n_tools), tethers(kMostTethers),
      contact_(capacity, 16 * capacity), geometry_(capacity), matrix_(capacity), x_(Points::Zero(3, capacity)), x_trial_(x_),
      theta_(Eigen::VectorXd::Zero(capacity)), theta_trial_(theta_), gradient_(Eigen::Matrix4Xd::Zero(4, capacity)),
      move_(gradient_), boundary_move_(gradient_), lengths_(capacity),
      inverse_mass_(theta_), stiffened_(m), rest_kappa_(Eigen::Matrix4Xd::Zero(4, capacity)), rest_twist_(theta_) {
  chain_.next.resize(static_cast<std::size_t>(capacity));
  chain_.second.resize(static_cast<std::size_t>(capacity));
}

RodMemory ImplicitRod::make_memory() const {
  RodMemory m;
  m.self.reserve(static_cast<std::size_t>(4 * x_.cols()));
  m.obstacle.reserve(static_cast<std::size_t>(4 * x_.cols()));
  m.grasps.reserve(grasps.tools.size() * kGraspPointsPerTool);
  return m;
}

RodStepSummary ImplicitRod::step(RodState& s, RodMemory& memory, const RodStepOptions& o) noexcept {
  const StageScope stage("thread, rest");
  RodStepSummary summary;
  begin(s, memory, o);
  soften_rest(s, o.dt);
  predict(s, memory, o);
  for (;; ++summary.iterations) {
    summary.arrived = advance_boundary(s);
    fit_geometry(s);
    const FrictionLoad load = summary.iterations < kLoadsFall ? FrictionLoad::falling : FrictionLoad::kept;
    contact_.update(x_, material.radius, contact_material, load);
    obstacles.update(x_, material.radius, contact_material, contact_.travel, load);
    assemble_gradient(s, o);
    summary.residual = gradient_.leftCols(s.n).topRows<3>().cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    const double moment = gradient_.leftCols(s.n).row(3).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / material.radius;
    if (!std::isfinite(summary.residual + moment)) break;
    summary.converged = summary.arrived && std::max(summary.residual, 0.1 * moment) < late_tolerance(o, summary.iterations, force_scale(s));
    const int most = summary.arrived ? o.max_iterations : kMoreToArrive * o.max_iterations;
    if (summary.converged || summary.iterations >= most) break;
    if (!newton_step(s, memory, o)) break;
  }
  restore_rest(s);
  summary.crowded = contact_.overflowed();
  summary.sound = std::isfinite(summary.residual) && theta_.head(s.n).allFinite() && x_.leftCols(s.n).allFinite();
  if (summary.sound) {
    finish(s, memory, o);
  } else {
    s.v.setZero();
    s.theta_dot.setZero();
  }
  return summary;
}

void ImplicitRod::soften_rest(RodState& s, double dt) noexcept {
  stiffened_ = material;
  rest_kappa_.leftCols(s.n) = s.rest_kappa.leftCols(s.n);
  rest_twist_.head(s.n) = s.rest_twist.head(s.n);
  const double r = material.internal_friction / dt;
  if (r == 0.0) return;
  fit_geometry(s);
  stiffened_.EI *= 1.0 + r;
  stiffened_.GJ *= 1.0 + r;
  for (int i = 1; i + 1 < s.n; ++i) {
    s.rest_kappa.col(i) = (s.rest_kappa.col(i) + r * geometry_.kappa.col(i)) / (1.0 + r);
    s.rest_twist[i] = (s.rest_twist[i] + r * geometry_.twist[i]) / (1.0 + r);
  }
}

void ImplicitRod::restore_rest(RodState& s) noexcept {
  s.rest_kappa.leftCols(s.n) = rest_kappa_.leftCols(s.n);
  s.rest_twist.head(s.n) = rest_twist_.head(s.n);
}

void ImplicitRod::begin(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept {
  x_.leftCols(s.n) = s.x.leftCols(s.n);
  theta_.head(s.n) = s.theta.head(s.n);
  set_reference(s, geometry_);
  geometry_fits_ = own_known_ = false;
  extra_inertia_ = 0.0;
  last_energy_ = -std::numeric_limits<double>::infinity();
  for (ObstacleBody& b : obstacles.bodies) b.X_now = b.X_start;
  grasps.locate(memory.grasps, s);
  tethers.locate(s);
  expect_moves(s, o.dt);
  find_near(s, memory);
}

/// Reach of the first search: as far as the velocities lead, and half as far again; where a node is led, to its goal.
void ImplicitRod::expect_moves(const RodState& s, double dt) noexcept {
  const double r = material.radius;
  const auto expected = [&](int i) {
    const double led = boundary.held.col(i).head<3>().any() ? (boundary.target.col(i).head<3>() - s.x.col(i)).norm() : 0.0;
    return std::max({2.0 * r, std::min(1.5 * dt * s.v.col(i).norm(), 40.0 * r), 1.01 * led});
  };
  double here = expected(0);
  for (int j = 0; j + 1 < s.n; ++j) {
    const double next = expected(j + 1);
    contact_.travel.reach[j] = std::max(here, next);
    here = next;
  }
}

/// Starts from where the last velocity leads, if that is better than staying: a thread led by the hand moves on much as
/// it did, and a strand that is being pushed together need not find its buckled shape anew in every step.
void ImplicitRod::predict(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept {
  advance_boundary(s);
  contact_.update(x_, material.radius, contact_material, FrictionLoad::anew);
  obstacles.update(x_, material.radius, contact_material, contact_.travel, FrictionLoad::anew);
  move_.leftCols(s.n).topRows<3>() = o.dt * s.v.leftCols(s.n);
  move_.leftCols(s.n).row(3) = o.dt * s.theta_dot.head(s.n).transpose();
  for (int i = 0; i < s.n; ++i)
    for (int c = 0; c < 4; ++c)
      if (boundary.held(c, i)) move_(c, i) = 0.0;
  if (largest_move(move_, s.n) == 0.0) return;
  keep_lengths(s, EdgeLength::unchanged);
  contact_.travel.look_along(move_);
  double fraction = free_fraction(s, memory);
  fit_geometry(s);
  const double before = energy_here(s, o);
  for (int k = 0; k < 2; ++k, fraction *= 0.5) {
    if (try_move(s, fraction, before, o)) break;
  }
}

/// Fraction of move_ that crosses nothing; finds the near pairs again if the move reaches beyond those known, and goes no
/// further than they reach.
double ImplicitRod::free_fraction(const RodState& s, const RodMemory& memory) noexcept {
  const StageScope stage("crossings");
  RodTravel& travel = contact_.travel;
  double fraction = 1.0;
  if (self_contact) fraction = std::min(1.0, kLongestReach * material.radius / travel.farthest());
  if (travel.within_reach() < fraction) {
    for (int j = 0; j + 1 < s.n; ++j) travel.reach[j] = 2.0 * material.radius + fraction * travel.stride(j);
    find_near(s, memory);
    contact_.update(x_, material.radius, contact_material, FrictionLoad::kept);
    obstacles.update(x_, material.radius, contact_material, contact_.travel, FrictionLoad::kept);
    fraction = contact_.overflowed() ? 0.0 : std::min(fraction, travel.within_reach());
  }
  if (self_contact) fraction = std::min(fraction, contact_.free_fraction(x_, move_, material.radius));
  return std::min(fraction, obstacles.free_fraction(x_, move_, material.radius, contact_.travel));
}

/// Goes `fraction` of move_ if the energy there is at most `highest`.
bool ImplicitRod::try_move(const RodState& s, double fraction, double highest, const RodStepOptions& o) noexcept {
  const StageScope stage("line search");
  x_trial_.leftCols(s.n) = x_.leftCols(s.n) + fraction * move_.leftCols(s.n).topRows<3>();
  theta_trial_.head(s.n) = theta_.head(s.n) + fraction * move_.leftCols(s.n).row(3).transpose();
  follow_reference(s.n, x_trial_, theta_trial_, geometry_);
  own_ = own_energy(s, x_trial_, theta_trial_, o);
  geometry_fits_ = own_known_ = touch_energy(own_, s, x_trial_, o, fraction) <= highest;
  if (!geometry_fits_) return false;
  take_reference(s.n, geometry_);
  contact_.travel.went(fraction);
  std::swap(x_, x_trial_);
  std::swap(theta_, theta_trial_);
  return true;
}

/// All that can come into touch while edges move within travel.reach.
void ImplicitRod::find_near(const RodState& s, const RodMemory& memory) noexcept {
  const StageScope stage("near pairs");
  RodTravel& travel = contact_.travel;
  travel.start(s.n);
  if (self_contact) {  // where strands crowd, a shorter reach leaves room for every pair
    contact_.find_pairs(s, x_, material.radius);
    while (contact_.overflowed() && travel.reach.head(s.n - 1).maxCoeff() > kLeastReach * material.radius) {
      travel.reach *= 0.5;
      contact_.find_pairs(s, x_, material.radius);
    }
  }
  fit_pattern(s.n);
  obstacles.find_touches(s, x_, material.radius, travel.reach);
  contact_.recall(memory.self);
  obstacles.recall(memory.obstacle);
}

void ImplicitRod::fit_pattern(int n) noexcept {
  const StageScope stage("elimination order");
  if (pattern_n_ == n && contact_.find_slots(matrix_)) return;
  pattern_n_ = n;
  matrix_.begin_pattern(n);
  for (int i = 0; i + 1 < n; ++i) matrix_.connect(i, i + 1);
  for (int i = 0; i + 2 < n; ++i) matrix_.connect(i, i + 2);
  contact_.connect(matrix_);
  matrix_.analyse();
  for (int i = 0; i + 1 < n; ++i) chain_.next[i] = matrix_.find(i, i + 1);
  for (int i = 0; i + 2 < n; ++i) chain_.second[i] = matrix_.find(i, i + 2);
  contact_.find_slots(matrix_);
}

/// Moves bodies and held coordinates on towards their targets, as far as nothing is crossed. True when all have arrived.
bool ImplicitRod::advance_boundary(const RodState& s) noexcept {
  bool arrived = obstacles.advance_bodies(x_, material.radius);
  boundary_move_.leftCols(s.n).setZero();
  bool any = false;
  for (int i = 0; i < s.n; ++i) {
    for (int c = 0; c < 4; ++c) {
      if (!boundary.held(c, i)) continue;
      const double here = c < 3 ? x_(c, i) : theta_[i];
      boundary_move_(c, i) = boundary.target(c, i) - here;
      any = any || boundary_move_(c, i) != 0.0;
    }
  }
  if (!any) return arrived;
  contact_.travel.look_along(boundary_move_);
  double fraction = 1.0;
  if (self_contact) fraction = contact_.free_fraction(x_, boundary_move_, material.radius);
  fraction = std::min(fraction, obstacles.free_fraction(x_, boundary_move_, material.radius, contact_.travel));
  geometry_fits_ = false;
  contact_.travel.went(fraction);
  x_.leftCols(s.n) += fraction * boundary_move_.leftCols(s.n).topRows<3>();
  theta_.head(s.n) += fraction * boundary_move_.leftCols(s.n).row(3).transpose();
  if (fraction == 1.0) {  // exactly on target, so that rounding cannot keep the step from arriving
    for (int i = 0; i < s.n; ++i) {
      for (int c = 0; c < 3; ++c)
        if (boundary.held(c, i)) x_(c, i) = boundary.target(c, i);
      if (boundary.held(3, i)) theta_[i] = boundary.target(3, i);
    }
  }
  return arrived && fraction == 1.0;
}

void ImplicitRod::assemble_gradient(const RodState& s, const RodStepOptions& o) noexcept {
  const StageScope stage("forces");
  gradient_.leftCols(s.n) = -boundary.load.leftCols(s.n);
  const double rho = material.mass_per_length();
  const double dt = o.dt;
  for (int i = 0; i < s.n; ++i) {
    const double span = node_span(s, i);
    const Vec3 travelled = x_.col(i) - s.x.col(i);
    const Vec3 predicted = dt * s.v.col(i) + dt * dt * o.gravity;
    gradient_.col(i).head<3>() += rho * span / (dt * dt) * (travelled - predicted) + material.drag * span / dt * travelled;
    if (i + 1 < s.n) gradient_(3, i) += spin_inertia(material, s, i) / (dt * dt) * (theta_[i] - s.theta[i] - dt * s.theta_dot[i]);
  }
  add_elastic_gradient(stiffened_, s, geometry_, gradient_);
  if (self_contact) contact_.add_gradient(x_, s.x, contact_material, gradient_);
  obstacles.add_gradient(x_, s.x, material.radius, contact_material, gradient_);
  grasps.add_gradient(x_, gradient_);
  tethers.add_gradient(x_, o.dt, gradient_);
  for (int i = 0; i < s.n; ++i)
    for (int c = 0; c < 4; ++c)
      if (boundary.held(c, i)) gradient_(c, i) = 0.0;
}

void ImplicitRod::assemble_stiffness(const RodState& s, const RodStepOptions& o, Stiffness kind) noexcept {
  const StageScope stage("stiffness");
  if (contact_.pattern_stale()) fit_pattern(s.n);
  matrix_.set_zero();
  const double dt = o.dt;
  for (int i = 0; i < s.n; ++i) {
    Mat4 block = Mat4::Zero();
    const double inertia = (1.0 + extra_inertia_) * material.mass_per_length() / (dt * dt) + material.drag / dt;
    block.diagonal().head<3>().setConstant(inertia * node_span(s, i));
    block(3, 3) = i + 1 < s.n ? spin_inertia(material, s, i) / (dt * dt) : 1.0;  // no edge lies behind the last node
    for (int c = 0; c < 4; ++c)
      if (boundary.held(c, i)) block(c, c) += kHeld;
    matrix_.add_diagonal(i, block);
  }
  add_elastic_hessian(stiffened_, s, geometry_, kind, chain_, matrix_);
  grasps.add_stiffness(chain_, matrix_);
  tethers.add_stiffness(x_, o.dt, chain_, matrix_);
  if (self_contact) contact_.add_stiffness(x_, material.radius, contact_material, chain_, matrix_);
  obstacles.add_stiffness(x_, material.radius, contact_material, chain_, matrix_);
}

/// The largest tension or contact force [N]: what an unbalanced force is small against.
double ImplicitRod::force_scale(const RodState& s) const noexcept {
  double scale = 0.0;
  for (int j = 0; j + 1 < s.n; ++j)
    if (s.alive[j]) scale = std::max(scale, std::abs(material.EA * (geometry_.length[j] / s.rest_length[j] - 1.0)));
  if (self_contact)
    for (const RodPair& p : contact_.pairs()) scale = std::max(scale, p.force);
  return scale;
}

/// Newton direction in move_, with the exact stiffness where it can be factorised and does not throw nodes about, else with that of Gauss
/// and Newton (compressed strands make it so) and extra inertia, as much as it takes (K. Levenberg, Q. Appl. Math. 2:164, 1944; D. Marquardt,
/// J. Soc. Indust. Appl. Math. 11:431, 1963): a slack loop that weighs nothing then stays, and contacts and stretch elsewhere are still balanced
/// in full, where a direction made shorter as a whole would balance neither.
bool ImplicitRod::direction(const RodState& s, const RodStepOptions& o, Stiffness& kind) noexcept {
  for (;; kind = Stiffness::gauss_newton) {
    assemble_stiffness(s, o, kind);
    if (!matrix_.factor()) {
      if (kind == Stiffness::gauss_newton) return false;
      continue;
    }
    move_.leftCols(s.n) = -gradient_.leftCols(s.n);
    matrix_.solve(move_.leftCols(s.n));
    const double length = largest_move(move_, s.n);
    if (length > o.longest_move && extra_inertia_ < kMostExtraInertia) {
      extra_inertia_ = std::clamp(30.0 * extra_inertia_, 100.0, kMostExtraInertia);
      continue;
    }
    if (length > o.longest_move) move_.leftCols(s.n) *= o.longest_move / length;
    slope_ = (gradient_.leftCols(s.n).array() * move_.leftCols(s.n).array()).sum();
    keep_lengths(s, EdgeLength::first_order);
    contact_.travel.look_along(move_);
    return true;
  }
}

/// More inertia for the next direction where this one had to be shortened, less where it was good. A thread that touches nothing keeps its lengths
/// by another way (keep_lengths), and would only fall more slowly.
void ImplicitRod::adapt_inertia(bool shortened) noexcept {
  extra_inertia_ = shortened ? std::clamp(5.0 * extra_inertia_, 3.0, kMostExtraInertia) : 0.3 * extra_inertia_;
  if (extra_inertia_ < 0.3) extra_inertia_ = 0.0;
}

bool ImplicitRod::touches_nothing() const noexcept {
  const auto pressed = [](const auto& touch) { return touch.force > 0.0; };
  return grasps.held().empty() && tethers.list.empty() &&
         std::none_of(obstacles.touches().begin(), obstacles.touches().end(), pressed) &&
         !(self_contact && std::any_of(contact_.pairs().begin(), contact_.pairs().end(), pressed));
}

/// Takes the second-order stretch out of move_, where nothing touches the thread: strands that press on one another would be pushed into each
/// other by a correction that knows of masses only.
void ImplicitRod::keep_lengths(const RodState& s, EdgeLength which) noexcept {
  if (!touches_nothing()) return;
  const StageScope stage("lengths");
  for (int i = 0; i < s.n; ++i)
    inverse_mass_[i] = boundary.held.col(i).head<3>().any() ? 0.0 : 1.0 / (material.mass_per_length() * node_span(s, i));
  lengths_.keep(s, x_, inverse_mass_, which, move_);
}

/// Newton step; where the exact stiffness leads nowhere, that of Gauss and Newton is tried before a last small move.
bool ImplicitRod::newton_step(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept {
  Stiffness kind = Stiffness::exact;
  if (!direction(s, o, kind)) return false;
  bool moved = advance(s, memory, o);
  if (!moved && kind == Stiffness::exact) {
    kind = Stiffness::gauss_newton;
    fit_geometry(s);
    if (!direction(s, o, kind)) return false;
    moved = advance(s, memory, o);
  }
  if (!moved) try_move(s, std::ldexp(1.0, -kMostHalvings), std::numeric_limits<double>::infinity(), o);  // rounding
  return true;
}

/// A move is taken if the sum falls below what it was at this iterate or at the one before (Grippo, Lampariello, Lucidi, SIAM J. Numer. Anal. 23:707,
/// 1986, with a memory of two): the first step into a new contact, whose stiffness is not in the matrix yet, need not be cut to nothing.
bool ImplicitRod::advance(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept {
  if (!(slope_ < 0.0)) return false;
  double fraction = free_fraction(s, memory);
  fit_geometry(s);
  const double before = energy_here(s, o), highest = std::max(before, last_energy_);
  last_energy_ = before;
  for (int k = 0; k < kMostHalvings; ++k, fraction *= 0.5)
    if (try_move(s, fraction, highest + 1e-4 * fraction * slope_, o)) {
      adapt_inertia(k > 0 && !touches_nothing());
      return true;
    }
  return false;
}

/// geometry_ of the present x_ and theta_, and their directors as the reference of what comes; computed anew only if something else was looked
/// at or moved since.
void ImplicitRod::fit_geometry(const RodState& s) noexcept {
  if (geometry_fits_) return;
  follow_reference(s.n, x_, theta_, geometry_);
  take_reference(s.n, geometry_);
  geometry_fits_ = true;
  own_known_ = false;
}

/// Of all but what touches the thread, at x and theta, whose geometry is in geometry_.
double ImplicitRod::own_energy(const RodState& s, const Points& x, const Eigen::VectorXd& theta, const RodStepOptions& o) const noexcept {
  double u = elastic_energy(stiffened_, s, geometry_);
  const double rho = material.mass_per_length(), dt = o.dt;
  for (int i = 0; i < s.n; ++i) {
    const double span = node_span(s, i);
    const Vec3 predicted = s.x.col(i) + dt * s.v.col(i) + dt * dt * o.gravity;
    u += 0.5 * rho * span / (dt * dt) * (x.col(i) - predicted).squaredNorm();
    u += 0.5 * material.drag * span / dt * (x.col(i) - s.x.col(i)).squaredNorm();
    if (i + 1 < s.n) u += 0.5 * spin_inertia(material, s, i) * std::pow((theta[i] - s.theta[i]) / dt - s.theta_dot[i], 2);
    u -= boundary.load.col(i).head<3>().dot(x.col(i)) + boundary.load(3, i) * theta[i];
  }
  return u;
}

/// The sum, from what own_energy() says at x.
double ImplicitRod::touch_energy(double own, const RodState& s, const Points& x, const RodStepOptions& o, double fraction) noexcept {
  double u = own;
  if (self_contact) u += contact_.energy(x, s.x, material.radius, contact_material, fraction);
  return u + obstacles.energy(x, s.x, material.radius, contact_material, contact_.travel, fraction) + grasps.energy(x) + tethers.energy(x, o.dt);
}

/// The sum at x_ and theta_; what try_move() has worked out there already is not worked out again.
double ImplicitRod::energy_here(const RodState& s, const RodStepOptions& o) noexcept {
  if (!own_known_) own_ = own_energy(s, x_, theta_, o);
  own_known_ = true;
  return touch_energy(own_, s, x_, o, 0.0);
}

void ImplicitRod::finish(RodState& s, RodMemory& memory, const RodStepOptions& o) noexcept {
  s.v.leftCols(s.n) = (x_.leftCols(s.n) - s.x.leftCols(s.n)) / o.dt;
  s.theta_dot.head(s.n) = (theta_.head(s.n) - s.theta.head(s.n)) / o.dt;
  fit_geometry(s);
  accept_geometry(geometry_, x_, theta_, s);
  take_set(material, s, geometry_);
  contact_.remember(memory.self);
  obstacles.remember(memory.obstacle);
  grasps.update_points(memory.grasps);
}

RodStepSummary ImplicitRod::midpoint_step(RodState& s, RodMemory& memory, const RodStepOptions& o) noexcept {
  RodStepOptions half = o;
  half.dt = 0.5 * o.dt;
  const Points x_before = s.x, v_before = s.v;
  const Eigen::VectorXd theta_before = s.theta, rate_before = s.theta_dot;
  const RodStepSummary summary = step(s, memory, half);
  if (!summary.sound) return summary;
  x_.leftCols(s.n) = 2.0 * s.x.leftCols(s.n) - x_before.leftCols(s.n);
  theta_.head(s.n) = 2.0 * s.theta.head(s.n) - theta_before.head(s.n);
  update_geometry(s, x_, theta_, geometry_);
  accept_geometry(geometry_, x_, theta_, s);
  s.v.leftCols(s.n) = 2.0 * s.v.leftCols(s.n) - v_before.leftCols(s.n);
  s.theta_dot.head(s.n) = 2.0 * s.theta_dot.head(s.n) - rate_before.head(s.n);
  return summary;
}

}  // namespace filum
