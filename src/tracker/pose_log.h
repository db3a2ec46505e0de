#pragma once
// Poses that a camera saw, as CSV: time [s], tool, marker, position [m], quaternion w x y z, residual [px], and the 21 numbers of the upper
// triangle of the marker's covariance (position [m], rotation vector [rad]; camera's frame), row by row. Tests: pose_log_test, marker_tracker_test.

#include <fstream>
#include <string>

#include "tracker/marker_tracker.h"

namespace filum {

class PoseLog {
 public:
  /// Throws InputError for a file that exists or cannot be written.
  explicit PoseLog(const std::string& path);
  /// `X`: the pose that was sent. In the file when this returns: whatever ends the program, nothing is lost. Throws where the disk is full.
  void add(double time, const MarkerPose& pose, const Pose& X);
  /// Throws where the file does not end well.
  void close();

 private:
  void require_written() const;
  std::string path_;
  std::ofstream file_;
};

}  // namespace filum
