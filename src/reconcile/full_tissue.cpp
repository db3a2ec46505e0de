// tissue-block and spatula-press by the trainer's tissue (physics/linear_fem, physics/pore_flow). Linear in the motion, so one equilibrium for each geometry
// gives every force in proportion, and one relaxation after a sudden motion every record by superposition (Boltzmann).
// Friction at the platens is found under a growing compression, where it too is in proportion. A block without drainage or friction at its platens is homogeneous: nothing is asked of a mesh.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/linear_fem.h"
#include "physics/pore_flow.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {
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

Kernel over_sudden(const DrainingForce& f) {
  Kernel k{f.rest / f.sudden(), f.weight, f.time};
  for (double& w : k.weight) w /= f.sudden();
  return k;
}

}  // namespace

PressedBox pressed_box(const Vec3& box, double blade_length, double blade_width, int cells) {
  const std::vector<double> x = graded(0.5 * blade_length, 0.5 * box.x(), cells + cells / 2), y = graded(0.5 * blade_width, 0.5 * box.y(), cells);
  const std::vector<double> z = graded(0.5 * std::min(blade_width, box.z()), box.z(), cells);  // depth below the surface
  const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1, nz = static_cast<int>(z.size()) - 1;
  PressedBox out{box_mesh(Vec3::Zero(), Vec3(nx, ny, nz), nx, ny, nz), {}, {}, {}, {}, {}};
  for (int i = 0; i < out.mesh.n_nodes(); ++i) {
    const Vec3 cell = out.mesh.nodes.col(i);
    const auto a = static_cast<std::size_t>(std::lround(cell.x())), b = static_cast<std::size_t>(std::lround(cell.y())), c = static_cast<std::size_t>(nz - std::lround(cell.z()));
    out.mesh.nodes.col(i) = Vec3(x[a], y[b], box.z() - z[c]);
    out.bottom.push_back(c == z.size() - 1);
    out.blade.push_back(c == 0 && x[a] < 0.5 * blade_length * (1 + 1e-9) && y[b] < 0.5 * blade_width * (1 + 1e-9));
    out.middle_x.push_back(a == 0);
    out.middle_y.push_back(b == 0);
    out.free.push_back(!out.blade.back() && (c == 0 || a == x.size() - 1 || b == y.size() - 1));
  }
  return out;
}

double press_stiffness(const Vec3& box, double blade_length, double blade_width, double poissons_ratio, int cells) {
  const PressedBox b = pressed_box(box, blade_length, blade_width, cells);
  FemOptions o;
  o.averaged_pressure = true;
  o.solver.relative = 1e-6;
  o.solver.max_iterations = 4000;
  LinearFem fem(b.mesh, {{1.0, poissons_ratio, 1000.0}}, o, "box of tissue");
  std::vector<int> held;
  std::vector<MovedNode> moved;
  for (int i = 0; i < b.mesh.n_nodes(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    MovedNode m;
    m.node = i;
    if (b.bottom[at]) {
      held.push_back(i);
    } else if (b.blade[at]) {
      m.target = Vec3(0, 0, -1.0);  // of depth 1: the problem is linear
      moved.push_back(m);
    } else if (b.middle_x[at] || b.middle_y[at]) {  // planes of symmetry: stiff against leaving them
      m.prescribed = false;
      const double k = 1e4 * fem.nodal_stiffness(i);
      m.stiffness = Vec3(b.middle_x[at] ? k : 0.0, b.middle_y[at] ? k : 0.0, 0.0).asDiagonal();
      moved.push_back(m);
    }
  }
  fem.hold(held);
  FemState s = fem.rest();
  if (!fem.equilibrium(s, moved).sound) return NAN;
  double force = 0.0;
  for (const MovedNode& m : moved)
    if (m.prescribed) force -= m.force.z();
  return 4.0 * force;
}

Kernel press_drainage(const Vec3& box, double blade_length, double blade_width, double poissons_ratio, double share, int cells) {
  const PressedBox b = pressed_box(box, blade_length, blade_width, cells);
  DrainingBody body{b.mesh, {1.0, poissons_ratio, 1000.0}, {1.0, poisson_by_punch(share, poissons_ratio)}, {}, Points::Zero(3, b.mesh.n_nodes()), b.free};
  for (std::size_t i = 0; i < b.blade.size(); ++i) {
    const bool tied = b.blade[i] || b.bottom[i];
    for (const bool held : {tied || b.middle_x[i], tied || b.middle_y[i], tied}) body.held.push_back(held);
    if (b.blade[i]) body.motion(2, static_cast<Eigen::Index>(i)) = -1.0;
  }
  return over_sudden(draining_force(body));
}

Kernel block_drainage(const Block& block, double poissons_ratio, double share, bool ends, int cells) {
  // through the sides nothing varies along the height: one layer will do
  const int along = ends ? cells : 1, across = ends ? (cells + 1) / 2 : 2 * cells;
  const double high = ends ? 0.5 * block.height : 0.5 * block.width / across;
  DrainingBody body{box_mesh(Vec3::Zero(), Vec3(across, across, along), across, across, along), {1.0, poissons_ratio, 1000.0}, {1.0, poisson_by_block(share, poissons_ratio)}, {}, {}, {}};
  Points& nodes = body.mesh.nodes;
  body.motion = Points::Zero(3, nodes.cols());
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    const double x = nodes(0, i), y = nodes(1, i), ring = std::max(x, y), z = nodes(2, i);
    const bool top = z > along - 0.5, bottom = z < 0.5;
    for (const bool held : {x == 0.0, y == 0.0, top || bottom}) body.held.push_back(held);
    body.open.push_back(ends ? top : ring > across - 0.5);
    if (top) body.motion(2, i) = -1.0;
    const double angle = ring == 0.0 ? 0.0 : 0.25 * std::numbers::pi * (x >= y ? y / ring : 2.0 - x / ring);
    if (block.round) nodes.col(i).head<2>() = 0.5 * block.width * ring / across * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    else nodes.col(i).head<2>() = 0.5 / across * Eigen::Vector2d(block.width * x, block.depth * y);
    nodes(2, i) = high * z / along;
  }
  return over_sudden(draining_force(body));
}

