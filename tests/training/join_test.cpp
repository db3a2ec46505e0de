// In a task's report: needle_watch_test.

#include "training/join.h"

#include <gtest/gtest.h>

namespace filum {
namespace join_test {

struct Bench {
  Observation o;
  BloodWatch watch;
  BloodObservation& blood = o.tissue.blood;

  Bench() { blood.present = true; }
  void see(double time, std::initializer_list<WorldEvent> events = {}) {
    o.time = time;
    o.n_events = 0;
    for (const WorldEvent& e : events) o.events[static_cast<std::size_t>(o.n_events++)] = e;
    watch.observe(o);
  }
};

TEST(Join, TellsOfFlowOnlyOnceAClampIsOff) {
  Bench b;
  b.blood.least_area = 0.2e-6;
  b.blood.leaks = 3e-7;
  b.blood.lost = 1e-9;
  b.blood.wrong_order = true;
  b.see(1.0);
  b.blood.least_area = 0.3e-6;
  b.see(2.0);
  EXPECT_FALSE(b.watch.clamps().any());
  EXPECT_EQ(b.watch.clamps().most_leak, 0.0);
  EXPECT_FALSE(b.watch.clamps().wrong_order);
  b.blood.wrong_order = false;
  b.blood.least_area = 0.4e-6;
  b.blood.leaks = 2e-7;
  b.blood.through = 5e-7;
  b.blood.lost = 2e-9;
  b.blood.pressure = {12e3, 11e3};
  b.see(3.0, {{"clamp-off", -1, 0.0, "-"}});
  const ClampReport& c = b.watch.clamps();
  EXPECT_TRUE(c.any());
  EXPECT_EQ(c.upstream, 3.0);
  EXPECT_NE(c.downstream, c.downstream) << "still on";
  EXPECT_EQ(c.area_before, 0.3e-6) << "of the last moment with both on";
  EXPECT_EQ(c.area, 0.4e-6);
  EXPECT_EQ(c.leak, 2e-7);
  EXPECT_EQ(c.through, 5e-7);
  EXPECT_EQ(c.lost, 2e-9);
  EXPECT_EQ(c.pressure[0], 12e3);
  EXPECT_EQ(c.pressure[1], 11e3);
  b.blood.leaks = 1e-7;
  b.see(4.0);
  EXPECT_EQ(c.leak, 1e-7);
  EXPECT_EQ(c.most_leak, 2e-7);
}

/// A test that was spoiled says nothing of the join and does not count; seconds and volume are those of the last test that had them.
TEST(Join, CountsMilkingTestsThatSaySomething) {
  Bench b;
  b.see(1.0, {{"milking-let-go", 0, 0.5, "ul"}});
  EXPECT_EQ(b.watch.milking().tests(), 0) << "not yet";
  b.see(2.0, {{"milking-refilled", 0, 0.7, "s"}, {"milking-let-go", 1, 0.25, "ul"}});
  b.see(3.0, {{"milking-stayed-empty", 1, 3.0, "s"}});
  b.see(4.0, {{"milking-spoiled", 1, 0.0, "-"}});
  b.see(5.0);
  const MilkingReport& m = b.watch.milking();
  EXPECT_EQ(m.refilled, 1);
  EXPECT_EQ(m.stayed_empty, 1);
  EXPECT_EQ(m.spoiled, 1);
  EXPECT_EQ(m.tests(), 2);
  EXPECT_EQ(m.seconds, 0.7);
  EXPECT_NEAR(m.volume, 0.25e-9, 1e-24);
}

TEST(Join, SaysNothingOfASceneWithoutBlood) {
  Bench b;
  b.blood.present = false;
  b.see(1.0, {{"clamp-off", -1, 1.0, "-"}, {"milking-refilled", 0, 0.7, "s"}});
  EXPECT_FALSE(b.watch.clamps().any());
  EXPECT_EQ(b.watch.milking().tests(), 0);
  EXPECT_NE(b.watch.clamps().area_before, b.watch.clamps().area_before);
}

}  // namespace join_test
}  // namespace filum
