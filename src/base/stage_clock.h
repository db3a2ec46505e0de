#pragma once
// Where the time of a step goes. Functions name the stage they are; a bench that listens on its thread adds their times up, and without one
// nothing is measured: no clock is read, and what is computed does not depend on it.
//
//   void find_near() { const StageScope stage("near pairs"); ... }
//
// Time counts for the innermost stage only, so that the stages of a step add up to it. Test: stage_clock_test.

#include <array>
#include <chrono>
#include <cstring>

namespace filum {

/// Listens to the stages of the thread it is made in, for as long as it lives; one at a time in a thread.
class StageClock {
 public:
  struct Stage {
    const char* name = nullptr;
    double milliseconds = 0.0;
  };
  static constexpr int kMost = 24;  // what comes after these counts for the stage around it

  StageClock() noexcept { listening = this; }
  ~StageClock() { listening = nullptr; }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  /// All stages met so far, with their time since the last clear().
  const Stage* begin() const noexcept { return stages_.data(); }
  const Stage* end() const noexcept { return stages_.data() + n_; }
  void clear() noexcept {
    for (Stage& s : stages_) s.milliseconds = 0.0;
  }

 private:
  friend class StageScope;
  using Clock = std::chrono::steady_clock;
  static constexpr int kNone = -1;

  /// Goes on with stage k; returns the one before.
  int enter(int k) noexcept {
    const Clock::time_point now = Clock::now();
    if (current_ != kNone)
      stages_[static_cast<std::size_t>(current_)].milliseconds += std::chrono::duration<double, std::milli>(now - since_).count();
    since_ = now;
    const int before = current_;
    current_ = k;
    return before;
  }
  int find(const char* name) noexcept {
    for (int k = 0; k < n_; ++k)
      if (std::strcmp(stages_[static_cast<std::size_t>(k)].name, name) == 0) return k;
    if (n_ == kMost) return current_;
    stages_[static_cast<std::size_t>(n_)].name = name;
    return n_++;
  }

  static inline constinit thread_local StageClock* listening = nullptr;
  std::array<Stage, kMost> stages_{};
  Clock::time_point since_{};
  int n_ = 0, current_ = kNone;
};

/// From here to the end of the block is the stage `name`, a text that lives for ever.
class StageScope {
 public:
  explicit StageScope(const char* name) noexcept : clock_(StageClock::listening) {
    if (clock_ != nullptr) before_ = clock_->enter(clock_->find(name));
  }
  ~StageScope() {
    if (clock_ != nullptr) clock_->enter(before_);
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  StageClock* clock_;
  int before_ = StageClock::kNone;
};

}  // namespace filum
