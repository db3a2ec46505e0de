#include "physics/vessel_wall.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/ensure.h"
#include "base/stage_clock.h"
#include "physics/vessel_wall_pressure.h"

namespace filum {
namespace {

constexpr double kDecrease = 1e-4;  // of the slope (Armijo)
constexpr double kBack = 0.8;       // of the slope, that may be left beyond the valley where energies differ by rounding (Hager & Zhang 2005, eq. 4.1)
constexpr double kBetter = 0.8;     // a residual that falls to this share is welcome whatever the energy says
constexpr int kShortenings = 8;
constexpr double kQuiet = 0.1;       // of the tolerance: below this a step needs no iteration at all
constexpr double kLonger = 1.3;      // than the step taken last: more is not tried at first
constexpr double kFirm = 5.0;        // times the matrix at rest: with 1 the steps of a wall at work overshoot, most of them to a third (DECISIONS)
constexpr double kBedding = 0.006;   // of the mean diagonal of the elements' matrix
constexpr double kMeetingReach = 0.5;   // of the wall's thickness
constexpr double kMeetingShare = 0.1;   // stiffness of a node against a face, of lambda times thickness: a cube of the wall a tenth as wide as high
constexpr double kLeastStretch = 0.3, kMostStretch = 16.0;  // [-], det F and |F|^2 of a node beyond which the first matrix is only turned
constexpr int kMostPairs = 64;
constexpr double kLateGrowth = 1.6;     // of the tolerance from one late iteration to the next
constexpr double kLargestLate = 3e-5;   // [N]: a third of what blood at 100 mmHg presses on a node of an artery with
constexpr double kViolent = 10.0;    // times the tolerance: unbalanced force of a node at the first guess that is too far off to be trusted

using Vector = Eigen::VectorXd;
Eigen::Map<const Vector> flat(const Points& p) noexcept { return {p.data(), p.size()}; }

/// Inner, outer, before, after, left and right: the pairs of nodes that span a node's directions outward, along and around.
std::vector<std::array<int, 6>> find_neighbours(const VesselMesh& mesh) {
  std::vector<std::array<int, 6>> list(static_cast<std::size_t>(mesh.n_nodes()));
  for (std::size_t i = 0; i < list.size(); ++i) list[i].fill(static_cast<int>(i));
  for (const auto& nodes : mesh.elements)
    for (std::size_t a = 0; a < 8; ++a) {
      auto& own = list[static_cast<std::size_t>(nodes[a])];
      own[a & 4 ? 0 : 1] = nodes[a ^ 4];
      own[a & 2 ? 2 : 3] = nodes[a ^ 2];
      own[a & 1 ? 4 : 5] = nodes[a ^ 1];
    }
  return list;
}

Mat3 span_of(const Points& x, const std::array<int, 6>& n) noexcept {
  Mat3 f;
  f << x.col(n[1]) - x.col(n[0]), x.col(n[3]) - x.col(n[2]), x.col(n[5]) - x.col(n[4]);
  return f;
}
Mat3 frame_of(const Mat3& span) noexcept {
  Mat3 f;
  f.col(0) = span.col(0).normalized();
  f.col(1) = (span.col(1) - span.col(1).dot(f.col(0)) * f.col(0)).normalized();
  f.col(2) = f.col(0).cross(f.col(1));
  return f.allFinite() ? f : Mat3(Mat3::Identity());
}

/// Without the directions in which the element would rather buckle: stresses of the first shape (a ring sprung shut, a stretched tube
/// with a free edge) make it indefinite (Teran, Sifakis, Irving & Fedkiw, SCA 2005).
WallElements::Stiffness positive(const WallElements::Stiffness& K) {
  const Eigen::SelfAdjointEigenSolver<WallElements::Stiffness> s(K);
  if (s.eigenvalues()[0] > -1e-6 * s.eigenvalues()[23]) return K;
  return s.eigenvectors() * s.eigenvalues().cwiseMax(0.0).asDiagonal() * s.eigenvectors().transpose();
}

/// Matrix of the first guess: inertia, the elements at rest and a soft bedding; held nodes keep a diagonal of their own and no coupling.
/// Each node's numbers in its own directions, by which a tube is the same all round.
/// Without the bedding the softest modes of the straight tube, turned into a bent one, stretch it: directions a thousand times too long.
std::vector<SlabFactor::Block> first_matrix(const VesselMesh& mesh, const WallElements& elements, const Vector& inertia, const std::vector<char>& held,
                                            const std::vector<Mat3>& own) {
  std::vector<SlabFactor::Block> blocks;
  double diagonal = 0.0;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const auto K = positive(elements.stiffness(e, mesh.nodes, true));
    const auto& nodes = mesh.elements[static_cast<std::size_t>(e)];
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        const int i = nodes[static_cast<std::size_t>(a)], j = nodes[static_cast<std::size_t>(b)];
        if (i < j || held[static_cast<std::size_t>(i)] || held[static_cast<std::size_t>(j)]) continue;
        blocks.push_back({i, j, kFirm * own[static_cast<std::size_t>(i)].transpose() * K.block<3, 3>(3 * a, 3 * b) * own[static_cast<std::size_t>(j)]});
        if (i == j) diagonal += K.block<3, 3>(3 * a, 3 * b).trace() / (3.0 * mesh.n_nodes());
      }
  }
  for (int i = 0; i < mesh.n_nodes(); ++i)
    blocks.push_back({i, i, (held[static_cast<std::size_t>(i)] ? 1.0 : kFirm * (inertia[i] + kBedding * diagonal)) * Mat3::Identity()});
  return blocks;
}

