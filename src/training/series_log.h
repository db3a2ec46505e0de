#pragma once
// What a task run is scored and plotted from, sampled at kMetricRate of scored time into memory reserved
// beforehand.

#include <array>
#include <vector>

#include "base/pose.h"
#include "world/observation.h"

namespace filum {

struct ToolLog {
  std::vector<Vec3> tip;             // [m], frame W
  std::vector<double> grip;          // [N], squeeze at the pads
  std::vector<double> thread_force;  // [N], pull of the thread on the jaws
  Points path() const;               // [m], 3 x n
};

class SeriesLog {
 public:
  SeriesLog(int n_tools, double longest);  // longest [s] of scored time that is kept

  /// Adds one sample; `tension` [N] is the thread's largest since the last one. False once the memory is
  /// full.
  bool add(const Observation& o, double tension);

  std::size_t size() const { return time_.size(); }
  int n_tools() const { return n_tools_; }
  const std::vector<double>& time() const { return time_; }        // [s], scene time
  const std::vector<double>& tension() const { return tension_; }  // [N]
  const ToolLog& tool(int t) const { return tools_[static_cast<std::size_t>(t)]; }

 private:
  int n_tools_;
  std::size_t capacity_;
  std::vector<double> time_, tension_;
  std::array<ToolLog, 3> tools_;
};

}  // namespace filum
