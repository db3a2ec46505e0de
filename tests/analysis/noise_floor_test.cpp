#include "analysis/noise_floor.h"

#include <gtest/gtest.h>

namespace filum {
namespace noise_floor_test {

constexpr int kTool = 1;

RecordedSession session(const std::string& file, const std::string& input, double size, int tool = kTool) {
  RecordedSession s;
  s.file = file;
  s.meta.input = input;
  ToolSeries t;
  t.tool = tool;
  for (int k = 0; k < 100; ++k) {
    t.hand.clock.push_back(0.002 * k);
    t.scene.clock.push_back(0.002 * k);
  }
  t.hand.scene = t.scene.scene = t.hand.clock;
  t.hand.p = Points::Constant(3, 100, size);
  t.scene.p = Points::Constant(3, 100, 0.1 * size);
  s.tools.push_back(t);
  return s;
}

EvenPath judged() { return session("a", "haptic 1", 1.0).tools[0].hand.even(); }

TEST(NoiseFloor, IsWhatTheClampedToolReportsInTheSpaceThatIsAsked) {
  const RecordedSession hand = session("hand.rec", "haptic 1", 1.0), still = session("still.rec", "haptic 1", 3.0);
  const NoiseFloor own = noise_floor(hand, &still, kTool, true, judged()), scene = noise_floor(hand, &still, kTool, false, judged());
  ASSERT_TRUE(own.path && scene.path);
  EXPECT_DOUBLE_EQ(own.path->stretches.at(0)(0, 5), 3.0);
  EXPECT_DOUBLE_EQ(scene.path->stretches.at(0)(0, 5), 0.3) << "a scaled scene has a scaled floor";
  EXPECT_EQ(own.source, "clamped tool: still.rec");
}

TEST(NoiseFloor, IsNotThereWhereTheOtherToolWasClampedOrNoneWas) {
  const RecordedSession hand = session("hand.rec", "haptic 1", 1.0), other = session("still.rec", "haptic 1", 3.0, 0);
  EXPECT_FALSE(noise_floor(hand, &other, kTool, true, judged()).path);
  EXPECT_EQ(noise_floor(hand, &other, kTool, true, judged()).source, "the clamped recording does not hold this tool");
  EXPECT_FALSE(noise_floor(hand, nullptr, kTool, true, judged()).path);
  EXPECT_EQ(noise_floor(hand, nullptr, kTool, true, judged()).source, "not measured");
}

TEST(NoiseFloor, OfAScriptIsZero) {
  for (const char* input : {"demonstrator", "demonstration slow.yaml"}) {
    const NoiseFloor floor = noise_floor(session("a", input, 1.0), nullptr, kTool, true, judged());
    ASSERT_TRUE(floor.path) << input;
    for (const Points& p : floor.path->stretches) EXPECT_EQ(p.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(floor.source, "zero: a script has no sensor");
  }
  EXPECT_FALSE(noise_floor(session("a", "replay of a demonstration", 1.0), nullptr, kTool, true, judged()).path) << "it may have come from a hand";
}

TEST(NoiseFloor, IsTakenFromTheSameDeviceOnly) {
  const std::vector<RecordedSession> clamped = {session("first", "igtl 18944", 1.0), session("second", "haptic 1", 1.0)};
  ASSERT_NE(clamped_like(session("a", "haptic 1", 1.0), clamped), nullptr);
  EXPECT_EQ(clamped_like(session("a", "haptic 1", 1.0), clamped)->file, "second");
  EXPECT_EQ(clamped_like(session("a", "haptic 2", 1.0), clamped), nullptr);
}

}  // namespace noise_floor_test
}  // namespace filum
