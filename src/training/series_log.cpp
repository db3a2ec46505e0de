#include "training/series_log.h"

#include <algorithm>
#include <cmath>

#include "training/metrics.h"

namespace filum {

Points ToolLog::path() const {
  Points points(3, static_cast<Eigen::Index>(tip.size()));
  for (std::size_t k = 0; k < tip.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = tip[k];
  return points;
}

SeriesLog::SeriesLog(int n_tools, double longest)
    : n_tools_(std::clamp(n_tools, 0, 3)),
      capacity_(static_cast<std::size_t>(std::ceil(longest * kMetricRate)) + 1) {
  time_.reserve(capacity_);
  tension_.reserve(capacity_);
  for (int t = 0; t < n_tools_; ++t) {
    ToolLog& log = tools_[static_cast<std::size_t>(t)];
    log.tip.reserve(capacity_);
    log.grip.reserve(capacity_);
    log.thread_force.reserve(capacity_);
  }
}

bool SeriesLog::add(const Observation& o, double tension) {
  if (time_.size() == capacity_) return false;
  time_.push_back(o.time);
  tension_.push_back(tension);
  for (int t = 0; t < n_tools_; ++t) {
    const ToolObservation& tool = o.tools[static_cast<std::size_t>(t)];
    ToolLog& log = tools_[static_cast<std::size_t>(t)];
    log.tip.push_back(tool.X_WT.p);
    log.grip.push_back(tool.grip_force);
    log.thread_force.push_back(tool.thread_force);
  }
  return true;
}

}  // namespace filum
