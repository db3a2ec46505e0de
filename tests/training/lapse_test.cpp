#include "training/lapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/numbers.h"
#include "training/stitch_pairs.h"

namespace filum {
namespace lapse_test {

constexpr double kThickness = 0.15e-3;

TissueDescription card() {
  TissueDescription d;
  d.cut_along = Vec3::UnitX();
  return d;
}

/// A stitch across a cut along x: in on one side, out on the other.
void add_stitch(TissueObservation& t, double x, double bite_in, double bite_out, double skew = 0.0) {
  for (int side = 0; side < 2; ++side) {
    PassObservation& p = t.passes[static_cast<std::size_t>(t.n_passes++)];
    p.state = PassObservation::State::thread;
    p.out = true;
    p.side = side;
    const double y = side == 0 ? -bite_in : bite_out;
    p.entry_rest = Vec3(side == 0 ? x : x + skew, y, side == 0 ? 0.1e-3 : -0.1e-3);
    p.exit_rest = Vec3(side == 0 ? x : x + skew, y, side == 0 ? -0.1e-3 : 0.1e-3);
    p.bite_entry = p.bite_exit = std::abs(y);
    p.entry_angle = p.exit_angle = 1.5;
    p.depth_share = 1.0;
  }
}

Observation seen(const TissueObservation& t) {
  Observation o;
  o.tissue = t;
  return o;
}

std::vector<Stitch> stitches_in(const TissueObservation& t, const TissueDescription& scene, const std::vector<double>& times = {}) {
  StitchPairs pairs;
  pairs.observe(seen(t));
  return stitches_of(LapseRules(), t, pairs.with_needle(t), times, scene);
}

std::vector<Lapse> lapses(const TissueObservation& t, const TissueDescription& scene = card(), bool complete = false) {
  const auto stitches = stitches_in(t, scene, std::vector<double>(kMaxPasses, 1.0));
  return lapses_of(LapseRules(), stitches, spacings_of(stitches, scene, complete), kThickness, 9.0);
}
bool has(const std::vector<Lapse>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const Lapse& l) { return name == l.name; });
}

TissueObservation good() {
  TissueObservation t;
  for (int k = 0; k < 4; ++k) add_stitch(t, 0.4e-3 * k, 0.3e-3, 0.3e-3);
  return t;
}

TEST(Lapse, GoodStitchesHaveNone) {
  EXPECT_TRUE(lapses(good()).empty());
  const auto s = stitches_in(good(), card());
  ASSERT_EQ(s.size(), 4u);
  EXPECT_NEAR(s[1].bite[0], 0.3e-3, 1e-12);
  EXPECT_NEAR(s[1].bite[1], 0.3e-3, 1e-12);
  EXPECT_NEAR(s[1].position, 0.4e-3, 1e-12);
  EXPECT_NEAR(s[1].obliquity, 0.0, 1e-9);
  for (const double gap : spacings_of(s, card(), true)) EXPECT_NEAR(gap, 0.4e-3, 1e-12);
}

TEST(Lapse, AStitchTellsTheLayersOfItsThinnerSideAndItsInnerBites) {
  TissueDescription vessel = card();
  vessel.layers = {{"adventitia", 0.0, 0.35}, {"media", 0.35, 0.93}, {"intima", 0.93, 1.0}};
  TissueObservation t;
  add_stitch(t, 0.0, 0.3e-3, 0.25e-3);
  t.passes[0].bite_exit = 0.28e-3;
  t.passes[1].bite_entry = 0.2e-3;
  for (int k = 0; k < 2; ++k) t.passes[static_cast<std::size_t>(k)].shallow = 0.0, t.passes[static_cast<std::size_t>(k)].deep = 1.0;
  EXPECT_EQ(stitches_in(t, vessel)[0].layers, (std::vector<std::string>{"adventitia", "media", "intima"}));
  t.passes[1].deep = t.passes[1].depth_share = 0.93;  // the point came as far as the intima, not into it
  const Stitch s = stitches_in(t, vessel)[0];
  EXPECT_EQ(s.layers, (std::vector<std::string>{"adventitia", "media"}));
  EXPECT_NEAR(s.inner[0], 0.28e-3, 1e-12);
  EXPECT_NEAR(s.inner[1], 0.2e-3, 1e-12);
  t.n_passes = 1;
  const Stitch half = stitches_in(t, vessel)[0];
  EXPECT_NEAR(half.inner[0], 0.28e-3, 1e-12);
  EXPECT_TRUE(std::isnan(half.inner[1]));
  vessel.lumen = true;
  vessel.radius = 0.5e-3;
}

