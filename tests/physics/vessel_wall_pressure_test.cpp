#include "physics/vessel_wall_pressure.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/rng.h"

using namespace filum;

namespace vessel_wall_pressure_test {

TEST(VesselWallPressure, PushesOutwardWithTheLumensArea) {
  const VesselMesh mesh = make_tube({});
  Points f = Points::Zero(3, mesh.n_nodes());
  const std::array<double, 1> p = {13332.0};
  add_pressure_forces(mesh, p, mesh.nodes, f);
  double outward = 0.0;
  for (int i = 0; i < mesh.n_nodes(); ++i) outward += f.col(i).head<2>().dot(mesh.nodes.col(i).head<2>().normalized());
  EXPECT_NEAR(outward / (13332.0 * 24.0 * std::sin(std::numbers::pi / 12.0) * 0.35e-3 * 3e-3), 1.0, 1e-9);  // of a 24-gon
  EXPECT_LT(f.rowwise().sum().norm(), 1e-12);
}

TEST(VesselWallPressure, StiffnessIsMinusDerivativeOfForce) {
  VesselMesh mesh = make_tube({});
  Rng rng(5);
  for (int i = 0; i < mesh.nodes.size(); ++i) mesh.nodes.data()[i] += 1e-5 * rng.normal();
  const std::array<double, 1> p = {1e4};
  WallFace face;
  for (const WallFace& f : mesh.faces)
    if (f.surface == WallSurface::inner) face = f;
  mesh.faces = {face};
  const auto K = pressure_stiffness(mesh, face, p[0], mesh.nodes);
  const auto node = [&](int c) { return mesh.elements[static_cast<std::size_t>(face.element)][static_cast<std::size_t>(face.corner[static_cast<std::size_t>(c)])]; };
  for (int k = 0; k < 12; ++k) {
    Points up = mesh.nodes, down = mesh.nodes, fu = Points::Zero(3, mesh.n_nodes()), fd = fu;
    up(k % 3, node(k / 3)) += 1e-8;
    down(k % 3, node(k / 3)) -= 1e-8;
    add_pressure_forces(mesh, p, up, fu);
    add_pressure_forces(mesh, p, down, fd);
    for (int j = 0; j < 12; ++j) EXPECT_NEAR(-(fu - fd)(j % 3, node(j / 3)) / 2e-8, K(j, k), 1e-6 * K.cwiseAbs().maxCoeff());
  }
}

TEST(VesselWallPressure, LumenOfAPolygonalTubeWhereverItLies) {
  TubeShape s;
  VesselMesh mesh;
  append(mesh, make_tube(s), {});
  append(mesh, make_tube(s), {Vec3(0.03, 0.01, 0.02), Quat(Eigen::AngleAxisd(0.7, Vec3(1, 1, 0).normalized()))});
  const double exact = 12.0 * std::sin(std::numbers::pi / 12.0) * 0.35e-3 * 0.35e-3 * 3e-3;
  EXPECT_NEAR(lumen_volume(mesh, 0, mesh.nodes) / exact, 1.0, 1e-9);
  EXPECT_NEAR(lumen_volume(mesh, 1, mesh.nodes) / exact, 1.0, 1e-9);
}

}  // namespace vessel_wall_pressure_test