double platen_stiffening(const Block& block, double poissons_ratio, double friction, int cells) {
  TetMesh mesh = box_mesh(Vec3::Zero(), Vec3::Constant(cells), cells, cells, cells);
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    const double x = mesh.nodes(0, i), y = mesh.nodes(1, i), ring = std::max(x, y);
    const double angle = ring == 0.0 ? 0.0 : 0.25 * std::numbers::pi * (x >= y ? y / ring : 2.0 - x / ring);
    if (block.round) mesh.nodes.col(i).head<2>() = 0.5 * block.width * ring / cells * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    else mesh.nodes.col(i).head<2>() = 0.5 / cells * Eigen::Vector2d(block.width * x, block.depth * y);
    mesh.nodes(2, i) *= 0.5 * block.height / cells;
  }
  FemOptions o;
  o.averaged_pressure = true;
  o.solver.relative = 1e-6;
  o.solver.max_iterations = 4000;
  LinearFem fem(mesh, {{1.0, poissons_ratio, 1000.0}}, o, "block");
  const double deep = 0.5 * block.height, still = 1e-3 * deep * block.width / block.height;  // at a strain of one; below this slip a node holds
  std::vector<MovedNode> moved;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 p = mesh.nodes.col(i);
    const double firm = 1e3 * fem.nodal_stiffness(i);
    const bool top = p.z() > deep * (1.0 - 1e-9);
    MovedNode m{i, false, Vec3(0, 0, top ? -deep : 0.0), Mat3::Zero()};
    const Vec3 k(p.x() < 1e-12 ? firm : 0.0, p.y() < 1e-12 ? firm : 0.0, top || p.z() < 1e-12 ? firm : 0.0);
    m.stiffness = k.asDiagonal();
    if (!k.isZero()) moved.push_back(m);
  }
  FemState s = fem.rest();
  double force = 0.0, before = -1.0;
  for (int k = 0; k < 60 && std::abs(force - before) > 1e-5 * std::abs(force); ++k) {  // friction as the spring that has its force at the slip found last
    if (!fem.equilibrium(s, moved).sound) return NAN;
    before = force;
    force = 0.0;
    for (MovedNode& m : moved) {
      if (m.target.z() == 0.0) continue;
      force -= m.force.z();
      const Vec3 p = mesh.nodes.col(m.node);
      const double drag = friction * std::max(0.0, -m.force.z()) / (s.u.col(m.node).head<2>().norm() + still);
      for (int c = 0; c < 2; ++c)
        if (p[c] >= 1e-12) m.stiffness(c, c) = drag;
    }
  }
  double volume = 0.0;  // of the mesh: a cylinder's is a little less than the cylinder's
  for (int e = 0; e < mesh.n_tets(); ++e) volume += tet_volume(mesh, e);
  return force * deep / volume;
}

