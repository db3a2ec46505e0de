#include "physics/wall_overlay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/vessel_wall_static.h"

using namespace filum;

namespace wall_overlay_test {

const std::vector<WallLayer> kRubber = {{"wall", 1e-4, WallLaw::hooke(300e3, 0.4)}};

TEST(WallOverlay, HomogeneousStrainIsExactAndTurningIsNone) {
  TubeShape shape;
  shape.around = 12;
  shape.along = 4;
  const VesselMesh mesh = make_tube(shape);
  const WallOverlay overlay(mesh, kRubber, mesh.nodes);
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Mat3 stretch = Vec3(0.9, 1.05, 1.3).asDiagonal();
  std::vector<double> strain;
  overlay.strain(turn * mesh.nodes, strain);
  for (const double s : strain) EXPECT_NEAR(s, 0.0, 1e-12);
  overlay.strain(turn * stretch * mesh.nodes, strain);
  for (const double s : strain) EXPECT_NEAR(s, 0.3, 1e-12);
}

TEST(WallOverlay, StrainIsThatOfTheElementsRound) {
  TubeShape shape;
  shape.around = 12;
  shape.along = 4;
  const VesselMesh mesh = make_tube(shape);
  const WallOverlay overlay(mesh, kRubber, mesh.nodes);
  Points x = mesh.nodes;
  const double half = 0.5 * shape.length;
  for (int i = 0; i < mesh.n_nodes(); ++i) x(2, i) = half + (x(2, i) > half ? 1.2 : 1.0) * (x(2, i) - half);
  std::vector<double> strain;
  overlay.strain(x, strain);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const double z = mesh.nodes(2, i), expected = z > half + 1e-6 ? 0.2 : z < half - 1e-6 ? 0.0 : 0.1;
    EXPECT_NEAR(strain[static_cast<std::size_t>(i)], expected, 1e-12);
  }
}

TEST(WallOverlay, PressureOfALumenIsFoundOnItsWallAndNowhereElse) {
  TubeShape shape;
  shape.around = 16;
  shape.along = 8;
  const VesselMesh mesh = make_tube(shape);
  const double kPressure = 8e3;  // [Pa]
  const WallElements elements(mesh, kRubber);
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 0);
  for (const int i : mesh.held)
    for (int c = 0; c < 3; ++c) load.fixed[static_cast<std::size_t>(3 * i + c)] = 1;
  load.pressure = {kPressure};
  Points x = mesh.nodes;
  ASSERT_TRUE(solve_static(mesh, elements, load, x, 1e-11).converged);
  std::vector<double> pressure;
  WallOverlay(mesh, kRubber, mesh.nodes).pressure(x, pressure);
  int inner = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (mesh.nodes(2, i) < 1e-6 || mesh.nodes(2, i) > shape.length - 1e-6) continue;  // clamp, rim
    const bool inside = mesh.nodes.col(i).head<2>().norm() < shape.inner_radius + 0.1 * shape.thickness;
    inner += inside ? 1 : 0;
    EXPECT_NEAR(pressure[static_cast<std::size_t>(i)], inside ? kPressure : 0.0, 1.0);
  }
  EXPECT_EQ(inner, 16 * 7);
  for (const int i : mesh.held) EXPECT_EQ(pressure[static_cast<std::size_t>(i)], 0.0);
}

}  // namespace wall_overlay_test
