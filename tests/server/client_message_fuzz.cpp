#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "server/client_message.h"

// Whatever bytes come: no crash, and an accepted pose is finite with a unit quaternion.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parsed = filum::parse_client_message({reinterpret_cast<const char*>(data), size});
  const auto* message = std::get_if<filum::ClientMessage>(&parsed);
  if (message == nullptr) return 0;
  if (const auto* pointer = std::get_if<filum::PointerMessage>(message)) {
    const bool good = pointer->X_WD.finite() && std::abs(pointer->X_WD.q.norm() - 1.0) < 1e-9 && pointer->grip >= 0.0 &&
                      pointer->grip <= 1.0 && pointer->tool >= 0 && pointer->tool <= 2;
    if (!good) std::abort();
  }
  return 0;
}
