#pragma once
// Forceps (and handles with a pose) on a serial port or pty, by the protocol in hardware/protocol. Damage and
// loss are counted and shown, never filled in; a handle that is pulled out and put back goes on by itself.

#include <cstdint>
#include <string>
#include <vector>

#include "devices/device.h"
#include "devices/forceps_stream.h"
#include "devices/serial_port.h"

namespace filum {

class SerialForceps final : public Device {
 public:
  /// Throws InputError when the port cannot be opened.
  SerialForceps(const std::string& port, ForcepsCalibration calibration, int baud = 500000);

  const std::string& name() const override { return name_; }
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override;
  DeviceHealth health() const noexcept override;
  /// Frames by kind of damage, hello, clock offset and calibration, for the doctor and the log.
  const ForcepsStream& stream() const noexcept { return stream_; }

 private:
  void ping(std::int64_t now_us) noexcept;

  std::string name_;
  ForcepsStream stream_;
  SerialPort port_;
  DeviceState state_ = DeviceState::waiting;
  std::int64_t next_ping_us_ = 0;  // [us]
  std::uint16_t ping_sequence_ = 0;
};

}  // namespace filum
