#pragma once
// Poses of the simulated tools to 3D Slicer and others by OpenIGTLink: a server for one peer, TRANSFORM messages named Tool0,
// Tool1, Tool2. Never blocks: what a slow peer does not take is not sent. Tests: igtl_stream_test, igtl_library_test.

#include <cstdint>
#include <string>

#include "base/pose.h"

namespace filum {

class IgtlStream {
 public:
  /// Listens; port 0 takes a free one. Throws InputError.
  explicit IgtlStream(const std::string& address = "127.0.0.1", int port = 18945);
  ~IgtlStream();
  IgtlStream(const IgtlStream&) = delete;
  IgtlStream& operator=(const IgtlStream&) = delete;

  int port() const noexcept { return port_; }
  /// Sends one pose; takes a peer first if there is none.
  void send(int tool, const Pose& X_WT, std::int64_t time_us) noexcept;
  bool has_peer() const noexcept { return peer_ >= 0; }
  std::uint64_t sent() const noexcept { return sent_; }
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  void accept_one() noexcept;
  void lose() noexcept;
  int listen_ = -1, peer_ = -1, port_ = 0;
  std::uint64_t sent_ = 0, dropped_ = 0;
};

}  // namespace filum
