#include "analysis/recorded_series.h"

#include <algorithm>
#include <string_view>

namespace filum {
namespace {

constexpr std::uint32_t kForceSaturated = 0x200;  // bit of SampleRecord::buttons, as devices/sample_faults.h sets it
constexpr std::uint32_t kForeignCalibration = 0x1000;
constexpr double kSilence = 0.5;  // [s], in which a handle may have been plugged in again
constexpr double kMissing = 0.1;  // [s], by which its clock then falls short; readings arrive later than others by less

/// Scene time of a host time: scripts and replays stamp their samples with the scene's own time, hands with the host's.
class SceneClock {
 public:
  explicit SceneClock(const RecordingMeta& meta) : scripted_(!meta.input.starts_with("serial") && !by_hand(meta.input)) {}
  void step(const StepRecord& record, double dt) {
    host_.push_back(1e-6 * static_cast<double>(record.host_time_us));
    scene_.push_back(static_cast<double>(record.step) * dt);
  }
  double operator()(std::int64_t host_us) const {
    const double host = 1e-6 * static_cast<double>(host_us);
    if (scripted_ || host_.empty()) return host;
    const auto at = std::upper_bound(host_.begin(), host_.end(), host);
    if (at == host_.begin()) return scene_.front() - (host_.front() - host);
    const auto k = static_cast<std::size_t>(at - host_.begin()) - 1;
    const double later = scene_[k] + (host - host_[k]);
    return k + 1 < scene_.size() ? std::min(later, scene_[k + 1]) : later;  // steps that come late do not send the scene back
  }

