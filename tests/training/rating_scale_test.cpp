#include "training/rating_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace filum {
namespace rating_scale_test {

RatingScale mars10() { return load_rating_scale(FILUM_SOURCE_DIR "/curricula/scales/mars10.yaml"); }

/// Eight stitches round a vessel of thickness 0.1 mm, 0.4 mm apart, bites of 0.25 mm, a join that leaks 1 ml/min.
NeedleReport good() {
  NeedleReport r;
  r.has_tissue = true;
  r.thickness = 0.1e-3;
  for (int k = 0; k < 8; ++k) {
    Stitch s;
    s.bite[0] = s.bite[1] = 0.25e-3;
    s.joins = true;
    s.knot = "square";
    s.slack = 1.2e-3;
    s.tail = 1.1e-3;
    s.short_tail = 0.9e-3;
    r.stitches.push_back(s);
  }
  r.spacings.assign(8, 0.4e-3);
  r.join = JoinReport{};
  r.join->leak = 1e-6 / 60.0;
  return r;
}

std::vector<std::optional<int>> points(const NeedleReport& r) {
  std::vector<std::optional<int>> all;
  for (const ScaleEstimate& e : estimates(mars10(), r)) all.push_back(e.points);
  return all;
}

using Points = std::vector<std::optional<int>>;

TEST(RatingScale, MarsTenHasItsFiveItemsOfTwoPoints) {
  const RatingScale s = mars10();
  ASSERT_EQ(s.items.size(), 5u);
  EXPECT_EQ(s.most * static_cast<int>(s.items.size()), 10);
  for (const ScaleItem& item : s.items) EXPECT_EQ(item.words.size(), 3u) << item.name;
}

TEST(RatingScale, EstimatesAllFiveFromGeometryAndTopology) {
  EXPECT_EQ(points(good()), (Points{2, 2, 2, 2, 2}));
  const auto all = estimates(mars10(), good());
  EXPECT_NEAR(*all[0].value, 1.0, 1e-12);
  EXPECT_EQ(all[0].unit, "ml/min");
}

TEST(RatingScale, TheWorstCriterionDecides) {
  NeedleReport r = good();
  r.join->leak = 10e-6 / 60.0;
  r.spacings[2] += 0.1e-3;  // 0.5 and 0.3 mm in eight: variation 0.125
  r.spacings[3] -= 0.1e-3;
  r.stitches[5].bite[1] = 0.15e-3;   // unequal by 0.4
  r.stitches[1].knot = "granny";     // one in eight
  r.stitches[2].short_tail = 0.2e-3;
  EXPECT_EQ(points(r), (Points{1, 1, 1, 1, 1}));
  r.lapses.push_back({"back-wall", 2, 1.0, 120.0, "deg"});
  r.spacings[2] += 0.2e-3;  // 0.7 and 0.1 mm: 0.375
  r.spacings[3] -= 0.2e-3;
  r.stitches[6].bite[0] = 0.45e-3;   // 4.5 thicknesses
  r.stitches[0].slack = 2.6e-3;
  r.stitches[0].tail = 4e-3;
  EXPECT_EQ(points(r), (Points{0, 0, 0, 0, 0}));
  EXPECT_NEAR(*estimates(mars10(), r)[1].value, 0.30 / 0.40 * std::sqrt(2.0 / 8.0), 1e-9);
}

/// As the lapse does: not only of those that join both sides, not of those that came out.
TEST(RatingScale, EveryBiteThatHoldsCountsForItsSize) {
  NeedleReport r = good();
  Stitch lone;
  lone.bite[0] = 0.33e-3;
  lone.bite[1] = std::numeric_limits<double>::quiet_NaN();
  r.stitches.push_back(lone);
  EXPECT_NEAR(scale_value("bite-widest", r), 3.3, 1e-9);
  EXPECT_EQ(points(r)[2], 1);
  r.stitches.back().lost = true;
  EXPECT_NEAR(scale_value("bite-widest", r), 2.5, 1e-9);
}

TEST(RatingScale, WhatCouldNotBeMeasuredIsNotMarked) {
  NeedleReport r = good();
  r.stitches.resize(2);
  r.spacings.resize(1);  // one space has no variation
  r.join.reset();
  r.stitches[1].knot.clear();
  r.stitches[1].slack = r.stitches[1].tail = r.stitches[1].short_tail = std::nan("");
  EXPECT_EQ(points(r), (Points{std::nullopt, std::nullopt, 2, std::nullopt, std::nullopt})) << "one is not tied";
  r.stitches[1].joins = false;
  EXPECT_EQ(points(r)[3], 2) << "a lone pass is no stitch with a loose knot";
}

RatingScale lapse_index() { return load_rating_scale(FILUM_SOURCE_DIR "/curricula/scales/lapse-index.yaml"); }

std::vector<std::string> names_with(const RatingScale& scale, const NeedleReport& r, std::optional<int> points) {
  std::vector<std::string> names;
  const auto all = estimates(scale, r);
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].points == points) names.push_back(scale.items[k].name);
  return names;
}

