#include "world/vessel_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "world/model.h"
#include "world/needle_model.h"
#include "world/state.h"
#include "world/vessel_file.h"
#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace vessel_scene_test {

std::shared_ptr<const Model> scene() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "card-stitches");
  return model;
}

std::shared_ptr<const Model> stumps() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "vessel-stitch");
  return model;
}

/// Of every shipped tissue: what tears a bite of one to three walls draws the strand aside by less than that bite, so that a stitch tied too tight tears it and does not slip off its edge.
TEST(VesselScene, ABiteTearsBeforeTheStrandIsAtItsEdge) {
  struct Tissue {
    const char* name;
    double wall;  // [m]
  };
  for (const Tissue& t : {Tissue{"artery", 0.14e-3}, {"vein", 0.033e-3}, {"silicone", 0.15e-3}, {"latex", 0.2e-3}}) {
    const TrackMaterial m = load_track(std::string(FILUM_SOURCE_DIR) + "/models/track/" + t.name + ".yaml");
    constexpr int kKnots = 3;  // the fewest of a way through a wall
    for (const double walls : {1.0, 2.0, 3.0}) {
      const double bite = walls * t.wall;
      EXPECT_GT(kKnots * knot_hold(m, bite).force, m.tear * bite) << t.name << ", " << walls;
    }
  }
}