/// About what an energy is wrong by. A point's energy is what is left of terms of the size of its shear modulus, so that the sum misses by as much however
/// small it is; taken for less, steps that led down by less than that were cut to nothing, one after the other. [J]
double rounding(const WallElements& elements, double volume, bool single_precision, double energy) noexcept {
  double thickness = 0.0, shear = 0.0;
  for (const WallLayer& l : elements.layers()) {
    thickness += l.thickness;
    shear += l.law.mu * l.thickness;
  }
  const double unit = 0.5 * (single_precision ? static_cast<double>(std::numeric_limits<float>::epsilon()) : std::numeric_limits<double>::epsilon());
  return std::max((single_precision ? 1e-6 : 1e-12) * std::abs(energy), unit * volume * shear / thickness);
}

}  // namespace

double late_tolerance(const WallOptions& o, int iterations) noexcept {
  const int late = std::max(0, iterations - o.strict_iterations + 1);
  return std::max(o.tolerance, std::min(kLargestLate, o.tolerance * std::pow(kLateGrowth, late)));
}

VesselWall::VesselWall(VesselMesh mesh, std::vector<WallLayer> layers, const WallOptions& options)
    : mesh_(std::move(mesh)), options_(options), elements_(mesh_, layers, options.single_precision), neighbours_(find_neighbours(mesh_)), tree_(face_triangles(mesh_), mesh_.nodes) {
  const int n = mesh_.n_nodes();
  inertia_ = Vector::Zero(n);
  const double per_volume = options_.density * (1.0 + options_.damping * options_.dt) / (options_.dt * options_.dt);
  for (int e = 0; e < mesh_.n_elements(); ++e)
    for (const int i : mesh_.elements[static_cast<std::size_t>(e)]) inertia_[i] += per_volume * elements_.volume(e) / 8.0;
  for (int e = 0; e < mesh_.n_elements(); ++e) volume_ += elements_.volume(e);
  held_.assign(static_cast<std::size_t>(n), 0);
  for (const int i : mesh_.held) held_[static_cast<std::size_t>(i)] = 1;
  std::vector<Mat3> own;  // directions
  for (const auto& next : neighbours_) {
    const Mat3 span = span_of(mesh_.nodes, next);
    own.push_back(frame_of(span));
    rest_inverse_.push_back(span.inverse() * own.back());
  }
  matrix_ = WallMatrix(mesh_, first_matrix(mesh_, elements_, inertia_, held_, own));
  springs_ = WallSprings(n);
  clamp_.resize(mesh_.edge_ring.size());
  pressure_.assign(clamp_.size(), 0.0);
  longest_move_ = 0.0;
  double squeeze = 0.0;
  for (const WallLayer& l : layers) {
    longest_move_ += l.thickness;
    squeeze += l.law.lambda * l.thickness;
  }
  meetings_ = WallMeetings(mesh_, kMeetingReach * longest_move_, kMeetingShare * squeeze);
  loads_.resize(kMostLoads);
  for (Points* p : {&x_, &target_, &residual_, &elastic_, &trial_elastic_, &trial_x_, &trial_residual_, &push_, &trial_push_, &own_.force, &trial_own_.force, &last_.x, &last_.force})
    p->setZero(3, n);
  last_.soundness.resize(static_cast<std::size_t>(mesh_.n_elements()));
  turn_.resize(static_cast<std::size_t>(n));
  single_turn_.resize(turn_.size());
  direction_ = Vector::Zero(3 * n);
  turned_ = steer_ = Eigen::VectorXf::Zero(3 * n);
  options_.memory = std::clamp(options_.memory, 1, kMostPairs);
  pairs_ = WallPairs(3 * n, options_.memory);
  found_.reserve(tree_.triangles().size());
}

