#include "physics/tube_slice.h"

#include <cmath>

#include "physics/vessel_wall_pressure.h"

namespace filum {
namespace {

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
  TubeShape shape = slice.shape;
  shape.around = slice.around;
  shape.through = slice.through;
  shape.along = 1;
  const VesselMesh mesh = make_tube(shape);
  const WallElements elements(mesh, slice.layers);
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 0);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    load.fixed[static_cast<std::size_t>(3 * i + 2)] = 1;
    for (int c = 0; c < 2; ++c)  // four meridians stay in their planes: no drift, no turn
      if (std::abs(mesh.nodes(c, i)) < 1e-6 * mesh.nodes.col(i).head<2>().norm()) load.fixed[static_cast<std::size_t>(3 * i + c)] = 1;
  }
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

}  // namespace filum