TEST(VesselScene, CardLiesStillByItself) {
  World w(scene());
  Inputs in;
  const Points before = w.observation().tissue.positions;
  for (int k = 0; k < 200; ++k) w.step(in);
  EXPECT_LT((w.observation().tissue.positions - before).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(w.observation().tissue.n_passes, 0);
  EXPECT_EQ(w.observation().tissue.n, scene()->vessel->mesh.n_nodes());
}

TEST(VesselScene, JawPressesTheCardDownAndFeelsIt) {
  World w(scene());
  Inputs in;
  ToolInput& t = in.tools[0];
  t.valid = true;
  t.grip_angle = 0.0;
  double deepest = 0.0, felt = 0.0;
  for (int k = 0; k < 900; ++k) {
    t.X_WD.p = Vec3(0.0, 1.5e-3, 1.5e-3 - std::min(k, 750) * 2e-6);
    w.step(in);
    deepest = std::min(deepest, w.observation().tissue.positions.row(2).minCoeff());
    felt = std::max(felt, w.observation().tools[0].f_T_W.z());
  }
  EXPECT_LT(deepest, -0.15e-3) << "below where it lay";
  EXPECT_GT(felt, 1e-4);
}

/// "magnitude of the thread's pull on the jaws" (observation.h): the thread lies centimetres away.
TEST(VesselScene, JawThatFeelsTheCardIsNotToldOfAPullOfTheThread) {
  World w(scene());
  Inputs in;
  ToolInput& t = in.tools[0];
  t.valid = true;
  t.grip_angle = 0.0;
  double nearest = 1.0, told = 0.0, felt = 0.0;
  for (int k = 0; k < 900; ++k) {
    t.X_WD.p = Vec3(0.0, 1.5e-3, 1.5e-3 - std::min(k, 750) * 2e-6);
    w.step(in);
    const Observation& o = w.observation();
    for (int i = 0; i < o.n_nodes; ++i) nearest = std::min(nearest, (o.positions.col(i) - o.tools[0].X_WT.p).norm());
    told = std::max(told, o.tools[0].thread_force);
    felt = std::max(felt, o.tools[0].f_T_W.norm());
  }
  EXPECT_GT(felt, 1e-4);
  EXPECT_GT(nearest, 2e-3);
  EXPECT_LT(told, 1e-5) << "the thread is " << 1e3 * nearest << " mm away";
}

/// At half a metre a second a step takes a jaw 1 mm on: through the card and out, if nothing held it back.
TEST(VesselScene, FastJawsDoNotPassThroughTheCard) {
  for (const double speed : {0.05, 0.2, 0.5}) {
    World w(scene());
    Inputs in;
    ToolInput& t = in.tools[0];
    t.valid = true;
    t.grip_angle = 0.0;
    double lowest = 0.0;
    for (int k = 0; k < 700; ++k) {
      t.X_WD.p = Vec3(0.0, 1.5e-3, std::max(-0.4e-3, 4e-3 - std::max(0, k - 200) * speed * 2e-3));
      w.step(in);
      lowest = std::min(lowest, w.state().instruments[0].X_WT.p.z());
    }
    EXPECT_LT(lowest, -0.25e-3) << "the hand gets its way, " << speed;
    const Points& x = w.observation().tissue.positions;
    double under = 0.0;  // of the card, where the jaw is
    for (int i = 0; i < x.cols(); ++i)
      if ((Vec3(x.col(i)) - w.state().instruments[0].X_WT.p).head<2>().norm() < 0.4e-3) under = std::min(under, x(2, i));
    EXPECT_LT(under, -0.3e-3) << "the card is below the jaw, " << speed;
  }
}

/// The hand feels the coupling between it and the tool (haptics/hand_coupling.h): a jaw that is held back hangs behind, where one
/// in free air has caught up.
TEST(VesselScene, FastJawThatIsHeldBackIsFelt) {
  const auto felt = [](double high) {  // [m], above the card; [N], at most, once the tool goes as fast as the hand
    World w(scene());
    Inputs in;
    ToolInput& t = in.tools[0];
    t.valid = true;
    t.grip_angle = 0.0;
    double most = 0.0;
    for (int k = 0; k < 320; ++k) {
      t.X_WD.p = Vec3(0.0, 1.5e-3, high + std::max(-0.4e-3, 10e-3 - std::max(0, k - 200) * 0.1 * 2e-3));
      w.step(in);
      if (k > 240) most = std::max(most, scene()->instruments[0].coupling_stiffness * (w.state().instruments[0].X_WT.p - t.X_WD.p).z());
    }
    return most;
  };
  EXPECT_GT(felt(0.0), 0.03);
  EXPECT_LT(felt(5e-3), 0.001);
}

/// However fast a jaw comes at a vessel from the side, it lies where one that comes slowly has pushed it.
TEST(VesselScene, FastJawsPushAVesselAside) {
  const auto aside = [](double speed) {  // [m/s]; [m]
    World w(stumps());
    const Points before = w.observation().tissue.positions;
    Inputs in;
    ToolInput& t = in.tools[0];
    t.valid = true;
    t.grip_angle = 0.0;
    for (int k = 0; k < 1200; ++k) {  // upstream stump, 1 mm from its edge, tip 0.4 mm below its axis
      t.X_WD.p = Vec3(-3e-3 + std::clamp((k - 200) * speed * 2e-3, 0.0, 3e-3), -1.3e-3, -0.4e-3);
      w.step(in);
    }
    return (w.observation().tissue.positions - before).row(0).maxCoeff();
  };
  const double slow = aside(0.02);
  EXPECT_GT(slow, 0.1e-3);
  EXPECT_NEAR(aside(0.1) / slow, 1.0, 0.02);
  EXPECT_NEAR(aside(0.5) / slow, 1.0, 0.02);
}

/// The sheet of the needle course is stretched over its frame: it lies still, and a closed jaw is held up by its tension T as by a membrane,
/// F / w = 2 pi T / ln(b / a), a the jaw's radius and b half the sheet's width.
TEST(VesselScene, StretchedCardLiesStillAndHoldsAgainstAJaw) {
  static const auto course = load_model(FILUM_SOURCE_DIR, "needle-course");
  World w(course);
  Inputs in;
  const Points before = w.observation().tissue.positions;
  for (int k = 0; k < 200; ++k) w.step(in);
  EXPECT_LT((w.observation().tissue.positions - before).cwiseAbs().maxCoeff(), 5e-6);
  ToolInput& t = in.tools[0];
  t.valid = true;
  t.grip_angle = 0.0;
  double felt = 0.0;
  for (int k = 0; k < 900; ++k) {
    t.X_WD.p = Vec3(0.0, 0.0, 1.5e-3 - std::min(k, 750) * 2e-6);
    w.step(in);
    felt = w.observation().tools[0].f_T_W.z();
  }
  const double w_most = -w.observation().tissue.positions.row(2).minCoeff() - 75e-6;  // of the underside
  const double tension = 150e-6 * 1.2e6 / (1.0 - 0.45) * (1.0 - 1.0 / 1.08), membrane = 2.0 * std::numbers::pi * tension / std::log(4.0 / 0.15);
  EXPECT_GT(w_most, 0.05e-3);
  EXPECT_NEAR(felt / w_most / membrane, 1.0, 0.4) << "N/m over N/m; the jaw is no point and the sheet is square";
  for (const WallFace& f : course->vessel->mesh.faces) EXPECT_TRUE(f.surface == WallSurface::inner || f.surface == WallSurface::outer) << "no rim for thread to catch on";
}

/// Hands that jump about the field, open and close, at up to half a metre a second.
class WildHands {
 public:
  explicit WildHands(unsigned seed) : random_(seed) {}
  Inputs next() {
    Inputs in;
    for (std::size_t i = 0; i < 2; ++i) {
      if (left_[i]-- <= 0) {
        left_[i] = 40 + static_cast<int>(60 * (1.0 + number()));
        from_[i] = to_[i];
        steps_[i] = left_[i];
        to_[i].p = Vec3(4e-3 * number(), 4e-3 * number(), 1e-3 + 3e-3 * number());
        to_[i].q = Quat(number(), number(), number(), number()).normalized();
        grip_[i] = number() > 0.0 ? 0.15 : -0.05;
      }
      const double f = 1.0 - static_cast<double>(left_[i]) / steps_[i];
      ToolInput& t = in.tools[i];
      t.X_WD = {(1.0 - f) * from_[i].p + f * to_[i].p, from_[i].q.slerp(f, to_[i].q)};
      t.grip_angle = grip_[i];
      t.valid = true;
    }
    return in;
  }

 private:
  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  std::mt19937 random_;
  std::array<Pose, 2> from_, to_;
  std::array<int, 2> left_{}, steps_{1, 1};
  std::array<double, 2> grip_{};
};

TEST(VesselScene, SurvivesWildHands) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    World w(scene());
    WildHands hands(seed);
    for (int k = 0; k < 1500; ++k) {
      w.step(hands.next());
      const State& s = w.state();
      ASSERT_TRUE(s.needle.X_WN.finite() && s.needle.v.allFinite()) << seed << ' ' << k;
      ASSERT_TRUE(s.thread.x.leftCols(s.thread.n).allFinite() && s.tissue.wall.x.allFinite()) << seed << ' ' << k;
    }
    const Observation& o = w.observation();
    EXPECT_LT(o.needle.X_WN.p.norm(), 100e-3) << "whipped by its thread to 0.7 m/s it flies v^2/g = 50 mm; what blows up goes further, seed " << seed;
    EXPECT_LT((o.positions.col(o.n_nodes - 1) - o.needle.swage_W).norm(), 20e-6) << "thread and needle are joined still, seed " << seed;
    EXPECT_LT(o.tissue.positions.cwiseAbs().maxCoeff(), 10e-3) << "the card is where its frame is, seed " << seed;
  }
}

