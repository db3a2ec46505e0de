#include "physics/vessel_wall_element.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/rng.h"

using namespace filum;

namespace vessel_wall_element_test {

std::vector<WallLayer> three_layers() {
  WallLaw media;
  media.kind = WallLaw::Kind::fibres;
  media.mu = 30e3;
  media.lambda = 2e6;
  media.k1 = 20e3;
  media.k2 = 0.84;
  media.beta = 0.5;
  WallLaw adventitia = media;
  adventitia.kind = WallLaw::Kind::neo_hookean;
  return {{"intima", 1e-5, WallLaw::hooke(100e3, 0.4)}, {"media", 5e-5, media}, {"adventitia", 4e-5, adventitia}};
}

struct Shaken {
  VesselMesh mesh;
  Points x;
  std::vector<double> sound;
  explicit Shaken(int through = 1) {
    TubeShape s;
    s.opening_angle = 1.0;
    s.stretch = 1.3;
    s.around = 9;
    s.along = 3;
    s.length = 0.8e-3;
    s.through = through;
    mesh = make_tube(s);
    x = mesh.nodes;
    Rng rng(3);
    for (int i = 0; i < x.size(); ++i) x.data()[i] += 5e-6 * rng.normal();
    sound.assign(static_cast<std::size_t>(mesh.n_elements()), 1.0);
  }
};

TEST(VesselWallElement, ForceIsMinusGradientOfEnergy) {
  for (const int through : {1, 2}) {
    Shaken s(through);
    const WallElements elements(s.mesh, three_layers());
    Points f = Points::Zero(3, s.x.cols()), scratch = f;
    elements.add_forces(s.x, s.sound, f);
    constexpr double kStep = 1e-10;
    for (int i = 0; i < s.x.size(); i += 7) {
      Points up = s.x, down = s.x;
      up.data()[i] += kStep;
      down.data()[i] -= kStep;
      const double slope = (elements.add_forces(up, s.sound, scratch) - elements.add_forces(down, s.sound, scratch)) / (2.0 * kStep);
      EXPECT_NEAR(-slope, f.data()[i], 1e-6 * f.cwiseAbs().maxCoeff()) << i;
    }
  }
}

TEST(VesselWallElement, StiffnessIsMinusDerivativeOfForceAndSymmetric) {
  Shaken s;
  const WallElements elements(s.mesh, three_layers());
  for (const int e : {0, 13}) {
    const auto K = elements.stiffness(e, s.x);
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
    std::vector<double> only(s.sound.size(), 0.0);
    only[static_cast<std::size_t>(e)] = 1.0;
    const auto& nodes = s.mesh.elements[static_cast<std::size_t>(e)];
    for (int k = 0; k < 24; ++k) {
      Points up = s.x, down = s.x, fu = Points::Zero(3, s.x.cols()), fd = fu;
      up(k % 3, nodes[static_cast<std::size_t>(k / 3)]) += 1e-10;
      down(k % 3, nodes[static_cast<std::size_t>(k / 3)]) -= 1e-10;
      elements.add_forces(up, only, fu);
      elements.add_forces(down, only, fd);
      for (int j = 0; j < 24; ++j)
        EXPECT_NEAR(-(fu - fd)(j % 3, nodes[static_cast<std::size_t>(j / 3)]) / 2e-10, K(j, k), 1e-6 * K.cwiseAbs().maxCoeff());
    }
  }
}

TEST(VesselWallElement, SinglePrecisionAgrees) {
  Shaken s;
  const WallElements exact(s.mesh, three_layers()), quick(s.mesh, three_layers(), true);
  Points f = Points::Zero(3, s.x.cols()), g = f;
  const double a = exact.add_forces(s.x, s.sound, f), b = quick.add_forces(s.x, s.sound, g);
  EXPECT_NEAR(b / a, 1.0, 1e-5);
  EXPECT_LT((f - g).cwiseAbs().maxCoeff(), 2e-5 * f.cwiseAbs().maxCoeff());
  EXPECT_NE(a, b);
}

TEST(VesselWallElement, NoForceAtRestNorByRigidMotion) {
  TubeShape shape;
  const VesselMesh mesh = make_tube(shape);
  const WallElements elements(mesh, three_layers());
  const std::vector<double> sound(static_cast<std::size_t>(mesh.n_elements()), 1.0);
  const Pose X{Vec3(0.01, -0.02, 0.03), Quat(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()))};
  Points moved = mesh.nodes, f = Points::Zero(3, mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) moved.col(i) = X * Vec3(mesh.nodes.col(i));
  EXPECT_NEAR(elements.add_forces(moved, sound, f), 0.0, 1e-19);  // [J], of 1e-5 J that a strain of 1 would store
  EXPECT_LT(f.cwiseAbs().maxCoeff(), 1e-11);
}

