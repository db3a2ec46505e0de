#include "base/stage_clock.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <thread>

namespace filum {
namespace stage_clock_test {

void wait_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

std::map<std::string, double> times(const StageClock& clock) {
  std::map<std::string, double> t;
  for (const StageClock::Stage& s : clock) t[s.name] = s.milliseconds;
  return t;
}

TEST(StageClock, TimeCountsForTheInnermostStage) {
  StageClock clock;
  const auto begin = std::chrono::steady_clock::now();
  {
    const StageScope outer("outer");
    wait_ms(5);
    {
      const StageScope inner("inner");
      wait_ms(10);
    }
    wait_ms(5);
  }
  const double all = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  const auto t = times(clock);
  ASSERT_EQ(t.size(), 2u);
  EXPECT_GE(t.at("outer"), 10.0);
  EXPECT_GE(t.at("inner"), 10.0);
  EXPECT_LE(t.at("outer") + t.at("inner"), all);
}

TEST(StageClock, ClearsAndGoesOnWithTheSameStages) {
  StageClock clock;
  for (int k = 0; k < 2; ++k) {
    clock.clear();
    const StageScope stage("waits");
    wait_ms(2);
  }
  { const StageScope other("other"); }
  const auto t = times(clock);
  ASSERT_EQ(t.size(), 2u);
  EXPECT_GE(t.at("waits"), 2.0);
}

TEST(StageClock, MoreStagesThanThereIsRoomForCountForTheOneAround) {
  StageClock clock;
  std::vector<std::string> names;
  for (int k = 0; k < StageClock::kMost + 5; ++k) names.push_back("stage " + std::to_string(k));
  const StageScope outer(names[0].c_str());
  for (const std::string& name : names) {
    const StageScope inner(name.c_str());
    wait_ms(1);
  }
  EXPECT_EQ(clock.end() - clock.begin(), StageClock::kMost);
}

TEST(StageClock, NothingIsHeardWithoutOneOrFromAnotherThread) {
  { const StageScope nobody("nobody"); }
  StageClock clock;
  std::thread([] { const StageScope elsewhere("elsewhere"); }).join();
  EXPECT_EQ(clock.begin(), clock.end());
}

}  // namespace stage_clock_test
}  // namespace filum
