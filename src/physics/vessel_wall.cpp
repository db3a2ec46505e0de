#include "physics/vessel_wall.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/ensure.h"
#include "physics/vessel_wall_pressure.h"

namespace filum {
namespace {

constexpr double kDecrease = 1e-4;  // of the slope (Armijo)
constexpr double kBack = 0.8;       // of the slope, that may be left beyond the valley where energies differ by rounding (Hager & Zhang 2005, eq. 4.1)
constexpr double kBetter = 0.8;     // a residual that falls to this share is welcome whatever the energy says
constexpr int kShortenings = 8;
constexpr double kQuiet = 0.1;       // of the tolerance: below this a step needs no iteration at all
constexpr double kLonger = 4.0;      // than the step taken last: more is not tried at first
constexpr double kBedding = 0.006;   // of the mean diagonal of the elements' matrix
constexpr double kMeetingReach = 0.5;   // of the wall's thickness
constexpr double kMeetingShare = 0.1;   // stiffness of a node against a face, of lambda times thickness: a cube of the wall a tenth as wide as high
constexpr double kStiff = 1.0;       // [N/m], springs above this come into the first matrix
constexpr double kViolent = 0.1;     // [N], unbalanced force of a node at the first guess that is too far off to be trusted

using Vector = Eigen::VectorXd;
Eigen::Map<const Vector> flat(const Points& p) noexcept { return {p.data(), p.size()}; }

/// Inner, outer, before and after: the pairs of nodes that span a node's outward and its lengthwise direction.
std::vector<std::array<int, 4>> find_neighbours(const VesselMesh& mesh) {
  std::vector<std::array<int, 4>> list(static_cast<std::size_t>(mesh.n_nodes()));
  for (std::size_t i = 0; i < list.size(); ++i) list[i].fill(static_cast<int>(i));
  for (const auto& nodes : mesh.elements)
    for (std::size_t a = 0; a < 8; ++a) {
      auto& own = list[static_cast<std::size_t>(nodes[a])];
      own[a & 4 ? 0 : 1] = nodes[a ^ 4];
      own[a & 2 ? 2 : 3] = nodes[a ^ 2];
    }
  return list;
}

Mat3 frame_of(const Points& x, const std::array<int, 4>& n) noexcept {
  const Vec3 out = x.col(n[1]) - x.col(n[0]), along = x.col(n[3]) - x.col(n[2]);
  Mat3 f;
  f.col(0) = out.normalized();
  f.col(1) = (along - along.dot(f.col(0)) * f.col(0)).normalized();
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
/// Without the bedding the softest modes of the straight tube, turned into a bent one, stretch it: directions a thousand times too long.
std::vector<SlabFactor::Block> first_matrix(const VesselMesh& mesh, const WallElements& elements, const Vector& inertia, const std::vector<char>& held) {
  std::vector<SlabFactor::Block> blocks;
  double diagonal = 0.0;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const auto K = positive(elements.stiffness(e, mesh.nodes, true));
    const auto& nodes = mesh.elements[static_cast<std::size_t>(e)];
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        const int i = nodes[static_cast<std::size_t>(a)], j = nodes[static_cast<std::size_t>(b)];
        if (i < j || held[static_cast<std::size_t>(i)] || held[static_cast<std::size_t>(j)]) continue;
        blocks.push_back({i, j, K.block<3, 3>(3 * a, 3 * b)});
        if (i == j) diagonal += K.block<3, 3>(3 * a, 3 * b).trace() / (3.0 * mesh.n_nodes());
      }
  }
  for (int i = 0; i < mesh.n_nodes(); ++i)
    blocks.push_back({i, i, (held[static_cast<std::size_t>(i)] ? 1.0 : inertia[i] + kBedding * diagonal) * Mat3::Identity()});
  return blocks;
}

}  // namespace

VesselWall::VesselWall(VesselMesh mesh, std::vector<WallLayer> layers, const WallOptions& options)
    : mesh_(std::move(mesh)), options_(options), elements_(mesh_, layers, options.single_precision), neighbours_(find_neighbours(mesh_)), tree_(face_triangles(mesh_), mesh_.nodes) {
  const int n = mesh_.n_nodes();
  inertia_ = Vector::Zero(n);
  const double per_volume = options_.density * (1.0 + options_.damping * options_.dt) / (options_.dt * options_.dt);
  for (int e = 0; e < mesh_.n_elements(); ++e)
    for (const int i : mesh_.elements[static_cast<std::size_t>(e)]) inertia_[i] += per_volume * elements_.volume(e) / 8.0;
  held_.assign(static_cast<std::size_t>(n), 0);
  for (const int i : mesh_.held) held_[static_cast<std::size_t>(i)] = 1;
  for (const auto& own : neighbours_) rest_frame_.push_back(frame_of(mesh_.nodes, own));
  factor_ = SlabFactor(mesh_.slab, first_matrix(mesh_, elements_, inertia_, held_));
  springs_ = WallSprings(factor_, mesh_);
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
  for (Points* p : {&x_, &target_, &residual_, &trial_x_, &trial_residual_, &push_, &trial_push_}) p->setZero(3, n);
  turn_.resize(static_cast<std::size_t>(n));
  direction_ = work_ = Vector::Zero(3 * n);
  turned_f_ = Eigen::VectorXf::Zero(3 * n);
  pairs_.resize(static_cast<std::size_t>(options_.memory));
  for (Pair& p : pairs_) p.s = p.y = Vector::Zero(3 * n);
  found_.reserve(256);
}

