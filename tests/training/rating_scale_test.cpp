#include "training/rating_scale.h"

#include <gtest/gtest.h>

#include <cmath>

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
