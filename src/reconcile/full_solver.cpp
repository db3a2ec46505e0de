#include "reconcile/full_solver.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/implicit_rod.h"

namespace filum::reconcile {
namespace {

/// Nodes of the natural shape; the clamp holds the first edge level, its middle is the end of the free length.
Points natural_shape(const std::vector<double>& rest, int edges) {
  const double edge = 1.0 / (edges - 0.5);
  Points x = Points::Zero(3, edges + 1);
  x(0, 0) = -0.5 * edge;
  double heading = 0.0;  // below the horizontal
  for (int k = 0; k < edges; ++k) {
    if (k > 0 && !rest.empty()) {
      const double at = std::min((k - 0.5) * edge, 1.0) * static_cast<double>(rest.size() - 1);
      const auto i = std::min(static_cast<std::size_t>(at), rest.size() - 2);
      heading += edge * (rest[i] + (at - static_cast<double>(i)) * (rest[i + 1] - rest[i]));
    }
    x.col(k + 1) = x.col(k) + edge * Vec3(std::cos(heading), 0.0, -std::sin(heading));
  }
  return x;
}

RodMaterial unit_rod(double weight) {
  RodMaterial m;
  m.radius = 1e-3;
  m.EI = 1.0;
  m.GJ = 1.0;
  m.EA = 4.0 / (m.radius * m.radius);
  m.density = weight / (std::numbers::pi * m.radius * m.radius);  // gravity is 1
  m.drag = 0.0;
  return m;
}

}  // namespace

HangingRod hang_rod(double G, const std::vector<double>& rest, int edges) {
  const Points shape = natural_shape(rest, edges);
  ImplicitRod rod(unit_rod(std::max(G, 1e-9)), ContactMaterial(), edges + 1);
  rod.self_contact = false;
  RodState s = RodState::from_nodes(shape, edges + 1, false);
  RodMemory memory = rod.make_memory();
  for (const int i : {0, 1}) {
    rod.boundary.held.col(i) = true;
    rod.boundary.target.col(i).head<3>() = s.x.col(i);
    rod.boundary.target(3, i) = 0.0;
  }
  RodStepOptions o;
  o.dt = 1e3;  // inertia does not count: each step is one of Newton's method on the potential
  o.max_iterations = 60;
  o.relative_tolerance = 1e-9;
  o.force_tolerance = 1e-11;
  HangingRod out;
  const int parts = G > 20.0 ? 4 : G > 6.0 ? 2 : 1;
  for (int part = 1; part <= parts; ++part) {
    o.gravity = Vec3(0, 0, -static_cast<double>(part) / parts);
    out.rests = false;
    for (int k = 0; k < 40 && !out.rests; ++k) {
      const Points before = s.x;
      s.v.setZero();
      s.theta_dot.setZero();
      if (!rod.step(s, memory, o).sound) return out;
      out.rests = (s.x - before).cwiseAbs().maxCoeff() < (part < parts ? 1e-2 : 1e-7);
    }
  }
  out.drop = -s.x(2, edges);
  out.reach = s.x(0, edges);
  return out;
}

namespace {

/// The thread: shapes at some instants of a record, in between by interpolation of what differs from the elastica (which is smooth in time).
class RodSolver final : public FullSolver {
 public:
  explicit RodSolver(const RigModel& model) : model_(model) {}
  std::string name() const override { return "the trainer's rod (physics/implicit_rod)"; }

  bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const override {
    model_.rig(t, s, out);
    constexpr Eigen::Index kInstants = 5;
    std::vector<Eigen::Index> at;
    for (Eigen::Index k = 0; k < kInstants; ++k) {
      const Eigen::Index n = k * (t.time.size() - 1) / (kInstants - 1);
      if (at.empty() || n > at.back()) at.push_back(n);
    }
    Eigen::MatrixXd miss(static_cast<Eigen::Index>(at.size()), out.cols());
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto bent = model_.bent_thread(t, s, at[k]);
      const HangingRod& rod = shape(bent.G, bent.rest, fine ? 48 : 24);
      if (!rod.rests) return false;
      for (Eigen::Index c = 0; c < out.cols(); ++c)
        miss(static_cast<Eigen::Index>(k), c) = bent.length * (model_.data().outputs[static_cast<std::size_t>(c)] == "tip_drop" ? rod.drop : rod.reach) - out(at[k], c);
    }
    std::size_t k = 0;
    for (Eigen::Index n = 0; n < out.rows(); ++n) {
      while (k + 2 < at.size() && at[k + 1] < n) ++k;
      const double w = at.size() > 1 ? static_cast<double>(n - at[k]) / static_cast<double>(at[k + 1] - at[k]) : 0.0;
      const auto i = static_cast<Eigen::Index>(k);
      out.row(n) += (1.0 - w) * miss.row(i) + w * miss.row(at.size() > 1 ? i + 1 : i);
    }
    return true;
  }

 private:
  const HangingRod& shape(double G, const std::vector<double>& rest, int edges) const {
    std::vector<long> key = {edges, std::lround(G * 1e7)};
    for (const double r : rest) key.push_back(std::lround(r * 1e7));
    const auto found = known_.find(key);
    return found != known_.end() ? found->second : known_.emplace(std::move(key), hang_rod(G, rest, edges)).first->second;
  }
  const RigModel& model_;
  mutable std::map<std::vector<long>, HangingRod> known_;
};

}  // namespace

std::unique_ptr<FullSolver> make_full_solver(const RigModel& model) {
  if (model.data().rig == Rig::suture_cantilever) return std::make_unique<RodSolver>(model);
  if (model.data().rig == Rig::spatula_press || model.data().rig == Rig::tissue_block) return make_tissue_solver(model);
  if (model.data().rig == Rig::vessel_inflation) return make_tube_solver(model);
  if (model.data().rig == Rig::suture_pull) return make_pull_solver(model);
  if (model.data().rig == Rig::needle_insertion) return make_needle_solver(model);
  return nullptr;
}

}  // namespace filum::reconcile
