#include "training/knot_classifier.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/training/knot_shapes.h"

namespace filum {
namespace knot_classifier_test {

using namespace shapes;

constexpr int kVariants = 1000;
constexpr double kRadius = 12e-6;  // [m], 10-0

struct Case {
  const char* name;
  std::function<Points()> shape;
  const char* knot_class;
  const char* composition;  // null: not looked at
  int enclosed;             // 1 round the post, 0 not, -1 not looked at
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

class KnownKnot : public testing::TestWithParam<Case> {};

/// 1,000 rotations (so also projections), random subdivisions and perturbations below half the strands'
/// distance.
TEST_P(KnownKnot, IsNamedRightInEveryVariant) {
  const Case& known = GetParam();
  const Points shape = known.shape();
  const double distance = strand_distance(shape);
  ASSERT_GT(distance, 1e-6);
  Rng rng(20261121);
  int wrong = 0;
  for (int k = 0; k < kVariants && wrong < 3; ++k) {
    const Points thread = varied(shape, distance, rng);
    KnotOptions options;
    options.seed = static_cast<std::uint64_t>(k + 1);
    options.closures = k % 10 == 0 ? 5 : 1;
    options.shape = known.composition != nullptr;
    const KnotReport report = classify_knot(thread, kRadius, nullptr, options);
    const bool right = report.knot_class == known.knot_class &&
                       (known.composition == nullptr || report.composition == known.composition);
    if (right) continue;
    ++wrong;
    ADD_FAILURE() << "variant " << k << ": " << report.knot_class << " [" << report.composition
                  << "], V = " << report.jones << ", " << report.note;
  }
}

TEST_P(KnownKnot, SaysWhetherThePostIsEnclosed) {
  const Case& known = GetParam();
  if (known.enclosed < 0) return;
  const PostShape bar = post();
  const KnotReport report = classify_knot(known.shape(), kRadius, &bar);
  EXPECT_EQ(report.encloses_post, known.enclosed == 1) << report.note;
  EXPECT_EQ(report.confidence, 1.0);
}

std::function<Points()> throws(std::vector<int> half_twists, double gap = 60e-6) {
  return [=] { return throws_round_post(half_twists, gap); };
}
std::function<Points()> hitches(std::vector<int> hands) {
  return [=] { return hitches_round_strand(hands); };
}
std::function<Points()> braid(int strands, std::vector<int> word) {
  return [=] { return open_braid(strands, word); };
}
constexpr double kTouching = 25e-6;  // [m], strands one diameter apart

INSTANTIATE_TEST_SUITE_P(
    Knots, KnownKnot,
    testing::Values(Case{"untied", throws({}), "unknot", "", -1},                                 //
                    Case{"overhand_right", throws({3}), "overhand", "1", 1},                      //
                    Case{"overhand_left", throws({-3}), "overhand", "1", 1},                      //
                    Case{"square", throws({3, -3}), "square", "1=1", 1},                          //
                    Case{"square_mirrored", throws({-3, 3}), "square", "1=1", 1},                 //
                    Case{"granny", throws({3, 3}), "granny", "1x1", 1},                           //
                    Case{"granny_mirrored", throws({-3, -3}), "granny", "1x1", 1},                //
                    Case{"surgeons", throws({5, -3}), "surgeons", "2=1", 1},                      //
                    Case{"surgeons_mirrored", throws({-5, 3}), "surgeons", "2=1", 1},             //
                    Case{"surgeons_reversed", throws({3, -5}), "other", "1=2", 1},                //
                    Case{"surgeons_granny", throws({5, 3}), "other", "2x1", 1},                   //
                    Case{"double_throw", throws({5}), "other", "2", 1},                           //
                    Case{"triple", throws({3, -3, 3}), "triple", "1=1=1", 1},                     //
                    Case{"triple_with_granny_below", throws({3, 3, -3}), "other", "1x1=1", 1},    //
                    Case{"triple_with_granny_above", throws({-3, 3, 3}), "other", "1=1x1", 1},    //
                    Case{"surgeons_and_one", throws({5, -3, 3}), "other", "2=1=1", 1},            //
                    Case{"square_touching", throws({3, -3}, kTouching), "square", "1=1", 1},      //
                    Case{"granny_touching", throws({-3, -3}, kTouching), "granny", "1x1", 1},     //
                    Case{"surgeons_touching", throws({5, -3}, kTouching), "surgeons", "2=1", 1},  //
                    Case{"triple_touching", throws({3, -3, 3}, kTouching), "triple", "1=1=1", 1}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(Hitches, KnownKnot,
                         testing::Values(Case{"from_square", hitches({1, -1}), "half-hitches", "1=1", 1},  //
                                         Case{"from_granny", hitches({1, 1}), "half-hitches", "1x1", 1},   //
                                         Case{"from_granny_mirrored", hitches({-1, -1}), "half-hitches",
                                              "1x1", 1},
                                         Case{"three", hitches({-1, 1, -1}), "half-hitches", "1=1=1", 1}),
                         [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Others, KnownKnot,
    testing::
        Values(Case{"trefoil_in_a_tail", braid(2, {1, 1, 1}), "overhand", nullptr, 0},  //
               Case{"figure_eight", braid(3, {1, -2, 1, -2}), "other", nullptr, -1},    //
               Case{"five_one", braid(2, {1, 1, 1, 1, 1}), "other", nullptr, -1},       //
               Case{"five_two", braid(3, {1, 1, 1, 2, -1, 2}), "other", nullptr, -1},   //
               Case{"six_one_determinant_nine", braid(4, {1, 1, 2, -1, -3, 2, -3}), "other", nullptr, -1},
               Case{"eight_twenty_alexander_of_square", braid(3, {1, 1, 1, -2, -1, -1, -1, -2}), "other",
                    nullptr, -1},
               Case{"unknot_of_mortons_braid", braid(4, {-3, -3, 2, -3, 2, 1, 1, 1, -2, 1, -2}), "unknot",
                    nullptr, -1},
               Case{
                   "unknot_doubled_trefoil",
                   [] {
                     return doubled(open_braid(2, {1, 1, 1}));
                   },
                   "unknot", nullptr, -1},
               Case{"unknot_doubled_8_19", [] { return doubled(open_braid(3, {1, 1, 1, 2, 1, 1, 1, 2})); },
                    "unknot", nullptr, -1}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(KnotClassifier, SeparatesWhatDeterminantAndAlexanderCannot) {
  const KnotReport square = classify_knot(throws_round_post({3, -3}), kRadius, nullptr);
  const KnotReport granny = classify_knot(throws_round_post({3, 3}), kRadius, nullptr);
  EXPECT_EQ(square.determinant, 9);
  EXPECT_EQ(granny.determinant, 9);
  EXPECT_EQ(square.alexander, granny.alexander);
  EXPECT_NE(square.jones, granny.jones);
}

TEST(KnotClassifier, ReportsTheHandOfEveryThrow) {
  EXPECT_EQ(classify_knot(throws_round_post({3}), kRadius, nullptr).throws, (std::vector<int>{3}));
  EXPECT_EQ(classify_knot(throws_round_post({-5, 3}), kRadius, nullptr).throws, (std::vector<int>{-5, 3}));
  EXPECT_EQ(classify_knot(throws_round_post({-3, -3, 3}), kRadius, nullptr).throws,
            (std::vector<int>{-3, -3, 3}));
}

TEST(KnotClassifier, GoodSquareKnotTurnsBothStrandsAlike) {
  const KnotReport square = classify_knot(throws_round_post({3, -3}, kTouching), kRadius, nullptr);
  EXPECT_GT(square.strand_turning[0], kStraightTurn);
  EXPECT_GT(square.strand_turning[1], kStraightTurn);
  const KnotReport slipped = classify_knot(hitches_round_strand({1, -1}), kRadius, nullptr);
  EXPECT_LT(slipped.strand_turning[0], 0.2);
  EXPECT_GT(slipped.strand_turning[1], 2.0 * kHitchTurn);
}

TEST(KnotClassifier, RefusesNonsenseWithoutThrowing) {
  Points nodes = throws_round_post({3, -3});
  nodes(1, 20) = std::nan("");
  EXPECT_EQ(classify_knot(nodes, kRadius, nullptr).knot_class, "unknot");
  EXPECT_FALSE(classify_knot(nodes, kRadius, nullptr).note.empty());
  EXPECT_FALSE(classify_knot(Points(3, 0), kRadius, nullptr).note.empty());
  EXPECT_EQ(classify_knot(Points::Zero(3, 50), kRadius, nullptr).knot_class, "unknot");
}

TEST(KnotClassifier, SameInputSameReport) {
  const Points nodes = throws_round_post({5, -3});
  EXPECT_EQ(classify_knot(nodes, kRadius, nullptr).jones, classify_knot(nodes, kRadius, nullptr).jones);
  EXPECT_EQ(classify_knot(nodes, kRadius, nullptr).n_crossings,
            classify_knot(nodes, kRadius, nullptr).n_crossings);
}

/// A first knot and what was tied beyond it with the same ends.
TEST(KnotClassifier, TheRestOfASumIsNamedByItself) {
  const auto rest = [](const std::vector<int>& all, const std::vector<int>& inner) {
    return rest_of_sum(classify_knot(shapes::throws_round_post(all), 12e-6, nullptr), classify_knot(shapes::throws_round_post(inner), 12e-6, nullptr));
  };
  const auto triple = rest({3, -3, 3, -3, 3}, {3, -3});
  ASSERT_TRUE(triple);
  EXPECT_EQ(triple->knot_class, "triple");
  EXPECT_EQ(triple->n_throws, 3);
  EXPECT_EQ(triple->composition, "1=1=1");
  EXPECT_EQ(rest({3, -3, 3, 3}, {3, -3})->knot_class, "granny");
  EXPECT_EQ(rest({3, -3, -3, 3, 3}, {3, -3})->knot_class, "other") << "1=1x1: the order was read";
  EXPECT_EQ(rest({3, -3, 3, -3, 3, -3}, {3, -3, 3})->knot_class, "triple");
  EXPECT_FALSE(rest({3, -3}, {3, -3})) << "nothing is left";
  EXPECT_FALSE(rest({3, -3, 3}, {3, 3, 3})) << "not in it";
  EXPECT_FALSE(rest({3, -3}, {})) << "no first knot";
}

}  // namespace knot_classifier_test
}  // namespace filum
