#include "session/recorder.h"

#include <pthread.h>
#include <sched.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "base/error.h"
#include "base/exchange.h"
#include "base/utc_stamp.h"
#include "session/block_writer.h"
#include "session/database.h"

namespace filum {
namespace {

constexpr std::size_t kMaxPending = 60000;  // records of a kind kept in memory while the disk refuses them

/// Runs before ordinary threads, after the haptic loop, where the system allows it. A commit takes a millisecond
/// in twenty; without this a machine with more work than cores lets the thread wait for half a second.
void ask_for_prompt_wakes() noexcept {
  sched_param priority{};
  priority.sched_priority = 1;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
}

std::string checked(const RecorderOptions& options) {
  const RecordingMeta& meta = options.meta;
  if (!meta.participant.empty() && !is_participant_code(meta.participant))
    throw InputError("session", "participant", "\"" + meta.participant + "\"",
                     "a code of 1 to 32 letters, digits, - or _ (never a name)");
  if (meta.n_tools < 0 || meta.n_tools > static_cast<int>(Inputs().tools.size()))
    throw InputError("session", "n_tools", std::to_string(meta.n_tools), "0 to 3");
  const std::filesystem::path path(options.file);
  std::error_code error;
  if (std::filesystem::exists(path, error))
    throw InputError(options.file, "recording", "a file that exists",
                     "a new file: recordings are never overwritten");
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error))
    throw InputError(options.file, "recording", "no folder " + folder.string(),
                     "a folder that can be written");
  return options.file;
}

/// Records on their way to the disk: out of the queue, not yet committed.
template <class Record>
struct Channel {
  explicit Channel(std::size_t capacity) : queue(capacity) { pending.reserve(1024); }

  bool push(const Record& record) noexcept {
    if (queue.push(record)) return true;
    lost.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  void drain() {
    Record record;
    while (pending.size() < kMaxPending && queue.pop(record)) pending.push_back(record);
  }

  Queue<Record> queue;
  std::vector<Record> pending;
  std::atomic<std::uint64_t> lost{0};
  std::uint64_t lost_reported = 0;
};

}  // namespace

struct Recorder::Impl {
  explicit Impl(RecorderOptions given)
      : options(std::move(given)),
        steps(options.step_capacity),
        samples(options.sample_capacity),
        events(options.event_capacity),
        array_hashes(options.array_hash_capacity),
        writer(checked(options), options.meta, options.sources) {}

  void start();
  void run();
  void begin() noexcept;
  bool commit_what_came();
  void report_losses();
  template <class Record>
  void report_loss(Channel<Record>& channel, const char* what);
  void set_trouble(const std::string& message);
  std::uint64_t lost() const {
    return steps.lost.load() + samples.lost.load() + events.lost.load() + array_hashes.lost.load();
  }

  RecorderOptions options;
  Channel<StepRecord> steps;
  Channel<SampleRecord> samples;
  Channel<EventRecord> events;
  Channel<ArrayHashRecord> array_hashes;
  BlockWriter writer;  // used by the constructor until the thread begins, then by the thread, then by close()

  mutable std::mutex mutex;  // of what follows
  std::condition_variable wake;
  bool begun = false;
  std::exception_ptr no_beginning;
  bool stop = false;
  std::optional<ScoreRecord> score;
  std::string trouble;
  std::uint64_t steps_stored = 0;
  std::uint64_t samples_stored = 0;

  std::thread thread;
  bool closed = false;
};

template <class Record>
void Recorder::Impl::report_loss(Channel<Record>& channel, const char* what) {
  const std::uint64_t lost_now = channel.lost.load(std::memory_order_relaxed);
  if (lost_now == channel.lost_reported) return;
  EventRecord event;
  event.name = "recording-lost";
  event.step = steps.pending.empty() ? 0 : steps.pending.back().step;
  event.value = static_cast<double>(lost_now - channel.lost_reported);
  event.unit = what;
  events.pending.push_back(event);
  channel.lost_reported = lost_now;
}

void Recorder::Impl::report_losses() {
  report_loss(steps, "steps");
  report_loss(samples, "samples");
  report_loss(events, "events");
  report_loss(array_hashes, "array hashes");
}

void Recorder::Impl::set_trouble(const std::string& message) {
  const std::lock_guard lock(mutex);
  trouble = message;
}

