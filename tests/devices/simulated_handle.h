#pragma once
// Forceps at the far end of a pty, which stand still at what a test sets.

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "hardware/protocol/filum_protocol.h"
#include "tests/devices/pty.h"

namespace filum {

/// A handle that sends what its two channels stand at, some thousand times a second.
class SimulatedHandle {
 public:
  explicit SimulatedHandle(Pty& pty) : thread_([this, &pty](std::stop_token stop) { send(pty, stop); }) {}
  std::atomic<double> angle{1000.0}, force{300.0};  // [count]
  /// Frames with what was set are on the line.
  void wait() const {
    const unsigned from = sent_;
    while (sent_ < from + 20) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

 private:
  void send(Pty& pty, const std::stop_token& stop) {
    std::uint16_t sequence = 0;
    for (std::uint32_t time = 0; !stop.stop_requested(); time += 250) {
      const auto jitter = static_cast<double>(sequence % 3) - 1.0;
      const filum_grip grip{0, 0, static_cast<std::uint16_t>(angle + jitter), static_cast<std::uint16_t>(force + jitter)};
      filum_frame frame{};
      filum_put_grip(&frame, &grip);
      frame.device = 1;
      frame.sequence = sequence++;
      frame.time_us = time;
      std::vector<std::uint8_t> wire(FILUM_MAX_WIRE);
      wire.resize(filum_frame_encode(&frame, wire.data()));
      if (!pty.write(wire)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++sent_;
      if (sequence % 8 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  std::atomic<unsigned> sent_ = 0;
  std::jthread thread_;
};

}  // namespace filum
