#pragma once
// One session from the first step to the result, live or headless: the same code on the same inputs. Threads by role:
//   hands    1 kHz: devices, coupling (HapticLoop; only with real devices, scripts are polled at scene time by the world's)
//   world    500 Hz: World::step, paced by the steady clock or unpaced
//   scoring  watches every observation in order, keeps samples and events, shows 60 pictures a second
// The recorder and the server have their own. If scoring falls behind, the world waits: nothing goes unscored.

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/exchange.h"
#include "cli/handle_watch.h"
#include "cli/inputs.h"
#include "cli/pacing.h"
#include "cli/security.h"
#include "cli/setup.h"
#include "haptics/haptic_loop.h"
#include "haptics/scene_eyes.h"
#include "session/recorder.h"
#include "training/task_session.h"

namespace filum {

/// What is shown of a session while it runs; valid during the call.
struct LiveView {
  const Observation& observation;
  const TaskStatus& status;
  const HapticReport& hands;
  const std::vector<std::string>& device_names;
  const std::vector<TaskWarning>& handle_warnings;  // what the handles say of their own readings
};

struct LiveOptions {
  bool paced = true;               // keep to the steady clock
  double longest = 3600.0;         // [s], scene time after which the session ends
  Recorder* recorder = nullptr;    // may be absent
  std::function<void(const LiveView&)> show;         // 60 times a second
  std::function<void(const TaskEvent&)> show_event;  // as they happen
};

/// A device and what it said of its health at the session's end.
struct DeviceOutcome {
  std::string name;
  DeviceHealth health;
};

struct LiveOutcome {
  Result result;
  std::uint64_t steps = 0;
  double scene_seconds = 0.0;      // [s]
  double wall_seconds = 0.0;       // [s]
  double real_time_factor = 0.0;   // of the whole session
  std::uint64_t overruns = 0;      // steps that took longer than dt
  std::uint64_t state_hash = 0;
  std::vector<DeviceOutcome> devices;
};

class LiveSession {
 public:
  LiveSession(Setup setup, InputDevices inputs, LiveOptions options);
  ~LiveSession();

  void start();
  /// The session ends after the step under way.
  void request_stop() noexcept { stop_.store(true); }
  /// True once all steps are done and scored.
  bool over() const noexcept { return over_.load(); }
  /// Waits for the end and lets the devices go. The result is without the pull test of its knot, which takes some seconds.
  LiveOutcome end();
  bool knot_to_pull() const { return has_knot_to_pull(task_, world_, outcome_.result); }
  /// After end(): pulls the knot, if there is one (see finish_with_security), stores the score and closes the recording.
  Result settle(const std::function<bool(double)>& go_on = {});
  /// Both.
  LiveOutcome wait();

  const SceneDescription& scene() const { return world_.description(); }
  /// May only be pushed to by one thread, while this object lives; null if no pointer takes part.
  PointerDevice* pointer() const { return pointer_; }

 private:
  void run_world() noexcept;
  void run_scoring();
  Inputs next_inputs(std::int64_t scene_us) noexcept;
  void step_once();
  void record_step(const Inputs& inputs, std::int64_t begin_us, std::int64_t end_us);
  void hand_over(bool late, std::int64_t took_us) noexcept;
  bool at_the_end() const noexcept;
  void score(const Observation& observation);
  void store_events();
  void store_event(const TaskEvent& event);
  Result with_handle_events(Result result) const;
  void store_samples();
  void show(const Observation& observation);

  Setup setup_;
  LiveOptions options_;
  bool scripted_;
  PointerDevice* pointer_;
  std::vector<std::string> device_names_;
  World world_;
  SceneEyes eyes_;                           // of a demonstrator, read by the world's thread alone
  std::unique_ptr<HapticLoop> hands_;        // until the end
  TaskSession task_;
  Pacing pacing_;
  Queue<Observation> observations_;
  Observation handed_;                       // of the world's thread
  Observation scored_;                       // of the scoring thread
  std::int64_t next_tick_us_ = 0;            // [us], scene time at which scripts are polled next
  std::int64_t epoch_us_ = 0;                // [us], steady clock at the start
  std::int64_t end_us_ = 0;                  // [us], steady clock at the end
  std::uint64_t script_end_step_ = 0;        // 0: scripts still play
  HandleWatch handles_;                      // of the scoring thread, until the end
  std::size_t events_stored_ = 0, handle_events_stored_ = 0;
  std::int64_t next_show_us_ = 0;
  std::atomic<bool> stop_{false}, world_over_{false}, over_{false};
  std::atomic<std::uint64_t> end_step_{0};   // 0: not known yet
  std::exception_ptr failure_;               // of the scoring thread
  LiveOutcome outcome_;                      // once ended
  std::thread world_thread_, scoring_thread_;
};

}  // namespace filum
