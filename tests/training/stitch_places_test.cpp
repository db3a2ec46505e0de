#include "training/stitch_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "oblique_edges.h"
#include "training/task.h"

namespace filum {
namespace stitch_places_test {

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<NeedleGoal> goals_of(const std::string& task) {
  return load_task(FILUM_SOURCE_DIR "/curricula/" + task + "/task.yaml").needle->goals;
}

/// As scenes of two stumps have it: 90 degrees lie on top.
TissueDescription vessel() {
  TissueDescription t;
  t.lumen = true;
  t.cut_along = -Vec3::UnitX();
  t.radius = 0.5e-3;
  return t;
}

/// [deg], whole, from 0 to 359, as they are to be sewn.
std::vector<int> degrees(const std::vector<double>& angles) {
  std::vector<int> all;
  for (const double a : angles) all.push_back((static_cast<int>(std::lround(a / kDegree)) % 360 + 360) % 360);
  return all;
}

std::vector<int> places(const std::string& task, const TissueDescription& tissue = vessel()) { return degrees(stitch_angles(goals_of(task), tissue)); }

/// Some of them in any order.
std::vector<int> sorted(std::vector<int> all, std::size_t from, std::size_t to) {
  std::sort(all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to));
  return {all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to)};
}

using Degrees = std::vector<int>;

TEST(StitchPlaces, StaysAtAThirdOfATurnAndTheMiddleOfEachSide) {
  const Degrees p = places("triangulation-120");
  ASSERT_EQ(p.size(), 6u);
  EXPECT_EQ(p[0], 90) << "what lies on top";
  EXPECT_EQ(sorted(p, 0, 3), (Degrees{90, 210, 330}));
  EXPECT_EQ(sorted(p, 3, 6), (Degrees{30, 150, 270}));
}

TEST(StitchPlaces, InTheSectorsOfTheirSteps) {
  const Degrees eight = places("anastomosis-8");
  ASSERT_EQ(eight.size(), 8u);
  EXPECT_EQ(Degrees(eight.begin(), eight.begin() + 6), (Degrees{90, 270, 0, 45, 315, 180}));
  EXPECT_EQ(sorted(eight, 6, 8), (Degrees{135, 225}));
  EXPECT_EQ(places("artery-four-stitches"), (Degrees{90, 270, 0, 180}));
  EXPECT_EQ(places("artery-two-stitches"), (Degrees{90, 270}));
  const Degrees back_first = places("posterior-wall-first");
  ASSERT_EQ(back_first.size(), 8u);
  EXPECT_EQ(back_first[0], 270);
  EXPECT_EQ(sorted(back_first, 1, 3), (Degrees{225, 315}));
  EXPECT_EQ(sorted(back_first, 3, 8), (Degrees{0, 45, 90, 135, 180}));
}

TEST(StitchPlaces, SpacesAreHalvedWhereNothingButARoomIsAskedFor) {
  const Degrees p = places("anastomosis-vein");
  ASSERT_EQ(p.size(), 8u);
  EXPECT_EQ(Degrees(p.begin(), p.begin() + 2), (Degrees{90, 270}));
  EXPECT_EQ(sorted(p, 2, 4), (Degrees{0, 180})) << "the middles first";
  EXPECT_EQ(sorted(p, 4, 8), (Degrees{45, 135, 225, 315}));
}

TEST(StitchPlaces, ARunningThreadGoesOnTheSameWayRound) { EXPECT_EQ(places("continuous-suture"), (Degrees{90, 135, 180, 225, 270, 315, 0, 45})); }

TEST(StitchPlaces, EndToSideFromHeelAndToe) {
  const Degrees p = places("end-to-side", testing_shapes::oblique_edges());
  ASSERT_EQ(p.size(), 8u);
  EXPECT_EQ(Degrees(p.begin(), p.begin() + 6), (Degrees{0, 180, 270, 315, 225, 90}));
  EXPECT_EQ(sorted(p, 6, 8), (Degrees{45, 135}));
}

TEST(StitchPlaces, OneStitchLiesOnTop) {
  for (const char* task : {"artery-stitch", "vessel-stitch", "stitch-knot"}) EXPECT_EQ(places(task), (Degrees{90})) << task;
  TissueDescription turned = vessel();
  turned.cut_along = Vec3(-std::cos(0.5), 0.0, std::sin(0.5));
  EXPECT_NEAR(stitch_angles(goals_of("artery-stitch"), turned)[0], 0.5 * std::numbers::pi - 0.5, 1e-12);
}

NeedleGoal stitch(int count, double from, double span, double apart) {
  NeedleGoal g;
  g.kind = NeedleGoal::Kind::stitch;
  g.stitch.count = count;
  g.stitch.from = from * kDegree;
  g.stitch.span = span * kDegree;
  g.stitch.apart = apart * kDegree;
  g.stitch.within = 5.0 * kDegree;
  return g;
}

TEST(StitchPlaces, NoneWhereTheyCannotBeTold) {
  EXPECT_TRUE(stitch_angles({stitch(1, 0, 40, 0), stitch(1, 0, 360, 100)}, vessel()).empty()) << "not evenly spaced";
  EXPECT_FALSE(stitch_angles({stitch(1, 0, 40, 0), stitch(1, 0, 360, 180)}, vessel()).empty());
  EXPECT_TRUE(places("vessel-handling").empty()) << "no stitch is asked for";
  EXPECT_TRUE(places("artery-stitch", testing_shapes::oblique_edges()).empty()) << "nothing lies on top of two edges";
  NeedleGoal several;
  several.kind = NeedleGoal::Kind::pass;
  several.passes = 8;
  EXPECT_TRUE(stitch_angles({several}, vessel()).empty()) << "anywhere";
}

TEST(StitchPlaces, AlongACardAsManyAsItsTaskAsksFor) {
  TissueDescription card;
  card.cut_along = Vec3::UnitX();
  card.rest = Points::Zero(3, 2);
  card.rest(0, 0) = -2e-3;
  card.rest(0, 1) = 2e-3;
  const std::vector<double> ten = stitches_along(goals_of("ten-stitches"), card);
  ASSERT_EQ(ten.size(), 10u);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_NEAR(ten[k], (static_cast<double>(k) - 4.5) * 4e-3 / 11.0, 1e-12);
  EXPECT_EQ(stitches_along(goals_of("card-stitches"), card), std::vector<double>{0.0});
  card.rest *= 10.0;
  EXPECT_NEAR(stitches_along(goals_of("ten-stitches"), card)[9], 4.5e-3, 1e-12) << "a millimetre apart";
  EXPECT_TRUE(stitches_along(goals_of("needle-loading"), card).empty());
}

}  // namespace stitch_places_test
}  // namespace filum
