#include "devices/forceps_stream.h"

#include <cmath>

#include "devices/sample_check.h"
#include "devices/sample_faults.h"

namespace filum {
namespace {

constexpr double kLengthUnit = 1e-7;  // [m]
constexpr double kQuaternionUnit = 1.0 / (1 << 30);
constexpr std::int64_t kClockMayRunBack = 100'000;  // [us], more is a restart
constexpr std::int64_t kClockMayLeap = 60'000'000;  // [us], of frames that come late; more is a restart: a clock begun anew seems ahead of one past half its range
constexpr std::int64_t kForgetAfter = 1'000'000;    // [us], a silent device gives up its place
constexpr int kBelieveAfter = 8;                    // so many late frames in a row are the truth

DeviceSample blank(int tool, std::uint32_t sequence, std::int64_t device_us, std::int64_t now_us) noexcept {
  DeviceSample sample;
  sample.tool = tool;
  sample.sequence = sequence;
  sample.device_time_us = device_us;
  sample.host_time_us = now_us;
  return sample;
}

std::uint32_t buttons_of(std::uint8_t flags) noexcept {
  return ((flags & FILUM_PEDAL) ? 1u : 0u) | ((flags & FILUM_BUTTON_CUT) ? 2u : 0u) |
         ((flags & FILUM_BUTTON_NEXT) ? 4u : 0u);
}

std::uint32_t faults_of(std::uint8_t flags) noexcept {
  return ((flags & FILUM_ANGLE_SATURATED) ? kAngleSaturated : 0u) | ((flags & FILUM_FORCE_SATURATED) ? kForceSaturated : 0u) |
         ((flags & FILUM_ANGLE_BROKEN) ? kAngleBroken : 0u) | ((flags & FILUM_FORCE_BROKEN) ? kForceBroken : 0u);
}

}  // namespace

std::optional<Pose> pose_of(const filum_pose& pose) noexcept {
  if (!(pose.flags & FILUM_POSE_TRACKED)) return std::nullopt;
  Pose X;
  for (int i = 0; i < 3; ++i) X.p[i] = pose.position[i] * kLengthUnit;
  const std::int32_t* w = pose.quaternion;
  X.q = Quat(w[0] * kQuaternionUnit, w[1] * kQuaternionUnit, w[2] * kQuaternionUnit, w[3] * kQuaternionUnit);
  if (X.p.cwiseAbs().maxCoeff() > kHandReach || std::abs(X.q.norm() - 1.0) > 0.01) return std::nullopt;
  X.q.normalize();
  return X;
}

filum_pose wire_pose(int tool, const Pose& X_WD) noexcept {
  filum_pose pose{};
  pose.tool = static_cast<std::uint8_t>(tool);
  pose.flags = FILUM_POSE_TRACKED;
  for (int i = 0; i < 3; ++i)
    pose.position[i] = static_cast<std::int32_t>(std::lround(X_WD.p[i] / kLengthUnit));
  const double q[4] = {X_WD.q.w(), X_WD.q.x(), X_WD.q.y(), X_WD.q.z()};
  for (int i = 0; i < 4; ++i)
    pose.quaternion[i] = static_cast<std::int32_t>(std::lround(q[i] / kQuaternionUnit));
  return pose;
}

void ForcepsStream::feed(std::span<const std::uint8_t> bytes, std::int64_t now_us,
                         std::vector<DeviceSample>& out) noexcept {
  reader_.feed(bytes, [&](const filum_frame& frame) { on_frame(frame, now_us, out); });
}

void ForcepsStream::restart() noexcept {
  reader_.restart();
  sources_ = {};
  buttons_ = {};
  clock_.restart();
  drift_.restart();
}

bool ForcepsStream::calibration_differs() const noexcept {
  return hello_ && hello_->calibration != 0 && hello_->calibration != calibration_.identity;
}

ForcepsStream::Source* ForcepsStream::source(std::uint16_t id, std::int64_t now_us) noexcept {
  Source* free = nullptr;
  for (Source& s : sources_) {
    if (s.used && s.id == id) return &s;
    const bool silent = !s.used || now_us - s.heard_us > kForgetAfter;
    if (silent && !free) free = &s;
  }
  if (free) {
    *free = Source{};
    free->id = id;
  }
  return free;
}

/// Sequence and clock; false for a frame that was seen before or comes too late.
bool ForcepsStream::follow(Source& from, const filum_frame& frame) noexcept {
  const auto step = static_cast<std::uint16_t>(frame.sequence - static_cast<std::uint16_t>(from.sequence));
  WideClock ahead = from.clock;
  const bool powered_up = frame.type == FILUM_HELLO && frame.sequence == 0;
  const std::int64_t passed = ahead.unwrap(frame.time_us) - from.time_us;
  const bool ran_back = passed < -kClockMayRunBack;
  const bool late = step == 0 || step >= 0x8000u;
  if (from.used && !powered_up && !ran_back) {
    if (late && ++from.refused_in_row < kBelieveAfter) return false;
    if (!late) lost_ += step - 1u;
  }
  const bool started_again = from.used && (powered_up || ran_back || (late && passed > kClockMayLeap));
  if (started_again) {  // its clock began anew, whatever its number was before
    from.clock.restart();
    clock_.restart();
    drift_.restart();
  }
  if (!from.used || started_again || late)
    from.sequence = frame.sequence;
  else
    from.sequence += step;
  from.used = true;
  from.refused_in_row = 0;
  from.time_us = from.clock.unwrap(frame.time_us);
  return true;
}

void ForcepsStream::on_frame(const filum_frame& frame, std::int64_t now_us,
                             std::vector<DeviceSample>& out) noexcept {
  Source* from = source(frame.device, now_us);
  if (!from || !follow(*from, frame)) {
    ++rejected_;
    return;
  }
  from->heard_us = now_us;
  last_frame_us_ = now_us;
  filum_grip grip;
  filum_pose pose;
  filum_hello hello;
  filum_pong pong;
  filum_handle_status status;
  if (filum_get_grip(&frame, &grip)) {
    on_grip(*from, grip, now_us, out);
  } else if (filum_get_pose(&frame, &pose)) {
    on_pose(*from, pose, now_us, out);
  } else if (filum_get_hello(&frame, &hello)) {
    hello_ = hello;
  } else if (filum_get_status(&frame, &status)) {
    status_ = status;
  } else if (filum_get_pong(&frame, &pong)) {
    const std::int64_t sent =
        now_us - static_cast<std::int32_t>(static_cast<std::uint32_t>(now_us) - pong.host_us);
    const std::int64_t device = from->time_us - static_cast<std::int32_t>(frame.time_us - pong.received_us);
    clock_.pong(sent, device, now_us);
    drift_.pong(sent, device, now_us);
  } else {
    ++rejected_;  // a tool that does not exist, or a ping, which only the trainer sends
  }
}

void ForcepsStream::on_grip(const Source& from, const filum_grip& grip, std::int64_t now_us,
                            std::vector<DeviceSample>& out) noexcept {
  DeviceSample sample = blank(grip.tool, from.sequence, from.time_us, now_us);
  sample.raw_angle = grip.angle;
  sample.raw_force = grip.force;
  sample.has_grip_angle = !(grip.flags & FILUM_ANGLE_BROKEN);
  sample.has_grip_force = !(grip.flags & (FILUM_FORCE_BROKEN | FILUM_NO_FORCE));
  if (sample.has_grip_angle) sample.grip_angle = calibration_.angle(grip.angle);
  if (sample.has_grip_force) sample.grip_force = calibration_.force(grip.force);
  sample.buttons = buttons_[grip.tool] = buttons_of(grip.flags);
  sample.buttons |= faults_of(grip.flags) | (calibration_differs() ? kForeignCalibration : 0u);
  out.push_back(sample);
  ++received_;
}

void ForcepsStream::on_pose(const Source& from, const filum_pose& wire, std::int64_t now_us,
                            std::vector<DeviceSample>& out) noexcept {
  const std::optional<Pose> pose = pose_of(wire);
  if (!pose) {
    // Out of sight is no error of the link; numbers that cannot be a pose are.
    if (wire.flags & FILUM_POSE_TRACKED) ++rejected_;
    return;
  }
  DeviceSample sample = blank(wire.tool, from.sequence, from.time_us, now_us);
  sample.has_pose = true;
  sample.X_WD = *pose;
  sample.buttons = buttons_[wire.tool];
  out.push_back(sample);
  ++received_;
}

}  // namespace filum
