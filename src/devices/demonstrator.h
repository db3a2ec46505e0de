#pragma once
// Plays a scripted demonstration (pose_script.h) as a device: one sample a tool at every millisecond of scene
// time, so that what a step is driven by does not depend on when poll() happened to be called. Keys given in the frame of something seen
// are looked for when the hand sets out; while it is not there, the script's clock stands still for all hands, the samples of the one that
// looks for it say so (kNotSeen), and after ten seconds the demonstration is over. A hand that stops where it feels a pull, or that follows
// what it sees, changes its own track only; the script's clock goes on.

#include <array>
#include <string>
#include <vector>

#include "devices/device.h"
#include "devices/pose_script.h"

namespace filum {

class Demonstrator final : public Device {
 public:
  /// Throws InputError for a bad file.
  explicit Demonstrator(const std::string& path);
  explicit Demonstrator(PoseScript script);

  const std::string& name() const override { return name_; }
  /// A caller that comes late gets the newest samples only; those it missed are counted as lost.
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override;
  DeviceHealth health() const noexcept override { return health_; }
  const PoseScript& script() const noexcept { return script_; }
  /// What the hands see by; must outlive the calls of poll(), which read it.
  void look_through(const Eyes* eyes) noexcept { eyes_ = eyes; }

 private:
  static constexpr std::int64_t kPeriod = 1000;            // [us]
  static constexpr std::int64_t kPatience = 10'000'000;    // [us]
  static constexpr int kFelt = 10;                         // samples in a row with a pull before the hand stops: a shorter one is a snap

  int blocked_at(double t);
  bool look(PoseTrack& track);
  void go_on_looking(PoseTrack& track, double t);
  void feel(PoseTrack& track, double t);

  PoseScript script_;
  std::string name_;
  const Eyes* eyes_ = nullptr;
  std::int64_t waited_us_ = 0, waiting_us_ = 0;  // [us], in all; since when nothing was found, in a row
  std::int64_t next_us_ = 0;  // [us], scene time of the next sample
  std::uint64_t moved_ = 0;   // tools the script moves
  std::array<int, kMaxTools> felt_{};  // samples in a row
  DeviceHealth health_;
};

}  // namespace filum