namespace {

class TissueSolver final : public FullSolver {
 public:
  explicit TissueSolver(const RigModel& model) : model_(model) {}
  std::string name() const override { return "the trainer's tissue (physics/linear_fem)"; }
  bool needed(const std::vector<const Form*>& forms) const override {
    return press() || std::any_of(forms.begin(), forms.end(), [](const Form* f) { return f->effect == Effect::poroelastic_drainage || f->effect == Effect::platen_friction; });
  }

  bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const override {
    Setting on_mesh = s;
    double stiffer = 1.0;
    if (const double* p = s.on(Effect::platen_friction); p != nullptr && t.word("mode") != "shear") {
      stiffer = between_platens(t, s.base[1], p[0], fine);
      on_mesh.p[static_cast<std::size_t>(index_of(Effect::platen_friction))] = nullptr;
    }
    Kernel drained;
    if (const double* p = s.on(Effect::poroelastic_drainage); p != nullptr && (press() || t.word("mode") != "shear")) {
      drained = drainage(t, s.base[1], p[1], s.form(Effect::poroelastic_drainage) % 2 == 1, fine);
      for (double& time : drained.tau) time /= p[0];
      on_mesh.drained = &drained;
      if (!std::isfinite(drained.rest)) return false;
    }
    PressTable pressed;
    if (press() && !law_of(s).linear()) {
      pressed = table(t, s, fine);
      on_mesh.press = &pressed;
      if (pressed.load.empty()) return false;
    }
    const double ratio = press() ? stiffness(t, s.base[1], fine) / model_.punch_stiffness(t, s.base[1]) : 1.0;
    std::array<double, 2> bond{};  // the tissue pulls as the mesh does, the blade comes off at its traction all the same
    if (const double* p = s.on(Effect::contact_adhesion); p != nullptr && press()) {
      bond[0] = p[0] / ratio;
      if (s.form(Effect::contact_adhesion) != 0) bond[1] = p[1];
      on_mesh.p[static_cast<std::size_t>(index_of(Effect::contact_adhesion))] = bond.data();
    }
    model_.rig(t, on_mesh, out);
    out *= stiffer;
    if (!press()) return std::isfinite(stiffer);
    for (Eigen::Index c = 0; c < out.cols(); ++c) {
      const std::string& name = model_.data().outputs[static_cast<std::size_t>(c)];
      if (name == "force" || name == "pressure") out.col(c) *= ratio;
    }
    return std::isfinite(ratio);
  }

