#pragma once
// What a browser may say. Parsing is a pure function of the text: nothing a browser sends can throw, and what is refused is
// refused with the field at fault. messages.schema.json is the contract; the tests compare the two.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "base/pose.h"

namespace filum {

struct StartMessage {
  std::string task;
  std::string input;  // "pointer" | "demo" | "device"
  std::string code;   // trainee code, may be empty; never a name
  bool take_over = false;
  double stiffness = 1.0;  // of the brain, as a surgeon turns the dial
  bool exam = false;       // without guides, hints and overlays
};
struct StopMessage {};
struct TakeControlMessage {};
struct PointerMessage {
  int tool = 0;                // 0 ... 2
  double time = 0.0;           // [s], the browser's monotonic clock
  Pose X_WD;                   // commanded pose, quaternion normalised
  double grip = 0.0;           // 0 open ... 1 closed tight
  std::uint32_t buttons = 0;   // bits: 1 clutch, 2 cut, 4 next, 8 and 16 clamps off, 32 fresh suture
};
struct AckMessage {
  std::uint64_t frame = 0;
};
struct ReplayOpenMessage {
  std::string session;
};
struct SeekMessage {
  double time = 0.0;  // [s]
};
struct PlayMessage {};
struct PauseMessage {};
struct OverlayMessage {
  std::string kind;  // "none" | "strain" | "pressure"
};

using ClientMessage = std::variant<StartMessage, StopMessage, TakeControlMessage, PointerMessage, AckMessage, ReplayOpenMessage,
                                   SeekMessage, PlayMessage, PauseMessage, OverlayMessage>;

/// Why a request is not carried out, in the words of the `error` message.
struct Refusal {
  std::string code;    // stable short name, e.g. "bad-message"
  std::string what;    // what happened
  std::string advice;  // what to do
};

inline constexpr std::size_t kMaxClientMessage = 16 * 1024;  // [byte]
inline constexpr double kReach = 1.0;                        // [m], farthest position a pointer may command

std::variant<ClientMessage, Refusal> parse_client_message(std::string_view text);

}  // namespace filum
