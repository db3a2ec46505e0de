#pragma once
// What a task of brain retraction asks for (training/retraction.h).

#include <vector>

#include "training/pressure.h"

namespace filum {

struct RetractionGoal {
  enum class Kind { press, release, expose, hold } kind = Kind::press;
  double low = 0.0, high = 0.0;  // [Pa]; expose and hold: no pressure above `high`
  double share = 0.0;
  double seconds = 0.0;          // [s]
  bool on_arm = false;           // a blade must be held by its arm
  bool blind = false;            // the pressure is not shown
};

struct RetractionTask {
  PressureLimits limits;
  std::vector<RetractionGoal> goals;
};

/// A step of a task file. Throws InputError.
RetractionGoal parse_goal(const YamlNode& node);

}  // namespace filum
