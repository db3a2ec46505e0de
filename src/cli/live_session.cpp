#include "cli/live_session.h"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

#include "training/result_json.h"

namespace filum {
namespace {

HapticOptions haptic_options(const MotionScale& scale) {
  HapticOptions options;
  options.scale = scale;
  return options;
}

constexpr std::size_t kQueue = 64;              // observations between world and scoring
constexpr std::uint64_t kStepsAfterDone = 250;  // more than kQueue, so that the last step does not depend on the threads' luck
constexpr std::uint64_t kStepsAfterScript = 40;  // shorter than it takes for a silent device to count as lost
constexpr std::uint64_t kArrayHashEvery = 250;  // steps
constexpr std::uint64_t kMostUnstored = 2048;   // steps, half of what the recorder holds while the disk stalls
constexpr std::int64_t kShowEvery = 16'667;     // [us]
constexpr std::int64_t kTick = 1000;            // [us]

void sleep_until(std::int64_t steady_us) noexcept {
  const timespec due{static_cast<time_t>(steady_us / 1'000'000), static_cast<long>(steady_us % 1'000'000) * 1000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {}
}

/// A run that is not paced would outrun a busy disk: it waits, unless the recorder is in trouble and stores no more.
void wait_for_disk(const Recorder& recorder, std::uint64_t step) {
  for (RecorderStatus now = recorder.status(); now.healthy && step > now.steps_stored + kMostUnstored; now = recorder.status())
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

void pause_briefly() { std::this_thread::sleep_for(std::chrono::microseconds(500)); }

SampleRecord sample_record(const DeviceSample& s) {
  return {s.tool,           s.host_time_us,   s.device_time_us, s.sequence,   s.has_pose,  s.has_grip_angle,
          s.has_grip_force, s.X_WD,           s.grip_angle,     s.grip_force, s.raw_angle, s.raw_force,
          s.buttons};
}

std::vector<std::string> names_of(const std::vector<std::unique_ptr<Device>>& devices) {
  std::vector<std::string> names;
  for (const auto& device : devices) names.push_back(device->name());
  return names;
}

}  // namespace

LiveSession::LiveSession(Setup setup, InputDevices inputs, LiveOptions options)
    : setup_(std::move(setup)),
      options_(std::move(options)),
      scripted_(inputs.scripted),
      pointer_(inputs.pointer),
      device_names_(names_of(inputs.devices)),
      world_(setup_.model),
      eyes_(world_.observation(), world_.description()),
      hands_(std::make_unique<HapticLoop>(std::move(inputs.devices), haptic_options(inputs.scale))),
      task_(setup_.task, world_.description()),
      pacing_(world_.description().dt),
      observations_(kQueue, world_.observation()),
      handed_(world_.observation()),
      scored_(world_.observation()) {
  if (inputs.demonstrator != nullptr) inputs.demonstrator->look_through(&eyes_);
}

LiveSession::~LiveSession() {
  stop_.store(true);
  if (world_thread_.joinable()) world_thread_.join();
  if (scoring_thread_.joinable()) scoring_thread_.join();
}

void LiveSession::start() {
  epoch_us_ = steady_now_us();
  if (!scripted_) hands_->start(epoch_us_);
  scoring_thread_ = std::thread([this] {
    try {
      run_scoring();
    } catch (...) {
      failure_ = std::current_exception();
      stop_.store(true);
    }
    over_.store(true);
  });
  world_thread_ = std::thread([this] { run_world(); });
}

// ---- world's thread

void LiveSession::run_world() noexcept {
  while (!stop_.load(std::memory_order_relaxed) && !at_the_end()) step_once();
  end_us_ = steady_now_us();
  hands_->stop();
  world_over_.store(true);
}

bool LiveSession::at_the_end() const noexcept {
  const std::uint64_t step = world_.observation().step;
  const std::uint64_t end = end_step_.load();
  if (end > 0 && step >= end) return true;
  if (script_end_step_ > 0 && step >= script_end_step_) return true;
  return world_.observation().time >= options_.longest;
}

Inputs LiveSession::next_inputs(std::int64_t scene_us) noexcept {
  if (!scripted_) return hands_->inputs().read();
  for (; next_tick_us_ <= scene_us; next_tick_us_ += kTick) hands_->tick(next_tick_us_);
  bool over = script_end_step_ == 0;
  for (std::size_t i = 0; i < hands_->n_devices(); ++i) over = over && hands_->device(i).health().state == DeviceState::finished;
  if (over) script_end_step_ = world_.observation().step + kStepsAfterScript;
  return hands_->inputs().read();
}

void LiveSession::step_once() {
  const double dt = world_.description().dt;
  if (options_.paced) sleep_until(pacing_.due(steady_now_us()));
  const Observation& before = world_.observation();
  const Inputs inputs = next_inputs(static_cast<std::int64_t>((before.time + 0.5 * dt) * 1e6));
  const std::int64_t begin_us = steady_now_us();
  world_.step(inputs);
  const std::int64_t end_us = steady_now_us();
  const bool late = pacing_.ended(begin_us, end_us);
  hands_->tool_states().write_slot() = tool_states_of(world_.observation(), scripted_ ? next_tick_us_ : end_us - epoch_us_);
  hands_->tool_states().publish();
  record_step(inputs, begin_us, end_us);
  hand_over(late && options_.paced, end_us - begin_us);
}

void LiveSession::record_step(const Inputs& inputs, std::int64_t begin_us, std::int64_t end_us) {
  if (options_.recorder == nullptr) return;
  const Observation& o = world_.observation();
  options_.recorder->record_step({o.step, begin_us - epoch_us_, static_cast<std::uint32_t>(end_us - begin_us), o.state_hash, inputs});
  if (o.step % kArrayHashEvery != 0) return;
  if (!options_.paced) wait_for_disk(*options_.recorder, o.step);
  for (const auto& [name, hash] : world_.array_hashes()) options_.recorder->record_array_hash({o.step, std::string_view(name), hash});
}

void LiveSession::hand_over(bool late, std::int64_t took_us) noexcept {
  handed_ = world_.observation();
  handed_.overruns = pacing_.overruns();
  handed_.real_time_factor = pacing_.real_time_factor();
  if (late && handed_.n_events < static_cast<int>(handed_.events.size())) {
    handed_.events[static_cast<std::size_t>(handed_.n_events++)] = {"overrun", -1, 1e-6 * static_cast<double>(took_us), "s"};
  }
  while (!observations_.push(handed_) && !over_.load()) pause_briefly();
}

// ---- scoring thread

void LiveSession::run_scoring() {
  for (;;) {
    const bool last = world_over_.load();  // read before the queue: what was pushed before is then seen
    bool any = false;
    while (observations_.pop(scored_)) {
      any = true;
      score(scored_);
    }
    store_samples();
    show(scored_);
    if (last && !any) break;
    if (!any) pause_briefly();
  }
}

void LiveSession::score(const Observation& observation) {
  task_.observe(observation);
  store_events();
  if (task_.done() && end_step_.load() == 0) end_step_.store(observation.step + kStepsAfterDone);
}

void LiveSession::store_events() {
  const auto& events = task_.events();
  for (; events_stored_ < events.size(); ++events_stored_) store_event(events[events_stored_]);
}

void LiveSession::store_event(const TaskEvent& e) {
  if (options_.recorder != nullptr) options_.recorder->record_event({scored_.step, e.time, e.name, e.tool, e.value, e.unit, std::string_view(e.text)});
  if (options_.show_event) options_.show_event(e);
}

void LiveSession::store_samples() {
  DeviceSample sample;
  while (hands_->samples().pop(sample)) {
    if (options_.recorder != nullptr) options_.recorder->record_sample(sample_record(sample));
    handles_.take(sample, scored_.time);
  }
  for (; handle_events_stored_ < handles_.events().size(); ++handle_events_stored_) store_event(handles_.events()[handle_events_stored_]);
}

void LiveSession::show(const Observation& observation) {
  const std::int64_t now = steady_now_us();
  if (!options_.show || now < next_show_us_) return;
  next_show_us_ = now + kShowEvery;
  const TaskStatus status = task_.status();
  options_.show({observation, status, hands_->report().read(), device_names_, handles_.warnings(observation.time)});
}

/// Among the task's events, where they belong in time.
Result LiveSession::with_handle_events(Result result) const {
  for (const TaskEvent& e : handles_.events()) {
    const auto after = std::upper_bound(result.events.begin(), result.events.end(), e.time, [](double time, const TaskEvent& other) { return time < other.time; });
    result.events.insert(after, e);
  }
  return result;
}

// ---- the caller's thread

LiveOutcome LiveSession::end() {
  world_thread_.join();
  scoring_thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  pointer_ = nullptr;
  for (std::size_t i = 0; i < hands_->n_devices(); ++i) outcome_.devices.push_back({device_names_[i], hands_->device(i).health()});
  hands_.reset();
  outcome_.result = with_handle_events(task_.finish());
  const Observation& o = world_.observation();
  outcome_.steps = o.step;
  outcome_.scene_seconds = o.time;
  outcome_.wall_seconds = 1e-6 * static_cast<double>(end_us_ - epoch_us_);
  outcome_.real_time_factor = outcome_.wall_seconds > 0.0 ? o.time / outcome_.wall_seconds : 0.0;
  outcome_.overruns = pacing_.overruns();
  outcome_.state_hash = o.state_hash;
  return outcome_;
}

Result LiveSession::settle(const std::function<bool(double)>& go_on) {
  const Result r = with_handle_events(finish_with_security(task_, world_, go_on));
  if (options_.recorder != nullptr) {
    options_.recorder->set_score({r.passed, r.total, r.seconds, result_json(r)});
    options_.recorder->close();
  }
  return r;
}

LiveOutcome LiveSession::wait() {
  LiveOutcome outcome = end();
  outcome.result = settle();
  return outcome;
}

}  // namespace filum
