// A process that records at 500 Hz is killed at a random moment, fifty times. All it had recorded up to 100
// ms before must be there, in order and bit for bit.

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>

#include "base/rng.h"
#include "session/recorder.h"
#include "session/recording_reader.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace recorder_kill_test {

constexpr int kKills = 50;
constexpr std::uint64_t kMostSteps = 1000;

std::int64_t now_us() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1000000 + now.tv_nsec / 1000;
}

void sleep_until_us(std::int64_t when) {
  const timespec at{when / 1000000, (when % 1000000) * 1000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

/// What the child tells its parent through shared memory; it outlives the child.
struct Progress {
  std::atomic<std::uint64_t> pushed{0};
  std::array<std::atomic<std::int64_t>, kMostSteps + 1> pushed_at_us{};
};

[[noreturn]] void record_until_killed(const std::string& file, Progress& progress) {
  Recorder recorder(synthetic::options(file));
  const std::int64_t start = now_us();
  for (std::uint64_t i = 1; i <= kMostSteps; ++i) {
    sleep_until_us(start + static_cast<std::int64_t>(i) * 2000);
    recorder.record_sample(synthetic::sample(2 * i));
    recorder.record_sample(synthetic::sample(2 * i + 1));
    if (i % 10 == 0) recorder.record_event(synthetic::event(i));
    if (!recorder.record_step(synthetic::step(i))) std::_Exit(3);
    progress.pushed_at_us[i].store(now_us());
    progress.pushed.store(i);
  }
  for (;;) pause();
}

/// Steps read back, each compared; -1 at the first that differs.
long count_good_steps(const RecordingReader& recording) {
  auto cursor = recording.steps();
  StepRecord record;
  long n = 0;
  while (cursor.next(record)) {
    if (!synthetic::same(record, synthetic::step(static_cast<std::uint64_t>(++n)))) return -1;
  }
  return n;
}

long count_good_samples(const RecordingReader& recording) {
  auto cursor = recording.samples();
  SampleRecord record;
  long n = 0;
  while (cursor.next(record)) {
    if (!synthetic::same(record, synthetic::sample(static_cast<std::uint64_t>(2 + n++)))) return -1;
  }
  return n;
}

TEST(RecorderKill, AllButTheLastHundredMillisecondsSurviveFiftyKills) {
  Rng rng(20261121);
  auto* progress = static_cast<Progress*>(
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(progress, MAP_FAILED);
  std::int64_t worst_us = 0;
  for (int kill_number = 0; kill_number < kKills; ++kill_number) {
    const synthetic::Folder folder;
    const std::string file = folder.file("a.filum-session");
    new (progress) Progress;
    const std::int64_t lifetime_us = static_cast<std::int64_t>(rng.uniform(0.15e6, 0.65e6));
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) record_until_killed(file, *progress);
    while (progress->pushed.load() == 0) sleep_until_us(now_us() + 500);
    sleep_until_us(now_us() + lifetime_us);
    const std::int64_t killed_at = now_us();
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));

    const RecordingReader recording(file);
    EXPECT_FALSE(recording.finished());
    EXPECT_EQ(recording.sources().size(), 2u);
    const long stored = count_good_steps(recording);
    ASSERT_GE(stored, 0) << "a step differs";
    const std::uint64_t next = static_cast<std::uint64_t>(stored) + 1;
    if (next <= progress->pushed.load())
      worst_us = std::max(worst_us, killed_at - progress->pushed_at_us[next].load());
    std::uint64_t due = progress->pushed.load();
    while (due > 0 && killed_at - progress->pushed_at_us[due].load() < 100000) --due;
    EXPECT_GE(static_cast<std::uint64_t>(stored), due) << "kill " << kill_number;
    EXPECT_GE(count_good_samples(recording), 2 * stored);
  }
  RecordProperty("oldest_lost_step_ms", static_cast<int>(worst_us / 1000));
  std::printf("oldest step lost by a kill was %.1f ms old\n", static_cast<double>(worst_us) / 1000.0);
  munmap(progress, sizeof(Progress));
}

}  // namespace recorder_kill_test
}  // namespace filum
