// Linear tetrahedra against theory and against the same element in an independent program.

#include <cmath>
#include <functional>

#include "evidence/brain_block.h"
#include "base/numbers.h"
#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"

namespace filum {
namespace {

FemSolverOptions exact(double relative) {
  FemSolverOptions o;
  o.relative = relative;
  o.max_iterations = 20000;
  return o;
}

std::vector<int> nodes_where(const TetMesh& m, const std::function<bool(const Vec3&)>& take) {
  std::vector<int> list;
  for (int i = 0; i < m.n_nodes(); ++i)
    if (take(m.nodes.col(i))) list.push_back(i);
  return list;
}

// ---- beam B of the reference: 100 x 20 x 20 mm, 10 kPa, nu 0.45, 1000 kg/m3, clamped at x = 0

TetMesh beam(int nx, int n) { return box_mesh(Vec3(0, -0.01, -0.01), Vec3(0.1, 0.01, 0.01), nx, n, n); }
bool clamped(const Vec3& x) { return x.x() < 1e-9; }

double beam_sag(int nx, int n, bool averaged) {
  FemOptions options;
  options.averaged_pressure = averaged;
  options.solver = exact(1e-8);
  LinearFem fem(beam(nx, n), {{10e3, 0.45, 1000.0}}, options);
  fem.hold(nodes_where(fem.mesh(), clamped));
  Points loads = Points::Zero(3, fem.mesh().n_nodes());
  loads.row(2) = -0.1 * fem.mass().transpose();
  FemState s = fem.rest();
  fem.equilibrium(s, {}, &loads);
  const auto tip = nodes_where(fem.mesh(), [](const Vec3& x) { return x.x() > 0.1 - 1e-9 && x.tail<2>().norm() < 1e-9; });
  return -s.u(2, tip.at(0));
}

/// Lowest natural frequency [Hz] by inverse iteration on K v = omega^2 M v.
double beam_frequency(int nx, int n, double side) {
  FemOptions options;
  options.solver = exact(1e-4);
  LinearFem fem(beam(nx, n), {{10e3, 0.45, 1000.0}}, options);
  fem.hold(nodes_where(fem.mesh(), clamped));
  FemState s = fem.rest();
  Points shape = Points::Zero(3, fem.mesh().n_nodes());
  for (int i = 0; i < shape.cols(); ++i) shape.col(i) = Vec3(0, 1.0, side) * std::pow(fem.mesh().nodes(0, i), 2);
  double omega2 = 0.0;
  for (int k = 0; k < 4; ++k) {
    Points loads = shape;
    for (int i = 0; i < shape.cols(); ++i) loads.col(i) *= fem.mass()[i];
    s.u = shape * (omega2 > 0.0 ? 1.0 / omega2 : 0.0);
    fem.equilibrium(s, {}, &loads);
    double kinetic = 0.0;
    for (int i = 0; i < shape.cols(); ++i) kinetic += fem.mass()[i] * s.u.col(i).squaredNorm();
    omega2 = s.u.cwiseProduct(fem.elastic_force(s.u)).sum() / kinetic;  // Rayleigh's quotient
    shape = s.u / std::sqrt(kinetic);
  }
  return std::sqrt(omega2) / (2.0 * kPi);
}

void list_beam(ProblemList& list) {
  ValidationProblem p;
  p.quantity = "deflection of the tip under 0.1 m/s2";
  p.unit = "mm";
  p.name = "tissue-cantilever-same-element";
  p.source = "CalculiX C3D4 on the same 20 x 4 x 4 mesh (and an independent assembly, equal to 7 digits)";
  p.expected = 2.28393;
  p.tolerance = 1e-4;
  p.note = "no order: the same mesh in both";
  list.push_back({p, [](ValidationProblem& r) { r.got = 1e3 * beam_sag(20, 4, false); }});
  p.note = "order of the error from 10 x 2 x 2 and 20 x 4 x 4";
  p.name = "tissue-cantilever-plain";
  p.source = "CalculiX C3D20 (quadratic); plain linear tetrahedra are stated to be 39 % too stiff at 20 x 4 x 4, nu 0.45";
  p.expected = 3.7232;
  p.tolerance = 0.40;
  list.push_back({p, [](ValidationProblem& r) {
                    r.got = 1e3 * beam_sag(20, 4, false);
                    r.order = order_of_errors(1e3 * beam_sag(10, 2, false) - r.expected, r.got - r.expected);
                  }});
  p.name = "tissue-cantilever-averaged";
  p.source = "CalculiX C3D20; pressure averaged about the nodes (Bonet & Burton 1998), 20 x 4 x 4";
  p.tolerance = 0.25;
  list.push_back({p, [](ValidationProblem& r) {
                    r.got = 1e3 * beam_sag(20, 4, true);
                    r.order = order_of_errors(1e3 * beam_sag(10, 2, true) - r.expected, r.got - r.expected);
                  }});
  p.note = "no order: the same mesh in both";
  p.name = "tissue-frequency-soft-diagonal";
  p.quantity = "natural frequency of the first pair, which the diagonals of the mesh split";
  p.unit = "Hz";
  p.source = "CalculiX C3D4 60 x 12 x 12 (consistent mass; ours is lumped)";
  p.expected = 1.03937;
  p.tolerance = 5e-3;
  list.push_back({p, [](ValidationProblem& r) { r.got = beam_frequency(60, 12, -1.0); }});
  p.name = "tissue-frequency-stiff-diagonal";
  p.expected = 1.06810;
  list.push_back({p, [](ValidationProblem& r) { r.got = beam_frequency(60, 12, 1.0); }});
}

// ---- time

void list_time(ProblemList& list) {
  ValidationProblem p;
  p.name = "tissue-energy";
  p.source = "trapezoidal rule, undamped, no load: energy is conserved (Newmark 1/4, 1/2)";
  p.quantity = "largest relative change of energy in 200 steps";
  p.tolerance = 1e-10;
  p.note = "no order: exact on any mesh, to rounding";
  list.push_back({p, [](ValidationProblem& r) {
                    FemOptions options;
                    options.dt = 5e-3;
                    options.solver = exact(1e-15);
                    LinearFem fem(block_of_nodes(7, 7, 7, Vec3(0.06, 0.06, 0.06)), {{}}, options);
                    fem.hold(nodes_where(fem.mesh(), [](const Vec3& x) { return x.z() < -0.06 + 1e-9; }));
                    FemState s = fem.rest();
                    for (int i = 0; i < s.v.cols(); ++i)
                      if (!fem.held()[static_cast<std::size_t>(i)]) s.v.col(i) = 0.1 * Vec3(std::sin(3.0 * i), std::cos(5.0 * i), std::sin(7.0 * i));
                    const double start = fem.energy(s);
                    for (int k = 0; k < 200; ++k) {
                      fem.step(s, {});
                      r.got = std::max(r.got, std::abs(fem.energy(s) / start - 1.0));
                    }
                  }});
}

// ---- half space, quarter of a disc: x, y >= 0; rings are circles, cells grow outwards

constexpr double kYoung = 3e3, kPoisson = 0.45, kReduced = kYoung / (1.0 - kPoisson * kPoisson);

/// `rings` cells within radius a, cells growing by `growth` beyond up to `far` [m]; as deep as wide.
TetMesh quarter_space(double a, int rings, double growth, double far) {
  std::vector<double> radius = {0.0};
  double cell = a / rings;
  while (radius.back() < far) {
    radius.push_back(radius.back() + cell);
    if (radius.back() > 1.5 * a) cell *= growth;
  }
  const int n = static_cast<int>(radius.size()) - 1;
  TetMesh m = box_mesh(Vec3::Zero(), Vec3::Ones(), n, n, n);
  for (int i = 0; i < m.n_nodes(); ++i) {
    const auto number = [&](int c) { return static_cast<std::size_t>(std::lround(m.nodes(c, i) * n)); };
    const std::size_t x = number(0), y = number(1), z = number(2);
    const std::size_t ring = std::max(x, y);
    const double angle = ring == 0 ? 0.0 : x >= y ? 0.25 * kPi * double(y) / double(ring) : 0.5 * kPi - 0.25 * kPi * double(x) / double(ring);
    m.nodes.col(i) = Vec3(radius[ring] * std::cos(angle), radius[ring] * std::sin(angle), radius[z] - radius.back());
  }
  m.nodes.row(2).array() -= m.nodes.row(2).maxCoeff();
  // the box grows with z from below: turn it over so that the small cells are at the top, z = 0
  for (int i = 0; i < m.n_nodes(); ++i) m.nodes(2, i) = -radius.back() - m.nodes(2, i);
  for (Tetrahedron& t : m.tets) std::swap(t[2], t[3]);
  return m;
}

/// Quarter of an elastic half space; its flat sides slide, its far sides are held.
struct HalfSpace {
  LinearFem fem;
  std::vector<MovedNode> moved;  // supports of the planes of symmetry first
  std::vector<std::size_t> own;  // node -> index in moved, or SIZE_MAX
  FemState state;

