#include "haptics/haptic_loop.h"

#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <utility>

namespace filum {
namespace {

/// A tick takes microseconds and the thread sleeps after each, so nothing else starves.
bool run_before_others() noexcept {
  sched_param priority{};
  priority.sched_priority = 20;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0;
}

constexpr std::uint64_t kStatsEvery = 128;  // ticks between two looks at the histogram

}  // namespace

std::int64_t steady_now_us() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

ToolStates tool_states_of(const Observation& observation, std::int64_t now_us) noexcept {
  ToolStates states;
  states.time_us = now_us;
  for (std::size_t i = 0; i < states.tools.size() && static_cast<int>(i) < observation.n_tools; ++i) {
    const ToolObservation& tool = observation.tools[i];
    states.tools[i] = {tool.X_WT.p, tool.v_W, tool.f_T_W, true};
  }
  for (std::size_t i = 0; i < observation.brain.blades.size() && static_cast<int>(i) < observation.brain.n_blades; ++i) {
    const BladeObservation& blade = observation.brain.blades[i];
    states.tools[i].blade = true;
    states.tools[i].p_WT = observation.tools[i].X_WD.p;
    states.tools[i].parked = blade.parked;
    states.tools[i].torque_W = blade.torque_W;
    states.tools[i].stiffness_W = blade.stiffness_W;
  }
  return states;
}

HapticLoop::HapticLoop(std::vector<std::unique_ptr<Device>> devices, const HapticOptions& options)
    : options_(options),
      devices_(std::move(devices)),
      merge_(options.scale),
      couplings_{HandCoupling(options.coupling), HandCoupling(options.coupling),
                 HandCoupling(options.coupling)},
      samples_(options.sample_queue) {
  if (devices_.size() > InputMerge::kMaxSources)
    throw std::invalid_argument("more devices than the loop can poll");
  polled_.reserve(kMaxSamplesPerPoll);
  now_.n_devices = static_cast<int>(devices_.size());
}

HapticLoop::~HapticLoop() {
  stop();
}

void HapticLoop::tick(std::int64_t now_us) noexcept {
  if (last_tick_us_ >= 0) periods_.add(now_us - last_tick_us_);
  poll_devices(now_us);
  Inputs& inputs = inputs_.write_slot();
  inputs = merge_.inputs(now_us);
  render(inputs, now_us);
  inputs_.publish();
  last_tick_us_ = now_us;
  publish(now_us);
}

void HapticLoop::poll_devices(std::int64_t now_us) noexcept {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    Device& device = *devices_[i];
    const int source = static_cast<int>(i);
    polled_.clear();
    device.poll(now_us, polled_);
    for (const DeviceSample& sample : polled_) {
      merge_.take(sample, source, device.stale_after_us());
      if (!samples_.push(sample)) ++now_.samples_dropped;
    }
    now_.devices[i] = device.health();
    if (now_.devices[i].state == DeviceState::lost) merge_.drop(source);
  }
}

void HapticLoop::render(const Inputs& inputs, std::int64_t now_us) noexcept {
  const ToolStates& states = tools_.read();
  const bool world_live = states.time_us >= 0 && now_us - states.time_us <= options_.world_silent_us;
  const double dt = last_tick_us_ < 0 || now_us <= last_tick_us_
                        ? 1e-6 * static_cast<double>(options_.period_us)
                        : 1e-6 * static_cast<double>(now_us - last_tick_us_);
  for (std::size_t i = 0; i < couplings_.size(); ++i) {
    const ToolInput& input = inputs.tools[i];
    const ToolStates::Tool& tool = states.tools[i];
    const bool clutched = (input.buttons & 1u) != 0;
    now_.valid[i] = input.valid;
    now_.scene_force[i] = world_live && tool.present ? tool.f_T_W : Vec3(Vec3::Zero());
    now_.scene_torque[i] = world_live && tool.present ? tool.torque_W : Vec3(Vec3::Zero());
    if (!input.valid || clutched || !world_live || !tool.present || tool.parked) {
      couplings_[i].release();
      contacts_[i].release();
      blades_[i].release();
      now_.hand_force[i].setZero();
      continue;
    }
    now_.hand_force[i] = options_.scale.factor * felt(i, input, now_us, dt, states);
  }
  seen_states_us_ = states.time_us;
  HandForces forces;
  forces.force = now_.hand_force;
  forces.torque = now_.scene_torque;
  forces.valid = now_.valid;
  for (const auto& device : devices_) device->render(now_us, forces);
}

/// The world runs at half this rate or less: between its states a local model of what the tool touches goes on.
Vec3 HapticLoop::felt(std::size_t i, const ToolInput& input, std::int64_t now_us, double dt, const ToolStates& states) noexcept {
  const ToolStates::Tool& tool = states.tools[i];
  const Vec3& hand = input.X_WD.p;
  if (tool.blade) {
    if (states.time_us != seen_states_us_ || !blades_[i].known()) blades_[i].update(tool.p_WT, tool.f_T_W, tool.stiffness_W, hand, states.time_us);
    return couplings_[i].pass(blades_[i].force(hand, now_us), hand, dt);
  }
  if (states.time_us != seen_states_us_ || !contacts_[i].known()) contacts_[i].update(tool.p_WT, tool.v_W, tool.f_T_W, hand, states.time_us);
  return couplings_[i].force(hand, contacts_[i].tip(hand, now_us), tool.v_W, dt);
}

void HapticLoop::publish(std::int64_t now_us) noexcept {
  now_.time_us = now_us;
  if (now_.ticks++ % kStatsEvery == 0) {
    now_.period_p50_us = periods_.quantile(0.50);
    now_.period_p99_us = periods_.quantile(0.99);
  }
  now_.period_max_us = periods_.longest_us();
  report_slot_.write_slot() = now_;
  report_slot_.publish();
}

void HapticLoop::start(std::int64_t epoch_us) {
  stop();
  stop_asked_.store(false);
  thread_ = std::thread([this, epoch = epoch_us < 0 ? steady_now_us() : epoch_us] { run(epoch); });
}

void HapticLoop::stop() noexcept {
  stop_asked_.store(true);
  if (thread_.joinable()) thread_.join();
}

void HapticLoop::run(std::int64_t epoch_us) noexcept {
  now_.real_time = options_.real_time && run_before_others();
  std::int64_t next = steady_now_us();
  while (!stop_asked_.load(std::memory_order_relaxed)) {
    const timespec due{static_cast<time_t>(next / 1'000'000), static_cast<long>(next % 1'000'000) * 1000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
    }
    const std::int64_t now = steady_now_us();
    tick(now - epoch_us);
    const std::int64_t late = (now - next) / options_.period_us;
    now_.missed += static_cast<std::uint64_t>(late);
    next += (late + 1) * options_.period_us;
  }
}

}  // namespace filum