TEST(VesselScene, StumpsStandOpenAndStill) {
  World w(stumps());
  Inputs in;
  const Points before = w.observation().tissue.positions;
  const TissueDescription& d = w.description().tissue;
  EXPECT_EQ(d.kind, "vessel");
  EXPECT_TRUE(d.lumen);
  EXPECT_EQ(d.triangles.size(), 2 * stumps()->vessel->mesh.faces.size());
  for (int k = 0; k < 100; ++k) w.step(in);
  EXPECT_LT((w.observation().tissue.positions - before).cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_EQ(w.observation().tissue.soundness, 1.0);
  const VesselMesh& mesh = stumps()->vessel->mesh;
  ASSERT_EQ(mesh.edge_ring.size(), 2u);
  for (std::size_t part = 0; part < 2; ++part)
    for (const int i : mesh.edge_ring[part]) {
      const Vec3 p = w.observation().tissue.positions.col(i);
      EXPECT_NEAR(p.y(), part == 0 ? -0.3e-3 : 0.3e-3, 20e-6);
      EXPECT_NEAR(std::hypot(p.x(), p.z()), d.radius - d.thickness, 20e-6);
    }
}

/// The point of the closed forceps in the lumen lifts the wall from within; from above it presses the same wall down.
TEST(VesselScene, JawsTouchStumpsInsideAndOutside) {
  for (const double side : {1.0, -1.0}) {
    World w(stumps());
    Inputs in;
    ToolInput& t = in.tools[0];
    t.valid = true;
    t.grip_angle = 0.0;
    const double start = side > 0.0 ? 0.1e-3 : 0.7e-3, end = side > 0.0 ? 0.36e-3 : 0.46e-3;
    Mat3 frame;  // handle out through the gap from within, upward from above
    const Vec3 handle = side > 0.0 ? Vec3(0, 0.96, 0.28) : Vec3(0, 0, 1);
    frame << Vec3::UnitX(), handle.cross(Vec3::UnitX()), handle;
    t.X_WD.q = Quat(frame);
    double moved = 0.0;
    for (int k = 0; k < 700; ++k) {
      const double f = std::min(1.0, k / 600.0);
      t.X_WD.p = Vec3(0.0, -0.6e-3 + (k < 200 && side > 0.0 ? 5e-6 * (200 - k) : 0.0), start + f * (end - start));
      w.step(in);
    }
    const double felt = w.observation().tools[0].f_T_W.z();
    const Points& now = w.observation().tissue.positions;
    for (Eigen::Index i = 0; i < now.cols(); ++i)
      if (now(1, i) < -0.3e-3 && now(1, i) > -1.0e-3 && now(2, i) > 0.2e-3) moved = std::max(moved, side * (now(2, i) - w.description().tissue.rest(2, i)));
    EXPECT_LT(side * felt, -1e-4) << "the tissue pushes back";
    EXPECT_GT(moved, 5e-6);
  }
}

/// The button `cut` held slides the clamp until the edges meet, `next` turns it over; a scene restored on the way goes on alike.
TEST(VesselScene, ClampSlidesAndTurnsOver) {
  World w(stumps());
  Inputs in;
  in.tools[0].valid = true;
  in.tools[0].X_WD.p = Vec3(-6e-3, 4e-3, 8e-3);
  const auto run = [&](World& world, int steps, std::uint32_t buttons) {
    in.tools[0].buttons = buttons;
    for (int k = 0; k < steps; ++k) world.step(in);
  };
  const VesselMesh& mesh = stumps()->vessel->mesh;
  const int first = mesh.edge_ring[0][0], second = mesh.edge_ring[1][0];
  const auto y = [&](int node) { return w.observation().tissue.positions(1, node); };
  const double open = y(second) - y(first);
  run(w, 1, 0);
  run(w, 250, 2);
  EXPECT_NEAR(y(second) - y(first), open - 0.25e-3, 20e-6) << "half a second at 0.5 mm/s";
  run(w, 10, 0);
  EXPECT_NEAR(w.state().tissue.clamp.gap, stumps()->vessel->clamp.gap - 0.25e-3, 1e-9) << "let go, it stays";
  run(w, 100, 2);
  EXPECT_NEAR(w.state().tissue.clamp.gap, stumps()->vessel->clamp.gap - 0.15e-3, 1e-9) << "pressed again, it slides back";
  run(w, 2, 0);
  World other(stumps());
  other.restore(w.state());
  run(w, 1200, 4);
  EXPECT_NEAR(w.state().tissue.clamp.turn, 3.14159265, 1e-6);
  const Vec3 r = w.observation().tissue.positions.col(first), before = mesh.nodes.col(first);
  EXPECT_NEAR(r.x(), -before.x(), 20e-6);
  EXPECT_NEAR(r.z(), -before.z(), 20e-6);
  run(other, 1200, 4);
  EXPECT_EQ(w.state_hash(), other.state_hash());
}

/// A scene's own turns, one after the other and round again; what is asked for on the way counts at once.
TEST(VesselScene, ClampGoesThroughItsTurns) {
  auto model = std::make_shared<Model>(*stumps());
  auto vessel = std::make_shared<VesselModel>(*model->vessel);
  vessel->turns = {0.0, -0.3, 0.2};
  model->vessel = vessel;
  World w(model);
  Inputs in;
  in.tools[0].valid = true;
  in.tools[0].X_WD.p = Vec3(-6e-3, 4e-3, 8e-3);
  const auto press = [&](int steps) {
    in.tools[0].buttons = 4;
    w.step(in);
    const double said = w.observation().n_events > 0 ? w.observation().events[0].value : -9.0;
    in.tools[0].buttons = 0;
    for (int k = 0; k < steps; ++k) w.step(in);
    return said;
  };
  EXPECT_EQ(press(150), -0.3);
  EXPECT_NEAR(w.state().tissue.clamp.turn, -0.3, 1e-12);
  const Vec3 r = w.observation().tissue.positions.col(0), before = vessel->mesh.nodes.col(0), turned = Eigen::AngleAxisd(-0.3, Vec3::UnitY()) * before;
  EXPECT_LT((r - turned).norm(), 20e-6) << "the held end is where the bar has turned it";
  EXPECT_EQ(press(10), 0.2);
  EXPECT_EQ(press(150), 0.0);
  EXPECT_NEAR(w.state().tissue.clamp.turn, 0.0, 1e-12);
}

TEST(VesselScene, StumpsSurviveWildHands) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    World w(stumps());
    WildHands hands(seed);
    for (int k = 0; k < 500; ++k) {
      w.step(hands.next());
      const State& s = w.state();
      ASSERT_TRUE(s.needle.X_WN.finite() && s.thread.x.leftCols(s.thread.n).allFinite() && s.tissue.wall.x.allFinite()) << seed << ' ' << k;
    }
    EXPECT_LT(w.observation().tissue.positions.cwiseAbs().maxCoeff(), 10e-3) << "the stumps are in their clamp, seed " << seed;
  }
}

