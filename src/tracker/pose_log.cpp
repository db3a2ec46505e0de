#include "tracker/pose_log.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "base/error.h"
#include "base/file_kind.h"

namespace filum {

PoseLog::PoseLog(const std::string& path) : path_(path) {
  if (is_there(path)) throw InputError("--log", "file", path, "a file that does not exist yet");
  file_.open(path);
  file_ << "time_s,tool,marker,x_m,y_m,z_m,qw,qx,qy,qz,residual_px";
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) file_ << ",c" << i << j;
  file_ << "\n";
  if (!file_.flush()) throw InputError("--log", "file", path, "a file that can be written");
}

void PoseLog::add(double time, const MarkerPose& pose, const Pose& X) {
  char text[320];
  std::snprintf(text, sizeof text, "%.6f,%d,%d,%.7f,%.7f,%.7f,%.9f,%.9f,%.9f,%.9f,%.4f", time, pose.tool, pose.marker, X.p.x(), X.p.y(), X.p.z(),
                X.q.w(), X.q.x(), X.q.y(), X.q.z(), pose.residual);
  file_ << text;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) {
      std::snprintf(text, sizeof text, ",%.6e", pose.covariance(i, j));
      file_ << text;
    }
  file_ << "\n";
  file_.flush();
  require_written();
}

void PoseLog::close() {
  file_.close();
  require_written();
}

/// A full disk is no fault of what was asked for, hence no InputError.
void PoseLog::require_written() const {
  if (!file_) throw std::runtime_error(path_ + ": poses: found a write error, expected a disk with space left");
}

}  // namespace filum