 private:
  bool press() const { return model_.data().rig == Rig::spatula_press; }
  /// Box, blade.
  std::array<double, 5> sizes(const Trial& t) const {
    const Vec3 box(t.size("length"), t.size("width"), t.size("height"));
    return {box.x(), box.y(), box.z(), std::min(t.size("blade_length"), 0.98 * box.x()), std::min(t.size("blade_width"), 0.98 * box.y())};
  }
  static Block block_of(const Trial& t) {
    if (t.shape == "cylinder") return {t.size("diameter"), t.size("diameter"), t.size("height"), true};
    return {t.size("length"), t.size("width"), t.size("height"), false};
  }
  double between_platens(const Trial& t, double nu, double friction, bool fine) const {
    const Block b = block_of(t);
    nu = std::min(nu, 0.49);
    friction = std::exp(5e-3 * std::round(200.0 * std::log(friction)));
    const std::vector<double> key = {b.width, b.depth, b.height, b.round ? 1.0 : 0.0, nu, friction, fine ? 1.0 : 0.0};
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    return known_[key] = platen_stiffening(b, nu, friction, fine ? 8 : 5);
  }
  double stiffness(const Trial& t, double nu, bool fine) const {
    const auto [x, y, z, length, width] = sizes(t);
    const std::vector<double> key = {x, y, z, length, width, nu, fine ? 1.0 : 0.0};
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    return known_[key] = press_stiffness(Vec3(x, y, z), length, width, std::min(nu, 0.49), fine ? 5 : 3);
  }
  TissueLaw law_of(const Setting& s) const {
    TissueLaw law;
    if (const double* p = s.on(Effect::strain_stiffening)) law.stiffening = p[0], law.exponential = s.form(Effect::strain_stiffening) == 2;
    if (const double* p = s.on(Effect::first_cycle_softening)) law.softening = p[0], law.softening_energy = p[1], law.softening_form = s.form(Effect::first_cycle_softening);
    if (const double* p = s.on(Effect::permanent_set)) law.set = p[0], law.set_strain = s.form(Effect::permanent_set) == 0 ? 0.0 : model_.largest_strain();
    return law;
  }
  /// The values are taken to three digits, so that a fit that stands still asks for no further equilibria.
  const PressTable& table(const Trial& t, const Setting& s, bool fine) const {
    const auto [x, y, z, length, width] = sizes(t);
    const double nu = std::min(s.base[1], 0.49), peak = 1e-4 * std::round(1e4 * t.at("depth").maxCoeff() / z);
    TissueLaw law = law_of(s);
    const auto digits = [](double v) { return v == 0.0 ? 0.0 : std::exp(0.01 * std::round(100.0 * std::log(v))); };
    for (double* v : {&law.stiffening, &law.softening, &law.softening_energy, &law.set}) *v = digits(*v);
    const std::vector<double> key = {x, y, z, length, width, nu, peak, law.stiffening, law.exponential ? 1.0 : 0.0, law.softening, law.softening_energy, double(law.softening_form), law.set, law.set_strain, fine ? 1.0 : 0.0};
    const auto found = pressed_.find(key);
    if (found != pressed_.end()) return found->second;
    double& square = square_[{x, y, z, length, width, nu}];  // the material's: of one mesh for both
    if (square == 0.0) square = local_strain_square(pressed_box(Vec3(x, y, z), length, width, 2), z, nu);
    const double stiffening = law.stiffening, soft[] = {law.softening, law.softening_energy}, set = law.set;
    Setting rounded = s;
    const auto put = [&](Effect e, const double* v) { if (s.on(e) != nullptr) rounded.p[static_cast<std::size_t>(index_of(e))] = v; };
    put(Effect::strain_stiffening, &stiffening), put(Effect::first_cycle_softening, soft), put(Effect::permanent_set, &set);
    return pressed_[key] = press_table(pressed_box(Vec3(x, y, z), length, width, fine ? 3 : 2), z, nu, law, square, std::max(peak, 1e-4), [&](double e, double most) { return model_.press_law(t, rounded, e, most); });
  }
  const Kernel& drainage(const Trial& t, double nu, double share, bool ends, bool fine) const {
    nu = std::min(nu, 0.49);
    share = std::clamp(1e-3 * std::round(1e3 * share), 1e-3, 0.95);
    std::vector<double> key = {nu, share, ends ? 1.0 : 0.0, fine ? 1.0 : 0.0, t.size("height")};
    const bool round = t.shape == "cylinder";
    for (const char* name : {"length", "width", "diameter", "blade_length", "blade_width"}) key.push_back(std::string(name).starts_with("blade") && !press() ? 0.0 : (std::string(name) == "diameter") != round ? 0.0 : t.size(name));
    const auto found = relaxing_.find(key);
    if (found != relaxing_.end()) return found->second;
    if (press()) {
      const auto [x, y, z, length, width] = sizes(t);
      return relaxing_[key] = press_drainage(Vec3(x, y, z), length, width, nu, share, fine ? 3 : 2);
    }
    return relaxing_[key] = block_drainage(block_of(t), nu, share, ends, fine ? 8 : 5);
  }
  const RigModel& model_;
  mutable std::map<std::vector<double>, double> known_;
  mutable std::map<std::vector<double>, Kernel> relaxing_;
  mutable std::map<std::vector<double>, PressTable> pressed_;
  mutable std::map<std::vector<double>, double> square_;
};

}  // namespace

std::unique_ptr<FullSolver> make_tissue_solver(const RigModel& model) { return std::make_unique<TissueSolver>(model); }

}  // namespace filum::reconcile
