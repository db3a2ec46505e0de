// The real firmware under simavr, voltages in, bytes out through a pty, read by the trainer's own serial driver.
// FILUM_FIRMWARE_SECONDS sets how long the long run is in simulated time (10 s unless said otherwise).
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <random>
#include <thread>

#include "devices/sample_faults.h"
#include "devices/serial_forceps.h"
#include "tests/devices/pty.h"
#include "tests/firmware/avr_board.h"

namespace filum {
namespace forceps_firmware_test {

ForcepsCalibration calibration() {
  ForcepsCalibration c;
  c.angle_zero = 0.0;
  c.angle_gain = 1e-4;
  c.force_zero = 0.0;
  c.force_gain = 1e-3;
  c.angle_limit = 1.0;
  c.force_limit = 10.0;
  return c;
}

/// [count], what four conversions of a voltage add up to.
int counts(int millivolt) { return 4 * (millivolt * 1024 / 5000); }

/// Board, line and driver with one clock: the simulated one.
class Bench {
 public:
  explicit Bench(const std::string& link = {})
      : board_(FILUM_FIRMWARE_ELF), pty_(link.empty() ? std::make_unique<Pty>() : std::make_unique<Pty>(link)),
        driver_(pty_->path(), calibration()) {}

  /// One millisecond: the board runs, its bytes go down the line (through `damage` if there is one), the driver polls.
  template <class Damage>
  void step(Damage&& damage, std::int64_t us = 1000) {
    board_.run_us(us);
    std::vector<std::uint8_t> bytes = board_.take_sent();
    damage(bytes);
    sent_bytes_ += bytes.size();
    if (plugged_ && !bytes.empty()) pty_->write(bytes);
    driver_.poll(board_.time_us(), samples_);
    std::uint8_t back[256];
    const ssize_t n = plugged_ ? pty_->read(back) : 0;
    if (n > 0) board_.receive(std::span(back, static_cast<std::size_t>(n)));
  }
  void step() {
    step([](std::vector<std::uint8_t>&) {});
  }
  void run(int ms) {
    for (int k = 0; k < ms; ++k) step();
  }
  void unplug() {
    pty_->unplug();
    plugged_ = false;
  }
  void plug() {
    pty_->plug();
    plugged_ = true;
  }

