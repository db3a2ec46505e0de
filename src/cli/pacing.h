#pragma once
// Keeps the steps of the world in time with the steady clock. A step that comes late moves all that follow: the scene slows
// down, it never hurries to catch up.

#include <cstdint>

namespace filum {

class Pacing {
 public:
  explicit Pacing(double dt) : dt_us_(static_cast<std::int64_t>(dt * 1e6)) {}

  /// Time to begin the next step [us, same clock as now_us], given that it is now_us.
  std::int64_t due(std::int64_t now_us) noexcept;

  /// The step that began at `begin_us` has ended; true if it took longer than dt.
  bool ended(std::int64_t begin_us, std::int64_t end_us) noexcept;

  std::uint64_t overruns() const noexcept { return overruns_; }
  /// Scene time through wall time, over the last half second or so; 1 keeps up.
  double real_time_factor() const noexcept { return factor_; }

 private:
  std::int64_t dt_us_;
  std::int64_t next_us_ = -1;
  std::int64_t last_begin_us_ = -1;
  std::uint64_t overruns_ = 0;
  double period_us_ = 0.0;  // smoothed
  double factor_ = 1.0;
};

}  // namespace filum