/// False where nothing was waiting, or it could not be stored.
bool Recorder::Impl::commit_what_came() {
  // Steps first: whatever was pushed before a step that is taken here is then taken in the same transaction.
  steps.drain();
  array_hashes.drain();
  events.drain();
  samples.drain();
  report_losses();
  std::optional<ScoreRecord> new_score;
  {
    const std::lock_guard lock(mutex);
    new_score.swap(score);
  }
  const bool nothing = steps.pending.empty() && samples.pending.empty() && events.pending.empty() &&
                       array_hashes.pending.empty() && !new_score;
  if (nothing) return false;
  try {
    writer.commit({steps.pending, samples.pending, events.pending, array_hashes.pending, new_score});
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex);
    trouble = "not stored, trying again: " + database::reason(error) +
              ". Free some space or choose another folder.";
    if (!score) score.swap(new_score);
    return false;
  }
  const std::lock_guard lock(mutex);
  steps_stored += steps.pending.size();
  samples_stored += samples.pending.size();
  steps.pending.clear();
  samples.pending.clear();
  events.pending.clear();
  array_hashes.pending.clear();
  trouble.clear();
  return true;
}

/// Returns when the thread runs and its first commit is on disk: neither its start nor the log's delays a record.
void Recorder::Impl::start() {
  thread = std::thread([this] { run(); });
  {
    std::unique_lock lock(mutex);
    wake.wait(lock, [this] { return begun; });
  }
  if (!no_beginning) return;
  thread.join();
  std::rethrow_exception(no_beginning);
}

void Recorder::Impl::begin() noexcept {
  std::exception_ptr failure;
  try {
    writer.begin();
  } catch (...) {
    failure = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex);
    no_beginning = failure;
    stop = stop || failure;
    begun = true;
  }
  wake.notify_all();
}

void Recorder::Impl::run() {
  ask_for_prompt_wakes();
  begin();
  std::unique_lock lock(mutex);
  while (!stop) {
    wake.wait_for(lock, options.interval, [this] { return stop; });
    lock.unlock();
    commit_what_came();
    lock.lock();
  }
}

Recorder::Recorder(RecorderOptions options) {
  options.meta.format = kRecordingFormat;
  if (options.meta.started_utc.empty()) options.meta.started_utc = utc_now();
  impl_ = std::make_unique<Impl>(std::move(options));
  impl_->start();
}

Recorder::~Recorder() {
  close();
}

bool Recorder::record_step(const StepRecord& record) noexcept {
  return impl_->steps.push(record);
}
bool Recorder::record_event(const EventRecord& record) noexcept {
  return impl_->events.push(record);
}
bool Recorder::record_array_hash(const ArrayHashRecord& record) noexcept {
  return impl_->array_hashes.push(record);
}
bool Recorder::record_sample(const SampleRecord& record) noexcept {
  return impl_->samples.push(record);
}

void Recorder::set_score(const ScoreRecord& score) {
  const std::lock_guard lock(impl_->mutex);
  impl_->score = score;
}

RecorderStatus Recorder::status() const {
  RecorderStatus status;
  const std::lock_guard lock(impl_->mutex);
  status.records_lost = impl_->lost();
  status.steps_stored = impl_->steps_stored;
  status.samples_stored = impl_->samples_stored;
  status.message = impl_->trouble;
  if (status.message.empty() && status.records_lost > 0)
    status.message = std::to_string(status.records_lost) + " records lost: the disk did not keep up";
  status.healthy = status.message.empty();
  return status;
}

bool Recorder::close() {
  if (impl_->closed) return status().healthy;
  impl_->closed = true;
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->wake.notify_all();
  impl_->thread.join();
  // What was pushed after the thread's last look. More than one commit takes needs several; whoever still pushes does not keep it open.
  const RecorderOptions& o = impl_->options;
  const std::size_t most = std::max({o.step_capacity, o.sample_capacity, o.event_capacity, o.array_hash_capacity}) / kMaxPending + 2;
  for (std::size_t n = 0; n < most && impl_->commit_what_came(); ++n) {
  }
  if (impl_->trouble.empty()) {  // lost records are told in the recording; what is not stored is not
    try {
      impl_->writer.finish();
    } catch (const std::exception& error) {
      impl_->set_trouble("not closed properly: " + database::reason(error) +
                         ". What was stored can still be read.");
    }
  }
  return status().healthy;
}

const std::string& Recorder::file() const {
  return impl_->options.file;
}

std::string utc_now() { return utc_stamp("%Y-%m-%dT%H:%M:%SZ"); }

}  // namespace filum
