#pragma once
// The simulated tools' poses to 3D Slicer and others, from 127.0.0.1 by OpenIGTLink, as often as pictures are shown.

#include "devices/igtl_stream.h"
#include "world/observation.h"

namespace filum {

class ToolStream {
 public:
  /// Throws InputError when the port is in use.
  explicit ToolStream(int port) : stream_("127.0.0.1", port) {}
  void send_all(const Observation& o) noexcept {
    const auto us = static_cast<std::int64_t>(1e6 * o.time);
    for (int i = 0; i < o.n_tools; ++i) stream_.send(i, o.tools[static_cast<std::size_t>(i)].X_WT, us);
  }

 private:
  IgtlStream stream_;
};

}  // namespace filum
