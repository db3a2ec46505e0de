#include "cli/replay_session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>

#include "base/error.h"
#include "short_session.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace replay_session_test {

using namespace std::chrono_literals;

/// What a viewer is shown and told.
class Screen {
 public:
  ReplaySession::ShowFrame frames() {
    return [this](const Observation& o, const TaskView&) { note([&] { times.push_back(o.time); }); };
  }
  ReplaySession::ShowState states() {
    return [this](const ReplayView& v) { note([&] { told.push_back(v); }); };
  }
  template <class Condition>
  bool wait(Condition condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 20s, condition);
  }
  std::vector<double> times;     // [s], of the pictures
  std::vector<ReplayView> told;

 private:
  template <class Change>
  void note(Change change) {
    const std::lock_guard lock(mutex_);
    change();
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
};

class ReplaySessionTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto recorder = make_recorder(file_, load_setup(FILUM_SOURCE_DIR, "tip-hold"), "demonstrator");
    started_session(recorder.get())->wait();
  }
  synthetic::Folder folder_;
  const std::string file_ = folder_.file("one");
};

TEST_F(ReplaySessionTest, ShowsTheBeginningThenWhereItIsToldToGo) {
  Screen screen;
  ReplaySession replay(file_, "s1", screen.frames(), screen.states());
  EXPECT_EQ(replay.scene().task, "tip-hold");
  replay.start();
  ASSERT_TRUE(screen.wait([&] { return !screen.times.empty() && !screen.told.empty(); }));
  EXPECT_EQ(screen.times[0], 0.0);
  EXPECT_EQ(screen.told[0].session, "s1");
  EXPECT_NEAR(screen.told[0].duration, 0.5, 0.01);
  EXPECT_FALSE(screen.told[0].playing);
  ASSERT_TRUE(screen.wait([&] { return screen.told.back().ready == screen.told.back().duration; })) << "without being asked";
  EXPECT_TRUE(std::is_sorted(screen.told.begin(), screen.told.end(), [](const ReplayView& a, const ReplayView& b) { return a.ready < b.ready; }));
  replay.seek(0.25);
  EXPECT_TRUE(screen.wait([&] { return std::abs(screen.times.back() - 0.25) < 0.04; })) << screen.times.back();
  replay.seek(99.0);
  EXPECT_TRUE(screen.wait([&] { return screen.told.back().time == screen.told.back().duration; }));
  replay.seek(-1.0);
  EXPECT_TRUE(screen.wait([&] { return screen.told.back().time == 0.0 && screen.times.back() == 0.0; }));
}

TEST_F(ReplaySessionTest, PlaysToItsEndInItsOwnTimeAndStopsThere) {
  Screen screen;
  ReplaySession replay(file_, "s1", screen.frames(), screen.states());
  replay.start();
  ASSERT_TRUE(screen.wait([&] { return !screen.told.empty(); }));
  const auto begin = std::chrono::steady_clock::now();
  replay.play(true);
  ASSERT_TRUE(screen.wait([&] { return screen.told.back().time >= screen.told.back().duration && !screen.told.back().playing; }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 400ms);
  EXPECT_TRUE(screen.wait([&] { return screen.times.size() > 4; }));
  EXPECT_TRUE(std::is_sorted(screen.times.begin(), screen.times.end()));
  replay.play(true);  // from the beginning again
  EXPECT_TRUE(screen.wait([&] { return screen.told.back().playing && screen.told.back().time < 0.4; }));
  replay.play(false);
  EXPECT_TRUE(screen.wait([&] { return !screen.told.back().playing; }));
}

TEST_F(ReplaySessionTest, AnotherOverlayShowsTheSamePictureAgain) {
  Screen screen;
  ReplaySession replay(file_, "s1", screen.frames(), screen.states());
  replay.start();
  ASSERT_TRUE(screen.wait([&] { return screen.times.size() == 1; }));
  replay.show_again();
  ASSERT_TRUE(screen.wait([&] { return screen.times.size() == 2; }));
  EXPECT_EQ(screen.times[1], screen.times[0]);
  EXPECT_THROW(ReplaySession(folder_.file("none"), "s2", screen.frames(), screen.states()), InputError);
}

}  // namespace replay_session_test
}  // namespace filum
