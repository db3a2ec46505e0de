#pragma once
// The movements and forces of one recorded session, ready for analysis: the hand as its device reported it (hand space)
// and the tool as it was commanded in the scene after clutch and motion scaling (scene space). Both are kept apart,
// because a scaled scene shows a scaled tremor.

#include <array>
#include <string>
#include <vector>

#include "analysis/grasp_force.h"
#include "analysis/tremor.h"
#include "base/pose.h"
#include "session/recording_reader.h"

namespace filum {

/// A path with its own clock (for even sampling) and the scene's (for finding windows).
struct TimedPath {
  std::vector<double> clock;  // [s], of the device
  std::vector<double> scene;  // [s]
  Points p;                   // [m], 3 x n
  double ahead = 0.0;         // [s], of the device's clock, since that began anew
  TimedPath cut(double from, double to) const;  // by scene time
  EvenPath even() const { return even_path(clock, p); }
};

struct TimedForce {
  std::vector<double> clock, scene;  // [s]
  std::vector<double> force;         // [N]
  double ahead = 0.0;                // [s], as of a path
  std::string source = "none";       // "device", "simulation" or "none"
  bool foreign = false;              // the handle was calibrated by another file than the one in use: forces may be wrong
  std::size_t saturated = 0;         // readings at the end of the amplifier's range: the true force may be larger
  /// [s], of the scene at a time of the device's clock, between the first and the last reading.
  double scene_time(double at) const;
};

struct Window {
  std::string name;             // "hold 1", "whole session"
  double from = 0.0, to = 0.0;  // [s], scene time
};

struct ToolSeries {
  int tool = 0;
  TimedPath hand, scene;
  TimedForce grip;
  std::vector<Window> holds;  // in which the task asked for stillness
  std::vector<HeldObject> held;
  std::vector<std::array<double, 2>> target_error;  // time [s], rms distance from the target since the last [m]
};

struct RecordedSession {
  std::string file;
  RecordingMeta meta;
  double seconds = 0.0;  // [s], of scene
  std::vector<ToolSeries> tools;  // those that were moved
};

/// Throws InputError for a recording that cannot be read.
RecordedSession read_session(const RecordingReader& recording);

}  // namespace filum
