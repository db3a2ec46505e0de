#include "world/fresh_suture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
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

/// The upstream stump of an artery. One suture lies tied elsewhere; the next one leads from the lumen out through the wall on top, its short end 0.3 mm inside. Forceps hold it 3 mm
/// above the wall.
struct PulledOut {
  static constexpr int kTied = 10;       // nodes of the first suture
  static constexpr double kInside = 0.3e-3, kHeld = 3e-3;  // [m]

  explicit PulledOut(bool second) : m(scene("artery-knot", 1)), s(World(m).state()) {
    find_place();
    lay_thread();
    lay_track();
    hold_thread();
    if (second) return;
    RodMemory none;
    take_out({0, kTied - 1}, s.thread, none);
    const double start = s.thread.arc_start;
    s.thread.arc_start = 0.0;
    for (GraspPoint& g : s.memory.grasps) g.arc -= start;
  }

  std::shared_ptr<Model> m;
  State s;
  int element = -1;
  Vec3 in, out;  // [m], where it goes through the wall

 private:
  Vec3 middle(int e, std::size_t from) const {
    const auto& nodes = m->vessel->mesh.elements[static_cast<std::size_t>(e)];
    return std::accumulate(nodes.begin() + from, nodes.begin() + from + 4, Vec3(Vec3::Zero()), [&](const Vec3& sum, int n) { return Vec3(sum + 0.25 * s.tissue.wall.x.col(n)); });
  }
  double start() const { return arc_of_node(s.thread, kTied); }
  /// The outermost element on top, a millimetre from the cut edge.
  void find_place() {
    const VesselMesh& mesh = m->vessel->mesh;
    for (int e = 0; e < mesh.n_elements(); ++e) {
      const Vec3 p = middle(e, 4);
      if (mesh.part[static_cast<std::size_t>(e)] != 0 || mesh.span[static_cast<std::size_t>(e)][1] < 1.0 || std::abs(p.y() + 0.9e-3) > 0.35e-3) continue;
      if (element >= 0 && p.z() <= out.z()) continue;
      element = e;
      in = middle(e, 0);
      out = p;
    }
  }
  void lay_thread() {
    Points x(3, kTied + 45);
    for (int i = 0; i < x.cols(); ++i) x.col(i) = i < kTied ? Vec3(-8e-3, 6e-3 + 0.5e-3 * i, -2.9e-3) : Vec3(in + (0.3e-3 * (i - kTied) - kInside) * Vec3::UnitZ());
    s.thread = RodState::from_nodes(x, m->description.capacity);
    s.thread.alive[kTied - 1] = 0;
    s.thread.rest_length[kTied - 1] = 1e-3;
    s.memory.self.clear();
    s.memory.obstacle.clear();
    const NeedleShape& n = m->needle->shape;
    s.needle.X_WN.q = Quat::FromTwoVectors(n.tangent(0.0), Vec3::UnitZ());
    s.needle.X_WN.p = Vec3(x.col(x.cols() - 1)) - s.needle.X_WN.q * n.point(0.0);
    s.tissue.tracks.point_before = s.needle.X_WN * n.point(n.length());
  }
  void lay_track() {
    s.tissue.tracks.n = 1;
    NeedleTrack& t = s.tissue.tracks.tracks[0];
    t.n = 2;
    t.out = 1;
    t.bite_entry = t.bite_exit = 0.4e-3;
    t.hole = m->needle->shape.wire_radius;
    const double entry = start() + kInside - arc_of_node(s.thread, s.thread.n - 1);
    t.knots[0] = {{element, -Vec3::UnitZ()}, entry, 0.07e-3, 0.0};
    t.knots[1] = {{element, Vec3::UnitZ()}, entry + (out - in).norm(), 0.07e-3, 0.0};
    t.entry = t.knots[0].at;
    t.exit = t.knots[1].at;
  }
  void hold_thread() {
    Mat3 r;
    r << Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX();
    InstrumentState& f = s.instruments[0];
    f.X_WT = f.X_WD = {Vec3(out + kHeld * Vec3::UnitZ() - 0.5 * m->instruments[0].pads.length * Vec3::UnitX()), Quat(r)};
    f.angle = 0.0;
    f.grip_command = -0.1;
    f.grip_force = 0.5;
    s.armed[0] = 0;
    const double above = (out - in).norm() + kHeld;  // [m], the lumen
    for (const double g : {above - 0.05e-3, above + 0.05e-3}) s.memory.grasps.push_back({0, start() + kInside + g, f.X_WT.inverse() * Vec3(in + g * Vec3::UnitZ())});
  }
};

/// A thread that is pulled right out of the wall is out, whichever suture of the scene it is; the one tied before stays where it is.
TEST(FreshSuture, TheSecondSutureCanBePulledOut) {
  for (const bool second : {false, true}) {
    const PulledOut p(second);
    World w(p.m);
    w.restore(p.s);
    Inputs in;
    in.tools[0] = {p.s.instruments[0].X_WT, -0.1, 0.0, false, true, 0};
    double nearest = 1.0;  // [m], of the tied suture to the hole
    for (int k = 0; k < 700; ++k) {
      in.tools[0].X_WD.p.z() += k < 500 ? 5e-6 : 0.0;  // 2.5 mm
      w.step(in);
      const Observation& o = w.observation();
      for (int i = 0; second && i <= o.parted[0]; ++i) nearest = std::min(nearest, (Vec3(o.positions.col(i)) - p.out).norm());
    }
    EXPECT_EQ(w.observation().tissue.passes[0].state, PassObservation::State::pulled_out) << (second ? "second" : "first");
    EXPECT_GT(nearest, 5e-3);
  }
}

}  // namespace fresh_suture_test
}  // namespace filum
