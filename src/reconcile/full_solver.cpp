#include "reconcile/full_solver.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/implicit_rod.h"
#include "physics/linear_fem.h"

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

/// 0 ... `blade` in equal cells, then cells that widen by a third each, up to `end`.
std::vector<double> graded(double blade, double end, int cells) {
  std::vector<double> x = {0.0};
  for (int i = 1; i <= cells; ++i) x.push_back(blade * i / cells);
  double width = blade / cells;
  std::vector<double> outside;
  double sum = 0.0;
  for (int i = 0; i < 60 && sum < end - blade; ++i) width *= 1.33, outside.push_back(width), sum += width;
  double at = blade;
  for (const double w : outside) x.push_back(at += w * (end - blade) / sum);
  return x;
}

}  // namespace

double press_stiffness(const Vec3& box, double blade_length, double blade_width, double poissons_ratio, int cells) {
  const std::vector<double> x = graded(0.5 * blade_length, 0.5 * box.x(), cells + cells / 2), y = graded(0.5 * blade_width, 0.5 * box.y(), cells);
  std::vector<double> z = graded(0.5 * std::min(blade_width, box.z()), box.z(), cells);  // depth below the surface
  const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1, nz = static_cast<int>(z.size()) - 1;
  TetMesh mesh = box_mesh(Vec3::Zero(), Vec3(nx, ny, nz), nx, ny, nz);
  std::vector<int> held;
  std::vector<MovedNode> moved;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 cell = mesh.nodes.col(i);
    const auto a = static_cast<std::size_t>(std::lround(cell.x())), b = static_cast<std::size_t>(std::lround(cell.y())), c = static_cast<std::size_t>(nz - std::lround(cell.z()));
    mesh.nodes.col(i) = Vec3(x[a], y[b], box.z() - z[c]);
    if (c == z.size() - 1) held.push_back(i);
  }
  FemOptions o;
  o.averaged_pressure = true;
  o.solver.relative = 1e-6;
  o.solver.max_iterations = 4000;
  LinearFem fem(mesh, {{1.0, poissons_ratio, 1000.0}}, o, "box of tissue");
  fem.hold(held);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 p = mesh.nodes.col(i);
    if (p.z() < 1e-9 * box.z()) continue;
    MovedNode m;
    m.node = i;
    if (p.z() > box.z() * (1.0 - 1e-9) && p.x() < 0.5 * blade_length * (1 + 1e-9) && p.y() < 0.5 * blade_width * (1 + 1e-9)) {
      m.target = Vec3(0, 0, -1.0);  // of depth 1: the problem is linear
    } else if (p.x() == 0.0 || p.y() == 0.0) {  // planes of symmetry: stiff against leaving them
      m.prescribed = false;
      const double k = 1e4 * fem.nodal_stiffness(i);
      m.stiffness = Vec3(p.x() == 0.0 ? k : 0.0, p.y() == 0.0 ? k : 0.0, 0.0).asDiagonal();
    } else {
      continue;
    }
    moved.push_back(m);
  }
  FemState s = fem.rest();
  if (!fem.equilibrium(s, moved).sound) return NAN;
  double force = 0.0;
  for (const MovedNode& m : moved)
    if (m.prescribed) force -= m.force.z();
  return 4.0 * force;
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

/// The tissue under a blade: linear, so one equilibrium for each geometry gives every force in proportion.
class TissueSolver final : public FullSolver {
 public:
  explicit TissueSolver(const RigModel& model) : model_(model) {}
  std::string name() const override { return "the trainer's tissue (physics/linear_fem)"; }

  bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const override {
    model_.rig(t, s, out);
    const double ratio = stiffness(t, s.base[1], fine) / model_.punch_stiffness(t, s.base[1]);
    for (Eigen::Index c = 0; c < out.cols(); ++c) {
      const std::string& name = model_.data().outputs[static_cast<std::size_t>(c)];
      if (name == "force" || name == "pressure") out.col(c) *= ratio;
    }
    return std::isfinite(ratio);
  }

 private:
  double stiffness(const Trial& t, double nu, bool fine) const {
    const Vec3 box(t.size("length"), t.size("width"), t.size("height"));
    const double length = t.size("blade_length"), width = t.size("blade_width");
    const std::vector<double> key = {box.x(), box.y(), box.z(), length, width, nu, fine ? 1.0 : 0.0};
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    return known_[key] = press_stiffness(box, std::min(length, 0.98 * box.x()), std::min(width, 0.98 * box.y()), std::min(nu, 0.49), fine ? 5 : 3);
  }
  const RigModel& model_;
  mutable std::map<std::vector<double>, double> known_;
};

}  // namespace

std::unique_ptr<FullSolver> make_full_solver(const RigModel& model) {
  if (model.data().rig == Rig::suture_cantilever) return std::make_unique<RodSolver>(model);
  if (model.data().rig == Rig::spatula_press) return std::make_unique<TissueSolver>(model);
  if (model.data().rig == Rig::vessel_inflation) return make_tube_solver(model);
  if (model.data().rig == Rig::suture_pull) return make_pull_solver(model);
  if (model.data().rig == Rig::needle_insertion) return make_needle_solver(model);
  return nullptr;
}

}  // namespace filum::reconcile
