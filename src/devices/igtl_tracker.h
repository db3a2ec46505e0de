#pragma once
// Tool poses from a tracking system (NDI through PLUS, 3D Slicer, ...) by OpenIGTLink: connects to its server and takes
// TRANSFORM and TDATA messages whose names begin with tool0, tool1, tool2 (in any case: "Tool0ToReference"). A tool that is
// not in a message was not seen: no sample, so the trainer's tool stops and scoring pauses; a held pose is never invented.
// A pose that is not newer than the last one of its tool, by the sender's time stamp (none: zero), is a repetition and refused; a peer that
// says nothing else any more is dropped and connected to anew, since its clock may have been set back.
// Poses are of the jaw tip in the field's frame: calibrate tip and field in the tracking system.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "devices/device.h"
#include "devices/igtl_message.h"

namespace filum {

class IgtlTracker final : public Device {
 public:
  /// Throws InputError for an address that is none. A server that is not there yet is tried every second.
  explicit IgtlTracker(const std::string& address = "127.0.0.1", int port = 18944);
  ~IgtlTracker() override;
  IgtlTracker(const IgtlTracker&) = delete;
  IgtlTracker& operator=(const IgtlTracker&) = delete;

  const std::string& name() const override { return name_; }
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override;
  DeviceHealth health() const noexcept override;
  std::uint64_t other_messages() const noexcept { return other_; }
  std::uint64_t repeated() const noexcept { return repeated_; }

  /// Bytes as they came, in pieces of any size; false when the peer is to be dropped. Needs no socket.
  bool feed(std::span<const std::uint8_t> bytes, std::int64_t now_us, std::vector<DeviceSample>& out) noexcept;

 private:
  void connect(std::int64_t now_us) noexcept;
  void drop() noexcept;
  void take(const IgtlPose& pose, std::int64_t time_us, std::int64_t now_us, std::vector<DeviceSample>& out) noexcept;
  bool message(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept;

  std::string name_;
  std::uint32_t address_ = 0;  // network byte order
  std::uint16_t port_ = 0;
  int fd_ = -1;
  bool connecting_ = false, ever_ = false;
  std::int64_t next_try_us_ = 0, now_us_ = 0, heard_us_ = 0;  // [us]
  std::vector<std::uint8_t> buffer_;  // one message; reserved once
  std::uint64_t skip_ = 0;            // [byte], of a body that is too long to be a pose
  std::uint32_t sequence_ = 0;
  std::array<std::int64_t, kMaxTools> newest_us_{};  // [us], sender's clock
  int repeated_in_row_ = 0;
  std::uint64_t received_ = 0, damaged_ = 0, refused_ = 0, other_ = 0, repeated_ = 0;
};

}  // namespace filum
