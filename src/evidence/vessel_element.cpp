// Problems of the wall's element alone: patch test, turning, bending of a beam with one element through its thickness.

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/rng.h"
#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"
#include "evidence/vessel_probe.h"

namespace filum {
namespace {

/// Largest miss of a free node when the border of an irregular card is moved by x -> A x, relative to the largest displacement.
double patch_error(const Mat3& A) {
  CardShape shape;
  shape.width = shape.depth = 4e-3;
  shape.thickness = 1e-3;
  shape.across = shape.deep = 4;
  shape.through = 2;
  VesselMesh mesh = make_card(shape);
  Rng rng(7);
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 1);
  for (int i = 0; i < mesh.n_nodes(); i += 3) {  // three nodes of a column move alike, so that edges through it stay parallel
    const bool border = std::abs(std::abs(mesh.nodes(0, i)) - 2e-3) < 1e-9 || mesh.nodes(1, i) > -1e-9 || mesh.nodes(1, i) < -4e-3 + 1e-9;
    if (border) continue;
    const Vec3 off(3e-4 * (rng.uniform() - 0.5), 3e-4 * (rng.uniform() - 0.5), 0.0);
    for (int k = 0; k < 3; ++k) mesh.nodes.col(i + k) += off;
    for (int c = 0; c < 3; ++c) load.fixed[static_cast<std::size_t>(3 * (i + 1) + c)] = 0;  // inside: the middle of the column
  }
  for (int e = 0; e < mesh.n_elements(); ++e)
    for (int a = 0; a < 8; ++a) mesh.stress_free[static_cast<std::size_t>(e)].col(a) = mesh.nodes.col(mesh.elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)]);
  const WallElements elements(mesh, {{"wall", 1e-3, WallLaw::hooke(10e3, 0.45)}});
  const Points exact = A * mesh.nodes;
  Points x = exact;
  for (int i = 0; i < x.size(); ++i)
    if (!load.fixed[static_cast<std::size_t>(i)]) x.data()[i] = mesh.nodes.data()[i];
  solve_static(mesh, elements, load, x, 1e-16, 30);
  return (x - exact).cwiseAbs().maxCoeff() / (exact - mesh.nodes).cwiseAbs().maxCoeff();
}

void list_patch(ProblemList& list) {
  ValidationProblem p;
  p.name = "vessel-patch";
  p.source = "Patch test: constant strain on the border of an irregular card of two elements through, linear law, finite strain of 0.1 %";
  p.quantity = "largest error of an inner node, relative";
  p.tolerance = 1e-8;
  p.note = "no order: exact on any mesh";
  list.push_back({p, [](ValidationProblem& r) {
                    Mat3 A;
                    A << 1e-3, 2e-4, 0, 0, -5e-4, 1e-4, 3e-4, 0, 7e-4;
                    r.got = patch_error(Mat3::Identity() + A);
                  }});
}

void list_turning(ProblemList& list) {
  ValidationProblem p;
  p.name = "vessel-rotation";
  p.source = "A pressed, stretched rabbit carotid turned by 30 degrees as a rigid body: its forces turn with it";
  p.quantity = "largest change of a force, relative to the largest force";
  p.tolerance = 1e-9;
  p.note = "no order: exact on any mesh, to rounding";
  list.push_back({p, [](ValidationProblem& r) {
                    TubeSlice s = rabbit_carotid(true);
                    s.around = 16;
                    s.through = 4;
                    s.shape.stretch = 1.7;
                    const SliceState state = inflate(s, {0.0, 5e3}).back();
                    const WallElements elements(state.mesh, s.layers);
                    const std::vector<double> sound(static_cast<std::size_t>(state.mesh.n_elements()), 1.0);
                    const Mat3 turn = Eigen::AngleAxisd(30.0 * 3.14159265358979 / 180.0, Vec3(1, 2, -1).normalized()).toRotationMatrix();
                    Points before = Points::Zero(3, state.x.cols()), after = before;
                    elements.add_forces(state.x, sound, before);
                    elements.add_forces(turn * state.x, sound, after);
                    r.got = (after - turn * before).cwiseAbs().maxCoeff() / before.cwiseAbs().maxCoeff();
                  }});
}

/// Tip deflection [m] of a beam 100 x 20 x 20 mm under a tip load, `n` elements along, n / 10 across and one through it. Its clamp holds the end's plane and keeps it from sliding, but
/// lets it grow thick and wide where it is bent, as a beam's theory has it.
double tip(int n, double force, double poisson) {
  CardShape shape;
  shape.depth = 0.1;
  shape.width = 0.02;
  shape.thickness = 0.02;
  shape.deep = n;
  shape.across = std::max(1, n / 10);
  const VesselMesh mesh = make_card(shape);
  const WallElements elements(mesh, {{"beam", 0.02, WallLaw::hooke(10e3, poisson)}});
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 0);
  load.force = Points::Zero(3, mesh.n_nodes());
  int at_tip = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (mesh.nodes(1, i) < -0.1 + 1e-9) {
      const auto fix = [&](int c) { load.fixed[static_cast<std::size_t>(3 * i + c)] = 1; };
      fix(1);
      const bool below = mesh.nodes(2, i) < 0.0;
      if (below || poisson == 0.0) fix(2);
      if (below && mesh.nodes(0, i) < -1e-2 + 1e-9) fix(0);
    }
    at_tip += mesh.nodes(1, i) > -1e-9;
  }
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.nodes(1, i) > -1e-9) load.force(2, i) = -force / at_tip;
  Points x = mesh.nodes;
  if (!solve_static(mesh, elements, load, x, 1e-14, 40).converged) return NAN;
  return mesh.nodes(2, mesh.n_nodes() - 1) - x(2, mesh.n_nodes() - 1);
}

void list_cantilever(ProblemList& list, const char* name, double poisson, double tolerance) {
  const double shear = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson), modulus = 10e3 / (2.0 * (1.0 + poisson));
  std::array<char, 40> number;
  std::snprintf(number.data(), number.size(), "%g", poisson);
  ValidationProblem p;
  p.name = name;
  p.source = std::string("Timoshenko beam 100 x 20 x 20 mm, E = 10 kPa, Poisson's ratio ") + number.data() +
             ", 1 uN at its tip: F L^3/(3 E I) + F L/(k G A), k = 10 (1 + nu)/(12 + 11 nu) (Cowper, J. Appl. Mech. 33 (1966) 335-340); one element through it";
  p.quantity = "tip deflection";
  p.unit = "um";
  p.expected = 2.5 + 0.1 * 1e-6 / (shear * modulus * 4e-4) * 1e6;
  p.tolerance = tolerance;
  list.push_back({p, [poisson](ValidationProblem& r) {
                    const double coarse = tip(10, 1e-6, poisson), middle = tip(20, 1e-6, poisson);
                    r.got = 1e6 * tip(40, 1e-6, poisson);
                    r.order = observed_order(1e6 * coarse, 1e6 * middle, r.got);
                  }});
}

}  // namespace

void list_vessel_element(ProblemList& list) {
  list_patch(list);
  list_turning(list);
  list_cantilever(list, "vessel-cantilever", 0.0, 0.01);
  list_cantilever(list, "vessel-cantilever-0.45", 0.45, 0.02);
}

}  // namespace filum
