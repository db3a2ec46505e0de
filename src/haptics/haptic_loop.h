#pragma once
// The 1 kHz loop between hands and world: polls the devices, merges what they say into Inputs for the world's
// thread, and works out from the tools the world shows the force each hand should feel. tick() is the whole
// of it and reads no clock, so a headless run calls it at scene time; start() runs it in a thread of its own
// against the steady clock. tick() allocates nothing, locks nothing, logs nothing and throws nothing.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "base/exchange.h"
#include "devices/device.h"
#include "haptics/blade_feel.h"
#include "haptics/hand_coupling.h"
#include "haptics/input_merge.h"
#include "haptics/local_contact.h"
#include "haptics/period_stats.h"
#include "world/inputs.h"
#include "world/observation.h"

namespace filum {

/// What the coupling needs of the simulated tools.
struct ToolStates {
  struct Tool {
    Vec3 p_WT = Vec3::Zero();   // [m], simulated tip
    Vec3 v_W = Vec3::Zero();    // [m/s]
    Vec3 f_T_W = Vec3::Zero();  // [N], force of the scene on the tool
    bool present = false;
    bool blade = false;   // goes where the hand goes: the hand feels the scene's own force; p_WT is then where the hand was
    bool parked = false;  // on an arm: the hand feels nothing
    Vec3 torque_W = Vec3::Zero();     // [N m], of the scene on a blade about its tip
    Mat3 stiffness_W = Mat3::Zero();  // [N/m], of what a blade touches
  };
  std::array<Tool, kMaxTools> tools;
  std::int64_t time_us = -1;  // [us], of the clock that tick() is given; -1 never
};
ToolStates tool_states_of(const Observation& observation, std::int64_t now_us) noexcept;

/// The loop's own report of one tick.
struct HapticReport {
  std::uint64_t ticks = 0;
  std::int64_t time_us = 0;  // [us]
  std::array<Vec3, kMaxTools> hand_force{Vec3::Zero(), Vec3::Zero(),
                                         Vec3::Zero()};  // [N], to render, frame W
  std::array<Vec3, kMaxTools> scene_force{Vec3::Zero(), Vec3::Zero(),
                                          Vec3::Zero()};  // [N], of the scene on the tool, frame W
  std::array<Vec3, kMaxTools> scene_torque{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // [N m], about the tip: blades
  std::array<bool, kMaxTools> valid{};                    // the hand is live
  int n_devices = 0;
  std::array<DeviceHealth, InputMerge::kMaxSources> devices;
  std::uint64_t samples_dropped = 0;  // samples the recorder did not take in time
  bool real_time = false;             // the thread runs before ordinary ones: root, or rtprio in limits.conf
  std::uint64_t missed = 0;           // ticks skipped because the thread came too late
  std::int64_t period_p50_us = 0, period_p99_us = 0, period_max_us = 0;  // [us]
};

struct HapticOptions {
  HandCouplingOptions coupling;
  MotionScale scale;                      // from the hand's space to the scene's; forces go back by the same factor
  std::int64_t period_us = 1000;          // [us]
  std::int64_t world_silent_us = 50'000;  // [us] without a new state of the tools: no force
  bool real_time = true;                  // run before ordinary threads where that is allowed
  std::size_t sample_queue = 16384;       // samples kept for the recorder
};

class HapticLoop {
 public:
  /// At most InputMerge::kMaxSources devices; throws std::invalid_argument for more.
  explicit HapticLoop(std::vector<std::unique_ptr<Device>> devices, const HapticOptions& options = {});
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// One turn at time now_us [us] since the session started.
  void tick(std::int64_t now_us) noexcept;

  /// Runs tick() every period in a thread; time 0 is now, or `epoch_us` of the steady clock [us]. Late ticks
  /// are skipped and counted, never made up for.
  void start(std::int64_t epoch_us = -1);
  void stop() noexcept;

  // Exchange with other threads; one thread at each end.
  Latest<Inputs>& inputs() noexcept { return inputs_; }             // read by the world
  Latest<ToolStates>& tool_states() noexcept { return tools_; }     // written by the world
  Queue<DeviceSample>& samples() noexcept { return samples_; }      // read by the recorder
  Latest<HapticReport>& report() noexcept { return report_slot_; }  // read by whoever shows it

  const Device& device(std::size_t i) const { return *devices_.at(i); }
  std::size_t n_devices() const noexcept { return devices_.size(); }

 private:
  void poll_devices(std::int64_t now_us) noexcept;
  void render(const Inputs& inputs, std::int64_t now_us) noexcept;
  Vec3 felt(std::size_t i, const ToolInput& input, std::int64_t now_us, double dt, const ToolStates& states) noexcept;
  void publish(std::int64_t now_us) noexcept;
  void run(std::int64_t epoch_us) noexcept;

  HapticOptions options_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<DeviceSample> polled_;
  InputMerge merge_;
  std::array<HandCoupling, kMaxTools> couplings_;
  std::array<LocalContact, kMaxTools> contacts_;
  std::array<BladeFeel, kMaxTools> blades_;
  std::int64_t seen_states_us_ = -1;  // [us], of the tool states seen last
  PeriodStats periods_;
  HapticReport now_;
  std::int64_t last_tick_us_ = -1;  // [us]

  Latest<Inputs> inputs_;
  Latest<ToolStates> tools_;
  Queue<DeviceSample> samples_;
  Latest<HapticReport> report_slot_;
  std::atomic<bool> stop_asked_{false};
  std::thread thread_;
};

/// [us], the steady clock that start() takes its epoch from.
std::int64_t steady_now_us() noexcept;

}  // namespace filum
