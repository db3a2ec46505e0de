#pragma once
// Bytes from a forceps link to samples: frames, sequence and clock of each device on the link, calibration.
// Pure: it owns no port, so that every kind of damage can be tried on it.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "devices/clock_sync.h"
#include "devices/device.h"
#include "devices/forceps_calibration.h"
#include "devices/frame_reader.h"

namespace filum {

class ForcepsStream {
 public:
  explicit ForcepsStream(ForcepsCalibration calibration) : calibration_(std::move(calibration)) {}

  /// Appends the samples of all frames that end in `bytes`; `now_us` [us] is the host's clock. Allocates
  /// nothing as long as `out` has room for one sample for every 20 bytes.
  void feed(std::span<const std::uint8_t> bytes, std::int64_t now_us,
            std::vector<DeviceSample>& out) noexcept;
  /// The port was reopened: forget half a frame, sequence numbers and clocks. The counters stay.
  void restart() noexcept;

  std::uint64_t received() const noexcept { return received_; }  // good samples
  std::uint64_t lost() const noexcept { return lost_; }          // missing sequence numbers
  std::uint64_t rejected() const noexcept { return rejected_; }  // whole frames with impossible content
  const FrameCounts& frames() const noexcept { return reader_.counts(); }
  /// [us], host clock of the last good frame; absent before the first.
  std::optional<std::int64_t> last_frame_us() const noexcept { return last_frame_us_; }
  /// The last hello of any device on the link.
  const std::optional<filum_hello>& hello() const noexcept { return hello_; }
  /// The last status of any device on the link.
  const std::optional<filum_handle_status>& status() const noexcept { return status_; }
  /// True when a handle says it was calibrated and the file in use is for another one.
  bool calibration_differs() const noexcept;
  /// Offset of the clock of the device that answered last.
  const ClockSync& clock() const noexcept { return clock_; }
  const ClockDrift& drift() const noexcept { return drift_; }
  const ForcepsCalibration& calibration() const noexcept { return calibration_; }

 private:
  struct Source {  // one device id on the link
    bool used = false;
    std::uint16_t id = 0;
    std::uint32_t sequence = 0;  // unwrapped
    WideClock clock;
    std::int64_t time_us = 0;   // [us], device clock of its last frame
    std::int64_t heard_us = 0;  // [us], host clock of its last frame
    int refused_in_row = 0;     // frames that came late or twice since the last good one
  };

  void on_frame(const filum_frame& frame, std::int64_t now_us, std::vector<DeviceSample>& out) noexcept;
  Source* source(std::uint16_t id, std::int64_t now_us) noexcept;
  bool follow(Source& source, const filum_frame& frame) noexcept;
  void on_grip(const Source& source, const filum_grip& grip, std::int64_t now_us,
               std::vector<DeviceSample>& out) noexcept;
  void on_pose(const Source& source, const filum_pose& pose, std::int64_t now_us,
               std::vector<DeviceSample>& out) noexcept;

  ForcepsCalibration calibration_;
  FrameReader reader_;
  std::array<Source, 4> sources_;
  std::array<std::uint32_t, kMaxTools> buttons_{};  // pose frames carry the buttons of the last grip frame
  std::uint64_t received_ = 0, lost_ = 0, rejected_ = 0;
  std::optional<std::int64_t> last_frame_us_;
  std::optional<filum_hello> hello_;
  std::optional<filum_handle_status> status_;
  ClockSync clock_;
  ClockDrift drift_;
};

/// A pose as its frame carries it, and back; absent where it is not to be trusted (untracked, out of reach,
/// not unit).
std::optional<Pose> pose_of(const filum_pose& pose) noexcept;
filum_pose wire_pose(int tool, const Pose& X_WD) noexcept;

}  // namespace filum