WallState VesselWall::first_state() const {
  WallState s;
  s.x = mesh_.nodes;
  s.v = Points::Zero(3, s.x.cols());
  s.soundness.assign(static_cast<std::size_t>(mesh_.n_elements()), 1.0);
  s.clamp = clamp_;
  s.history.s.setZero(3 * s.x.cols(), options_.memory);
  s.history.y = s.history.s;
  s.history.products.setZero(options_.memory, options_.memory);
  s.history.least.setZero(options_.memory);
  return s;
}

bool VesselWall::add_load(const WallState& state, const WallPoint& at, const Vec3& force, const Mat3& stiffness, const WallSlip& slip) noexcept {
  return at.element >= 0 && add(WallLoad::spring(place_of(at), state.x, force, stiffness, slip)) >= 0;
}

int VesselWall::add_push(const WallState& state, const WallPoint& at, const WallStand& stand) noexcept {
  return at.element < 0 ? -1 : add(WallLoad::stop(place_of(at), state.x, stand));
}

int VesselWall::add_ball(const WallState& state, const WallCrossing& place, const Vec3& centre, double radius, double stiffness, double friction,
                         const Vec3& carried) noexcept {
  const WallStand stand{place.away, radius - place.fraction, stiffness, friction, carried};
  if (place.fraction < 0.0) return add_push(state, place.point, stand);
  return add(WallLoad::ball(triangles()[static_cast<std::size_t>(place.triangle)], place.weights, state.x, stand, centre, radius));
}

int VesselWall::add(const WallLoad& load) noexcept {
  if (n_loads_ == kMostLoads) return -1;
  loads_[static_cast<std::size_t>(n_loads_)] = load;
  return n_loads_++;
}

WallPlace VesselWall::place_of(const WallPoint& at) const noexcept { return {mesh_.elements[static_cast<std::size_t>(at.element)], corner_weights(at.local)}; }

void VesselWall::find_frames(const Points& x) noexcept {
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const Mat3 span = span_of(x, neighbours_[i]);
    turn_[i] = span * rest_inverse_[i];
    const double J = turn_[i].determinant();
    if (!(J > kLeastStretch && turn_[i].squaredNorm() < kMostStretch)) turn_[i] = frame_of(span);
    single_turn_[i] = turn_[i].cast<float>();
  }
}

// The wall goes on as it went; a part whose clamp moves is first carried along as a rigid body.
void VesselWall::guess(const WallState& state) noexcept {
  const double h = options_.dt;
  target_ = state.x + h / (1.0 + options_.damping * h) * state.v;
  x_ = state.x + h * state.v;
  for (std::size_t p = 0; p < clamp_.size(); ++p) {
    const Pose moved = clamp_[p] * state.clamp[p].inverse();
    const bool still = clamp_[p].p == state.clamp[p].p && clamp_[p].q.coeffs() == state.clamp[p].q.coeffs();
    for (int i = 0; i < x_.cols(); ++i) {
      if (mesh_.node_part[static_cast<std::size_t>(i)] != static_cast<int>(p)) continue;
      if (held_[static_cast<std::size_t>(i)])
        x_.col(i) = still ? Vec3(state.x.col(i)) : moved * Vec3(state.x.col(i));
      else if (!still)
        x_.col(i) = moved * Vec3(state.x.col(i));
    }
  }
}

// The potential is that of everything but pressure, whose work is reckoned along the way that advance() takes.
double VesselWall::evaluate(const WallState& state) noexcept {
  const StageScope stage("wall: forces");
  Points& r = trial_residual_;
  const Points& x = trial_x_;
  double energy = 0.0;
  for (int i = 0; i < x.cols(); ++i) {
    const Vec3 behind = target_.col(i) - x.col(i);
    energy += 0.5 * inertia_[i] * behind.squaredNorm();
    r.col(i) = inertia_[i] * behind;
  }
  if (last_.is_of(x, state.soundness)) {
    trial_own_.force = last_.force;
    trial_own_.energy = last_.energy;
  } else {
    trial_own_.force.setZero();
    trial_own_.energy = elements_.add_forces(x, state.soundness, trial_own_.force);
  }
  energy += trial_own_.energy;
  trial_elastic_ = trial_own_.force;
  if (pressed_) {
    trial_push_.setZero();
    add_pressure_forces(mesh_, pressure_, x, trial_push_);
    trial_elastic_ += trial_push_;
  }
  energy += meetings_.add_forces(x, trial_elastic_);
  r += trial_elastic_;
  for (WallLoad& l : loads()) {
    energy += l.answer(x);
    l.add_to(r);
  }
  for (const int i : mesh_.held) r.col(i).setZero();
  return r.allFinite() ? energy : std::numeric_limits<double>::infinity();
}

