#pragma once
// One interface for everything that moves a tool: recorded sessions, the demonstrator, the pointer in the browser, serial
// forceps. A device only reports what it measured; a value it does not measure is absent (its has_ flag is false) and a
// value that was lost is never invented. Devices know nothing of the world or the session.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/pose.h"

namespace filum {

inline constexpr int kMaxTools = 3;  // left hand, right hand, and one parked or assistant's tool

/// One time-stamped reading for one tool.
struct DeviceSample {
  int tool = 0;                     // index of the tool in the scene, 0 ... kMaxTools-1
  std::int64_t host_time_us = 0;    // [us], host steady clock when the reading arrived
  std::int64_t device_time_us = 0;  // [us], device clock, unwrapped; equals host_time_us where there is none
  std::uint32_t sequence = 0;       // counts up by one; a gap is a loss
  bool has_pose = false;
  bool has_grip_angle = false;
  bool has_grip_force = false;
  Pose X_WD;                        // pose of the handle in the scene's world frame W
  double grip_angle = 0.0;          // [rad], opening between the jaws; 0 closed, below 0 squeezed beyond closure, below 0 = squeezed
  double grip_force = 0.0;          // [N], measured at the pads, >= 0
  std::int32_t raw_angle = 0;       // [count], as sent; 0 where there is no converter
  std::int32_t raw_force = 0;       // [count]
  std::uint32_t buttons = 0;        // bit set: 1 clutch, 2 cut, 4 next, 8 and 16 clamps off, 32 fresh suture
};

enum class DeviceState { waiting, live, stale, lost, finished };

/// What a device can say of its own health; counters only ever grow.
struct DeviceHealth {
  DeviceState state = DeviceState::waiting;
  std::uint64_t received = 0;      // good samples
  std::uint64_t lost = 0;          // missing sequence numbers
  std::uint64_t corrupt = 0;       // frames refused: length, checksum, type
  std::uint64_t rejected = 0;      // samples refused: NaN, out of range, wrong tool
};

/// Forces to be felt by the hands, of all tools.
struct HandForces {
  std::array<Vec3, kMaxTools> force{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // [N], frame W
  std::array<Vec3, kMaxTools> torque{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // [N m], about the tip, for those that can show it
  std::array<bool, kMaxTools> valid{};                                          // false: no force
};

/// A source of samples. poll() is called at 1 kHz from the haptic thread: it may not block, allocate in the steady state or
/// throw. Construction throws InputError (base/error.h) when the thing named cannot be opened or read.
class Device {
 public:
  virtual ~Device() = default;
  /// Short name for messages, e.g. "serial /dev/pts/3".
  virtual const std::string& name() const = 0;
  /// Appends to `out` (capacity reserved by the caller, never more than kMaxSamplesPerPoll a call) the samples that have
  /// arrived by scene time `now_us` [us since the session started].
  virtual void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept = 0;
  /// Called after poll() with what the hands should feel now; devices without motors take no notice. As poll(): no blocking,
  /// allocating or throwing.
  virtual void render(std::int64_t /*now_us*/, const HandForces& /*forces*/) noexcept {}
  virtual DeviceHealth health() const noexcept = 0;
  /// [us], how long a sample counts as the present when no newer one comes.
  virtual std::int64_t stale_after_us() const noexcept { return 100'000; }
};

inline constexpr std::size_t kMaxSamplesPerPoll = 256;

}  // namespace filum
