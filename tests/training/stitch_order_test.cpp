#include "training/stitch_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oblique_edges.h"
#include "training/needle_watch.h"
#include "training/task.h"

namespace filum {
namespace stitch_order_test {

constexpr double kDegree = std::numbers::pi / 180.0, kRadius = 0.6e-3;

TissueDescription vessel() {
  TissueDescription t;
  t.kind = "vessel";
  t.lumen = true;
  t.cut_along = -Vec3::UnitX();
  t.radius = kRadius;
  t.thickness = 0.1e-3;
  return t;
}

/// A made-up vessel in which stitches appear.
class Vessel {
 public:
  explicit Vessel(const std::string& task, const TissueDescription& tissue = vessel())
      : Vessel(load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/" + task + "/task.yaml").needle->goals, tissue) {}
  explicit Vessel(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue = vessel()) : goals_(goals), tissue_(tissue), order_(goals_, tissue_) {
    o_.n_nodes = 4;  // a straight thread, so that there is no knot
    o_.positions.setZero(3, 4);
    o_.arc.resize(4);
    for (int i = 0; i < 4; ++i) o_.positions(0, i) = o_.arc[static_cast<std::size_t>(i)] = 20e-3 * i;
  }
  /// Bites at these angles [deg] on the two stumps.
  void stitch(double first, double second) {
    bite(first, 0);
    order_.observe(o_, events_);
    bite(second, 1);
    order_.observe(o_, events_);
  }
  void stitch(double angle) { stitch(angle, angle); }
  void half_stitch(double angle) {
    bite(angle, 0);
    order_.observe(o_, events_);
  }
  PassObservation& last() { return o_.tissue.passes[static_cast<std::size_t>(o_.tissue.n_passes - 1)]; }
  Observation& observation() { return o_; }
  /// Which of the goals of kind stitch have what they ask for, as "110".
  std::string made() const {
    std::string text;
    for (std::size_t g = 0; g < goals_.size(); ++g)
      if (goals_[g].kind == NeedleGoal::Kind::stitch) text += order_.made(static_cast<int>(g)) ? '1' : '0';
    return text;
  }
  int running_goal() const {
    for (std::size_t g = 0; g < goals_.size(); ++g)
      if (goals_[g].stitch.running) return static_cast<int>(g);
    return -1;
  }
  const StitchOrder& order() const { return order_; }
  const std::vector<TaskEvent>& events() const { return events_; }

 private:
  void bite(double angle, int side) {
    PassObservation& p = o_.tissue.passes[static_cast<std::size_t>(o_.tissue.n_passes++)];
    p = {};
    p.out = true;
    p.side = side;
    p.state = PassObservation::State::thread;
    p.arc = 1e-3 * o_.tissue.n_passes;
    const double a = angle * kDegree;
    if (!tissue_.edges[0].rim.empty()) {
      p.entry_rest = p.exit_rest = at_share(tissue_.edges[static_cast<std::size_t>(side)].rim, angle / 360.0);
      return;
    }
    p.entry_rest = p.exit_rest = kRadius * Vec3(-std::cos(a), 0.0, std::sin(a)) + (side == 0 ? -0.2e-3 : 0.2e-3) * Vec3::UnitY();
  }
  static Vec3 at_share(const std::vector<Vec3>& rim, double share) {
    double whole = 0.0, left = 0.0;
    const auto side = [&](std::size_t k) { return (rim[(k + 1) % rim.size()] - rim[k]).norm(); };
    for (std::size_t k = 0; k < rim.size(); ++k) whole += side(k);
    left = (share - std::floor(share)) * whole;
    std::size_t k = 0;
    for (; left > side(k); ++k) left -= side(k);
    return rim[k];
  }
  std::vector<NeedleGoal> goals_;
  TissueDescription tissue_;
  StitchOrder order_;
  Observation o_;
  std::vector<TaskEvent> events_;
};

TEST(StitchOrder, StaysAtAThirdOfATurnFirst) {
  for (const double first : {0.0, 90.0, 200.0}) {
    Vessel v("triangulation-120");
    v.stitch(first);
    EXPECT_EQ(v.made(), "1000");
    v.stitch(first - 112.0);
    EXPECT_EQ(v.made(), "1100");
    v.stitch(first + 122.0);
    EXPECT_EQ(v.made(), "1110");
    for (const double fill : {62.0, 180.0, -58.0}) v.stitch(first + fill);
    EXPECT_EQ(v.made(), "1111") << first;
    EXPECT_EQ(v.order().out_of_turn(), 0);
    EXPECT_TRUE(v.events().empty());
  }
}

TEST(StitchOrder, StaysAcrossFromEachOtherAreNoTriangle) {
  Vessel v("triangulation-120");
  v.stitch(90.0);
  v.stitch(270.0);
  EXPECT_EQ(v.made(), "1000");
  EXPECT_EQ(v.order().out_of_turn(), 1);
  ASSERT_EQ(v.events().size(), 1u);
  EXPECT_STREQ(std::string(v.events()[0].name).c_str(), "stitch-out-of-turn");
}

TEST(StitchOrder, AStayThatIsOffOnOneStumpIsNone) {
  Vessel v("triangulation-120");
  v.stitch(0.0);
  v.stitch(120.0, 150.0);
  EXPECT_EQ(v.made(), "1000") << "a dog-ear";
  EXPECT_EQ(v.order().out_of_turn(), 1);
}

TEST(StitchOrder, AStitchBetweenStaysComesTooEarlyAndCountsLater) {
  Vessel v("triangulation-120");
  v.stitch(0.0);
  v.stitch(60.0);
  EXPECT_EQ(v.order().out_of_turn(), 1);
  v.stitch(120.0);
  v.stitch(240.0);
  EXPECT_EQ(v.made(), "1110");
  v.stitch(180.0);
  v.stitch(300.0);
  EXPECT_EQ(v.made(), "1111") << "the early one is one of the three between";
  EXPECT_EQ(v.order().out_of_turn(), 1);
}

TEST(StitchOrder, StitchesThatWaitAreTakenInAnyOrder) {
  std::vector<NeedleGoal> goals;
  for (const double from : {0.0, 90.0, 180.0}) {
    NeedleGoal g;
    g.kind = NeedleGoal::Kind::stitch;
    g.stitch.from = (from - 20.0) * kDegree;
    g.stitch.span = 40.0 * kDegree;
    goals.push_back(g);
  }
  for (const std::vector<double>& angles : std::vector<std::vector<double>>{{0.0, 90.0, 180.0}, {90.0, 180.0, 0.0}, {180.0, 90.0, 0.0}}) {
    Vessel v(goals);
    for (const double a : angles) v.stitch(a);
    EXPECT_EQ(v.made(), "111") << "begun at " << angles.front();
  }
}

TEST(StitchOrder, PosteriorWallFirst) {
  Vessel right("posterior-wall-first");
  for (const double a : {270.0, 225.0, 315.0, 180.0, 0.0, 135.0, 45.0, 90.0}) right.stitch(a);
  EXPECT_EQ(right.made(), "111");
  EXPECT_EQ(right.order().out_of_turn(), 0);
  Vessel front("posterior-wall-first");
  for (const double a : {270.0, 90.0, 225.0, 315.0}) front.stitch(a);
  EXPECT_EQ(front.made(), "110");
  EXPECT_EQ(front.order().out_of_turn(), 1) << "the front before the back was closed";
  Vessel wrong("posterior-wall-first");
  wrong.stitch(90.0);
  EXPECT_EQ(wrong.made(), "000");
  EXPECT_EQ(wrong.order().out_of_turn(), 1);
}

TEST(StitchOrder, VeinsStaysStandAcross) {
  Vessel v("anastomosis-vein");
  for (const double a : {90.0, 275.0}) v.stitch(a);
  EXPECT_EQ(v.made(), "110");
  v.stitch(100.0);
  EXPECT_EQ(v.order().out_of_turn(), 1) << "ten degrees from a stay is none of the six between";
  for (const double a : {0.0, 180.0, 45.0, 135.0, 225.0, 318.0}) v.stitch(a);
  EXPECT_EQ(v.made(), "111");
}

TEST(StitchOrder, EndToSideHeelToeAndThenEitherWall) {
  Vessel v("end-to-side", testing_shapes::oblique_edges());
  for (const double a : {3.0, 178.0, 270.0, 315.0, 225.0, 90.0, 45.0, 135.0}) v.stitch(a);
  EXPECT_EQ(v.made(), "11111111");
  EXPECT_EQ(v.order().out_of_turn(), 0);
  Vessel wrong("end-to-side", testing_shapes::oblique_edges());
  wrong.stitch(0.0);
  wrong.stitch(180.0, 150.0);
  EXPECT_EQ(wrong.made(), "10000000") << "at the toe of the opening but not of the stump";
  wrong.stitch(180.0);
  wrong.stitch(90.0);
  EXPECT_EQ(wrong.made(), "11000000") << "the wall that lies behind came first";
  EXPECT_EQ(wrong.order().out_of_turn(), 2);
}

TEST(StitchOrder, ARunningThreadGoesOnTheSameWayRound) {
  Vessel v("continuous-suture");
  for (int k = 0; k < 8; ++k) v.stitch(-40.0 * k);
  EXPECT_EQ(v.made(), "11");
  EXPECT_EQ(v.order().out_of_turn(), 0);
  EXPECT_TRUE(v.order().runs_on(v.running_goal(), v.observation()));
  Vessel back("continuous-suture");
  for (const double a : {0.0, 45.0, 90.0, 45.0}) back.stitch(a);
  EXPECT_EQ(back.order().out_of_turn(), 1) << "back again";
  Vessel far("continuous-suture");
  for (const double a : {0.0, 90.0}) far.stitch(a);
  EXPECT_EQ(far.order().out_of_turn(), 1) << "a stitch left out";
}

TEST(StitchOrder, ACutThreadDoesNotRunOn) {
  Vessel v("continuous-suture");
  for (int k = 0; k < 8; ++k) v.stitch(45.0 * k);
  ASSERT_TRUE(v.order().runs_on(v.running_goal(), v.observation()));
  Observation& o = v.observation();
  for (int i = 0; i < 4; ++i) o.arc[static_cast<std::size_t>(i)] = 2e-3 * i + 3e-3;
  o.n_parted = 1;
  o.parted[0] = 1;  // between the arcs of 5 and 7 mm: after the third stitch
  EXPECT_FALSE(v.order().runs_on(v.running_goal(), o));
}

TEST(StitchOrder, BitesThatWerePulledOutAreNoStitch) {
  Vessel v("triangulation-120");
  v.half_stitch(0.0);
  v.last().state = PassObservation::State::pulled_out;
  v.stitch(30.0);
  EXPECT_EQ(v.made(), "1000");
  v.stitch(150.0);
  EXPECT_EQ(v.made(), "1100") << "120 degrees from the stitch, not from the bite that was pulled out";
}

}  // namespace stitch_order_test
}  // namespace filum