void VesselWall::gather_springs() noexcept {
  const StageScope stage("wall: springs");
  springs_.gather_again();
  for (WallLoad& l : loads()) {
    l.gathered = l.phase();
    if (const Mat3 k = l.felt(); l.gathered == 2 || k.trace() > kStiff) springs_.add({l.place().node, l.place().weight, k}, turn_, matrix_);
  }
  springs_.prepare(matrix_);
}

/// Has something that stands against the wall come to touch it, or left it?
bool VesselWall::springs_stale() noexcept {
  return std::ranges::any_of(loads(), [](const WallLoad& l) { return l.phase() != l.gathered; });
}

/// b becomes Q (P + springs)^-1 Q^T b.
void VesselWall::precondition(Eigen::VectorXf& b) noexcept {
  const StageScope stage("wall: first matrix");
  const int n = mesh_.n_nodes();
  for (const int i : mesh_.held) b.segment<3>(3 * i).setZero();
  for (int i = 0; i < n; ++i) turned_.segment<3>(3 * i) = single_turn_[static_cast<std::size_t>(i)].transpose() * b.segment<3>(3 * i);
  matrix_.solve(turned_);
  springs_.correct(matrix_, turned_);
  for (int i = 0; i < n; ++i) b.segment<3>(3 * i) = single_turn_[static_cast<std::size_t>(i)] * turned_.segment<3>(3 * i);
  for (const int i : mesh_.held) b.segment<3>(3 * i).setZero();
}

/// What the pairs of earlier steps say with the springs of this one.
void VesselWall::recall(const WallHistory& h) noexcept {
  const StageScope stage("wall: recall");
  pairs_.take(h.y, h.products, h.least);
  for (WallLoad& l : loads()) l.counted = {};
  count_springs(h);
}

/// Brings the pairs up to date with what has come to touch the wall, or left it, since they were last asked.
void VesselWall::count_springs(const WallHistory& h) noexcept {
  for (WallLoad& l : loads()) {
    if (l.phase() == l.counted.phase) continue;
    if (l.counted.phase != 0) pairs_.stiffen(h.s, l.counted.place, -l.counted.stiffness);
    l.counted = {l.phase(), l.place(), l.felt()};
    if (l.counted.phase != 0) pairs_.stiffen(h.s, l.counted.place, l.counted.stiffness);
  }
  pairs_.count(h.n, h.newest);
}

void VesselWall::direction(const WallHistory& h) noexcept {
  const StageScope stage("wall: direction");
  steer_ = flat(residual_).cast<float>();
  pairs_.before(h.s, steer_);
  precondition(steer_);
  pairs_.after(h.s, steer_);
  direction_ = steer_.cast<double>();
}

/// Goes along the direction, less far if that turns elements inside out or the energy does not fall.
bool VesselWall::advance(const WallState& state) noexcept {
  const double before = residual_.norm(), slope = flat(residual_).dot(direction_), noise = rounding(elements_, volume_, options_.single_precision, energy_);
  double step = std::min({1.0, kLonger * taken_, longest_move_ / direction_.cwiseAbs().maxCoeff()});
  for (int k = 0; k < kShortenings; ++k) {
    trial_x_ = x_ + step * direction_.reshaped(3, x_.cols());
    trial_energy_ = evaluate(state);
    if (std::isfinite(trial_energy_)) {
      const double change = trial_energy_ - energy_ - (pressed_ ? 0.5 * step * (flat(push_) + flat(trial_push_)).dot(direction_) : 0.0);
      const bool falls = change <= -kDecrease * step * slope;
      const bool level = change <= noise && flat(trial_residual_).dot(direction_) >= -kBack * slope;
      if (falls || level || trial_residual_.norm() < kBetter * before) {
        taken_ = step;
        return true;
      }
      const double best = 0.5 * slope * step / (slope + change / step);  // of the parabola
      step *= std::clamp(best / step, 0.02, 0.5);
    } else {
      step *= 0.25;
    }
  }
  return false;
}

