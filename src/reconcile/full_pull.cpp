// suture-pull by the trainer's rod (physics/implicit_rod, rod_obstacle): a limp thread drawn over a round bar by its friction, for angles and
// coefficients about those of the records; between them its departure from Euler's law, which is small and smooth, is interpolated. What is no friction
// (drag, the force to bend) is added as in the reduced model.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/implicit_rod.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace {

constexpr double kBar = 10e-3, kThread = 0.1e-3, kHang = 10e-3;  // [m]

/// A thread that comes straight from the slack end, turns by `wrap` about a bar along y, each turn beside the one before, and leaves straight.
Points wound(int n, double R, double edge, double wrap) {
  Points x(3, n);
  const double pitch = 4.0 * kThread / (2.0 * std::numbers::pi);  // along the bar, an angle of 1
  for (int i = 0; i < n; ++i) {
    const double s = edge * i - kHang, a = std::clamp(s / R, 0.0, wrap), past = s < 0.0 ? s : std::max(0.0, s - wrap * R);
    x.col(i) = Vec3(-R * std::cos(a), pitch * a, R * std::sin(a)) + past * Vec3(std::sin(a), 0.0, std::cos(a));
  }
  return x;
}

}  // namespace

double drawn_ratio(double mu, double wrap, int edges_a_radian) {
  const double R = kBar + kThread, edge = R / edges_a_radian;
  const int n = static_cast<int>((wrap * R + 2.0 * kHang) / edge) + 1;
  RodMaterial m;
  m.radius = kThread;
  m.EI = m.GJ = 1e-7;  // T R^2/B = 1000: limp
  m.EA = 1e4;
  m.drag = 1.0;
  const Points nodes = wound(n, R, edge, wrap);
  ImplicitRod rod(m, ContactMaterial(), n);
  rod.self_contact = false;
  rod.contact_material.stiffness = 1e5;
  Obstacle bar;
  bar.a_B = Vec3(0, -5e-3, 0), bar.b_B = Vec3(0, 5e-3 + 4.0 * kThread * wrap, 0);
  bar.r_a = bar.r_b = kBar;
  bar.friction = mu;
  rod.obstacles.bodies.resize(1);
  rod.obstacles.obstacles.push_back(bar);
  RodState s = RodState::from_nodes(nodes, n);
  RodMemory memory = rod.make_memory();
  RodStepOptions o;
  o.dt = 1e-3;
  o.gravity.setZero();
  o.max_iterations = 60;
  o.relative_tolerance = 1e-6;
  o.force_tolerance = 1e-13;
  const Vec3 out = (nodes.col(n - 1) - nodes.col(n - 2)).normalized();
  rod.boundary.load.col(0).head<3>() = (nodes.col(0) - nodes.col(1)).normalized();  // 1 N
  rod.boundary.held.col(n - 1) = true;
  rod.boundary.target.col(n - 1).head<3>() = s.x.col(n - 1);
  rod.boundary.target(3, n - 1) = 0.0;
  constexpr int kSteps = 500, kCounted = 150;
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    rod.boundary.target.col(n - 1).head<3>() += 5e-3 * o.dt * out;
    if (!rod.step(s, memory, o).sound) return NAN;
    if (k >= kSteps - kCounted) sum += edge_tension(m, s, n - 3) / edge_tension(m, s, 1);
  }
  return sum / kCounted;
}

namespace {

class PullSolver final : public FullSolver {
 public:
  explicit PullSolver(const RigModel& model) : model_(model) {
    std::map<long, int> seen;
    for (const Trial& t : model.data().trials)
      for (const double a : t.at("wrap_angle")) ++seen[std::lround(std::abs(a) * 1e3)];
    if (seen.size() <= 4)
      for (const auto& [angle, count] : seen) angles_.push_back(1e-3 * static_cast<double>(angle));
    else
      for (int i = 0; i < 4; ++i) angles_.push_back(1e-3 * (static_cast<double>(seen.begin()->first) + static_cast<double>(seen.rbegin()->first - seen.begin()->first) * i / 3.0));
    std::erase_if(angles_, [](double a) { return a < 0.05; });
  }
  std::string name() const override { return "the trainer's rod on a bar (physics/implicit_rod, rod_obstacle)"; }

  bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const override {
    model_.rig(t, s, out);
    if (angles_.empty()) return true;
    for (Eigen::Index n = 0; n < out.rows(); ++n) {
      const auto slid = model_.slide(t, s, n);
      const double x = slid.mu * slid.wrap, more = departure(slid.mu, std::abs(slid.wrap), fine);
      if (!std::isfinite(more)) return false;
      out(n, 0) += slid.hold * (std::exp(std::min(x * (1.0 + more), 20.0)) - std::exp(std::min(x, 20.0)));
    }
    return true;
  }

 private:
  /// log(T2/T1)/(mu wrap) - 1 at an angle that was run; coefficients a factor of two apart.
  double at(int octave, std::size_t angle, bool fine) const {
    const auto key = std::make_tuple(octave, angle, fine);
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    const double mu = std::exp2(octave);
    return known_[key] = std::log(drawn_ratio(mu, angles_[angle], fine ? 16 : 8)) / (mu * angles_[angle]) - 1.0;
  }
  double departure(double mu, double wrap, bool fine) const {
    const double x = std::clamp(std::log2(std::max(mu, 1e-6)), -5.0, 0.0);
    const int octave = std::min(static_cast<int>(std::floor(x)), -1);
    std::size_t i = 0;
    while (i + 2 < angles_.size() && angles_[i + 1] < wrap) ++i;
    const std::size_t j = std::min(i + 1, angles_.size() - 1);
    const double w = j > i ? std::clamp((wrap - angles_[i]) / (angles_[j] - angles_[i]), 0.0, 1.0) : 0.0, u = x - octave;
    const auto between = [&](std::size_t k) { return (1.0 - u) * at(octave, k, fine) + u * at(octave + 1, k, fine); };
    return w <= 0.0 ? between(i) : w >= 1.0 ? between(j) : (1.0 - w) * between(i) + w * between(j);
  }

  const RigModel& model_;
  std::vector<double> angles_;  // [rad]
  mutable std::map<std::tuple<int, std::size_t, bool>, double> known_;
};

}  // namespace

std::unique_ptr<FullSolver> make_pull_solver(const RigModel& model) { return std::make_unique<PullSolver>(model); }

}  // namespace filum::reconcile
