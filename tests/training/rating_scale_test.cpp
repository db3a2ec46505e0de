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
    s.position = 0.4e-3 * k;
    r.stitches.push_back(s);
  }
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

TEST(RatingScale, EstimatesWhatGeometryTellsAndLeavesTheRestToTheRater) {
  EXPECT_EQ(points(good()), (Points{2, 2, 2, std::nullopt, std::nullopt}));
  const auto all = estimates(mars10(), good());
  EXPECT_NEAR(*all[0].value, 1.0, 1e-12);
  EXPECT_EQ(all[0].unit, "ml/min");
  EXPECT_NE(all[3].why.find("rater"), std::string::npos);
}

TEST(RatingScale, TheWorstCriterionDecides) {
  NeedleReport r = good();
  r.join->leak = 10e-6 / 60.0;
  r.stitches[3].position += 0.1e-3;  // spaces 0.5 and 0.3 mm in seven: variation 0.134
  r.stitches[5].bite[1] = 0.15e-3;   // unequal by 0.4
  EXPECT_EQ(points(r), (Points{1, 1, 1, std::nullopt, std::nullopt}));
  r.lapses.push_back({"back-wall", 2, 1.0, 120.0, "deg"});
  r.stitches[3].position += 0.2e-3;  // 0.7 and 0.1 mm: 0.40
  r.stitches[6].bite[0] = 0.45e-3;   // 4.5 thicknesses
  EXPECT_EQ(points(r), (Points{0, 0, 0, std::nullopt, std::nullopt}));
  EXPECT_NEAR(*estimates(mars10(), r)[1].value, 0.30 / 0.40 * std::sqrt(2.0 / 7.0), 1e-9);
}

TEST(RatingScale, WhatCouldNotBeMeasuredIsNotMarked) {
  NeedleReport r = good();
  r.stitches.resize(2);  // one space has no variation
  r.join.reset();
  EXPECT_EQ(points(r), (Points{std::nullopt, std::nullopt, 2, std::nullopt, std::nullopt}));
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
