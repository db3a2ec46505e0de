#include "physics/vessel_wall_wide.h"

#include <gtest/gtest.h>

#include "physics/vessel_wall_element.h"

using namespace filum;

namespace vessel_wall_wide_test {

/// A layered artery of 7 x 5 elements, which fill neither eight lanes nor sixteen.
VesselMesh tube() {
  TubeShape shape;
  shape.around = 7;
  shape.along = 5;
  return make_tube(shape);
}

std::vector<WallLayer> layers() {
  WallLaw inner, outer;
  inner.kind = WallLaw::Kind::neo_hookean;
  inner.mu = 30e3;
  inner.lambda = 2e6;
  outer = inner;
  outer.kind = WallLaw::Kind::fibres;
  outer.k1 = 30e3;
  outer.k2 = 0.84;
  outer.beta = 0.5;
  return {{"inner", 0.04e-3, inner}, {"outer", 0.06e-3, outer}};
}

/// Stretched, squeezed and sheared by `share`, every node otherwise.
Points moved(const Points& x, double share) {
  Points out = x;
  for (int i = 0; i < x.cols(); ++i) out.col(i) += share * 0.05e-3 * Vec3(std::sin(1.7 * i), std::cos(2.3 * i), std::sin(0.9 * i + 1.0)) + share * 0.3 * Vec3(0, 0, x(2, i));
  return out;
}

TEST(VesselWallWide, GivesTheSameBitsAsEightAtATime) {
  if (!has_wide_lanes()) GTEST_SKIP() << "this processor, or this build, has no registers of 512 bits";
  const VesselMesh mesh = tube();
  const WallElements eight(mesh, layers(), true, false), sixteen(mesh, layers(), true, true);
  std::vector<double> soundness(mesh.elements.size(), 1.0);
  soundness[3] = 0.0;
  soundness[11] = 0.37;
  for (const double share : {0.0, 0.1, 0.5, -0.5}) {
    const Points x = moved(mesh.nodes, share);
    Points a = Points::Zero(3, x.cols()), b = a;
    const double of_eight = eight.add_forces(x, soundness, a), of_sixteen = sixteen.add_forces(x, soundness, b);
    EXPECT_EQ(of_eight, of_sixteen) << share;
    EXPECT_TRUE((a.array() == b.array()).all()) << share << ": " << (a - b).cwiseAbs().maxCoeff() << " N";
    EXPECT_TRUE(std::isfinite(of_eight)) << share;
    if (share != 0.0) {
      EXPECT_GT(a.cwiseAbs().maxCoeff(), 1e-5);
    }
  }
}

TEST(VesselWallWide, InsideOutIsRefusedToo) {
  if (!has_wide_lanes()) GTEST_SKIP() << "this processor, or this build, has no registers of 512 bits";
  const VesselMesh mesh = tube();
  const WallElements sixteen(mesh, layers(), true, true);
  Points x = mesh.nodes, force = Points::Zero(3, x.cols());
  x.col(mesh.elements[34][7]) -= 1e-3 * Vec3::UnitZ();
  EXPECT_EQ(sixteen.add_forces(x, std::vector<double>(mesh.elements.size(), 1.0), force), std::numeric_limits<double>::infinity());
}

}  // namespace vessel_wall_wide_test
