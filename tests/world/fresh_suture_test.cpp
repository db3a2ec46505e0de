#include "world/fresh_suture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/allocation_count.h"
#include "world/needle_model.h"
#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace fresh_suture_test {

constexpr std::uint32_t kFresh = 32;

std::shared_ptr<Model> scene(const std::string& task, int sutures) {
  auto m = std::make_shared<Model>(*load_model(FILUM_SOURCE_DIR, task));
  m->sutures = sutures;
  return m;
}

Inputs resting(const Model& m, std::uint32_t buttons) {
  Inputs in;
  for (std::size_t i = 0; i < m.instruments.size(); ++i) in.tools[i] = {m.instrument_start[i], 0.2, 0.0, false, true, buttons};
  return in;
}

/// What the world said of sutures in one step with this button.
std::string press(World& w, std::uint32_t buttons = kFresh) {
  w.step(resting(w.model(), buttons));
  std::string said;
  const Observation& o = w.observation();
  for (int k = 0; k < o.n_events; ++k)
    if (std::string(o.events[static_cast<std::size_t>(k)].name).starts_with("suture")) said += o.events[static_cast<std::size_t>(k)].name;
  return said;
}

/// Thread nodes of a scene at its start.
int first_nodes(const Model& m) { return static_cast<int>(m.thread_path.cols()); }

/// As after a stitch: the thread cut behind nodes 5 and 13, what lies between them on its way through two elements, the needle beside the field.
State sewn(const std::shared_ptr<const Model>& m) {
  State s = World(m).state();
  s.thread.alive[5] = s.thread.alive[13] = 0;
  for (int i = 0; i < s.thread.n; ++i) s.thread.x(0, i) += i > 13 ? 1e-3 : i > 5 ? -1e-3 : 2e-3;  // apart from where the new one will lie
  s.needle.X_WN.p.x() += 1e-3;
  s.tissue.tracks.n = 1;
  NeedleTrack& t = s.tissue.tracks.tracks[0];
  t.n = 2;
  t.out = 1;
  for (int k = 0; k < 2; ++k) {
    t.knots[static_cast<std::size_t>(k)].at.element = k;
    t.knots[static_cast<std::size_t>(k)].strand = arc_of_node(s.thread, 8 + k) - arc_of_node(s.thread, s.thread.n - 1);
  }
  s.tissue.touches.n = 2;
  s.tissue.touches.touches[0].arc = arc_of_node(s.thread, 10) + 1e-5;
  s.tissue.touches.touches[1].arc = arc_of_node(s.thread, 2);
  s.cut_low = arc_of_node(s.thread, 5) + 1e-5;
  return s;
}

/// [m], material coordinate of the thread in knot `k` of way `track`.
double arc_in(const State& s, int track, int k) {
  return arc_of_node(s.thread, s.thread.n - 1) + s.tissue.tracks.tracks[static_cast<std::size_t>(track)].knots[static_cast<std::size_t>(k)].strand;
}

/// What is said to a press of the button in this state, which it changes.
std::string ask(const std::shared_ptr<const Model>& m, State& s) {
  Observation o;
  FreshSuture(*m).hear(s, kFresh, o);
  s.sutures.down = 0;
  return o.n_events == 1 ? o.events[0].name : "";
}

TEST(FreshSuture, LiesWhereTheFirstOneLay) {
  const auto m = scene("needle-loading", 3);
  World w(m);
  for (int k = 0; k < 100; ++k) w.step(resting(*m, 0));
  State moved = w.state();
  moved.needle.X_WN.p += Vec3(2e-3, 0, 0);
  moved.thread.x.row(0).array() += 2e-3;
  w.restore(moved);
  EXPECT_EQ(press(w), "suture-fresh");
  EXPECT_EQ(w.observation().needle.sutures_left, 1);
  EXPECT_EQ(w.observation().n_nodes, first_nodes(*m));
  EXPECT_LT((w.observation().needle.X_WN.p - m->needle->start.p).norm(), 30e-6) << "one step on";
  for (int i = 0; i < first_nodes(*m); ++i) EXPECT_LT((w.observation().positions.col(i) - m->thread_path.col(i)).norm(), 50e-6);
  EXPECT_EQ(w.observation().n_parted, 0);
  EXPECT_EQ(press(w), "") << "held down, the button is heard once";
  press(w, 0);
  EXPECT_EQ(press(w), "suture-fresh");
  press(w, 0);
  EXPECT_EQ(press(w), "suture-none-left");
}

TEST(FreshSuture, TiedStitchesStayAndLooseEndsGo) {
  const auto m = scene("artery-knot", 8);
  const State before = sewn(m);
  State s = before;
  EXPECT_EQ(ask(m, s), "suture-fresh");
  ASSERT_EQ(s.thread.n, 8 + first_nodes(*m)) << "of the three pieces only the one in the tissue is kept";
  EXPECT_EQ(s.thread.x.leftCols(8), before.thread.x.middleCols(6, 8));
  EXPECT_EQ(s.thread.x.middleCols(8, first_nodes(*m)), m->thread_path);
  EXPECT_EQ(s.thread.alive[7], 0);
  EXPECT_EQ(s.thread.alive.head(7).minCoeff(), 1);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(arc_in(s, 0, k), arc_in(before, 0, k), 1e-15) << "it runs through the tissue where it did";
  EXPECT_NEAR(arc_of_node(s.thread, 0), arc_of_node(before.thread, 6), 1e-15);
  ASSERT_EQ(s.tissue.touches.n, 1);
  EXPECT_EQ(s.tissue.touches.touches[0].arc, before.tissue.touches.touches[0].arc);
  EXPECT_EQ(s.cut_low, -1.0) << "the parted edge before what is kept went with the end";
  EXPECT_EQ(s.needle.X_WN.p, m->needle->start.p);
  EXPECT_EQ(s.sutures.taken, 2);
}

