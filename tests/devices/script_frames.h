#pragma once
// What a pair of forceps would send while somebody moves them as a demonstration says.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "devices/forceps_calibration.h"
#include "devices/forceps_stream.h"
#include "devices/pose_script.h"
#include "hardware/protocol/filum_protocol.h"

namespace filum {

class ScriptFrames {
 public:
  ScriptFrames(PoseScript script, ForcepsCalibration calibration)
      : script_(std::move(script)), calibration_(std::move(calibration)) {}

  const PoseScript& script() const { return script_; }

  /// From now on this opening [rad] and squeeze [N] instead of the script's.
  void hold(double grip_angle, double grip_force) { held_ = {grip_angle, grip_force}; }

  /// Appends the frames of one instant t [s]: pose and grip of every tool the script moves.
  void append(double t, std::vector<std::vector<std::uint8_t>>& frames) {
    for (int tool = 0; tool < script_.n_tools(); ++tool) {
      DeviceSample sample = script_.at(tool, t);
      if (!sample.has_pose) continue;
      if (held_) {
        sample.grip_angle = (*held_)[0];
        sample.grip_force = (*held_)[1];
        sample.has_grip_force = true;
      }
      filum_frame frame{};
      // Grip first: a pose frame carries the buttons of the grip before it.
      const filum_grip grip{static_cast<std::uint8_t>(tool), flags_of(sample),
                            calibration_.angle_count(sample.grip_angle),
                            calibration_.force_count(sample.grip_force)};
      filum_put_grip(&frame, &grip);
      frames.push_back(finish(frame, t));
      const filum_pose pose = wire_pose(tool, sample.X_WD);
      filum_put_pose(&frame, &pose);
      frames.push_back(finish(frame, t));
    }
  }
  std::vector<std::uint8_t> hello(double t) {
    filum_frame frame{};
    const filum_hello hello{{1, 0, 0}, 7, 4095, 4095, 1000, calibration_.identity};
    filum_put_hello(&frame, &hello);
    return finish(frame, t);
  }
  std::vector<std::uint8_t> pong(const filum_ping& ping, double t) {
    filum_frame frame{};
    const filum_pong pong{ping.host_us, device_us(t)};
    filum_put_pong(&frame, &pong);
    return finish(frame, t);
  }

 private:
  static std::uint8_t flags_of(const DeviceSample& sample) {
    return static_cast<std::uint8_t>(
        (sample.has_grip_force ? 0 : FILUM_NO_FORCE) | ((sample.buttons & 1u) ? FILUM_PEDAL : 0) |
        ((sample.buttons & 2u) ? FILUM_BUTTON_CUT : 0) | ((sample.buttons & 4u) ? FILUM_BUTTON_NEXT : 0));
  }
  static std::uint32_t device_us(double t) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(t * 1e6));
  }
  std::vector<std::uint8_t> finish(filum_frame& frame, double t) {
    frame.device = 1;
    frame.sequence = sequence_++;
    frame.time_us = device_us(t);
    std::vector<std::uint8_t> wire(FILUM_MAX_WIRE);
    wire.resize(filum_frame_encode(&frame, wire.data()));
    return wire;
  }

  PoseScript script_;
  ForcepsCalibration calibration_;
  std::optional<std::array<double, 2>> held_;
  std::uint16_t sequence_ = 0;
};

}  // namespace filum