TEST(Lapse, EachPlantedFaultIsFoundAndNothingElse) {
  struct Case {
    const char* name;
    void (*plant)(TissueObservation&);
  };
  const Case cases[] = {
      {"wide-bite", [](TissueObservation& t) { t.passes[2].bite_entry = t.passes[2].bite_exit = 0.5e-3; t.passes[2].entry_rest.y() = t.passes[2].exit_rest.y() = -0.5e-3; }},
      {"partial-thickness", [](TissueObservation& t) { t.passes[3].depth_share = 0.6; }},
      {"wall-tear", [](TissueObservation& t) { t.passes[5].torn = 50e-6; }},
      {"oblique", [](TissueObservation& t) { for (int k = 0; k < 8; k += 2) t.passes[static_cast<std::size_t>(k)].entry_rest.x() -= 0.4e-3; }},
      {"unequal-spacing", [](TissueObservation& t) { for (int k = 6; k < 8; ++k) t.passes[static_cast<std::size_t>(k)].entry_rest.x() += 1e-3, t.passes[static_cast<std::size_t>(k)].exit_rest.x() += 1e-3; }},
  };
  for (const Case& c : cases) {
    TissueObservation t = good();
    c.plant(t);
    const auto found = lapses(t);
    EXPECT_TRUE(has(found, c.name)) << c.name;
    for (const Lapse& l : found) EXPECT_STREQ(l.name, c.name);
  }
}

TEST(Lapse, HalfAStitchHasOneBite) {
  TissueObservation t;
  add_stitch(t, 0.0, 0.3e-3, 0.3e-3);
  t.n_passes = 1;
  const auto s = stitches_in(t, card(), {2.5});
  ASSERT_EQ(s.size(), 1u);
  EXPECT_TRUE(std::isnan(s[0].bite[1]));
  EXPECT_EQ(s[0].time, 2.5);
}

TEST(Lapse, RulesComeFromAFileThatSaysWhereFrom) {
  for (const char* name : {"card", "vessel", "anastomosis"}) {
    const LapseRules r = load_lapse_rules(std::string(FILUM_SOURCE_DIR "/curricula/lapses/").append(name).append(".yaml"));
    EXPECT_FALSE(r.source.empty());
    EXPECT_NEAR(r.oblique, 0.349, 1e-3);
    const bool tied = std::string(name) == "anastomosis";
    EXPECT_EQ(std::isfinite(r.loose_gap), tied) << "edges that nobody was asked to join may stand apart";
    EXPECT_EQ(std::isfinite(r.line_gap), tied);
  }
}

constexpr double kRadius = 0.5e-3;

TissueDescription tube() {
  TissueDescription d;
  d.lumen = true;
  d.axis = Vec3::UnitY();
  d.cut_along = -Vec3::UnitX();
  d.radius = kRadius;
  return d;
}

/// A bite of a tube's wall at `angle`, `y` from the cut; `inwards`: outside-in.
PassObservation bite(int side, double angle, double y, bool inwards) {
  PassObservation p;
  p.state = PassObservation::State::thread;
  p.out = true;
  p.side = side;
  const auto at = [&](double r) { return Vec3(-r * std::cos(angle), y, r * std::sin(angle)); };
  const Vec3 outer = at(kRadius), inner = at(kRadius - kThickness);
  p.entry_rest = inwards ? outer : inner;
  p.exit_rest = inwards ? inner : outer;
  p.entry_depth = inwards ? 0.0 : 1.0;
  p.exit_depth = inwards ? 1.0 : 0.0;
  p.bite_entry = p.bite_exit = std::abs(y);
  p.entry_angle = p.exit_angle = 1.2;
  p.depth_share = 1.0;
  return p;
}

