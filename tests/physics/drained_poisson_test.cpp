#include <gtest/gtest.h>

#include "physics/pore_flow.h"

namespace filum {
namespace drained_poisson_test {

/// The law's drained moduli lose just the share that was asked for: Young's modulus in a block.
TEST(DrainedPoisson, BlockLosesItsShareOfYoungsModulus) {
  const FemMaterial sudden{3e3, 0.48, 1000.0};
  for (const double share : {0.01, 0.1, 0.3}) {
    const PoreLaw law = pore_law(sudden, {1e-9, poisson_by_block(share, sudden.poisson)}, "test");
    EXPECT_NEAR(law.drained.young / sudden.young, 1.0 - share, 1e-12);
  }
  EXPECT_NEAR(poisson_by_block(0.0, 0.48), 0.48, 1e-15) << "nothing drains";
}

/// E/(1 - nu^2), which a flat punch on a half space meets.
TEST(DrainedPoisson, PunchLosesItsShareOfThePlaneStrainModulus) {
  const FemMaterial sudden{3e3, 0.48, 1000.0};
  for (const double share : {0.01, 0.1, 0.3}) {
    const PoreLaw law = pore_law(sudden, {1e-9, poisson_by_punch(share, sudden.poisson)}, "test");
    const auto modulus = [](const FemMaterial& m) { return m.young / (1.0 - m.poisson * m.poisson); };
    EXPECT_NEAR(modulus(law.drained) / modulus(sudden), 1.0 - share, 1e-12);
  }
}

/// No tissue loses 95 % by drainage alone; what is asked for is kept where a law can be made of it.
TEST(DrainedPoisson, PunchStaysWhereALawCanBeMadeOfIt) {
  const double poisson = poisson_by_punch(0.95, 0.48);
  EXPECT_EQ(poisson, -0.9);
  EXPECT_NO_THROW(pore_law({3e3, 0.48, 1000.0}, {1e-9, poisson}, "test"));
}

}  // namespace drained_poisson_test
}  // namespace filum