TEST(RatingScale, TheLapseIndexHasTenLapsesOfWhichFewerAreBetter) {
  const RatingScale s = lapse_index();
  ASSERT_EQ(s.items.size(), 10u);
  EXPECT_EQ(s.most, 1);
  EXPECT_TRUE(s.fewer_is_better);
  EXPECT_FALSE(mars10().fewer_is_better);
  for (const ScaleItem& item : s.items) {
    ASSERT_EQ(item.criteria.size(), 1u) << item.name;
    EXPECT_EQ(item.criteria[0].measure, item.name);
    EXPECT_EQ(item.words[0], "absent");
  }
}

TEST(RatingScale, ALapseOfTheReportIsPresentByItsNameAlone) {
  const RatingScale s = lapse_index();
  NeedleReport r = good();
  r.line_tested = true;
  EXPECT_EQ(names_with(s, r, 0).size(), 10u) << "a good join";
  for (const ScaleItem& item : s.items) {
    NeedleReport one = r;
    one.lapses.push_back({item.name.c_str(), 0, 1.0, 1.0, "-"});
    one.lapses.push_back(one.lapses.back());
    one.lapses.push_back({"loose-knot", 0, 1.0, 1.0, "-"});
    EXPECT_EQ(names_with(s, one, 1), std::vector<std::string>{item.name}) << "two of it are one point, a loose knot is none of the ten";
    EXPECT_EQ(scale_value(item.name, one), 2.0);
  }
}

/// "Absent" is said only of what was looked for: otherwise raters would be compared with what nobody saw.
TEST(RatingScale, ALapseThatWasNotLookedForIsLeftToTheRater) {
  const RatingScale s = lapse_index();
  NeedleReport r = good();
  EXPECT_EQ(names_with(s, r, std::nullopt), std::vector<std::string>{"disrupted-line"}) << "stitches may still be to come";
  r.lapses.push_back({"disrupted-line", 0, 1.0, 1.0, "thicknesses"});
  EXPECT_EQ(names_with(s, r, 1), std::vector<std::string>{"disrupted-line"}) << "found all the same";
  r.lapses.clear();
  r.line_tested = true;
  r.join->sound = false;
  EXPECT_EQ(names_with(s, r, std::nullopt), (std::vector<std::string>{"thread-in-lumen", "edge-overlap"}));
  r.join.reset();
  EXPECT_EQ(names_with(s, r, std::nullopt), (std::vector<std::string>{"thread-in-lumen", "edge-overlap"}));
  r.spacings.resize(1);
  EXPECT_EQ(names_with(s, r, std::nullopt).size(), 3u) << "one space is not unequal";
  r.stitches.clear();
  r.line_tested = false;
  EXPECT_EQ(names_with(s, r, std::nullopt).size(), 10u) << "nothing was sewn";
}

TEST(RatingScale, WhereFewerIsBetterTheMostOfTheCriteriaCounts) {
  const std::string text = "format: filum-scale/1\nname: a\ntitle: A\nsource: S\nmost: 1\nbetter: fewer\nitems:\n  - name: x\n    title: X\n    points: [no, yes]\n    criteria:\n"
                           "      - {measure: oblique, title: O, source: S, one: [\"1\", \"9\"]}\n      - {measure: wide-bite, title: W, source: S, one: [\"1\", \"9\"]}\n";
  NeedleReport r = good();
  r.lapses.push_back({"wide-bite", 0, 1.0, 4.0, "thicknesses"});
  EXPECT_EQ(estimates(parse_rating_scale(YamlNode::parse(text, "f")), r)[0].points, 1);
  const auto with = [&](const std::string& way) { return parse_rating_scale(YamlNode::parse(std::string(text).replace(text.find("fewer"), 5, way), "f")); };
  EXPECT_EQ(estimates(with("more"), r)[0].points, 0);
  EXPECT_THROW(with("less"), InputError);
}

TEST(RatingScale, RefusesAScaleThatSaysTwoThings) {
  const std::string head = "format: filum-scale/1\nname: a\ntitle: A\nsource: S\nmost: 1\nitems:\n  - name: x\n    title: X\n    points: [no, yes]\n";
  EXPECT_NO_THROW(parse_rating_scale(YamlNode::parse(head + "    rater: eye\n", "f")));
  EXPECT_THROW(parse_rating_scale(YamlNode::parse(head, "f")), InputError);
  EXPECT_THROW(parse_rating_scale(YamlNode::parse(head + "    rater: eye\n  - name: x\n    title: Y\n    points: [no, yes]\n    rater: eye\n", "f")), InputError);
  const std::string criterion = "    criteria:\n      - {measure: leak, title: T, source: S, one: [\"2\", \"1\"]}\n";
  EXPECT_THROW(parse_rating_scale(YamlNode::parse(head + criterion, "f")), InputError);
}

}  // namespace rating_scale_test
}  // namespace filum