std::vector<Lapse> tube_lapses(const std::vector<PassObservation>& bites) {
  TissueObservation t;
  for (const PassObservation& p : bites) t.passes[static_cast<std::size_t>(t.n_passes++)] = p;
  const std::vector<double> times(kMaxPasses, 2.0);
  const auto stitches = stitches_in(t, tube(), times);
  auto found = lapses_of(LapseRules(), stitches, spacings_of(stitches, tube(), false), kThickness, 2.0);
  find_back_walls(LapseRules(), t, times, tube(), stitches, found);
  return found;
}

TEST(Lapse, StitchesOfATubeAreMeasuredAroundIt) {
  TissueObservation t;
  for (const double angle : {0.3, 3.0}) {  // the second runs over the seam of the angle
    t.passes[static_cast<std::size_t>(t.n_passes++)] = bite(0, angle, -0.3e-3, true);
    t.passes[static_cast<std::size_t>(t.n_passes++)] = bite(1, angle + 0.3, 0.3e-3, false);
  }
  const auto s = stitches_in(t, tube());
  ASSERT_EQ(s.size(), 2u);
  EXPECT_NEAR(s[0].position, kRadius * 0.45, 1e-9);
  for (const Stitch& k : s) EXPECT_NEAR(k.obliquity, std::atan2(0.3 * kRadius, 0.6e-3), 1e-9);
}

TEST(Lapse, BackWallOfATube) {
  EXPECT_TRUE(tube_lapses({bite(0, 1.5, -0.3e-3, true), bite(1, 1.55, 0.3e-3, false)}).empty());
  const auto caught = tube_lapses({bite(0, 1.5, -0.3e-3, true), bite(0, -1.4, -0.3e-3, false)});
  EXPECT_TRUE(has(caught, "back-wall")) << "out through the far side of the same stump";
  EXPECT_EQ(tube_lapses({bite(0, 1.5, -0.5e-3, true), bite(0, -1.4, -0.5e-3, false)}).size(), 2u) << "one wide bite and the back wall: the way on is no bite of its own";
  EXPECT_FALSE(has(tube_lapses({bite(0, 1.0, -0.3e-3, true), bite(1, 1.0, 0.3e-3, false), bite(0, 1.5, -0.3e-3, true), bite(0, -1.4, -0.3e-3, false)}), "unequal-spacing"));
  const auto across = tube_lapses({bite(0, 1.5, -0.3e-3, true), bite(1, -1.4, 0.3e-3, false)});
  ASSERT_TRUE(has(across, "back-wall"));
  for (const Lapse& l : across)
    if (std::string(l.name) == "back-wall") {
      EXPECT_NEAR(l.value, 2.9 * 180.0 / 3.14159265358979, 1e-6);
      EXPECT_EQ(l.stitch, 0);
    }
  EXPECT_FALSE(has(tube_lapses({bite(0, 1.5, -0.3e-3, true), bite(0, -1.4, -0.3e-3, true)}), "back-wall")) << "two bites from outside";
}

