#include "world/track_reach.h"

#include <gtest/gtest.h>

namespace filum {
namespace track_reach_test {

/// A thread of 10 mm, its first 2 mm cut off, with tracks at 4.0 to 4.2 mm (laid from the needle's side) and at 7 mm, and one that has ended.
struct Reaches {
  RodState thread;
  TrackState tracks;

  Reaches() {
    Points nodes = Points::Zero(3, 9);
    for (int i = 0; i < 9; ++i) nodes(0, i) = 1e-3 * i;
    thread = RodState::from_nodes(nodes, 9);
    thread.arc_start = 2e-3;
    add({-5.8e-3, -6.0e-3});
    add({});
    add({-3e-3});
  }
  void add(std::initializer_list<double> strands) {
    NeedleTrack& t = tracks.tracks[static_cast<std::size_t>(tracks.n++)];
    for (const double s : strands) {
      t.knots[static_cast<std::size_t>(t.n)].at.element = t.n;
      t.knots[static_cast<std::size_t>(t.n++)].strand = s;
    }
  }
};

TEST(TrackReach, HoldsTheTracksAndALittleBeside) {
  const Reaches r;
  const TrackReaches reaches(r.tracks, r.thread);
  for (const double arc : {3.71e-3, 4.1e-3, 4.49e-3, 6.71e-3, 7.29e-3}) EXPECT_TRUE(reaches.hold(arc)) << arc;
  for (const double arc : {2e-3, 3.69e-3, 4.51e-3, 6.69e-3, 7.31e-3, 10e-3}) EXPECT_FALSE(reaches.hold(arc)) << arc;
}

TEST(TrackReach, TellsTheMouthsByTheThreadsArc) {
  const Reaches r;
  const TrackReaches reaches(r.tracks, r.thread);
  const TrackReach* first = reaches.at(4.1e-3);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->low.element, 1);
  EXPECT_EQ(first->high.element, 0);
  EXPECT_NEAR(first->from, 3.7e-3, 1e-9);
  EXPECT_NEAR(first->to, 4.5e-3, 1e-9);
}

TEST(TrackReach, TellsWhereTheNextBegins) {
  const Reaches r;
  const TrackReaches reaches(r.tracks, r.thread);
  EXPECT_NEAR(reaches.next(2e-3), 3.7e-3, 1e-9);
  EXPECT_NEAR(reaches.next(4.1e-3), 6.7e-3, 1e-9);
  EXPECT_GT(reaches.next(7e-3), 1.0);
}

TEST(TrackReach, HoldsAnEdgeWhereItHoldsAllItsSamples) {
  const Reaches r;
  const TrackReaches reaches(r.tracks, r.thread);
  EXPECT_TRUE(reaches.hold_all(3.8e-3, 0.5e-3, 5));
  EXPECT_FALSE(reaches.hold_all(3.6e-3, 0.5e-3, 5));
}

}  // namespace track_reach_test
}  // namespace filum