  HalfSpace(double a, int rings, double growth, double far) : fem(quarter_space(a, rings, growth, far), {{kYoung, kPoisson, 1000.0}}, options()) {
    const TetMesh& m = fem.mesh();
    const double depth = m.nodes.row(2).minCoeff(), wide = m.nodes.row(0).maxCoeff();
    fem.hold(nodes_where(m, [&](const Vec3& x) { return x.z() < depth + 1e-9 || x.head<2>().norm() > wide - 1e-9; }));
    own.assign(static_cast<std::size_t>(m.n_nodes()), SIZE_MAX);
    for (int i = 0; i < m.n_nodes(); ++i) {
      Vec3 slide(std::abs(m.nodes(0, i)) < 1e-12 ? kStiff : 0.0, std::abs(m.nodes(1, i)) < 1e-12 ? kStiff : 0.0, 0.0);
      if (slide.isZero() || fem.held()[static_cast<std::size_t>(i)]) continue;
      at(i).stiffness += Mat3(slide.asDiagonal());
    }
    state = fem.rest();
  }
  MovedNode& at(int i) {
    auto& k = own[static_cast<std::size_t>(i)];
    if (k == SIZE_MAX) {
      k = moved.size();
      moved.push_back({i, false, Vec3::Zero()});
    }
    return moved[k];
  }
  void press(int i, double z) {
    at(i).stiffness(2, 2) = kStiff;
    at(i).target.z() = z;
  }
  double push() const {  // [N], of the whole, four quarters
    double sum = 0.0;
    for (const MovedNode& m : moved)
      if (m.stiffness(2, 2) > 0.0) sum -= 4.0 * m.force.z();
    return sum;
  }
  static constexpr double kStiff = 1e4;  // [N/m]
  static FemOptions options() {
    FemOptions o;
    o.solver = exact(1e-5);
    o.averaged_pressure = true;
    return o;
  }
};

double punch_force(double a, double depth, int rings) {
  HalfSpace half(a, rings, 1.35, 40.0 * a);
  for (const int i : nodes_where(half.fem.mesh(), [&](const Vec3& x) { return x.z() > -1e-12 && x.head<2>().norm() < a * (1.0 + 1e-9); })) half.press(i, -depth);
  half.fem.equilibrium(half.state, half.moved);
  return half.push();
}

/// Nodes under the sphere are pressed to it; those that would be pulled are let go, one round after the other.
double sphere_force(double radius, double depth, int rings) {
  const double reach = std::sqrt(radius * depth);
  HalfSpace half(1.5 * reach, rings, 1.35, 40.0 * reach);
  std::vector<int> touching = nodes_where(half.fem.mesh(), [&](const Vec3& x) { return x.z() > -1e-12 && x.head<2>().norm() < 1.45 * reach; });
  for (int round = 0; round < 5; ++round) {
    for (const int i : touching) {
      const double r = half.fem.mesh().nodes.col(i).head<2>().norm();
      half.press(i, r * r / (2.0 * radius) - depth);
    }
    half.fem.equilibrium(half.state, half.moved);
    const auto pulled = [&](int i) { return half.at(i).force.z() > 0.0; };
    for (const int i : touching)
      if (pulled(i)) half.at(i).stiffness(2, 2) = 0.0;
    if (std::erase_if(touching, pulled) == 0) break;
  }
  return half.push();
}

double boussinesq_sag(double force, double r, int rings) {
  HalfSpace half(r, rings, 1.35, 40.0 * r);
  Points loads = Points::Zero(3, half.fem.mesh().n_nodes());
  const auto nodes = [&](double at) { return nodes_where(half.fem.mesh(), [&](const Vec3& x) { return x.z() > -1e-12 && std::abs(x.head<2>().norm() - at) < 1e-9; }); };
  loads(2, nodes(0.0).at(0)) = -0.25 * force;
  half.fem.equilibrium(half.state, half.moved, &loads);
  double sum = 0.0;
  for (const int i : nodes(r)) sum -= half.state.u(2, i);
  return sum / static_cast<double>(nodes(r).size());
}

void list_half_space(ProblemList& list) {
  ValidationProblem p;
  p.name = "tissue-flat-punch";
  p.source = "F = 2 E* a d, frictionless rigid flat punch on a half space, a 2.5 mm, d 0.2 mm, 3 kPa, nu 0.45; block of 40 a";
  p.quantity = "force";
  p.unit = "mN";
  p.expected = 2e3 * kReduced * 2.5e-3 * 0.2e-3;
  p.tolerance = 0.10;
  p.note = "no order: one graded mesh in a block of finite size, which is part of the error";
  list.push_back({p, [](ValidationProblem& r) { r.got = 1e3 * punch_force(2.5e-3, 0.2e-3, 8); }});
  p.name = "tissue-hertz";
  p.source = "F = 4/3 E* sqrt(R) d^1.5, sphere R 2 mm, d 0.2 mm, 3 kPa, nu 0.45; block of 40 a";
  p.expected = 1e3 * 4.0 / 3.0 * kReduced * std::sqrt(2e-3) * std::pow(0.2e-3, 1.5);
  list.push_back({p, [](ValidationProblem& r) { r.got = 1e3 * sphere_force(2e-3, 0.2e-3, 6); }});
  p.name = "tissue-boussinesq";
  p.source = "u_z = (1-nu^2) F/(pi E r), point load 10 mN, r 5 mm; block of 40 r";
  p.quantity = "surface displacement";
  p.unit = "mm";
  p.expected = 1e3 * (1.0 - kPoisson * kPoisson) * 10e-3 / (kPi * kYoung * 5e-3);
  list.push_back({p, [](ValidationProblem& r) { r.got = 1e3 * boussinesq_sag(10e-3, 5e-3, 6); }});
}

// ---- solvers

/// Displacement of a loaded block by one solver.
FemState loaded_block(const FemSolverOptions& solver, FemSummary& summary, double& force) {
  FemOptions options;
  options.dt = 5e-3;
  options.mass_damping = 20.0;
  options.stiffness_damping = 10e-3;
  options.solver = solver;
  BrainBlock block(block_of_nodes(13, 13, 6, Vec3(0.06, 0.06, 0.03)), options, 20e-3, {});
  for (int k = 1; k <= 60; ++k) block.step(Vec3(0, 0, -k * 0.1e-3));
  summary = block.summary;
  force = block.force();
  return block.state;
}

void list_solvers(ProblemList& list) {
  ValidationProblem p;
  p.name = "tissue-gauss-seidel";
  p.source = "Gauss-Seidel (Eq. 7, SOR 1.3) and preconditioned conjugate gradients, both to 1e-10, 60 steps of a press";
  p.quantity = "relative difference of the displacements";
  p.tolerance = 1e-6;
  p.note = "no order: two solvers on one mesh";
  list.push_back({p, [](ValidationProblem& r) {
                    FemSolverOptions sweeps = exact(1e-10), gradients = exact(1e-10);
                    sweeps.method = FemSolverOptions::Method::gauss_seidel;
                    sweeps.relaxation = 1.3;
                    FemSummary summary;
                    double force = 0.0;
                    const FemState a = loaded_block(sweeps, summary, force), b = loaded_block(gradients, summary, force);
                    r.got = (a.u - b.u).norm() / b.u.norm();
                  }});
  p.name = "tissue-residual";
  p.source = "force on the blade at the run-time residual of 1e-3 against 1e-10, 60 steps of a press to 6 mm";
  p.quantity = "difference of the force";
  p.unit = std::string("N");
  p.tolerance = 5e-3;
  p.note = "no order: two tolerances on one mesh";
  list.push_back({p, [](ValidationProblem& r) {
                    FemSummary summary;
                    double loose = 0.0, tight = 0.0;
                    loaded_block(exact(1e-3), summary, loose);
                    loaded_block(exact(1e-10), summary, tight);
                    r.got = std::abs(loose - tight);
                  }});
}

}  // namespace

void list_tissue(ProblemList& list) {
  list_beam(list);
  list_time(list);
  list_half_space(list);
  list_solvers(list);
}

}  // namespace filum
