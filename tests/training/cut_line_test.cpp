#include "training/cut_line.h"

#include <gtest/gtest.h>

#include "oblique_edges.h"
#include "training/lapse.h"
#include "training/stitch_pairs.h"
#include "training/stitch_guide.h"

namespace filum {
namespace cut_line_test {

using testing_shapes::oblique_edges;
using testing_shapes::on_ellipse;

constexpr double kPi = std::numbers::pi;

/// Length of an ellipse from psi 0 to `psi` by the midpoint rule.
double arc(double a, double b, double psi) {
  double sum = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double p = psi * (k + 0.5) / 20000;
    sum += std::hypot(b * std::cos(p), a * std::sin(p)) * psi / 20000;
  }
  return sum;
}

TEST(CutLine, AnglesRunByEqualSharesOfEachEdge) {
  const TissueDescription t = oblique_edges();
  const CutLine cut(t);
  const double whole = arc(0.7e-3, 0.3e-3, 2.0 * kPi), other = arc(0.6e-3, 0.4e-3, 2.0 * kPi);
  EXPECT_NEAR(cut.radius(), 0.25 * (whole + other) / kPi, 1e-4 * cut.radius());
  for (const double psi : {0.0, 0.3, 1.0, 0.5 * kPi, 2.5}) {
    EXPECT_NEAR(cut.angle({on_ellipse(0.7e-3, 0.3e-3, psi, 0.0), 0}), 2.0 * kPi * arc(0.7e-3, 0.3e-3, psi) / whole, 1e-3);
    EXPECT_NEAR(cut.angle({on_ellipse(0.6e-3, 0.4e-3, psi, 0.3e-3), 1}), 2.0 * kPi * arc(0.6e-3, 0.4e-3, psi) / other, 1e-3);
  }
  EXPECT_NEAR(std::abs(cut.angle({on_ellipse(0.7e-3, 0.3e-3, kPi, 0.0), 0})), kPi, 1e-3) << "the toe";
  // by shares, not by the angle about one axis: 45 degrees seen from above lie elsewhere
  const double seen = std::atan2(0.3e-3 * std::sin(1.0), 0.7e-3 * std::cos(1.0));
  EXPECT_GT(std::abs(cut.angle({on_ellipse(0.7e-3, 0.3e-3, 1.0, 0.0), 0}) - seen), 0.1);
}

TEST(CutLine, StitchesAcrossTheEdgesLaidTogether) {
  const TissueDescription t = oblique_edges();
  const CutLine cut(t);
  const CutPlace in{Vec3(0.55e-3, 0, 0), 0}, out{Vec3(0.4e-3, 0, 0.55e-3), 1};  // 0.25 mm from either edge at the middle of a side
  EXPECT_NEAR(cut.along(in, out), 0.0, 1e-6);
  EXPECT_NEAR(cut.across(in, out), 0.5e-3, 1e-6);
  EXPECT_NEAR(cut.position(in, out), 0.5 * kPi * cut.radius(), 1e-3 * cut.radius()) << "a quarter of the way round";
  const double psi = 0.5 * kPi + 0.2;
  const CutPlace aside{on_ellipse(0.6e-3, 0.4e-3, psi, 0.5e-3), 1};
  EXPECT_NEAR(cut.along(in, aside), cut.radius() * 2.0 * kPi * (arc(0.6e-3, 0.4e-3, psi) / arc(0.6e-3, 0.4e-3, 2.0 * kPi) - 0.25), 3e-3 * cut.radius());
}

TEST(CutLine, TheWallAcrossIsFarRoundItsOwnVessel) {
  const TissueDescription t = oblique_edges();
  const CutLine cut(t);
  const CutPlace beside{Vec3(0.42e-3, 0, -0.2e-3), 0}, branch{Vec3(0.4e-3, 0, 0.5e-3), 1}, below{Vec3(0.05e-3, 0, -0.9e-3), 0};
  EXPECT_LT(cut.round_lumen(beside, branch), 0.7);
  EXPECT_GT(cut.round_lumen(below, branch), 0.75 * kPi) << "the vessel's far wall, whose nearest edge is on the same side";
  EXPECT_NEAR(cut.round_lumen(beside, {Vec3(-0.4e-3, 0, 0.5e-3), 1}), kPi, 0.05) << "the other side of the opening";
}

PassObservation bite(const Vec3& in, const Vec3& out, int side, bool inwards) {
  PassObservation p;
  p.state = PassObservation::State::thread;
  p.out = true;
  p.side = side;
  p.entry_rest = in;
  p.exit_rest = out;
  p.entry_depth = inwards ? 0.0 : 1.0;
  p.exit_depth = inwards ? 1.0 : 0.0;
  p.bite_entry = p.bite_exit = 0.2e-3;
  p.depth_share = 1.0;
  return p;
}

TEST(CutLine, LapsesOfStitchesEndToSide) {
  const TissueDescription t = oblique_edges();
  TissueObservation o;
  const auto add = [&](const PassObservation& p) { o.passes[static_cast<std::size_t>(o.n_passes++)] = p; };
  const auto radially = [](double a, double b, double psi, double z, double out) { return Vec3(on_ellipse(a, b, psi, z) + out * Vec3(std::sin(psi), std::cos(psi), 0).normalized()); };
  for (const double psi : {0.0, 0.5 * kPi, kPi}) {
    add(bite(radially(0.7e-3, 0.3e-3, psi, 0.0, 0.2e-3), radially(0.7e-3, 0.3e-3, psi, -0.1e-3, 0.15e-3), 0, true));
    add(bite(on_ellipse(0.6e-3, 0.4e-3, psi, 0.45e-3), on_ellipse(0.6e-3, 0.4e-3, psi, 0.5e-3), 1, false));
  }
  add(bite(Vec3(-0.5e-3, 0, -0.1e-3), Vec3(-0.35e-3, 0, -0.1e-3), 0, true));  // then through the far wall of the vessel instead of the stump
  add(bite(Vec3(0, 0, -0.8e-3), Vec3(0, 0, -0.9e-3), 0, false));
  const std::vector<double> times(kMaxPasses, 1.0);
  StitchPairs pairs;
  Observation seen;
  seen.tissue = o;
  pairs.observe(seen);
  const LapseRules rules = load_lapse_rules(FILUM_SOURCE_DIR "/curricula/lapses/end-to-side.yaml");
  const auto stitches = stitches_of(rules, o, pairs.made(), times, t);
  ASSERT_EQ(stitches.size(), 4u) << "three whole ones, and one through the far wall";
  const CutLine cut(t);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(std::abs(stitches[k].position), cut.radius() * 0.5 * kPi * static_cast<double>(k), 0.02 * cut.radius());
    EXPECT_LT(stitches[k].obliquity, 0.02);
  }
  const auto spacings = spacings_of({stitches[0], stitches[1]}, t, false);
  EXPECT_NEAR(spacings[0], 0.5 * kPi * cut.radius(), 0.02 * cut.radius());
  std::vector<Lapse> found;
  find_back_walls(rules, o, times, t, stitches, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_STREQ(found[0].name, "back-wall");
  EXPECT_EQ(found[0].stitch, 3);
  JoinReport join;
  for (int k = 0; k < 24; ++k) join.edge.push_back({k / 24.0, std::abs(k - 6) < 3 ? 0.2e-3 : 0.0});  // about a quarter of the way round
  found.clear();
  find_gap_lapses(rules, join, t, {stitches[0], stitches[1]}, false, 2.0, found);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_STREQ(found[0].name, "loose-knot");
  EXPECT_EQ(found[0].stitch, 1);
  EXPECT_STREQ(found[1].name, "disrupted-line");
}

}  // namespace cut_line_test
}  // namespace filum