WallState VesselWall::first_state() const {
  WallState s;
  s.x = mesh_.nodes;
  s.v = Points::Zero(3, s.x.cols());
  s.soundness.assign(static_cast<std::size_t>(mesh_.n_elements()), 1.0);
  s.clamp = clamp_;
  return s;
}

int VesselWall::settle(WallState& state, int most_steps, double speed) {
  int k = 0;
  while (k < most_steps) {
    ++k;
    const WallSummary r = step(state);
    if (!r.sound || state.v.colwise().norm().maxCoeff() < speed) break;
  }
  state.v.setZero();
  return k;
}

bool VesselWall::add_load(const WallState& state, const WallPoint& at, const Vec3& force, const Mat3& stiffness) noexcept {
  if (n_loads_ == kMostLoads || at.element < 0) return false;
  Load& l = loads_[static_cast<std::size_t>(n_loads_++)];
  l.node = mesh_.elements[static_cast<std::size_t>(at.element)];
  l.weight = corner_weights(at.local);
  l.force = force;
  l.stiffness = stiffness;
  l.at = position(state, at);
  return true;
}

void VesselWall::find_frames(const Points& x) noexcept {
  for (std::size_t i = 0; i < turn_.size(); ++i) turn_[i] = frame_of(x, neighbours_[i]) * rest_frame_[i].transpose();
}

