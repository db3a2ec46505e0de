// From a pulse at the simulated converter's input to the event it causes in the simulated scene, in simulated time: the
// firmware, the line at 500 kbit/s, the driver polled at 1 kHz, the world stepped at 500 Hz. Not in it: the filter in front
// of the converter (1.5 ms to 63 % of a step), a USB-serial chip (1 ms with its latency timer at 1) and a busy machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>

#include "devices/serial_forceps.h"
#include "haptics/haptic_loop.h"
#include "tests/devices/pty.h"
#include "tests/firmware/avr_board.h"
#include "world/model.h"
#include "world/world.h"

namespace filum {
namespace latency_test {

/// A hand that stays where it is.
class StillHand final : public Device {
 public:
  explicit StillHand(const Pose& X_WD) : X_WD_(X_WD) {}
  const std::string& name() const override { return name_; }
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override {
    DeviceSample sample;
    sample.host_time_us = sample.device_time_us = now_us;
    sample.has_pose = true;
    sample.X_WD = X_WD_;
    out.push_back(sample);
  }
  DeviceHealth health() const noexcept override { return {DeviceState::live, 1, 0, 0, 0}; }

 private:
  std::string name_ = "still hand";
  Pose X_WD_;
};

ForcepsCalibration calibration() {
  ForcepsCalibration c;
  c.angle_zero = 0.0;
  c.angle_gain = 2e-5;  // half range: 0.04 rad, less than the object's 0.067
  c.force_zero = 1000.0;
  c.force_gain = 1e-4;
  c.angle_limit = 1.0;
  c.force_limit = 10.0;
  return c;
}

TEST(Latency, FromThePulseAtTheConverterToTheEventInTheWorld) {
  const auto model = load_model(FILUM_SOURCE_DIR, "grasp-transfer");
  World world(model);
  AvrBoard board(FILUM_FIRMWARE_ELF);
  Pty pty;
  Pose X = model->instrument_start[0];
  X.p = Vec3(4e-3, -4e-3, -2.6e-3);  // the firm object
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::make_unique<SerialForceps>(pty.path(), calibration()));
  devices.push_back(std::make_unique<StillHand>(X));
  HapticLoop hands(std::move(devices));
  board.set_voltage(0, 2500);
  std::vector<double> latencies;  // [ms]
  std::int64_t pulse_at = -1, now = 0;
  bool pressed = false;
  const auto millisecond = [&](int pulse_in_us) {
    if (pulse_in_us >= 0) {
      board.run_us(pulse_in_us);
      pulse_at = board.time_us();
      pressed = !pressed;
      board.set_voltage(1, pressed ? 2500 : 600);
    }
    board.run_us(1000 - std::max(0, pulse_in_us));
    now = board.time_us();
    pty.write(board.take_sent());
    hands.tick(now);
    DeviceSample unused;
    while (hands.samples().pop(unused)) {}
    if ((now / 1000) % 2 != 0) return;
    world.step(hands.inputs().read());
    for (int e = 0; e < world.observation().n_events; ++e) {
      const std::string name = world.observation().events[static_cast<std::size_t>(e)].name;
      if (pulse_at < 0 || name != (pressed ? "object-taken" : "object-released")) continue;
      latencies.push_back(1e-3 * static_cast<double>(now - pulse_at));
      pulse_at = -1;
    }
  };
  board.set_voltage(1, 600);
  for (int k = 0; k < 500; ++k) millisecond(-1);  // the jaws come to rest on the object
  for (int pulse = 0; pulse < 100; ++pulse) {
    millisecond((pulse * 377) % 1000);
    for (int k = 0; k < 30 + pulse % 2; ++k) millisecond(-1);
  }
  ASSERT_GT(latencies.size(), 95u);
  std::sort(latencies.begin(), latencies.end());
  const double median = latencies[latencies.size() / 2];
  std::printf("pulse to event, %zu pulses: median %.2f ms, 5 %% %.2f, 95 %% %.2f, longest %.2f ms\n", latencies.size(), median,
              latencies[latencies.size() / 20], latencies[latencies.size() * 19 / 20], latencies.back());
  EXPECT_LE(median, 5.0);
}

}  // namespace latency_test
}  // namespace filum
