#pragma once
// What the viewer is told besides the Observation: plain copies, filled by whoever wires the parts together.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace filum {

struct TaskInfoView {
  std::string name, title, summary;
  std::string chapter;         // of the course
  bool demonstration = false;  // shown by the demonstrator only
  bool dial = false;           // the stiffness of its tissue can be turned
  bool shown = true;           // there is a demonstration of it
  bool rated = false;          // raters have a form for it
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

/// Brain retraction: pressure and dose against the limits in force.
struct RetractionView {
  bool present = false;
  bool blind = false;                  // to be hidden from the trainee now
  double pressure = 0.0, alarm = 0.0;  // [mmHg]
  double dose = 0.0;                   // [mmHg min]
  double loaded = 0.0;                 // [s], of the patient, without a pause
  double perfusion = -1.0;             // [mmHg], -1: mode is off
  std::string band, dose_band;         // "green" | "yellow" | "orange" | "red"
  std::array<double, 3> bands{}, dose_bands{};  // from which yellow, orange, red
  std::string label, version, source;  // of the limits
};

struct TaskView {
  std::string step_name;
  int step_index = 0;
  std::vector<std::string> steps;
  std::string hint;
  double elapsed = 0.0;  // [s], scored time
  bool done = false;
  std::vector<WarningView> warnings;
  std::vector<double> target;  // [m], x y z of each point; empty: none
  double within = 0.0;         // [m]
  RetractionView retraction;
};

/// A number for each vertex of the tissue, to be coloured by.
struct OverlayView {
  std::string kind;                            // "strain" | "pressure", empty: none
  std::string unit;
  double full = 0.0;                           // [unit], end of the scale
  double factor = 1.0;                         // from a value to the unit
  const std::vector<double>* values = nullptr;  // valid while the view is encoded
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
  double knot_test = -1.0;     // share of the pull test of the last knot that is done; below 0: none runs
  bool exam = false;           // no guides, hints or overlays
  bool pointer = false;        // the browser in control moves instruments: by pointer alone, or beside devices that do not know where they are
};

struct ReplayView {
  std::string session;
  double time = 0.0;      // [s]
  double duration = 0.0;  // [s]
  double ready = 0.0;     // [s], up to which it is computed and can be shown
  bool playing = false;
};

}  // namespace filum
