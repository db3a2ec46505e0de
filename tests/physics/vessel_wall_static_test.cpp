#include "physics/vessel_wall_static.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace filum;

namespace vessel_wall_static_test {

/// A short rubber tube pulled along its axis while its ends may narrow: stress mu (l^2 - 1/l) of an incompressible bar.
TEST(VesselWallStatic, RubberInUniaxialStretch) {
  TubeShape s;
  s.around = 12;
  s.along = 2;
  s.length = 0.5e-3;
  const VesselMesh mesh = make_tube(s);
  WallLaw law;
  law.kind = WallLaw::Kind::neo_hookean;
  law.mu = 100e3;
  law.lambda = 500e6;
  const WallElements elements(mesh, {{"wall", 1e-4, law}});
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 0);
  Points x = mesh.nodes;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (mesh.nodes(2, i) < 1e-9 || mesh.nodes(2, i) > 0.5e-3 - 1e-9) load.fixed[static_cast<std::size_t>(3 * i + 2)] = 1;
    for (int c = 0; c < 2; ++c)
      if (std::abs(mesh.nodes(c, i)) < 1e-9) load.fixed[static_cast<std::size_t>(3 * i + c)] = 1;
  }
  double area = 0.0;
  for (int e = 0; e < mesh.n_elements(); ++e) area += elements.volume(e) / 0.5e-3;
  for (const double stretch : {1.1, 1.3, 1.6}) {
    x.row(2) = stretch * mesh.nodes.row(2);
    const StaticSummary r = solve_static(mesh, elements, load, x, 1e-10);
    ASSERT_TRUE(r.converged);
    const Points f = reactions(mesh, elements, load, x);
    double force = 0.0;
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.nodes(2, i) > 0.5e-3 - 1e-9) force += f(2, i);
    EXPECT_NEAR(force / (law.mu * (stretch - 1.0 / (stretch * stretch)) * area), 1.0, 2e-3) << stretch;
  }
}

TEST(VesselWallStatic, ReportsWhatCannotBeSolved) {
  const VesselMesh mesh = make_tube({});
  const WallElements elements(mesh, {{"wall", 1e-4, WallLaw::hooke(1e5, 0.4)}});
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 1);
  Points x = mesh.nodes;
  x.row(0) *= -1.0;  // inside out
  EXPECT_FALSE(solve_static(mesh, elements, load, x, 1e-10).converged);
}

}  // namespace vessel_wall_static_test
