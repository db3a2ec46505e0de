#include "physics/tube_slice.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "physics/vessel_wall_pressure.h"

namespace filum {
namespace {

VesselMesh slice_mesh(const TubeSlice& slice) {
  TubeShape shape = slice.shape;
  shape.around = slice.around;
  shape.through = slice.through;
  shape.along = 1;
  return make_tube(shape);
}

WallLoadCase ends_held(const VesselMesh& mesh) {
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 0);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    load.fixed[static_cast<std::size_t>(3 * i + 2)] = 1;
    for (int c = 0; c < 2; ++c)  // four meridians stay in their planes: no drift, no turn
      if (std::abs(mesh.nodes(c, i)) < 1e-6 * mesh.nodes.col(i).head<2>().norm()) load.fixed[static_cast<std::size_t>(3 * i + c)] = 1;
  }
  return load;
}

/// Equilibrium with each element as sound as its energy and the most it has had say; `past` [J/m3] is brought up to date.
bool settle(const VesselMesh& mesh, const WallElements& elements, const WallSoftening& softening, WallLoadCase& load, std::vector<double>& past, Points& x) {
  constexpr int kSweeps = 20;
  bool converged = false;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {  // the motion is given: stresses hardly change the energies
    converged = solve_static(mesh, elements, load, x, 1e-12, 200).converged;
    double moved = 0.0;
    for (std::size_t e = 0; e < past.size(); ++e) {
      const double W = elements.energy(static_cast<int>(e), x) / elements.volume(static_cast<int>(e)), left = softening.left(W, past[e]);
      moved = std::max(moved, std::abs(left - load.soundness[e]));
      load.soundness[e] = left;
    }
    if (moved < 1e-6) break;
  }
  for (std::size_t e = 0; e < past.size(); ++e) past[e] = std::max(past[e], elements.energy(static_cast<int>(e), x) / elements.volume(static_cast<int>(e)));
  return converged;
}

SliceState measure(const VesselMesh& mesh, const WallElements& elements, const WallLoadCase& load, const Points& x, const TubeSlice& s, bool converged) {
  SliceState r;
  r.converged = converged;
  const int inner = 0, outer = s.through;  // every (through + 1)-th node from these
  int n = 0;
  for (int i = 0; i < mesh.n_nodes(); i += s.through + 1, ++n) {
    r.inner += x.col(i + inner).head<2>().norm();
    r.outer += x.col(i + outer).head<2>().norm();
  }
  r.inner /= n;
  r.outer /= n;
  const Points f = reactions(mesh, elements, load, x);
  const double top = s.shape.stretch * s.shape.length;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (x(2, i) > 0.5 * top) r.axial_force += f(2, i);
  r.lumen = lumen_volume(mesh, 0, x) / top;
  r.mesh = mesh;
  r.x = x;
  return r;
}

}  // namespace

std::vector<SliceState> inflate(const TubeSlice& slice, const std::vector<double>& pressures) {
  const VesselMesh mesh = slice_mesh(slice);
  const WallElements elements(mesh, slice.layers);
  WallLoadCase load = ends_held(mesh);
  Points x = mesh.nodes;
  std::vector<SliceState> results;
  for (const double p : pressures) {
    load.pressure = {p};
    bool converged = false;
    for (const double share : p == pressures.front() ? std::vector<double>{1e-3, 1e-2, 0.1, 1.0} : std::vector<double>{1.0}) {
      std::vector<WallLayer> softer = slice.layers;  // incompressibility is tightened from a mild start
      for (WallLayer& l : softer)
        if (l.law.kind != WallLaw::Kind::linear) l.law.lambda *= share;
      converged = solve_static(mesh, WallElements(mesh, softer), load, x, 1e-9, 200).converged;
    }
    results.push_back(measure(mesh, elements, load, x, slice, converged));
  }
  return results;
}

std::vector<double> borne(const TubeSlice& slice, const WallSoftening& softening, const std::vector<double>& inner) {
  const VesselMesh mesh = slice_mesh(slice);
  const WallElements elements(mesh, slice.layers);
  WallLoadCase load = ends_held(mesh);
  load.soundness.assign(static_cast<std::size_t>(mesh.n_elements()), 1.0);
  const int step = slice.through + 1;
  for (int i = 0; i < mesh.n_nodes(); i += step)
    for (int c = 0; c < 2; ++c) load.fixed[static_cast<std::size_t>(3 * i + c)] = 1;
  std::vector<double> past(load.soundness.size(), 0.0), out;
  Points x = mesh.nodes;
  for (const double r : inner) {
    for (int i = 0; i < mesh.n_nodes(); i += step) x.col(i).head<2>() = r * mesh.nodes.col(i).head<2>().normalized();
    const bool found = settle(mesh, elements, softening, load, past, x);
    const Points f = reactions(mesh, elements, load, x);
    double push = 0.0;
    for (int i = 0; i < mesh.n_nodes(); i += step) push += f.col(i).head<2>().dot(x.col(i).head<2>()) / r;
    // by the work on a polygon whose corners all move outward
    const double area = slice.around * r * std::sin(2.0 * std::numbers::pi / slice.around) * slice.shape.stretch * slice.shape.length;
    out.push_back(found ? push / area : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

}  // namespace filum
