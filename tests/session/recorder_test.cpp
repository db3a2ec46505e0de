#include "session/recorder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <thread>

#include "base/error.h"
#include "session/recording_reader.h"
#include "tests/session/disk_limit.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace recorder_test {

using synthetic::Folder;

std::uint64_t count_steps(const RecordingReader& recording) {
  RecordCursor<StepRecord> cursor = recording.steps();
  StepRecord record;
  std::uint64_t n = 0;
  while (cursor.next(record)) ++n;
  return n;
}

void wait_until(const std::function<bool()>& done) {
  for (int i = 0; i < 10000 && !done(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(done());
}

TEST(Recorder, StoresEverythingBitForBit) {
  const Folder folder;
  const std::string file = folder.file("a.filum-session");
  synthetic::write_recording(file, 1000);
  EXPECT_FALSE(std::filesystem::exists(file + "-wal"));  // one plain file after close
  const RecordingReader recording(file);
  EXPECT_TRUE(recording.finished());
  EXPECT_EQ(recording.meta().task, "knot-square");
  EXPECT_EQ(recording.meta().participant, "A17");
  EXPECT_EQ(recording.meta().dt, 0.002);
  EXPECT_EQ(recording.meta().started_utc.size(), 20u);
  auto steps = recording.steps();
  auto samples = recording.samples();
  auto events = recording.events();
  StepRecord step;
  SampleRecord sample;
  EventRecord event;
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    ASSERT_TRUE(steps.next(step));
    ASSERT_TRUE(synthetic::same(step, synthetic::step(i))) << i;
    for (const std::uint64_t n : {2 * i, 2 * i + 1}) {
      ASSERT_TRUE(samples.next(sample));
      ASSERT_TRUE(synthetic::same(sample, synthetic::sample(n))) << n;
    }
    if (i % 10 != 0) continue;
    ASSERT_TRUE(events.next(event));
    ASSERT_TRUE(synthetic::same(event, synthetic::event(i))) << i;
  }
  EXPECT_FALSE(steps.next(step));
  EXPECT_FALSE(samples.next(sample));
  EXPECT_FALSE(events.next(event));
  ASSERT_TRUE(recording.score().has_value());
  EXPECT_EQ(recording.score()->total, 87.5);
  EXPECT_EQ(recording.score()->json, R"({"total": 87.5})");
  ASSERT_EQ(recording.sources().size(), 2u);
  EXPECT_EQ(recording.sources()[1].text, "diameter: 25 um\n");
}

TEST(Recorder, TwoProducerThreadsLoseNothing) {
  const Folder folder;
  Recorder recorder(synthetic::options(folder.file("a")));
  constexpr std::uint64_t kSteps = 20000;
  std::thread devices([&] {
    for (std::uint64_t i = 1; i <= kSteps; ++i)
      while (!recorder.record_sample(synthetic::sample(i))) std::this_thread::yield();
  });
  // Steps are pushed only while there is room, so that none is refused.
  for (std::uint64_t i = 1; i <= kSteps; ++i) {
    if (i % 1000 == 0) wait_until([&] { return recorder.status().steps_stored + 2000 > i; });
    ASSERT_TRUE(recorder.record_step(synthetic::step(i)));
  }
  devices.join();
  recorder.close();
  const RecordingReader recording(folder.file("a"));
  EXPECT_EQ(count_steps(recording), kSteps);
}

TEST(Recorder, AFullQueueIsCountedAndRecorded) {
  const Folder folder;
  RecorderOptions options = synthetic::options(folder.file("a"));
  options.step_capacity = 10;
  options.interval = std::chrono::milliseconds(60000);  // the recorder's thread sleeps until close()
  Recorder recorder(options);
  std::uint64_t refused = 0;
  for (std::uint64_t i = 1; i <= 25; ++i) refused += recorder.record_step(synthetic::step(i)) ? 0 : 1;
  EXPECT_EQ(refused, 15u);
  EXPECT_EQ(recorder.status().records_lost, 15u);
  EXPECT_FALSE(recorder.status().healthy);
  EXPECT_FALSE(recorder.close());
  const RecordingReader recording(folder.file("a"));
  EXPECT_EQ(count_steps(recording), 10u);
  auto events = recording.events();
  EventRecord event;
  ASSERT_TRUE(events.next(event));
  EXPECT_EQ(event.name.view(), "recording-lost");
  EXPECT_EQ(event.value, 15.0);
  EXPECT_EQ(event.unit.view(), "steps");
}

TEST(Recorder, AFullDiskIsSaidAndNothingIsLostWhenThereIsSpaceAgain) {
  const Folder folder;
  RecorderOptions options = synthetic::options(folder.file("a"));
  options.interval = std::chrono::milliseconds(2);
  Recorder recorder(options);
  for (std::uint64_t i = 1; i <= 500; ++i) ASSERT_TRUE(recorder.record_step(synthetic::step(i)));
  wait_until([&] { return recorder.status().steps_stored == 500; });
  {
    const DiskLimit full(64 * 1024);
    for (std::uint64_t i = 501; i <= 1500; ++i) ASSERT_TRUE(recorder.record_step(synthetic::step(i)));
    wait_until([&] { return !recorder.status().healthy; });
    EXPECT_NE(recorder.status().message.find("trying again"), std::string::npos);
  }
  wait_until([&] { return recorder.status().healthy; });
  EXPECT_TRUE(recorder.close());
  EXPECT_EQ(count_steps(RecordingReader(folder.file("a"))), 1500u);
}

TEST(Recorder, ClosingOnAFullDiskKeepsWhatWasStored) {
  const Folder folder;
  RecorderOptions options = synthetic::options(folder.file("a"));
  options.interval = std::chrono::milliseconds(2);
  {
    Recorder recorder(options);
    for (std::uint64_t i = 1; i <= 500; ++i) ASSERT_TRUE(recorder.record_step(synthetic::step(i)));
    wait_until([&] { return recorder.status().steps_stored == 500; });
    const DiskLimit full(64 * 1024);
    for (std::uint64_t i = 501; i <= 1500; ++i) ASSERT_TRUE(recorder.record_step(synthetic::step(i)));
    EXPECT_FALSE(recorder.close());
    EXPECT_FALSE(recorder.status().message.empty());
  }
  const RecordingReader recording(folder.file("a"));
  EXPECT_GE(count_steps(recording), 500u);
  EXPECT_FALSE(recording.finished());
}

TEST(Recorder, OnAFullDiskARecordingThatLostRecordsIsNotFinished) {
  const Folder folder;
  RecorderOptions options = synthetic::options(folder.file("a"));
  options.step_capacity = 10;
  options.interval = std::chrono::milliseconds(60000);  // nothing is stored before close()
  {
    Recorder recorder(options);
    for (std::uint64_t i = 1; i <= 25; ++i) recorder.record_step(synthetic::step(i));
    for (std::uint64_t i = 1; i <= 5000; ++i) ASSERT_TRUE(recorder.record_sample(synthetic::sample(i)));
    // The mark "finished" has room, what was recorded has not.
    const DiskLimit full(64 * 1024);
    EXPECT_FALSE(recorder.close());
    EXPECT_NE(recorder.status().message.find("not stored"), std::string::npos) << recorder.status().message;
  }
  const RecordingReader recording(folder.file("a"));
  EXPECT_EQ(count_steps(recording), 0u);
  EXPECT_FALSE(recording.finished());
}

TEST(Recorder, ClosingStoresAllThatWaits) {
  const Folder folder;
  constexpr std::uint64_t kSamples = 130'000;  // more than is kept for one commit, twice
  RecorderOptions options = synthetic::options(folder.file("a"));
  options.sample_capacity = kSamples + 8;
  options.interval = std::chrono::hours(1);
  Recorder recorder(options);
  for (std::uint64_t i = 1; i <= kSamples; ++i) ASSERT_TRUE(recorder.record_sample(synthetic::sample(i)));
  EXPECT_TRUE(recorder.close());
  EXPECT_EQ(recorder.status().samples_stored, kSamples);
}

TEST(Recorder, RefusesPlacesItCannotWrite) {
  const Folder folder;
  EXPECT_THROW(Recorder(synthetic::options(folder.file("no/such/folder/a"))), InputError);
  EXPECT_THROW(Recorder(synthetic::options(folder.path().string())), InputError);
  synthetic::write_recording(folder.file("a"), 3);
  EXPECT_THROW(Recorder(synthetic::options(folder.file("a"))), InputError);  // never overwritten
  EXPECT_EQ(count_steps(RecordingReader(folder.file("a"))), 3u);
}

TEST(Recorder, RefusesAReadOnlyFolderClearly) {
  const Folder folder;
  const std::string inside = folder.file("locked");
  std::filesystem::create_directory(inside);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  std::filesystem::permissions(inside, std::filesystem::perms(0555));
  const synthetic::OrdinaryUser user;
  ASSERT_TRUE(user.is());
  try {
    Recorder recorder(synthetic::options(inside + "/a"));
    FAIL() << "a recording in a read-only folder";
  } catch (const InputError& error) {
    EXPECT_EQ(error.file, inside + "/a");
    EXPECT_NE(error.expected.find("written"), std::string::npos);
  }
}

TEST(Recorder, RefusesADiskThatIsFullFromTheStartAndLeavesNoFile) {
  const Folder folder;
  const DiskLimit full(512);
  EXPECT_THROW(Recorder(synthetic::options(folder.file("a"))), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Recorder, RefusesNamesForParticipants) {
  const Folder folder;
  RecorderOptions options = synthetic::options(folder.file("a"));
  options.meta.participant = "Jane Doe";
  EXPECT_THROW(Recorder{options}, InputError);
  EXPECT_FALSE(std::filesystem::exists(folder.file("a")));
}

TEST(Recorder, TheLastScoreCounts) {
  const Folder folder;
  {
    Recorder recorder(synthetic::options(folder.file("a")));
    recorder.set_score({false, 10.0, 1.0, "{}"});
    recorder.set_score({true, 90.0, 2.0, "{}"});
  }
  const RecordingReader recording(folder.file("a"));
  ASSERT_TRUE(recording.score().has_value());
  EXPECT_TRUE(recording.score()->passed);
  EXPECT_EQ(recording.score()->total, 90.0);
}

}  // namespace recorder_test
}  // namespace filum