TEST(FreshSuture, OneStitchAfterTheOther) {
  const auto m = scene("artery-knot", 8);
  State s = sewn(m);
  EXPECT_EQ(ask(m, s), "suture-fresh");
  const int strand = piece_to(s.thread, s.thread.n - 1).first;  // a second stitch with the new thread
  s.thread.alive[strand + 5] = s.thread.alive[strand + 13] = 0;
  for (int i = strand; i < s.thread.n; ++i) s.thread.x(0, i) += i > strand + 13 ? 1e-3 : i > strand + 5 ? -1.5e-3 : 2e-3;
  NeedleTrack& t = s.tissue.tracks.tracks[1] = s.tissue.tracks.tracks[0];
  s.tissue.tracks.n = 2;
  for (int k = 0; k < 2; ++k) t.knots[static_cast<std::size_t>(k)].strand = arc_of_node(s.thread, strand + 8 + k) - arc_of_node(s.thread, s.thread.n - 1);
  s.tissue.touches.touches[1] = s.tissue.touches.touches[0];
  s.tissue.touches.touches[1].arc = arc_of_node(s.thread, strand + 9);
  s.tissue.touches.n = 2;
  EXPECT_EQ(ask(m, s), "suture-fresh");
  ASSERT_EQ(s.thread.n, 16 + first_nodes(*m));
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(arc_in(s, 0, k), arc_of_node(s.thread, 2 + k), 1e-15);
    EXPECT_NEAR(arc_in(s, 1, k), arc_of_node(s.thread, 10 + k), 1e-15) << "the loose end before the second stitch went";
  }
  EXPECT_NEAR(s.tissue.touches.touches[1].arc, arc_of_node(s.thread, 11), 1e-15);
}

TEST(FreshSuture, IsRefusedWhileTheNeedleOrItsStrandIsInUse) {
  const auto m = scene("artery-knot", 8);
  const auto says = [&](auto spoil) {
    State s = sewn(m);
    spoil(s);
    const Points before = s.thread.x;
    const std::string said = ask(m, s);
    EXPECT_EQ(s.sutures.taken, said == "suture-fresh" ? 2 : 1);
    EXPECT_EQ(s.thread.x == before, said != "suture-fresh") << said;
    return said;
  };
  EXPECT_EQ(says([](State&) {}), "suture-fresh");
  EXPECT_EQ(says([](State& s) { s.needle.grips[1].held = 1; }), "suture-held");
  EXPECT_EQ(says([](State& s) {
              GraspPoint g;
              g.tool = 0;
              g.arc = arc_of_node(s.thread, s.thread.n - 3);
              s.memory.grasps.push_back(g);
            }), "suture-held");
  EXPECT_EQ(says([](State& s) { s.tissue.tracks.tracks[0].knots[1].strand = -1e-3; }), "suture-in-tissue");
  EXPECT_EQ(says([](State& s) { s.tissue.tracks.tracks[0].knots[1].strand = 1e-3; }), "suture-in-tissue");
  EXPECT_EQ(says([](State& s) { s.thread.alive[13] = 1; }), "suture-in-tissue") << "one end only is cut";
  EXPECT_EQ(says([&](State& s) { s.instruments[0].X_WT.p = m->thread_path.col(4) + Vec3(0, 0, 0.1e-3); }), "suture-in-the-way");
  EXPECT_EQ(says([&](State& s) { s.thread.x.row(0).array() += 1e-3; }), "suture-in-the-way") << "the tied piece lies there";
}

TEST(FreshSuture, IsRefusedWhereThereIsNoRoomForItsNodes) {
  auto m = scene("artery-knot", 8);
  State s = sewn(m);
  m->description.capacity = first_nodes(*m) + 7;  // one less than with the tied piece
  EXPECT_EQ(ask(m, s), "suture-no-room");
  ++m->description.capacity;
  EXPECT_EQ(ask(m, s), "suture-fresh");
}

TEST(FreshSuture, AHeldEndStaysInTheHand) {
  const auto m = scene("artery-knot", 8);
  State s = sewn(m);
  GraspPoint g;
  g.tool = 0;
  g.arc = arc_of_node(s.thread, 2);
  s.memory.grasps.push_back(g);
  EXPECT_EQ(ask(m, s), "suture-fresh");
  EXPECT_EQ(s.thread.n, 14 + first_nodes(*m));
  EXPECT_EQ(s.memory.grasps[0].arc, g.arc);
}

TEST(FreshSuture, GoesOnAlikeFromASnapshotAndAllocatesNothing) {
  const auto m = scene("needle-loading", 3);
  State cut = World(m).state();
  cut.thread.alive[6] = 0;
  cut.thread.x.row(0).array() += 1e-3;
  cut.needle.X_WN.p.x() += 1e-3;
  World one(m), other(m), plain(m);
  one.restore(cut);
  plain.restore(cut);
  long before = allocations;
  press(plain, 0);
  const long without = allocations - before;
  before = allocations;
  EXPECT_EQ(press(one), "suture-fresh");
  const long with = allocations - before;
  EXPECT_LE(with, without + 5) << "no more than a step without it, whose own are ODE's";
  other.restore(one.state());
  EXPECT_EQ(one.state_hash(), other.state_hash());
  for (int k = 0; k < 20; ++k) {
    press(one, 0);
    press(other, 0);
  }
  EXPECT_EQ(one.array_hashes(), other.array_hashes());
  State again = one.state();
  again.sutures.taken = 3;
  other.restore(again);
  EXPECT_NE(one.state_hash(), other.state_hash()) << "how many are left is part of the state";
}

}  // namespace fresh_suture_test
}  // namespace filum