TEST(Lapse, ThreadLeftInTheLumen) {
  JoinReport join;
  std::vector<Lapse> found;
  join.thread_inside = 0.4e-3;
  find_join_lapses(LapseRules(), join, 9.0, found);
  EXPECT_TRUE(found.empty());
  join.thread_inside = 0.8e-3;
  find_join_lapses(LapseRules(), join, 9.0, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_STREQ(found[0].name, "thread-in-lumen");
  join.overlap = 1.2;
  find_join_lapses(LapseRules(), join, 9.0, found);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_STREQ(found[2].name, "edge-overlap");
}

TEST(Lapse, ThreadLeftTooTightForItsBite) {
  auto t = good();
  for (std::size_t k : {2u, 3u}) t.passes[k].tension = 25e-3;
  EXPECT_FALSE(has(lapses(t), "too-tight")) << "83 N/m";
  for (std::size_t k : {2u, 3u}) t.passes[k].bite_entry = t.passes[k].bite_exit = 0.2e-3;
  const auto found = lapses(t);
  ASSERT_TRUE(has(found, "too-tight")) << "125 N/m";
  EXPECT_EQ(found[0].stitch, 1);
  EXPECT_NEAR(found[0].value, 125.0, 1e-9);
}

/// Stitches at 67.5 and 157.5 degrees, the gaps of eight nodes 45 degrees apart, the first at 22.5.
std::vector<Lapse> gap_lapses(const std::vector<double>& gaps, double second = 135.0, bool joins = true, bool complete = false) {
  LapseRules rules;
  rules.loose_gap = 0.5;
  rules.line_gap = 0.3;
  TissueDescription scene = tube();
  scene.thickness = kThickness;
  std::vector<Stitch> stitches(2);
  stitches[0].position = kRadius * 67.5 * std::acos(-1.0) / 180.0;
  stitches[1].position = kRadius * (second + 22.5) * std::acos(-1.0) / 180.0;
  stitches[0].joins = true;
  stitches[1].joins = joins;
  JoinReport join;
  for (std::size_t k = 0; k < gaps.size(); ++k) join.edge.push_back({(static_cast<double>(k) + 0.5) / static_cast<double>(gaps.size()), gaps[k] * kThickness});
  std::vector<Lapse> found;
  find_gap_lapses(rules, join, scene, stitches, complete, 3.0, found);
  return found;
}

TEST(Lapse, GapsAtStitchesAndBetweenThem) {
  EXPECT_TRUE(gap_lapses({2, 0, 0, 0, 2, 2, 2, 2}).empty()) << "where nothing is sewn yet there is no line";
  const auto loose = gap_lapses({2, 0, 0, 0.6, 2, 2, 2, 2});
  ASSERT_EQ(loose.size(), 1u);
  EXPECT_STREQ(loose[0].name, "loose-knot");
  EXPECT_EQ(loose[0].stitch, 1);
  const auto line = gap_lapses({2, 0, 0.4, 0, 2, 2, 2, 2});
  ASSERT_EQ(line.size(), 1u);
  EXPECT_STREQ(line[0].name, "disrupted-line");
  EXPECT_NEAR(line[0].value, 0.4, 1e-12);
  EXPECT_TRUE(gap_lapses({2, 0, 0.4, 0, 0, 2, 2, 2}, 180.0).empty()) << "too far apart to be neighbours";
  EXPECT_EQ(gap_lapses({0.1, 0, 0.4, 0, 0, 0.1, 0.1, 0.1}, 180.0, true, true).size(), 1u) << "unless no more stitches are to come";
  const auto seam = gap_lapses({0.4, 0, 2, 2, 2, 2, 2, 0}, 315.0);
  ASSERT_EQ(seam.size(), 1u) << "over the seam of the angle";
  EXPECT_STREQ(seam[0].name, "disrupted-line");
}

TEST(Lapse, GapsAreNoFaultOfBitesThatJoinNothing) {
  EXPECT_TRUE(gap_lapses({2, 0, 0, 0.6, 2, 2, 2, 2}, 135.0, false).empty()) << "a lone pass has no knot to be loose";
  EXPECT_TRUE(gap_lapses({2, 0, 0.4, 0, 2, 2, 2, 2}, 135.0, false).empty()) << "nor is it anybody's neighbour";
  EXPECT_EQ(gap_lapses({2, 0.6, 0, 0, 2, 2, 2, 2}, 135.0, false).size(), 1u) << "the other one has";
}

/// A needle straight through one wall moves hardly nearer to the edge: from hole to hole says nothing of how a stitch will lie.
TEST(Lapse, HalfAStitchIsNotOblique) {
  auto t = good();
  t.n_passes = 3;
  t.passes[2].entry_rest += Vec3(0.02e-3, -0.01e-3, 0.0);
  const auto s = stitches_in(t, card());
  ASSERT_EQ(s.size(), 2u);
  EXPECT_FALSE(std::isnan(s[0].obliquity));
  EXPECT_TRUE(std::isnan(s[1].obliquity));
  EXPECT_FALSE(has(lapses(t), "oblique"));
}

TEST(Lapse, OnlyThreadThroughBothSidesJoins) {
  auto t = good();
  t.passes[5].state = PassObservation::State::needle;
  t.n_passes = 6;
  StitchPairs pairs;
  pairs.observe(seen(t));
  t.passes[3].state = PassObservation::State::torn;  // after the stitch was made
  const auto s = stitches_of(LapseRules(), t, pairs.with_needle(t), {}, card());
  ASSERT_EQ(s.size(), 3u);
  EXPECT_TRUE(s[0].joins);
  EXPECT_FALSE(s[1].joins) << "one side torn out";
  EXPECT_TRUE(s[1].lost);
  EXPECT_FALSE(s[2].joins) << "the needle is still in it";
}

TEST(Lapse, OfWhatWasPulledOutOnlyATearIsLeft) {
  auto t = good();
  add_stitch(t, 1.6e-3, 0.9e-3, 0.3e-3);
  EXPECT_TRUE(has(lapses(t), "wide-bite"));
  t.passes[8].state = t.passes[9].state = PassObservation::State::pulled_out;
  EXPECT_TRUE(lapses(t).empty()) << "it was taken back";
  t.passes[8].state = PassObservation::State::torn;
  t.passes[8].torn = 0.2e-3;
  const auto found = lapses(t);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_STREQ(found[0].name, "wall-tear");
}

TEST(Lapse, AWallTornByAPointThatNeverCameOutIsTold) {
  auto t = good();
  PassObservation& p = t.passes[static_cast<std::size_t>(t.n_passes++)];
  p.state = PassObservation::State::torn;
  p.entry_rest = Vec3(1.6e-3, -0.1e-3, 0.1e-3);
  p.bite_entry = 0.1e-3;
  p.torn = 10e-6;
  EXPECT_TRUE(lapses(t).empty()) << "no more than counts";
  p.torn = 0.1e-3;
  const auto found = lapses(t);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_STREQ(found[0].name, "wall-tear");
  const Stitch s = stitches_in(t, card()).back();
  EXPECT_NEAR(s.position, 1.6e-3, 1e-9) << "where it went in";
  EXPECT_TRUE(s.lost && !s.joins && std::isnan(s.exit_angle) && std::isnan(s.inner[0]));
}

TissueObservation round_the_tube(const std::vector<double>& degrees, double skew = 0.0) {
  TissueObservation t;
  for (const double d : degrees) {
    const double a = d * std::numbers::pi / 180.0;
    t.passes[static_cast<std::size_t>(t.n_passes++)] = bite(0, a, -0.3e-3, true);
    t.passes[static_cast<std::size_t>(t.n_passes++)] = bite(1, a + skew, 0.3e-3, false);
  }
  return t;
}

TEST(Lapse, SpacingRoundATubeHangsOnNoSeam) {
  const double quarter = 0.5 * std::numbers::pi * kRadius;
  for (const double from : {0.0, 40.0, 100.0, 179.0, 300.0}) {
    std::vector<double> seven, eight;
    for (int k = 0; k < 8; ++k) {
      eight.push_back(from + 45.0 * k);
      if (k < 7) seven.push_back(from + 45.0 * k);
    }
    EXPECT_FALSE(has(lapses(round_the_tube(eight), tube(), true), "unequal-spacing")) << from;
    EXPECT_FALSE(has(lapses(round_the_tube(seven), tube(), false), "unequal-spacing")) << from << ": the eighth is still to come";
    EXPECT_TRUE(has(lapses(round_the_tube(seven), tube(), true), "unequal-spacing")) << from << ": one is missing";
    const auto open = spacings_of(stitches_in(round_the_tube(seven), tube()), tube(), false), closed = spacings_of(stitches_in(round_the_tube(seven), tube()), tube(), true);
    EXPECT_EQ(open.size(), 6u);
    ASSERT_EQ(closed.size(), 7u);
    EXPECT_NEAR(*std::max_element(closed.begin(), closed.end()), quarter, 1e-12) << from;
  }
}

TEST(Lapse, EachStitchHasAWayToTheNextButNoneWasLost) {
  const double quarter = 0.5 * std::numbers::pi * kRadius;
  auto stitches = stitches_in(round_the_tube({200.0, 20.0, 290.0}), tube());
  auto ways = ways_to_next(stitches, tube());
  EXPECT_NEAR(ways[0], quarter, 1e-12);
  EXPECT_NEAR(ways[1], 2.0 * quarter, 1e-12);
  EXPECT_NEAR(ways[2], quarter, 1e-12) << "over the seam, to the first";
  stitches[0].lost = true;
  ways = ways_to_next(stitches, tube());
  EXPECT_TRUE(std::isnan(ways[0]));
  EXPECT_NEAR(ways[1], 3.0 * quarter, 1e-12);
  ways = ways_to_next(stitches_in(good(), card()), card());
  EXPECT_NEAR(ways[0], 0.4e-3, 1e-12);
  EXPECT_TRUE(std::isnan(ways[3])) << "a card's cut has an end";
  EXPECT_TRUE(std::isnan(ways_to_next(stitches_in(round_the_tube({20.0}), tube()), tube())[0])) << "nobody is its own neighbour";
}

TEST(Lapse, TheOpenClampIsNoPartOfABite) {
  TissueDescription apart = tube();
  TissueObservation t = round_the_tube({45.0}, 0.6);  // 0.3 mm along a circle of 0.5 mm
  for (PassObservation* p : {&t.passes[0], &t.passes[1]}) {
    const double shift = p->side == 0 ? -0.3e-3 : 0.3e-3;  // stumps laid down 0.6 mm apart
    p->entry_rest.y() += shift;
    p->exit_rest.y() += shift;
  }
  const auto s = stitches_in(t, apart);
  ASSERT_EQ(s.size(), 1u);
  EXPECT_NEAR(s[0].obliquity, std::atan2(0.6 * kRadius, 0.6e-3), 1e-9) << "bites of 0.3 mm on either side";
  EXPECT_TRUE(has(lapses(t, apart), "oblique"));
}

TEST(Lapse, ALapseIsShownWhenItCanBeSeen) {
  auto t = good();
  t.passes[2].torn = 50e-6;
  auto stitches = stitches_in(t, card(), std::vector<double>(kMaxPasses, 1.0));
  stitches[1].tear_time = 4.0;
  stitches[2].slack = 3e-3;
  LapseRules rules;
  rules.slack = 2.5e-3;
  const auto found = lapses_of(rules, stitches, {}, kThickness, 9.0);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_STREQ(found[0].name, "wall-tear");
  EXPECT_EQ(found[0].time, 4.0) << "when it tore, not when the needle came out";
  EXPECT_STREQ(found[1].name, "loose-knot");
  EXPECT_EQ(found[1].time, 9.0) << "a knot is looked at at the end";
}

TEST(Lapse, TheRulesSayWhatIsCritical) {
  for (const char* name : {"vessel", "anastomosis", "vein", "end-to-side", "continuous"}) {
    const LapseRules rules = load_lapse_rules(std::string(FILUM_SOURCE_DIR "/curricula/lapses/").append(name).append(".yaml"));
    std::vector<Lapse> found = {{"wide-bite", 0, 1.0, 4.0, "thicknesses"}, {"back-wall", 1, 2.0, 170.0, "deg"}};
    mark_critical(rules, found);
    EXPECT_FALSE(found[0].critical) << name;
    EXPECT_TRUE(found[1].critical) << name;
  }
  const std::string text = "format: filum-lapses/1\ntitle: T\nsource: S\noblique: 20 deg\nwide_bite_thicknesses: 3\nleast_depth_share: 1\nspacing_variation: 0.25\n"
                           "spacing_ratio: 2\ntear: 20 um\ncritical: [backwall]\n";
  const std::string path = testing::TempDir() + "lapses_critical.yaml";
  std::ofstream(path) << text;
  EXPECT_THROW(load_lapse_rules(path), InputError) << "a lapse that there is not";
}

TEST(Lapse, AKnotWithSlackIsLooseAndToldOnce) {
  LapseRules rules;
  Stitch s;
  s.joins = true;
  s.depth = 1.0;
  s.slack = 1.9e-3;
  EXPECT_TRUE(lapses_of(rules, {s}, {}, kThickness, 9.0).empty()) << "not asked for";
  rules.slack = 2e-3;
  EXPECT_TRUE(lapses_of(rules, {s}, {}, kThickness, 9.0).empty());
  s.slack = 2.1e-3;
  auto found = lapses_of(rules, {s}, {}, kThickness, 9.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_STREQ(found[0].name, "loose-knot");
  EXPECT_EQ(found[0].value, 2.1e-3);
  rules.loose_gap = 0.5;
  TissueDescription scene = tube();
  scene.thickness = kThickness;
  JoinReport join;
  for (int k = 0; k < 8; ++k) join.edge.push_back({k / 8.0, kThickness});
  find_gap_lapses(rules, join, scene, {s}, false, 3.0, found);
  EXPECT_EQ(found.size(), 1u) << "its edges stand apart too";
}

}  // namespace lapse_test
}  // namespace filum