/// Forceps at a digital artery: come down, close from 200 to 400 ms, are led by 0.4 mm, open at 2.6 s.
struct Grasp {
  std::shared_ptr<const Model> model = load_model(FILUM_SOURCE_DIR, "artery-stitch");
  World w{model};
  Points before = w.observation().tissue.positions;
  Pose at;                // of the tool as it closes
  Vec3 lead = Vec3::Zero();
  double opened = 0.1;    // [rad]
  std::vector<std::string> said;

  /// Of the upstream stump: the middle of its rim, its outer radius, the way out of it along the vessel.
  Vec3 middle() const {
    Vec3 sum = Vec3::Zero();
    for (const int i : ring()) sum += before.col(i) / static_cast<double>(ring().size());
    return sum;
  }
  const std::vector<int>& ring() const { return model->vessel->mesh.edge_ring[0]; }
  double radius() const { return (Vec3(before.col(ring()[0])) - middle()).norm() + model->vessel->thickness; }
  Vec3 axis() const { return middle().y() < 0.0 ? Vec3(0, 1, 0) : Vec3(0, -1, 0); }

  void play(int from, int to) {
    Inputs in;
    in.tools[1] = {model->instrument_start[1], 0.2, 0.0, false, true, 0};
    ToolInput& t = in.tools[0];
    t.valid = true;
    for (int k = from; k < to; ++k) {
      const double come = std::min(1.0, k / 80.0), close = std::clamp((k - 100) / 100.0, 0.0, 1.0), led = std::clamp((k - 300) / 300.0, 0.0, 1.0);
      t.X_WD.q = at.q;
      t.X_WD.p = at.p + (1.0 - come) * 2e-3 * (at.q * Vec3::UnitZ()) + led * lead;
      t.grip_angle = k < 1300 ? opened - close * (opened + 0.03) : opened;
      w.step(in);
      const Observation& o = w.observation();
      for (int e = 0; e < o.n_events; ++e)
        if (o.events[static_cast<std::size_t>(e)].tool == 0) said.push_back(o.events[static_cast<std::size_t>(e)].name);
    }
  }
  double moved() const { return (w.observation().tissue.positions - before).colwise().norm().maxCoeff(); }  // [m]
  int times(const char* name) const { return static_cast<int>(std::count(said.begin(), said.end(), name)); }
};