TEST(VesselWallElement, InsideOutIsRefusedAndAnElementThatIsGoneIsNot) {
  Shaken s;
  const WallElements elements(s.mesh, three_layers());
  const auto& nodes = s.mesh.elements[5];
  for (std::size_t a = 0; a < 4; ++a) s.x.col(nodes[a]).swap(s.x.col(nodes[a + 4]));
  Points f = Points::Zero(3, s.x.cols());
  EXPECT_TRUE(std::isinf(elements.add_forces(s.x, s.sound, f)));
  std::vector<double> gone(s.sound.size(), 0.0);
  EXPECT_EQ(elements.add_forces(s.x, gone, f), 0.0);
}

/// A bent strip of one incompressible element through its thickness has the bending moment of plane strain, E/(1-nu^2) I kappa = 4 mu I kappa.
TEST(VesselWallElement, BendsAsAnIncompressiblePlate) {
  CardShape shape;
  shape.width = 1e-3;
  shape.depth = 1e-3;
  shape.thickness = 0.1e-3;
  shape.across = shape.deep = 10;
  const VesselMesh mesh = make_card(shape);
  WallLaw law;
  law.kind = WallLaw::Kind::neo_hookean;
  law.mu = 100e3;
  law.lambda = 100e6;
  const WallElements elements(mesh, {{"wall", 1e-4, law}});
  Points x = mesh.nodes, f = Points::Zero(3, mesh.n_nodes());
  const double kappa = 20.0;  // [1/m], about x
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const double y = mesh.nodes(1, i) + 5e-4, z = mesh.nodes(2, i), angle = kappa * y;
    x.col(i) = Vec3(mesh.nodes(0, i), (1.0 / kappa + z) * std::sin(angle), (1.0 / kappa + z) * std::cos(angle) - 1.0 / kappa);
  }
  const std::vector<double> sound(static_cast<std::size_t>(mesh.n_elements()), 1.0);
  const double energy = elements.add_forces(x, sound, f), I = 1e-3 * 1e-12 / 12.0;
  EXPECT_NEAR(energy / (0.5 * 4.0 * law.mu * I * kappa * kappa * 1e-3), 1.0, 0.01);
}

TEST(VesselWallElement, LayersAndStress) {
  const VesselMesh mesh = make_tube({});
  const WallElements elements(mesh, three_layers());
  EXPECT_EQ(elements.layer_at(0, -0.95), 0);
  EXPECT_EQ(elements.layer_at(0, 0.0), 1);
  EXPECT_EQ(elements.layer_at(0, 0.5), 2);
  // uniaxial stretch along z of the neo-Hookean adventitia: sigma_zz at fixed cross-section = mu(l - 1/l) + terms in J; compare with forces
  Points x = mesh.nodes;
  x.row(2) *= 1.01;
  Points f = Points::Zero(3, mesh.n_nodes());
  elements.add_forces(x, std::vector<double>(static_cast<std::size_t>(mesh.n_elements()), 1.0), f);
  double force = 0.0, by_stress = 0.0;
  for (int i = mesh.n_nodes() - 48; i < mesh.n_nodes(); ++i) force -= f(2, i);
  const int e = mesh.n_elements() - 1;
  for (int k = 0; k < 200; ++k) {
    const double zeta = -1.0 + (k + 0.5) / 100.0, r = 0.4e-3 + 0.05e-3 * zeta;
    by_stress += elements.stress(e, Vec3(0, 0, zeta), x)(2, 2) * 2.0 * M_PI * r * 1e-4 / 200.0;
  }
  EXPECT_NEAR(force / by_stress, 1.0, 0.02);
}

}  // namespace vessel_wall_element_test
