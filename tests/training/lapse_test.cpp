#include "training/lapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace filum {
namespace {

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

std::vector<Lapse> lapses(const TissueObservation& t) {
  return lapses_of(LapseRules(), stitches_of(t, std::vector<double>(kMaxPasses, 1.0), card()), kThickness);
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
  const auto s = stitches_of(good(), {}, card());
  ASSERT_EQ(s.size(), 4u);
  EXPECT_NEAR(s[1].bite[0], 0.3e-3, 1e-12);
  EXPECT_NEAR(s[1].bite[1], 0.3e-3, 1e-12);
  EXPECT_NEAR(s[1].position, 0.4e-3, 1e-12);
  EXPECT_NEAR(s[1].obliquity, 0.0, 1e-9);
  for (const double gap : spacings_of(s)) EXPECT_NEAR(gap, 0.4e-3, 1e-12);
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
  const auto s = stitches_of(t, {2.5}, card());
  ASSERT_EQ(s.size(), 1u);
  EXPECT_TRUE(std::isnan(s[0].bite[1]));
  EXPECT_EQ(s[0].time, 2.5);
}

TEST(Lapse, RulesComeFromAFileThatSaysWhereFrom) {
  for (const char* name : {"card", "vessel"}) {
    const LapseRules r = load_lapse_rules(std::string(FILUM_SOURCE_DIR) + "/curricula/lapses/" + name + ".yaml");
    EXPECT_FALSE(r.source.empty());
    EXPECT_NEAR(r.oblique, 0.349, 1e-3);
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
  const auto stitches = stitches_of(t, times, tube());
  auto found = lapses_of(LapseRules(), stitches, kThickness);
  find_back_walls(LapseRules(), t, times, tube(), stitches, found);
  return found;
}

TEST(Lapse, StitchesOfATubeAreMeasuredAroundIt) {
  TissueObservation t;
  for (const double angle : {0.3, 3.0}) {  // the second runs over the seam of the angle
    t.passes[static_cast<std::size_t>(t.n_passes++)] = bite(0, angle, -0.3e-3, true);
    t.passes[static_cast<std::size_t>(t.n_passes++)] = bite(1, angle + 0.3, 0.3e-3, false);
  }
  const auto s = stitches_of(t, {}, tube());
  ASSERT_EQ(s.size(), 2u);
  EXPECT_NEAR(s[0].position, kRadius * 0.45, 1e-9);
  for (const Stitch& k : s) EXPECT_NEAR(k.obliquity, std::atan2(0.3 * kRadius, 0.6e-3), 1e-9);
}

TEST(Lapse, BackWallOfATube) {
  EXPECT_TRUE(tube_lapses({bite(0, 1.5, -0.3e-3, true), bite(1, 1.55, 0.3e-3, false)}).empty());
  const auto caught = tube_lapses({bite(0, 1.5, -0.3e-3, true), bite(0, -1.4, -0.3e-3, false)});
  EXPECT_TRUE(has(caught, "back-wall")) << "out through the far side of the same stump";
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

}  // namespace
}  // namespace filum