Quat frame(const Vec3& opening, const Vec3& handle) {
  Mat3 axes;
  axes << opening, handle.cross(opening), handle;
  return Quat(axes);
}

TEST(VesselScene, OneJawInTheLumenHoldsTheWallThroughItsThickness) {
  Grasp g;
  const Vec3 handle = (Vec3::UnitZ() + g.axis()).normalized();
  g.at = {g.middle() + (g.radius() - 0.5 * g.model->vessel->thickness) * Vec3::UnitX() - 0.25e-3 * handle, frame(Vec3::UnitX(), handle)};
  g.lead = 0.4e-3 * Vec3::UnitX();
  g.play(0, 1300);
  EXPECT_EQ(g.times("wall-taken"), 1);
  const GripObservation held = g.w.observation().tissue.grips[0];
  EXPECT_TRUE(held.held && held.through);
  EXPECT_GT(held.pull, 0.3e-3);
  EXPECT_GT(g.moved(), 0.3e-3) << "the edge comes with the forceps";
  const double rest = 2.0 * std::asin(0.5 * g.model->vessel->thickness / 8e-3);
  EXPECT_GT(g.w.state().instruments[0].angle, 0.3 * rest) << "the jaws rest on it";
  EXPECT_LT(g.w.state().instruments[0].angle, rest);
  EXPECT_GT(g.w.observation().tools[0].grip_force, 0.05);
  g.play(1300, 1800);
  EXPECT_EQ(g.times("tissue-released"), 1);
  EXPECT_LT(g.moved(), 20e-6) << "back where it was";
}