  AvrBoard board_;
  std::unique_ptr<Pty> pty_;
  SerialForceps driver_;
  std::vector<DeviceSample> samples_;
  std::size_t sent_bytes_ = 0;
  bool plugged_ = true;
};

int long_run_seconds() {
  const char* text = std::getenv("FILUM_FIRMWARE_SECONDS");
  return text ? std::max(1, std::atoi(text)) : 10;
}

TEST(ForcepsFirmware, EverySampleArrivesOnceWithItsCountsAndItsTime) {
  Bench bench;
  const int seconds = long_run_seconds();
  std::int64_t last_time = -1;
  std::uint64_t received = 0;
  std::size_t bytes = 0;
  for (int ms = 0; ms < seconds * 1000; ++ms) {
    // A triangle on each channel, slow beside the conversions of one sample.
    const int up = ms % 4000 < 2000 ? ms % 2000 : 2000 - ms % 2000;
    bench.board_.set_voltage(0, 600 + 2 * up);
    bench.board_.set_voltage(1, 4500 - 2 * up);
    bench.step();
    for (const DeviceSample& s : bench.samples_) {
      if (last_time >= 0) {
        ASSERT_EQ(s.device_time_us - last_time, 1000) << "a sample is missing or doubled at " << ms << " ms";
      }
      last_time = s.device_time_us;
      ASSERT_NEAR(s.raw_angle, counts(600 + 2 * up), 12) << ms;
      ASSERT_NEAR(s.raw_force, counts(4500 - 2 * up), 12) << ms;
      ++received;
    }
    bench.samples_.clear();
  }
  const DeviceHealth health = bench.driver_.health();
  EXPECT_EQ(health.state, DeviceState::live);
  EXPECT_EQ(health.lost, 0u);
  EXPECT_EQ(health.corrupt, 0u);
  EXPECT_EQ(health.rejected, 0u);
  EXPECT_NEAR(static_cast<double>(received), seconds * 1000.0, 3.0);
  ASSERT_TRUE(bench.driver_.stream().status().has_value());
  EXPECT_EQ(bench.driver_.stream().status()->not_sent, 0);
  EXPECT_EQ(bench.driver_.stream().status()->late, 0);
  bytes = bench.sent_bytes_;
  std::printf("%d s simulated: %llu samples, %.1f kB/s of 50, least room in the send buffer %d bytes\n", seconds,
              static_cast<unsigned long long>(received), 1e-3 * static_cast<double>(bytes) / seconds,
              bench.driver_.stream().status()->room);
}

TEST(ForcepsFirmware, HelloSaysWhatItIs) {
  Bench bench;
  bench.run(50);
  ASSERT_TRUE(bench.driver_.stream().hello().has_value());
  const filum_hello& hello = *bench.driver_.stream().hello();
  EXPECT_EQ(hello.firmware[0], 1);
  EXPECT_EQ(hello.channels, 3);
  EXPECT_EQ(hello.angle_max, 4092);
  EXPECT_EQ(hello.rate_hz, 1000);
  EXPECT_EQ(hello.calibration, 0u) << "never written";
}

TEST(ForcepsFirmware, IdentityAndCalibrationComeFromItsEeprom) {
  Bench bench;
  const std::uint8_t stored[] = {7, 0, 42, 0, 0, 0};  // device 7, calibration 42
  bench.board_.write_eeprom(0, stored);
  bench.run(50);
  ASSERT_TRUE(bench.driver_.stream().hello().has_value());
  EXPECT_EQ(bench.driver_.stream().hello()->calibration, 42u);
  EXPECT_TRUE(bench.driver_.stream().calibration_differs()) << "the file in use is for no handle in particular";
}

TEST(ForcepsFirmware, SaturationBrokenWiresAndSwitches) {
  Bench bench;
  for (int channel = 0; channel < 2; ++channel) bench.board_.set_voltage(channel, 2500);
  bench.board_.set_voltage(2, 1250);
  bench.run(150);
  EXPECT_TRUE(bench.samples_.back().has_grip_angle);
  EXPECT_NEAR(bench.driver_.stream().status()->temperature, counts(1250), 4);
  EXPECT_EQ(bench.samples_.back().buttons, 0u);
  bench.board_.set_voltage(0, 4850);  // 97 % of the range: no rail, but the end of the amplifier
  bench.run(60);
  EXPECT_EQ(bench.samples_.back().buttons, kAngleSaturated);
  EXPECT_TRUE(bench.samples_.back().has_grip_angle);
  bench.board_.set_voltage(0, 0);  // the resistor draws an open input to ground
  bench.run(15);
  EXPECT_TRUE(bench.samples_.back().has_grip_angle) << "a short touch of the rail is no broken wire";
  bench.run(15);
  EXPECT_FALSE(bench.samples_.back().has_grip_angle);
  EXPECT_EQ(bench.samples_.back().buttons, kAngleSaturated | kAngleBroken) << "recorded beside the counts";
  EXPECT_TRUE(bench.samples_.back().has_grip_force) << "the other channel still measures";
  bench.board_.set_voltage(0, 2500);
  bench.board_.set_voltage(1, 5000);
  bench.run(40);
  EXPECT_TRUE(bench.samples_.back().has_grip_angle);
  EXPECT_FALSE(bench.samples_.back().has_grip_force);
  bench.board_.set_voltage(1, 2500);
  bench.board_.set_switch(2, true);
  bench.run(3);
  EXPECT_EQ(bench.samples_.back().buttons, 0u) << "switches are debounced for 5 ms";
  bench.board_.set_switch(3, true);
  bench.run(10);
  EXPECT_EQ(bench.samples_.back().buttons, 3u);
  bench.board_.set_switch(2, false);
  bench.board_.set_switch(4, true);
  bench.run(10);
  EXPECT_EQ(bench.samples_.back().buttons, 6u);
}

TEST(ForcepsFirmware, NoiseAndDroppedBytesAreCountedAndNothingIsInvented) {
  Bench bench;
  std::mt19937 random(3);
  const auto chance = [&](double p) { return std::uniform_real_distribution<double>()(random) < p; };
  std::uint64_t clean_before = 0, received = 0, wrong = 0;
  for (int ms = 0; ms < 6000; ++ms) {
    bench.board_.set_voltage(0, 1000 + ms % 3000);
    bench.board_.set_voltage(1, 4000 - ms % 3000);
    const bool noisy = ms >= 1000 && ms < 5000;
    bench.step([&](std::vector<std::uint8_t>& bytes) {
      if (!noisy) return;
      std::vector<std::uint8_t> out;
      for (std::uint8_t byte : bytes) {
        if (chance(2e-3)) continue;
        out.push_back(chance(2e-3) ? static_cast<std::uint8_t>(byte ^ (1u << (random() % 8))) : byte);
      }
      if (chance(5e-3))
        for (int i = 0; i < 9; ++i) out.push_back(static_cast<std::uint8_t>(random()));
      bytes = out;
    });
    for (const DeviceSample& s : bench.samples_) {
      ++received;
      // What comes through is what was measured a millisecond or two ago.
      wrong += std::abs(s.raw_angle - counts(1000 + ms % 3000)) > 16 && ms % 3000 > 3 ? 1 : 0;
    }
    bench.samples_.clear();
    if (ms == 999) clean_before = bench.driver_.health().lost + bench.driver_.health().corrupt;
  }
  const DeviceHealth health = bench.driver_.health();
  EXPECT_EQ(clean_before, 0u);
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(health.corrupt, 100u);
  EXPECT_GT(health.lost, 100u);
  // Grip frames of 6 s, a hello each second, a status each 100 ms, a pong a second: every one received or lost.
  const auto frames = bench.driver_.stream().frames().good + health.lost;
  EXPECT_NEAR(static_cast<double>(frames), 6000 + 6 + 60 + 6, 6.0);
  EXPECT_NEAR(static_cast<double>(received + health.lost), 6000.0, 60.0);
  EXPECT_EQ(health.state, DeviceState::live);
}

TEST(ForcepsFirmware, AResetIsSurvivedWithinASecondAndIsNoLoss) {
  Bench bench;
  bench.run(700);
  const std::uint64_t before = bench.driver_.health().received;
  bench.board_.reset();
  const std::int64_t reset_at = bench.board_.time_us();
  while (bench.driver_.health().received < before + 20 && bench.board_.time_us() < reset_at + 1'000'000) bench.step();
  EXPECT_LT(bench.board_.time_us() - reset_at, 200'000);
  EXPECT_EQ(bench.driver_.health().lost, 0u);
  bench.run(300);
  EXPECT_EQ(bench.driver_.health().state, DeviceState::live);
}

TEST(ForcepsFirmware, TheWatchdogEndsAHang) {
  Bench bench;
  bench.run(300);
  bench.board_.hang_us(300'000);
  bench.board_.take_sent();
  const std::uint64_t before = bench.driver_.health().received;
  bench.run(300);
  EXPECT_GT(bench.driver_.health().received, before + 200);
  ASSERT_TRUE(bench.driver_.stream().status().has_value());
  EXPECT_TRUE(bench.driver_.stream().status()->reset & 8) << "it says why it started";
}

TEST(ForcepsFirmware, PulledOutAndPutBackIsThereWithinASecond) {
  const auto link = std::filesystem::temp_directory_path() / ("filum-firmware-" + std::to_string(::getpid()));
  Bench bench(link.string());
  bench.run(200);
  bench.unplug();
  bench.run(50);
  EXPECT_EQ(bench.driver_.health().state, DeviceState::lost);
  bench.samples_.clear();
  bench.plug();
  // The port is reopened by a thread against the real clock; the board waits a little in each turn.
  const auto plugged = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - plugged).count(); };
  while (bench.samples_.empty() && seconds() < 5.0) {
    bench.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_FALSE(bench.samples_.empty());
  std::printf("back %.2f s after it was put in\n", seconds());
  EXPECT_EQ(bench.driver_.health().corrupt, 0u);
}

TEST(ForcepsFirmware, OffsetAndDriftOfItsClockAreEstimated) {
  const double ppm = 3000.0;  // the ceramic resonator of an Uno may be off by 5000
  Bench bench;
  bench.board_.set_clock_error(ppm);
  bench.run(13'000);  // one ping a second, four to a point
  const ClockDrift& drift = bench.driver_.stream().drift();
  ASSERT_TRUE(drift.known());
  const auto line = drift.at(bench.board_.time_us());
  std::printf("crystal %+.0f ppm: drift %.1f +- %.1f ppm, offset %.0f us\n", ppm, line.drift_ppm, line.drift_uncertainty_ppm,
              line.offset_us);
  EXPECT_NEAR(line.drift_ppm, ppm, 150.0) << "1 ms of polling over the 8 s between the points";
  const DeviceSample& last = bench.samples_.back();  // 1 to 2.5 ms old when it is polled
  EXPECT_NEAR(line.offset_us, static_cast<double>(last.device_time_us - last.host_time_us) + 1750.0, 1250.0);
}

}  // namespace forceps_firmware_test
}  // namespace filum