// The wall goes on as it went; a part whose clamp moves is first carried along as a rigid body.
void VesselWall::guess(const WallState& state) noexcept {
  const double h = options_.dt;
  target_ = state.x + h / (1.0 + options_.damping * h) * state.v;
  x_ = state.x + h * state.v;
  for (std::size_t p = 0; p < clamp_.size(); ++p) {
    const Pose moved = clamp_[p] * state.clamp[p].inverse();
    const bool still = moved.p.isZero(0.0) && std::abs(moved.q.w()) == 1.0;
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
  Points& r = trial_residual_;
  const Points& x = trial_x_;
  double energy = 0.0;
  for (int i = 0; i < x.cols(); ++i) {
    const Vec3 behind = target_.col(i) - x.col(i);
    energy += 0.5 * inertia_[i] * behind.squaredNorm();
    r.col(i) = inertia_[i] * behind;
  }
  energy += elements_.add_forces(x, state.soundness, r);
  if (pressed_) {
    trial_push_.setZero();
    add_pressure_forces(mesh_, pressure_, x, trial_push_);
    r += trial_push_;
  }
  energy += meetings_.add_forces(x, r);
  for (int k = 0; k < n_loads_; ++k) {
    const Load& l = loads_[static_cast<std::size_t>(k)];
    Vec3 at = -l.at;
    for (int a = 0; a < 8; ++a) at += l.weight[a] * x.col(l.node[static_cast<std::size_t>(a)]);
    const Vec3 spring = l.stiffness * at, f = l.force - spring;
    energy -= (l.force - 0.5 * spring).dot(at);
    for (int a = 0; a < 8; ++a) r.col(l.node[static_cast<std::size_t>(a)]) += l.weight[a] * f;
  }
  for (const int i : mesh_.held) r.col(i).setZero();
  return r.allFinite() ? energy : std::numeric_limits<double>::infinity();
}

void VesselWall::gather_springs() noexcept {
  springs_.clear();
  for (int k = 0; k < n_loads_; ++k) {
    const Load& l = loads_[static_cast<std::size_t>(k)];
    if (l.stiffness.trace() > kStiff) springs_.add({l.node, l.weight, l.stiffness}, turn_);
  }
  springs_.prepare();
}

/// d = Q (P + springs)^-1 Q^T r.
void VesselWall::precondition(const Vector& r, Vector& d) noexcept {
  const int n = mesh_.n_nodes();
  for (int i = 0; i < n; ++i) turned_f_.segment<3>(3 * i) = (turn_[static_cast<std::size_t>(i)].transpose() * r.segment<3>(3 * i)).cast<float>();
  factor_.solve(turned_f_);
  springs_.correct(turned_f_);
  for (int i = 0; i < n; ++i) d.segment<3>(3 * i) = turn_[static_cast<std::size_t>(i)] * turned_f_.segment<3>(3 * i).cast<double>();
  for (const int i : mesh_.held) d.segment<3>(3 * i).setZero();
}

/// Two-loop recursion (Nocedal & Wright, Numerical Optimization, 2006, algorithm 7.4).
void VesselWall::direction() noexcept {
  const int m = static_cast<int>(pairs_.size());
  std::array<double, 16> alpha{};
  work_ = flat(residual_);
  for (int k = 0; k < n_pairs_; ++k) {
    const Pair& p = pairs_[static_cast<std::size_t>((newest_ - k + m) % m)];
    alpha[static_cast<std::size_t>(k)] = p.inverse * p.s.dot(work_);
    work_ -= alpha[static_cast<std::size_t>(k)] * p.y;
  }
  precondition(work_, direction_);
  for (int k = n_pairs_; k-- > 0;) {
    const Pair& p = pairs_[static_cast<std::size_t>((newest_ - k + m) % m)];
    const double beta = p.inverse * p.y.dot(direction_);
    direction_ += (alpha[static_cast<std::size_t>(k)] - beta) * p.s;
  }
}

/// Goes along the direction, less far if that turns elements inside out or the energy does not fall.
bool VesselWall::advance(const WallState& state) noexcept {
  const double before = residual_.norm(), slope = flat(residual_).dot(direction_), noise = (options_.single_precision ? 1e-6 : 1e-12) * std::abs(energy_);
  double step = std::min({1.0, kLonger * taken_, longest_move_ / direction_.cwiseAbs().maxCoeff()});
  for (int k = 0; k < kShortenings; ++k) {
    trial_x_ = x_ + step * direction_.reshaped(3, x_.cols());
    trial_energy_ = evaluate(state);
    if (std::isfinite(trial_energy_)) {
      if (pressed_) trial_energy_ -= 0.5 * step * (flat(push_) + flat(trial_push_)).dot(direction_);
      const bool falls = trial_energy_ <= energy_ - kDecrease * step * slope;
      const bool level = trial_energy_ <= energy_ + noise && flat(trial_residual_).dot(direction_) >= -kBack * slope;
      if (falls || level || trial_residual_.norm() < kBetter * before) {
        taken_ = step;
        return true;
      }
      const double best = 0.5 * slope * step / (slope + (trial_energy_ - energy_) / step);  // of the parabola
      step *= std::clamp(best / step, 0.02, 0.5);
    } else {
      step *= 0.25;
    }
  }
  return false;
}

void VesselWall::add_pair() noexcept {
  const int m = static_cast<int>(pairs_.size());
  Pair& p = pairs_[static_cast<std::size_t>((newest_ + 1) % m)];
  p.s = flat(trial_x_) - flat(x_);
  p.y = flat(residual_) - flat(trial_residual_);  // gradients are minus residuals
  const double sy = p.s.dot(p.y);
  if (!(sy > 1e-10 * p.s.norm() * p.y.norm())) return;
  p.inverse = 1.0 / sy;
  newest_ = (newest_ + 1) % m;
  n_pairs_ = std::min(n_pairs_ + 1, m);
}

WallSummary VesselWall::step(WallState& state) noexcept {
  WallSummary summary;
  n_pairs_ = 0;
  taken_ = 1.0;
  guess(state);
  pressed_ = std::any_of(pressure_.begin(), pressure_.end(), [](double p) { return p != 0.0; });
  trial_x_ = x_;
  energy_ = evaluate(state);
  if (!std::isfinite(energy_) || trial_residual_.colwise().norm().maxCoeff() > kViolent) {  // is it better to start from where it is?
    const double guessed = energy_;
    work_ = flat(trial_residual_);
    for (int i = 0; i < x_.cols(); ++i)
      if (!held_[static_cast<std::size_t>(i)]) trial_x_.col(i) = state.x.col(i);
    energy_ = evaluate(state);
    if (energy_ < guessed) {
      x_ = trial_x_;
    } else {
      energy_ = guessed;
      trial_residual_ = work_.reshaped(3, x_.cols());
    }
  }
  const bool sound = std::isfinite(energy_);
  find_frames(x_);
  gather_springs();
  residual_ = trial_residual_;
  push_ = trial_push_;
  while (sound) {
    summary.residual = residual_.colwise().norm().maxCoeff();
    summary.converged = summary.residual <= options_.tolerance;
    const bool settled = summary.iterations > 0 || summary.residual <= kQuiet * options_.tolerance;  // what is left creeps home
    if ((summary.converged && settled) || summary.iterations == options_.max_iterations) break;
    direction();
    if (!advance(state)) break;
    ++summary.iterations;
    add_pair();
    energy_ = trial_energy_;  // less work of pressure: only differences from here on matter
    push_.swap(trial_push_);
    x_.swap(trial_x_);
    residual_.swap(trial_residual_);
  }
  summary.sound = sound;
  if (sound) {
    state.v = (x_ - state.x) / options_.dt;
    state.x = x_;
  } else {
    state.v.setZero();
  }
  state.clamp = clamp_;
  return summary;
}

}  // namespace filum
