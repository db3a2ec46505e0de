#pragma once
// What a recording holds, as plain fixed-size values that can pass through a lock-free queue, and their
// packed form. Doubles are stored bit for bit.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/pose.h"
#include "world/inputs.h"

namespace filum {

/// Text of at most N-1 bytes in place; longer text is cut, not within a character of UTF-8.
template <std::size_t N>
struct FixedText {
  std::array<char, N> bytes{};
  FixedText() = default;
  FixedText(std::string_view text) noexcept {  // NOLINT: meant to convert
    std::size_t n = text.size() < N ? text.size() : N - 1;
    if (n < text.size())
      while (n > 0 && (static_cast<unsigned char>(text[n]) & 0xC0U) == 0x80U) --n;
    for (std::size_t i = 0; i < n; ++i) bytes[i] = text[i];
  }
  FixedText(const char* text) noexcept : FixedText(std::string_view(text)) {}  // NOLINT: meant to convert
  std::string_view view() const noexcept { return bytes.data(); }
  bool operator==(const FixedText&) const = default;
};

/// One call of World::step: what went in, and the hash of the state that came out.
struct StepRecord {
  std::uint64_t step = 0;  // Observation::step after the call; each recording counts up by one without a gap
  std::int64_t host_time_us = 0;  // [us], host steady clock when the step began
  std::uint32_t compute_us = 0;   // [us], how long it took
  std::uint64_t state_hash = 0;
  Inputs inputs;
};

/// One raw reading of a device, field for field what devices/device.h reports (the session may not include
/// it).
struct SampleRecord {
  int tool = 0;
  std::int64_t host_time_us = 0;    // [us], host steady clock when the reading arrived
  std::int64_t device_time_us = 0;  // [us], device clock, unwrapped
  std::uint32_t sequence = 0;
  bool has_pose = false;
  bool has_grip_angle = false;
  bool has_grip_force = false;
  Pose X_WD;
  double grip_angle = 0.0;     // [rad]
  double grip_force = 0.0;     // [N]
  std::int32_t raw_angle = 0;  // [count]
  std::int32_t raw_force = 0;  // [count]
  std::uint32_t buttons = 0;
};

/// Something that happened: in the world ("grasp"), in the task ("throw laid"), to a device ("input-lost"),
/// to the clock
/// ("overrun") or to the recording itself ("recording-lost").
struct EventRecord {
  std::uint64_t step = 0;
  double time = 0.0;  // [s], scene time
  FixedText<40> name;
  int tool = -1;       // -1 none
  double value = 0.0;  // in `unit`
  FixedText<16> unit = "-";
  FixedText<200> text = "";  // for people, may be empty; not there in recordings of format 1
};

/// Hash of one array of the state, taken every so many steps so that a replay can name the first array that
/// differs.
struct ArrayHashRecord {
  std::uint64_t step = 0;
  FixedText<40> name;
  std::uint64_t hash = 0;
};

/// A file the run was made from, by its path below the project's root ("models/suture/10-0-nylon.yaml").
struct SourceFile {
  std::string path;
  std::string text;
};

/// Said once about a recording.
struct RecordingMeta {
  int format = 0;           // of the file; set by the program
  std::string program;      // version and build: bit-equal replay is promised for the same build only
  std::string task;         // "knot-square"
  std::string participant;  // code [A-Za-z0-9_-]{1,32} or empty; never a name
  std::string started_utc;  // "2026-11-21T09:30:00Z"
  std::string input;        // "serial /dev/ttyACM0", "demonstrator", ...
  double dt = 0.0;          // [s], of a step
  int n_tools = 0;          // 0 ... 3; inputs of further tools are not stored
};

/// Result of the task as the training rules gave it; json is stored as it is.
struct ScoreRecord {
  bool passed = false;
  double total = 0.0;    // [points]
  double seconds = 0.0;  // [s], scene time of the task
  std::string json;
};

// Packed form: little-endian, no padding. unpack() returns false when the bytes are not exactly `count`
// records.
void pack(std::span<const StepRecord> records, int n_tools, std::vector<char>& bytes);
void pack(std::span<const SampleRecord> records, std::vector<char>& bytes);
void pack(std::span<const EventRecord> records, std::vector<char>& bytes);
void pack(std::span<const ArrayHashRecord> records, std::vector<char>& bytes);
bool unpack(std::span<const char> bytes, std::size_t count, int n_tools, std::vector<StepRecord>& records);
bool unpack(std::span<const char> bytes, std::size_t count, std::vector<SampleRecord>& records);
bool unpack(std::span<const char> bytes, std::size_t count, std::vector<EventRecord>& records);
bool unpack(std::span<const char> bytes, std::size_t count, std::vector<ArrayHashRecord>& records);
/// Events of recordings of format 1.
bool unpack_without_text(std::span<const char> bytes, std::size_t count, std::vector<EventRecord>& records);

/// True for a participant code that may be stored: letters, digits, "_" and "-", 1 to 32 of them.
bool is_participant_code(std::string_view code) noexcept;

}  // namespace filum