/// To this step a new pair says what everything answered; to those to come what elements and inertia did: what touches the wall comes and goes.
void VesselWall::add_pair(WallHistory& h) noexcept {
  const int p = (h.newest + 1) % options_.memory;
  h.s.col(p) = (flat(trial_x_) - flat(x_)).cast<float>();
  h.y.col(p) = (flat(elastic_) - flat(trial_elastic_)).cast<float>();  // gradients are minus forces
  for (int i = 0; i < inertia_.size(); ++i) h.y.col(p).segment<3>(3 * i) += static_cast<float>(inertia_[i]) * h.s.col(p).segment<3>(3 * i);
  h.newest = p;
  h.n = std::min(h.n + 1, options_.memory);
  WallPairs::note(h.s, h.y, p, h.products, h.least);
  pairs_.answer(p) = (flat(residual_) - flat(trial_residual_)).cast<float>();
  pairs_.note(h.s, p);
  pairs_.count(h.n, h.newest);
}

/// Where the iteration begins: the guess, or where the wall is, if the guess is violent and that is better. False if neither is sound.
bool VesselWall::begin(const WallState& state) noexcept {
  taken_ = 1.0;
  guess(state);
  pressed_ = std::any_of(pressure_.begin(), pressure_.end(), [](double p) { return p != 0.0; });
  trial_x_ = x_;
  energy_ = evaluate(state);
  if (!std::isfinite(energy_) || trial_residual_.colwise().norm().maxCoeff() > kViolent * options_.tolerance) {  // is it better to start from where it is?
    const double guessed = energy_;
    take_forces();
    for (int i = 0; i < x_.cols(); ++i)
      if (!held_[static_cast<std::size_t>(i)]) trial_x_.col(i) = state.x.col(i);
    energy_ = evaluate(state);
    if (energy_ < guessed) {
      x_ = trial_x_;
      take_forces();
    } else {
      energy_ = guessed;
      answer_loads(x_);
    }
  } else {
    take_forces();
  }
  find_frames(x_);
  springs_.clear();
  gather_springs();
  return std::isfinite(energy_);
}

/// What was evaluated last is what the wall feels.
void VesselWall::take_forces() noexcept {
  push_.swap(trial_push_);
  residual_.swap(trial_residual_);
  elastic_.swap(trial_elastic_);
  own_.force.swap(trial_own_.force);
  own_.energy = trial_own_.energy;
}

/// Loads as they are at x, where all else is known already.
void VesselWall::answer_loads(const Points& x) noexcept {
  for (WallLoad& l : loads()) l.answer(x);
}

/// What the line search found is where the wall is now.
void VesselWall::accept(WallState& state) noexcept {
  add_pair(state.history);
  energy_ = trial_energy_;
  x_.swap(trial_x_);
  take_forces();
  if (!springs_stale()) return;
  gather_springs();
  count_springs(state.history);
}

/// Quasi-Newton steps until the residual is within the tolerance, the line search finds nothing or there were too many.
void VesselWall::iterate(WallState& state, WallSummary& summary) noexcept {
  for (;;) {
    summary.residual = residual_.colwise().norm().maxCoeff();
    summary.converged = summary.residual <= late_tolerance(options_, summary.iterations);
    const bool settled = summary.iterations > 0 || summary.residual <= kQuiet * options_.tolerance;  // what is left creeps home
    if ((summary.converged && settled) || summary.iterations == options_.max_iterations) return;
    if (summary.iterations == 0) recall(state.history);
    direction(state.history);
    if (advance(state)) {
      ++summary.iterations;
      accept(state);
    } else if (state.history.n > 0 && summary.iterations < options_.max_iterations) {  // what was learnt misleads: once more without
      state.history.n = 0;
      pairs_.forget();
      ++summary.iterations;
    } else {
      answer_loads(x_);
      return;
    }
  }
}

WallSummary VesselWall::step(WallState& state) noexcept {
  WallSummary summary;
  summary.sound = begin(state);
  if (summary.sound) {
    iterate(state, summary);
    state.v = (x_ - state.x) / options_.dt;
    state.x = x_;
    last_.x = x_;
    last_.soundness = state.soundness;
    last_.force.swap(own_.force);
    last_.energy = own_.energy;
  } else {
    state.v.setZero();
  }
  last_.told = summary.sound;
  state.clamp = clamp_;
  return summary;
}

}  // namespace filum
