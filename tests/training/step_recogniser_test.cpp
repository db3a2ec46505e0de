#include "training/step_recogniser.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/training/scripted_scene.h"

namespace filum {
namespace step_recogniser_test {

using namespace shapes;

Task square_task() {
  return load_task(FILUM_SOURCE_DIR "/curricula/knot-square/task.yaml");
}

class Watched {
 public:
  Watched() : recogniser(square_task(), knot_scene()) {}
  void run(double seconds) {
    for (int k = 0; k < static_cast<int>(seconds / 0.01); ++k) recogniser.observe(scene.next(0.01), events);
  }
  bool saw(const std::string& name) const { return count(name) > 0; }
  int count(const std::string& name) const {
    int n = 0;
    for (const TaskEvent& e : events) n += name == e.name ? 1 : 0;
    return n;
  }
  Scene scene;
  StepRecogniser recogniser;
  std::vector<TaskEvent> events;
};

TEST(StepRecogniser, MeasuresTurnsRoundATool) {
  Scene scene;
  ToolObservation& tool = scene.now().tools[1];
  for (double turns : {0.5, 1.0, 2.0}) {
    scene.show(wound_round(tool.X_WT.p, turns));
    EXPECT_NEAR(wrap_turns(scene.now(), tool), turns, 0.5);
    EXPECT_GT(wrap_turns(scene.now(), tool), turns - 0.01);
  }
  scene.show(wound_round(tool.X_WT.p + Vec3(0, 0, 0.05), 2.0));
  EXPECT_EQ(wrap_turns(scene.now(), tool), 0.0);
  // The same for a tool that is turned: its own axis counts.
  tool.X_WT.q = Quat(Eigen::AngleAxisd(1.0, Vec3(1, 2, 3).normalized()));
  Points wound = wound_round(Vec3::Zero(), 1.0);
  wound = (tool.X_WT.q.toRotationMatrix() * wound).colwise() + tool.X_WT.p;
  scene.show(wound);
  EXPECT_GT(wrap_turns(scene.now(), tool), 0.99);
}

TEST(StepRecogniser, FollowsASquareKnotStepByStep) {
  Watched w;
  w.scene.show(loosened(throws_round_post({}), 3.0));
  w.run(1.0);
  EXPECT_EQ(w.recogniser.step(), 0);
  w.scene.show(wound_round(w.scene.now().tools[1].X_WT.p, 1.0));
  w.run(0.5);
  EXPECT_EQ(w.recogniser.step(), 1);
  EXPECT_TRUE(w.saw("loop-formed"));
  w.scene.show(loosened(throws_round_post({3}), 4.0));
  w.run(0.25);
  EXPECT_EQ(w.recogniser.step(), 2);
  w.run(1.0);
  EXPECT_EQ(w.recogniser.step(), 3);
  w.scene.show(loosened(throws_round_post({3}), 4.0), 10e-3);
  w.run(1.0);
  EXPECT_EQ(w.recogniser.step(), 3) << "tension alone does not tighten: the loop is wide";
  w.scene.show(throws_round_post({3}), 10e-3);
  w.run(1.2);
  EXPECT_EQ(w.recogniser.step(), 4);
  w.scene.show(throws_round_post({3, -3}), 0.0);
  w.run(1.2);
  EXPECT_EQ(w.recogniser.step(), 7) << "not tightened without tension";
  w.scene.show(throws_round_post({3, -3}), 10e-3);
  w.run(1.2);
  EXPECT_EQ(w.recogniser.step(), 8);
  EXPECT_FALSE(w.recogniser.done());
  w.scene.now().cut_edge_low = 4;
  w.run(0.5);
  EXPECT_FALSE(w.recogniser.done());
  w.scene.now().cut_edge_high = w.scene.now().n_nodes - 6;
  w.run(0.5);
  EXPECT_TRUE(w.recogniser.done());
  for (const char* name : {"loop-formed", "end-passed", "throw-laid", "throw-tightened"})
    EXPECT_EQ(w.count(name), 2) << name;
  EXPECT_EQ(w.count("tails-cut"), 1);
  EXPECT_EQ(w.recogniser.knot_class(), "square");
  for (std::size_t k = 1; k < w.events.size(); ++k) EXPECT_GE(w.events[k].time, w.events[k - 1].time);
}

TEST(StepRecogniser, AStrandHeldInTheJawsIsNoLoop) {
  Watched w;
  ToolObservation& tool = w.scene.now().tools[1];
  w.scene.show(wound_round(tool.X_WT.p, 0.7));
  const double turns = wrap_turns(w.scene.now(), tool);
  ASSERT_GT(turns, 0.75) << "enough for a loop, if nothing holds the strand";
  ASSERT_LT(turns, 1.25) << "no more than a loop less than the half turn of a held strand";
  tool.grasped_edge = 3;
  w.run(0.5);
  EXPECT_EQ(w.recogniser.step(), 0);
  tool.grasped_edge = -1;
  w.run(0.5);
  EXPECT_EQ(w.recogniser.step(), 1);
}

TEST(StepRecogniser, NoStepWithoutItsSign) {
  Watched w;
  w.scene.show(throws_round_post({}), 20e-3);
  w.run(3.0);
  EXPECT_EQ(w.recogniser.step(), 0);
  EXPECT_TRUE(w.events.empty());
  w.scene.show(wound_round(w.scene.now().tools[1].X_WT.p, 0.1));
  w.run(1.0);
  EXPECT_EQ(w.recogniser.step(), 0) << "half a turn in passing is no loop";
}

TEST(StepRecogniser, SeesAThrowComeUndone) {
  Watched w;
  w.scene.show(throws_round_post({3}), 10e-3);
  w.run(4.0);
  EXPECT_EQ(w.recogniser.step(), 4);
  w.scene.show(throws_round_post({}));
  w.run(2.0);
  EXPECT_EQ(w.count("throw-undone"), 1);
  EXPECT_EQ(w.recogniser.step(), 0);
}

TEST(StepRecogniser, TellsAGrannyWhileItIsTied) {
  Watched w;
  w.scene.show(throws_round_post({3, 3}));
  w.run(1.0);
  EXPECT_EQ(w.recogniser.knot_class(), "granny");
  EXPECT_EQ(w.recogniser.n_throws(), 2);
}

TEST(StepRecogniser, SurvivesNonsense) {
  Watched w;
  Points bad = throws_round_post({3});
  bad(0, 5) = std::nan("");
  w.scene.show(bad);
  w.run(1.0);
  w.scene.show(Points(3, 0));
  w.run(1.0);
  w.scene.now().broken = true;
  w.scene.now().break_edge = 3;
  w.run(1.0);
  EXPECT_EQ(w.recogniser.step(), 0);
}

}  // namespace step_recogniser_test
}  // namespace filum
