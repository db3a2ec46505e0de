#include "cli/live_session.h"

#include <gtest/gtest.h>

#include "short_session.h"

namespace filum {
namespace live_session_test {

TEST(LiveSession, RunsItsTimeAndTheSameTwice) {
  const LiveOutcome one = started_session(nullptr)->wait(), two = started_session(nullptr)->wait();
  EXPECT_NEAR(one.scene_seconds, 0.5, 0.01);
  EXPECT_EQ(one.steps, two.steps);
  EXPECT_EQ(one.state_hash, two.state_hash);
  EXPECT_GT(one.real_time_factor, 0.0);
}

TEST(LiveSession, EndsWhenAskedAndLetsTheDevicesGo) {
  LiveOptions options;
  options.longest = 3600.0;  // paced: it would take an hour
  LiveSession session(load_setup(FILUM_SOURCE_DIR, "tip-hold"), open_live_inputs({}, FILUM_SOURCE_DIR), std::move(options));
  session.start();
  EXPECT_NE(session.pointer(), nullptr);
  session.request_stop();
  const LiveOutcome outcome = session.end();
  EXPECT_TRUE(session.over());
  EXPECT_FALSE(outcome.result.finished);
  EXPECT_FALSE(session.knot_to_pull());
  EXPECT_EQ(session.pointer(), nullptr);
  EXPECT_EQ(session.settle().total, outcome.result.total);
}

TEST(LiveSession, ShowsPicturesAndEvents) {
  int pictures = 0;
  LiveOptions options;
  options.paced = false;
  options.longest = 0.5;
  options.show = [&](const LiveView& v) {
    ++pictures;
    EXPECT_FALSE(v.device_names.empty());
  };
  LiveSession session(load_setup(FILUM_SOURCE_DIR, "tip-hold"), open_inputs("demo", FILUM_SOURCE_DIR, "tip-hold"), std::move(options));
  session.start();
  session.wait();
  EXPECT_GT(pictures, 0);
}

}  // namespace live_session_test
}  // namespace filum