TEST(VesselScene, TipsOnTheOutsideLiftTheVesselByItsAdventitia) {
  Grasp g;
  g.opened = 0.05;
  g.at = {g.middle() - 1e-3 * g.axis() + (g.radius() - 0.05e-3) * Vec3::UnitZ(), frame(Vec3::UnitX(), Vec3::UnitZ())};
  g.lead = 0.4e-3 * Vec3::UnitZ();
  g.play(0, 1300);
  EXPECT_EQ(g.times("tissue-taken"), 1);
  const GripObservation held = g.w.observation().tissue.grips[0];
  EXPECT_TRUE(held.held && !held.through);
  EXPECT_GT((g.w.observation().tissue.positions - g.before).row(2).maxCoeff(), 0.15e-3);
  EXPECT_LT(g.w.observation().tools[0].f_T_W.z(), -0.3e-3) << "it pulls down";
  g.play(1300, 1800);
  EXPECT_LT(g.moved(), 20e-6);
}

TEST(VesselScene, ClosedTipsThatPressOnItHoldNothing) {
  Grasp g;
  g.opened = -0.03;
  g.at = {g.middle() - 1e-3 * g.axis() + (g.radius() - 0.1e-3) * Vec3::UnitZ(), frame(Vec3::UnitX(), Vec3::UnitZ())};
  g.play(0, 500);
  EXPECT_GT(g.moved(), 0.1e-3);
  EXPECT_FALSE(g.w.observation().tissue.grips[0].held);
}

}  // namespace vessel_scene_test
}  // namespace filum