 private:
  static bool by_hand(const std::string& input) {
    for (const char* word : {"pointer", "haptic", "OpenIGTLink"})
      if (input.find(word) != std::string::npos) return true;
    return false;
  }
  bool scripted_;
  std::vector<double> host_, scene_;  // [s]
};

/// Device time of the next reading of a series, less what the series' clock is ahead of the device's. After a silence the
/// latter may have begun anew: it then goes on by the scene's, so that the silence is a gap and nothing is mixed.
template <class Series>
double going_on(Series& series, double clock, double scene) {
  clock += series.ahead;
  if (series.clock.empty()) return clock;
  const double silent = scene - series.scene.back(), missing = silent - (clock - series.clock.back());
  if (silent < kSilence || missing < kMissing) return clock;
  series.ahead += missing;
  return clock + missing;
}

void add_point(TimedPath& path, std::vector<double>& flat, double clock, double scene, const Vec3& p) {
  clock = going_on(path, clock, scene);
  if (!path.clock.empty() && clock <= path.clock.back()) return;  // a clock that restarted: what follows at once is lost, not mixed
  path.clock.push_back(clock);
  path.scene.push_back(scene);
  flat.insert(flat.end(), {p.x(), p.y(), p.z()});
}

void add_force(TimedForce& grip, const SampleRecord& s, double clock, double scene) {
  clock = going_on(grip, clock, scene);
  if (!grip.clock.empty() && clock <= grip.clock.back()) return;
  grip.source = "device";
  grip.clock.push_back(clock);
  grip.scene.push_back(scene);
  grip.force.push_back(s.grip_force);
  grip.foreign = grip.foreign || (s.buttons & kForeignCalibration) != 0;
  grip.saturated += (s.buttons & kForceSaturated) != 0 ? 1 : 0;
}

Points points_of(const std::vector<double>& flat) {
  return Eigen::Map<const Points>(flat.data(), 3, static_cast<Eigen::Index>(flat.size() / 3));
}

void read_samples(const RecordingReader& recording, const SceneClock& scene, std::array<ToolSeries, 3>& tools) {
  std::array<std::vector<double>, 3> flat;
  SampleRecord s;
  for (auto cursor = recording.samples(); cursor.next(s);) {
    if (s.tool < 0 || s.tool > 2) continue;
    const auto i = static_cast<std::size_t>(s.tool);
    const double clock = 1e-6 * static_cast<double>(s.device_time_us), at = scene(s.host_time_us);
    if (s.has_pose && s.X_WD.finite()) add_point(tools[i].hand, flat[i], clock, at, s.X_WD.p);
    if (s.has_grip_force) add_force(tools[i].grip, s, clock, at);
  }
  for (std::size_t i = 0; i < 3; ++i) tools[i].hand.p = points_of(flat[i]);
}

void read_steps(const RecordingReader& recording, SceneClock& scene, std::array<ToolSeries, 3>& tools, double& seconds) {
  const RecordingMeta& meta = recording.meta();
  std::array<std::vector<double>, 3> flat;
  StepRecord record;
  for (auto cursor = recording.steps(); cursor.next(record);) {
    scene.step(record, meta.dt);
    seconds = static_cast<double>(record.step) * meta.dt;
    for (std::size_t i = 0; i < static_cast<std::size_t>(meta.n_tools); ++i) {
      const ToolInput& in = record.inputs.tools[i];
      if (in.valid) add_point(tools[i].scene, flat[i], seconds, seconds, in.X_WD.p);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) tools[i].scene.p = points_of(flat[i]);
}

void read_event(const EventRecord& e, ToolSeries& tool) {
  const std::string_view name = e.name.view();
  if (name == "hold-begun") {
    tool.holds.push_back({"hold " + std::to_string(static_cast<int>(e.value)), e.time, -1.0});
  } else if (name == "hold-done" && !tool.holds.empty()) {
    tool.holds.back().to = e.time;
  } else if (name == "object-taken") {
    tool.held.push_back({e.time, 1e300, e.value, false});
  } else if ((name == "object-released" || name == "object-slipped" || name == "object-broken") && !tool.held.empty()) {
    tool.held.back().to = e.time;
    tool.held.back().slipped = name == "object-slipped";
  } else if (name == "target-error") {
    tool.target_error.push_back({e.time, e.value});
  }
}

}  // namespace

double TimedForce::scene_time(double at) const {
  const auto next = std::upper_bound(clock.begin(), clock.end(), at);
  if (next == clock.begin()) return scene.front();
  const auto k = static_cast<std::size_t>(next - clock.begin()) - 1;
  if (k + 1 == clock.size()) return scene[k];
  return scene[k] + (scene[k + 1] - scene[k]) * (at - clock[k]) / (clock[k + 1] - clock[k]);
}

TimedPath TimedPath::cut(double from, double to) const {
  TimedPath part;
  const auto first = std::lower_bound(scene.begin(), scene.end(), from) - scene.begin();
  const auto last = std::upper_bound(scene.begin(), scene.end(), to) - scene.begin();
  if (last <= first) return part;
  part.clock.assign(clock.begin() + first, clock.begin() + last);
  part.scene.assign(scene.begin() + first, scene.begin() + last);
  part.p = p.middleCols(first, last - first);
  return part;
}

RecordedSession read_session(const RecordingReader& recording) {
  RecordedSession session;
  session.file = recording.file();
  session.meta = recording.meta();
  std::array<ToolSeries, 3> tools;
  SceneClock scene(session.meta);
  read_steps(recording, scene, tools, session.seconds);
  read_samples(recording, scene, tools);
  EventRecord event;
  for (auto cursor = recording.events(); cursor.next(event);)
    if (event.tool >= 0 && event.tool < 3) read_event(event, tools[static_cast<std::size_t>(event.tool)]);
  for (int i = 0; i < 3; ++i) {
    ToolSeries& tool = tools[static_cast<std::size_t>(i)];
    tool.tool = i;
    std::erase_if(tool.holds, [](const Window& w) { return w.to <= w.from; });  // begun but not done
    if (tool.hand.clock.size() > 2 || tool.scene.clock.size() > 2) session.tools.push_back(std::move(tool));
  }
  return session;
}

}  // namespace filum
