#include "training/knot_invariant.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

namespace filum {
namespace knot_invariant_test {

/// Diagram of a closed braid (it must close to one component), crossing by crossing.
KnotDiagram braid(int strands, const std::vector<int>& word) {
  KnotDiagram diagram;
  for (int letter : word) diagram.sign.push_back(letter > 0 ? 1 : -1);
  for (int lane = 0, turn = 0; turn < strands; ++turn) {
    for (std::size_t k = 0; k < word.size(); ++k) {
      const int low = std::abs(word[k]) - 1;
      if (lane != low && lane != low + 1) continue;
      const bool rises = lane == low;
      diagram.code.push_back({static_cast<int>(k), rises == (word[k] > 0)});
      lane = rises ? low + 1 : low;
    }
  }
  return diagram;
}

Laurent poly(int low, std::vector<std::int64_t> c) {
  return Laurent(low, std::move(c));
}

// Jones and Alexander polynomials as tabulated (Rolfsen names; Jones 1985; KnotInfo's braids). A table gives
// one hand.
struct Known {
  const char* name;
  int strands;
  std::vector<int> word;
  Laurent jones;
  std::vector<std::int64_t> alexander;
};

const std::vector<Known>& known() {
  static const std::vector<Known> kKnown = {
      {"3_1", 2, {1, 1, 1}, poly(1, {1, 0, 1, -1}), {1, -1, 1}},
      {"4_1", 3, {1, -2, 1, -2}, poly(-2, {1, -1, 1, -1, 1}), {-1, 3, -1}},
      {"5_1", 2, {1, 1, 1, 1, 1}, poly(2, {1, 0, 1, -1, 1, -1}), {1, -1, 1, -1, 1}},
      {"5_2", 3, {1, 1, 1, 2, -1, 2}, poly(1, {1, -1, 2, -1, 1, -1}), {2, -3, 2}},
      {"6_1", 4, {1, 1, 2, -1, -3, 2, -3}, poly(-2, {1, -1, 2, -2, 1, -1, 1}), {-2, 5, -2}},
      {"6_2", 3, {1, 1, 1, -2, 1, -2}, poly(-1, {1, -1, 2, -2, 2, -2, 1}), {-1, 3, -3, 3, -1}},
      {"8_19", 3, {1, 1, 1, 2, 1, 1, 1, 2}, poly(3, {1, 0, 1, 0, 0, -1}), {1, -1, 0, 1, 0, -1, 1}},
      {"8_20", 3, {1, 1, 1, -2, -1, -1, -1, -2}, poly(-1, {-1, 2, -1, 2, -1, 1, -1}), {1, -2, 3, -2, 1}},
  };
  return kKnown;
}

TEST(KnotInvariant, AgreesWithTheTables) {
  for (const Known& k : known()) {
    const KnotDiagram diagram = braid(k.strands, k.word);
    const Laurent jones = jones_polynomial(diagram);
    EXPECT_TRUE(jones == k.jones || jones == k.jones.mirrored()) << k.name << ": " << jones.text("t");
    EXPECT_EQ(alexander_polynomial(diagram).text("t"), poly(0, k.alexander).text("t")) << k.name;
  }
}

TEST(KnotInvariant, RightHandedTrefoil) {
  EXPECT_EQ(jones_polynomial(braid(2, {1, 1, 1})).text("t"), "t + t^3 - t^4");
  EXPECT_EQ(jones_polynomial(braid(2, {-1, -1, -1})).text("t"), "-t^-4 + t^-3 + t^-1");
  EXPECT_EQ(jones_torus(3), jones_polynomial(braid(2, {1, 1, 1})));
}

TEST(KnotInvariant, TorusKnotsByFormula) {
  for (int k = 3; k <= 45; k += 2) {
    const KnotDiagram right = braid(2, std::vector<int>(static_cast<std::size_t>(k), 1));
    EXPECT_EQ(jones_polynomial(right), jones_torus(k)) << k;
    EXPECT_EQ(std::abs(alexander_polynomial(right).at_minus_one()), k);
  }
}

TEST(KnotInvariant, MultipliesOverConnectedSums) {
  const Laurent v3 = jones_torus(3), m3 = jones_torus(-3), v5 = jones_torus(5);
  EXPECT_EQ(jones_polynomial(braid(3, {1, 1, 1, 2, 2, 2})), v3 * v3);
  EXPECT_EQ(jones_polynomial(braid(3, {1, 1, 1, -2, -2, -2})), v3 * m3);
  EXPECT_EQ(jones_polynomial(braid(3, {1, 1, 1, 1, 1, -2, -2, -2})), v5 * m3);
  EXPECT_FALSE(v3 * v3 == v3 * m3);
  EXPECT_EQ(alexander_polynomial(braid(3, {1, 1, 1, 2, 2, 2})),
            alexander_polynomial(braid(3, {1, 1, 1, -2, -2, -2})));
}

TEST(KnotInvariant, DeterminantFromBothPolynomials) {
  for (const Known& k : known()) {
    const KnotDiagram diagram = braid(k.strands, k.word);
    EXPECT_EQ(std::abs(jones_polynomial(diagram).at_minus_one()),
              std::abs(alexander_polynomial(diagram).at_minus_one()))
        << k.name;
  }
}

TEST(KnotInvariant, FortyAndMoreCrossings) {
  // T(4,15): 45 crossings, width 8. V(T(p,q)) = t^((p-1)(q-1)/2) (1 - t^(p+1) - t^(q+1) + t^(p+q)) / (1 -
  // t^2).
  std::vector<int> word;
  for (int k = 0; k < 15; ++k) word.insert(word.end(), {1, 2, 3});
  Laurent numerator = poly(0, {1});
  numerator += Laurent::monomial(-1, 5);
  numerator += Laurent::monomial(-1, 16);
  numerator += Laurent::monomial(1, 19);
  EXPECT_EQ(jones_polynomial(braid(4, word)), numerator.divided(poly(0, {1, 0, -1})).shifted(21));
}

TEST(KnotInvariant, RefusesMoreThanItCanHold) {
  const KnotDiagram huge = braid(2, std::vector<int>(65, 1));
  EXPECT_TRUE(jones_polynomial(huge).zero());
  EXPECT_TRUE(alexander_polynomial(huge).zero());
}

TEST(KnotInvariant, NoCrossingsIsTheUnknot) {
  EXPECT_EQ(jones_polynomial(KnotDiagram()), Laurent::monomial(1, 0));
  EXPECT_EQ(jones_polynomial(braid(3, {1, -2})), Laurent::monomial(1, 0));
}

}  // namespace knot_invariant_test
}  // namespace filum
