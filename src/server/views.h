#pragma once
// What the viewer is told besides the Observation: plain copies, filled by whoever wires the parts together.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace filum {

struct TaskInfoView {
  std::string name, title, summary;
  bool demonstration = false;  // shown by the demonstrator only
};

struct DeviceView {
  std::string name;
  std::string state;  // "waiting" | "live" | "stale" | "lost" | "finished"
  std::uint64_t received = 0, lost = 0, corrupt = 0, rejected = 0;
};

struct WarningView {
  std::string level;  // "info" | "warn" | "danger"
  std::string text;
  std::string code;
};

struct TaskView {
  std::string step_name;
  int step_index = 0;
  std::vector<std::string> steps;
  std::string hint;
  double elapsed = 0.0;  // [s], scored time
  bool done = false;
  std::vector<WarningView> warnings;
};

struct EventView {
  double time = 0.0;  // [s]
  std::string name;
  int tool = -1;
  double value = 0.0;
  std::string unit = "-";
  std::string text;
};

/// What the trainer is doing. The server adds who is in control and how many watch.
struct TrainerView {
  std::string state = "idle";  // "idle" | "loading" | "running" | "ended" | "replay"
  std::string task;
  std::string input;           // empty: none
  bool recording = false;
  std::string session;         // identifier, empty: not recorded
  std::string warning;         // for people, empty: all well
};

struct ReplayView {
  std::string session;
  double time = 0.0;      // [s]
  double duration = 0.0;  // [s]
  bool playing = false;
};

}  // namespace filum
