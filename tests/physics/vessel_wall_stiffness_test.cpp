// The matrix against differences of the forces, and layers: vessel_wall_element_test.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/rng.h"
#include "physics/vessel_wall_element.h"

namespace filum {
namespace vessel_wall_stiffness_test {

WallLaw fibres() {
  WallLaw law;
  law.kind = WallLaw::Kind::fibres;
  law.mu = 30e3;
  law.lambda = 2e6;
  law.k1 = 20e3;
  law.k2 = 0.84;
  law.beta = 0.5;
  return law;
}

VesselMesh small_card() {
  CardShape shape;
  shape.width = 1e-3;
  shape.depth = 0.8e-3;
  shape.thickness = 0.1e-3;
  shape.across = 3;
  shape.deep = 2;
  return make_card(shape);
}

const Mat3 kTurn = Eigen::AngleAxisd(0.9, Vec3(2, -1, 3).normalized()).toRotationMatrix();

TEST(VesselWallStiffness, EnergiesOfElementsAddUpToTheWalls) {
  TubeShape shape;
  shape.opening_angle = 1.0;
  shape.around = 9;
  shape.along = 3;
  const VesselMesh mesh = make_tube(shape);
  const WallElements elements(mesh, {{"media", 6e-5, fibres()}, {"adventitia", 4e-5, WallLaw::hooke(100e3, 0.4)}});
  Points x = mesh.nodes, f = Points::Zero(3, mesh.n_nodes());
  Rng rng(6);
  for (int i = 0; i < x.size(); ++i) x.data()[i] += 5e-6 * rng.normal();
  double sum = 0.0;
  for (int e = 0; e < mesh.n_elements(); ++e) sum += elements.energy(e, x);
  EXPECT_NEAR(elements.add_forces(x, std::vector<double>(static_cast<std::size_t>(mesh.n_elements()), 1.0), f) / sum, 1.0, 1e-12);
}

TEST(VesselWallStiffness, StretchesAreThoseOfTheWallsOwnDirections) {
  const VesselMesh mesh = small_card();
  const WallElements elements(mesh, {{"wall", 1e-4, fibres()}});
  const WallElements::Strain s = elements.strain(3, kTurn * Vec3(1.2, 0.9, 1.1).asDiagonal() * mesh.nodes);
  EXPECT_NEAR(s.around, 1.2, 1e-12);
  EXPECT_NEAR(s.along, 0.9, 1e-12);
  EXPECT_NEAR(s.through, 1.1, 1e-12);
  EXPECT_NEAR(s.J, 1.2 * 0.9 * 1.1, 1e-12);
}

/// Slack fibres (of two families, at beta to either side of around) add nothing to the stiffness; counted as taut they add d2/de2 of their energy for a
/// strain e around, 2 k1 (2 cos^2 beta)^2 a volume. Where they are taut nothing changes.
TEST(VesselWallStiffness, TautCountsFibresWhereTheyAreSlack) {
  const VesselMesh mesh = small_card();
  const WallLaw law = fibres();
  const WallElements elements(mesh, {{"wall", 1e-4, law}});
  const auto added = [&](double stretch) {
    const Points x = Vec3(stretch, stretch, 1.0).asDiagonal() * mesh.nodes;
    const WallElements::Stiffness more = elements.stiffness(2, x, true) - elements.stiffness(2, x);
    Eigen::Matrix<double, 24, 1> around = Eigen::Matrix<double, 24, 1>::Zero();
    for (int a = 0; a < 8; ++a) around[3 * a] = mesh.nodes(0, mesh.elements[2][static_cast<std::size_t>(a)]);
    return around.dot(more * around) / elements.volume(2);
  };
  EXPECT_EQ(added(1.05), 0.0);
  EXPECT_NEAR(added(1.0 - 1e-6) / (2.0 * law.k1 * std::pow(2.0 * std::pow(std::cos(law.beta), 2), 2)), 1.0, 1e-5);  // the shape's change and its square
}

/// lambda tr(e) 1 + 2 mu e at small strain e, wherever in the element, and in the frame of what is seen.
TEST(VesselWallStiffness, StressIsHookesInTheFrameOfTheShape) {
  const double E = 100e3, nu = 0.4, mu = E / (2.0 * (1.0 + nu)), lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const VesselMesh mesh = small_card();
  const WallElements elements(mesh, {{"wall", 1e-4, WallLaw::hooke(E, nu)}});
  const double size = 1e-6;
  Mat3 e;
  e << 2.0, 0.7, 0.3, 0.7, -1.0, 0.4, 0.3, 0.4, 1.5;
  e *= size;
  const Mat3 law = lambda * e.trace() * Mat3::Identity() + 2.0 * mu * e, seen = kTurn * law * kTurn.transpose();
  const Points x = kTurn * (Mat3::Identity() + e) * mesh.nodes;
  for (const Vec3& local : {Vec3(0, 0, 0), Vec3(0.6, -0.9, 0.8)})
    EXPECT_LT((elements.stress(4, local, x) - seen).norm(), 20.0 * size * seen.norm());  // what is left is of second order
}

/// Under large even strain the forces on an element's corners make its virial: sum of x (-f)^T = volume times Cauchy's stress.
TEST(VesselWallStiffness, StressIsThatOfTheForces) {
  const VesselMesh mesh = small_card();
  const WallElements elements(mesh, {{"wall", 1e-4, fibres()}});
  Mat3 F;
  F << 1.3, 0.2, 0.0, 0.1, 0.95, 0.1, 0.0, 0.05, 0.85;
  const Points x = kTurn * F * mesh.nodes;
  std::vector<double> only(static_cast<std::size_t>(mesh.n_elements()), 0.0);
  only[4] = 1.0;
  Points f = Points::Zero(3, mesh.n_nodes());
  elements.add_forces(x, only, f);
  const Mat3 stress = -(x * f.transpose()) / (elements.volume(4) * F.determinant());
  EXPECT_LT((elements.stress(4, Vec3(-0.2, 0.5, 0.1), x) - stress).norm(), 1e-9 * stress.norm());
}

TEST(VesselWallStiffness, CornerWeightsCarryAnyTrilinearField) {
  const Vec3 local(0.3, -0.7, 0.9);
  const auto w = corner_weights(local);
  const auto field = [](const Vec3& l) { return 2.0 + l.x() - 3.0 * l.y() * l.z() + 4.0 * l.x() * l.y() * l.z(); };
  double sum = 0.0;
  for (int a = 0; a < 8; ++a) sum += w[a] * field(Vec3(a & 1 ? 1 : -1, a & 2 ? 1 : -1, a & 4 ? 1 : -1));
  EXPECT_NEAR(sum, field(local), 1e-14);
}

}  // namespace vessel_wall_stiffness_test
}  // namespace filum
