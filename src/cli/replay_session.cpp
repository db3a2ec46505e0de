#include "cli/replay_session.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include "cli/trainer.h"

namespace filum {
namespace {

constexpr double kMostPictures = 3600.0;  // of some 10 kB each
constexpr std::chrono::milliseconds kPeriod{16};
constexpr double kTellEvery = 0.1;  // [s]

struct Stopped {};  // leaves replay() when the viewer closes the recording

// The nodes in use only: a picture of a short thread is small.
Observation trimmed(const Observation& o) {
  Observation t = o;
  t.positions = o.positions.leftCols(o.n_nodes).eval();
  t.arc.resize(static_cast<std::size_t>(o.n_nodes));
  t.tension.resize(static_cast<std::size_t>(o.n_nodes));
  t.contact.resize(static_cast<std::size_t>(o.n_nodes));
  for (auto* values : {&t.arc, &t.tension, &t.contact}) values->shrink_to_fit();
  return t;
}

}  // namespace

ReplaySession::ReplaySession(const std::string& file, std::string session, ShowFrame show_frame, ShowState show_state)
    : session_(std::move(session)),
      recording_(file),
      recorded_(recording_),
      world_(recorded_.setup().model),
      show_frame_(std::move(show_frame)),
      show_state_(std::move(show_state)),
      task_(recorded_.setup().task, world_.description()) {
  if (recording_.score()) stored_score_ = recording_.score()->json;
  require_steps(recording_);
  duration_ = static_cast<double>(recording_.last_step()) * recording_.meta().dt;
  interval_ = std::max(interval_, duration_ / kMostPictures);
}

ReplaySession::~ReplaySession() {
  quit_.store(true);
  if (loader_.joinable()) loader_.join();
  if (shower_.joinable()) shower_.join();
}

void ReplaySession::start() {
  keep_picture(world_.observation());
  loader_ = std::thread([this] { load(); });
  shower_ = std::thread([this] { show_loop(); });
}

void ReplaySession::load() {
  try {
    double next = interval_;
    const ReplayResult result = replay(recording_, world_, [this, &next](const StepRecord&, const Observation& o) {
      if (quit_.load()) throw Stopped{};
      task_.observe(o);
      if (o.time + 1e-9 < next) return;
      next += interval_;
      keep_picture(o);
    }, true);
    if (!result.damage.empty()) end_here();
  } catch (const Stopped&) {
  } catch (const std::exception&) {
    end_here();
  }
}

/// Behind this point nothing can be replayed: what could stays to be seen, and its length is what is told.
void ReplaySession::end_here() {
  const std::lock_guard lock(mutex_);
  duration_ = pictures_.empty() ? 0.0 : pictures_.back().observation.time;
  changed_ = true;
}

std::string ReplaySession::damage() const {
  std::string all;
  for (const std::string& one : recording_.find_damage()) all += (all.empty() ? "This recording is damaged: " : "; ") + one;
  return all.empty() ? all : all + ". What can be read is shown.";
}

void ReplaySession::keep_picture(const Observation& observation) {
  Picture picture{trimmed(observation), task_view_of(task_.status())};
  const std::lock_guard lock(mutex_);
  pictures_.push_back(std::move(picture));
}

void ReplaySession::play(bool on) {
  const std::lock_guard lock(mutex_);
  if (on && time_ >= duration_) time_ = 0.0;
  playing_ = on;
  changed_ = true;
}

void ReplaySession::seek(double time) {
  const std::lock_guard lock(mutex_);
  time_ = std::clamp(time, 0.0, duration_);
  changed_ = true;
}

void ReplaySession::show_again() {
  const std::lock_guard lock(mutex_);
  shown_ = static_cast<std::size_t>(-1);
}

void ReplaySession::show_loop() {
  auto last = std::chrono::steady_clock::now();
  double since_told = 0.0;  // [s]
  double told_ready = -1.0;  // [s]
  while (!quit_.load()) {
    std::this_thread::sleep_for(kPeriod);
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double>(now - last).count();
    last = now;
    since_told += elapsed;
    const bool moved = show_next(elapsed);
    std::optional<ReplayView> tell;
    {
      const std::lock_guard lock(mutex_);
      const double ready = ready_to();
      if (changed_ || ((moved || ready != told_ready) && since_told > kTellEvery)) tell = ReplayView{session_, time_, duration_, ready, playing_};
      changed_ = false;
    }
    if (!tell) continue;
    since_told = 0.0;
    told_ready = tell->ready;
    show_state_(*tell);
  }
}

double ReplaySession::ready_to() const {
  const double last = pictures_.back().observation.time;
  return last + 2.0 * interval_ >= duration_ ? duration_ : last;
}

bool ReplaySession::show_next(double elapsed) {
  Picture picture;
  {
    const std::lock_guard lock(mutex_);
    if (playing_) {
      time_ = std::min(time_ + elapsed, std::max(time_, ready_to()));
      if (time_ >= duration_) {
        playing_ = false;
        changed_ = true;
      }
    }
    const auto at = static_cast<std::size_t>(time_ / interval_);
    const std::size_t wanted = std::min(at, pictures_.size() - 1);
    if (wanted == shown_) return false;
    shown_ = wanted;
    picture = pictures_[wanted];
  }
  show_frame_(picture.observation, picture.task);
  return true;
}

}  // namespace filum
