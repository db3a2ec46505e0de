// The elements' law against its closed form in a block that is stretched by e along z and keeps its volume: dev(eps) = (-e/2, -e/2, e), J = 3 e^2.

#include "physics/tissue_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace filum {
namespace tissue_law_test {

constexpr double kYoung = 3e3, kPoisson = 0.45, kG = kYoung / (2.0 * (1.0 + kPoisson));

struct Block {
  explicit Block(const TissueLaw& law) : mesh(box_mesh(Vec3::Zero(), Vec3(2e-3, 3e-3, 4e-3), 2, 3, 3)), elements(mesh, {{kYoung, kPoisson, 1000.0}}, law), memory(elements.start()) {}
  Points stretched(double e) const {
    Points u = mesh.nodes;
    u.row(0) *= -0.5 * e;
    u.row(1) *= -0.5 * e;
    u.row(2) *= e;
    return u;
  }
  /// Stress along z that the law has beyond the linear element [Pa].
  double beyond(double e) const {
    Points loads = Points::Zero(3, mesh.n_nodes());
    elements.push(stretched(e), memory, std::vector<char>(mesh.tets.size(), 0), loads);
    double sum = 0.0;
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.nodes(2, i) > 4e-3 - 1e-9) sum -= loads(2, i);
    EXPECT_LT(loads.rowwise().sum().norm(), 1e-12);  // of the elements on one another
    return sum / 6e-6;
  }
  void remember(double e) { elements.remember(stretched(e), memory); }
  TetMesh mesh;
  ElementLaw elements;
  TissueMemory memory;
};

TEST(TissueLaw, StiffensAsYeohAndDemiray) {
  TissueLaw law;
  law.stiffening = 4.0;
  for (const double e : {-0.1, 0.05, 0.2}) {
    law.exponential = false;
    EXPECT_NEAR(Block(law).beyond(e), 2.0 * kG * e * 2.0 * 4.0 * 3.0 * e * e, 1e-9);
    law.exponential = true;
    EXPECT_NEAR(Block(law).beyond(e), 2.0 * kG * e * std::expm1(2.0 * 4.0 * 3.0 * e * e), 1e-9);
    law.limit = 1.01;
    EXPECT_LE(std::abs(Block(law).beyond(e)), 2.0 * kG * std::abs(e) * 0.0101);
    law.limit = INFINITY;
  }
}

/// Stretched by e the block has 2G/(2/3 E) times what the uniaxial law has more: closed form at both signs, whatever the form; without it nothing.
TEST(TissueLaw, IsStifferInCompressionAsOgden) {
  TissueLaw law;
  EXPECT_TRUE(law.linear());
  for (const int form : {0, 1, 2})
    for (const double alpha : {-8.0, -20.0})
      for (const double e : {-0.1, -0.03, 0.04, 0.1}) {
        law.asymmetry = alpha;
        law.asymmetry_form = form;
        const double l = 1.0 + e, ogden = 2.0 / (3.0 * alpha) * (std::pow(l, alpha - 1.0) - std::pow(l, -0.5 * alpha - 1.0)) - e, b = 0.25 * alpha - 1.5;
        const double more = form == 0 ? ogden : form == 1 ? b * e * e : 0.1 * b * std::abs(e);
        EXPECT_NEAR(Block(law).beyond(e) / (2.0 * kG), more, 2e-3 * std::abs(more) + 1e-9) << form << " " << alpha << " " << e;  // chords of the table
      }
  law.asymmetry_form = 0;
  law.limit = 3.0;  // h has a slope of two at most where it is stiffer
  EXPECT_LT(Block(law).beyond(-0.1) / (2.0 * kG), -0.03);
  EXPECT_GT(Block(law).beyond(-0.1) / (2.0 * kG), -0.2 / 3.0);
}

TEST(TissueLaw, SoftensBelowTheLargestPastStrainOnly) {
  TissueLaw law;
  law.softening = 0.3;
  law.softening_energy = 2e-3;
  for (const int form : {0, 1, 2}) {
    law.softening_form = form;
    Block b(law);
    EXPECT_NEAR(b.beyond(0.1), 0.0, 1e-9);
    b.remember(0.1);
    EXPECT_NEAR(b.beyond(0.1), 0.0, 1e-9);
    const double x = kG * 1.5 * (0.1 * 0.1 - 0.06 * 0.06) / (2e-3 * kYoung);
    EXPECT_NEAR(b.beyond(0.06), -2.0 * kG * 0.06 * 0.3 * softening_share(x, form), 1e-9);
    b.remember(0.06);
    EXPECT_NEAR(b.beyond(-0.06), 2.0 * kG * 0.06 * 0.3 * softening_share(x, form), 1e-9);
  }
}

TEST(TissueLaw, SetsByAShareOfTheLargestPastStrain) {
  TissueLaw law;
  law.set = 0.2;
  Block b(law);
  b.remember(0.1);
  b.remember(-0.05);
  EXPECT_NEAR(b.beyond(0.0), -2.0 * kG * 0.02, 1e-9);
  EXPECT_NEAR(b.beyond(0.07), -2.0 * kG * 0.02, 1e-9);
  law.set_strain = 0.2;  // grows with the peak: half of it at 0.1
  Block grown(law);
  grown.remember(0.1);
  EXPECT_NEAR(grown.beyond(0.0), -2.0 * kG * 0.01, 1e-9);
}

TEST(TissueLaw, OffAddsNothingToTheLastBit) {
  Block b({});
  b.remember(0.1);
  EXPECT_EQ(b.beyond(0.07), 0.0);
  EXPECT_NEAR(b.elements.mean_square(b.stretched(0.1)), 1.5 * 0.01, 1e-12);
}

}  // namespace tissue_law_test
}  // namespace filum
