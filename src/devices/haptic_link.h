#pragma once
// Haptic devices on another computer (or another program on this one), by UDP: hardware/haptic-link/filum_link.h. Poses in,
// forces out. One peer at a time: whoever sends the first good packet, until it has been silent for two seconds; everyone
// else is refused, and so is what comes late, twice or from another session. A frame that is missing is lost, never made up.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "devices/device.h"
#include "hardware/haptic-link/filum_link.h"

struct sockaddr_in;

namespace filum {

struct LinkCounts {
  std::uint64_t malformed = 0;    // not a whole, undamaged packet
  std::uint64_t strangers = 0;    // another session than the one that runs; another address, as far as it was not thrown away before
  std::uint64_t late = 0;         // older than what is known: delayed or replayed
  std::uint64_t impossible = 0;   // out of reach, not a rotation, not an opening
  std::uint64_t floods = 0;       // polls that ended with packets left in the queue
};

class HapticLink final : public Device {
 public:
  /// Binds; port 0 takes a free one. Throws InputError for an address that is none of this machine's or a port in use.
  explicit HapticLink(const std::string& address = "127.0.0.1", int port = FILUM_LINK_PORT);
  ~HapticLink() override;
  HapticLink(const HapticLink&) = delete;
  HapticLink& operator=(const HapticLink&) = delete;

  const std::string& name() const override { return name_; }
  int port() const noexcept { return port_; }
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override;
  /// Sends the forces on the hands [N] of the tools that this peer moves.
  void render(std::int64_t now_us, const HandForces& forces) noexcept override;
  DeviceHealth health() const noexcept override;
  const LinkCounts& counts() const noexcept { return counts_; }
  std::int64_t stale_after_us() const noexcept override { return kStale; }

  static constexpr std::int64_t kStale = 20'000;       // [us]
  static constexpr std::int64_t kRelease = 2'000'000;  // [us]

 private:
  struct Hand {
    bool used = false;
    filum_link_pose newest{};
    std::int64_t heard_us = 0;      // [us]
    std::int64_t device_us = 0;     // [us], unwrapped
    std::uint32_t force_sequence = 0;
  };
  void take(const filum_link_pose& pose, std::int64_t now_us, std::vector<DeviceSample>& out) noexcept;
  bool is_peer(const sockaddr_in& from, const filum_link_pose& pose, std::int64_t now_us) noexcept;
  void listen_to(const sockaddr_in* peer) noexcept;
  void release() noexcept;

  std::string name_;
  int fd_ = -1, port_ = 0;
  bool has_peer_ = false;
  std::uint32_t peer_address_ = 0;  // network byte order
  std::uint16_t peer_port_ = 0;
  std::uint32_t session_ = 0;
  std::int64_t heard_us_ = 0, now_us_ = 0;  // [us]
  std::array<Hand, kMaxTools> hands_;
  LinkCounts counts_;
  std::uint64_t received_ = 0, lost_ = 0;
  bool ever_ = false;
};

/// Pose and sample of a packet; false if the numbers cannot be those of a hand.
bool sample_of(const filum_link_pose& pose, DeviceSample& sample) noexcept;
/// The packet for a pose; used by masters and tests.
filum_link_pose link_pose(int tool, const Pose& X, double grip_angle, double grip_force, std::uint8_t flags) noexcept;

}  // namespace filum
