#pragma once
// Tool poses from square markers (ArUco, dictionary 4x4_50: S. Garrido-Jurado et al., Pattern Recognition 47 (2014) 2280) in a
// picture: corners to sub-pixels, pose by IPPE (T. Collins, A. Bartoli, IJCV 109 (2014) 252) refined by Levenberg-Marquardt,
// covariance of first order: with J the derivative of the corners [px] by position and rotation vector and sigma the noise
// of a corner,
//   C = sigma^2 (J^T J)^-1.
// A marker that is not seen, partly covered or too blurred (marker_quality.h) gives nothing: a dropout. A flat square seen head on has two poses that fit almost equally; where
// the second fits nearly as well the pose is refused. Neglects: error of the calibration and of the printed size.
// It cannot measure tremor: see hardware/tracker/README.md. Test: marker_tracker_test.

#include <Eigen/Core>
#include <map>
#include <opencv2/core.hpp>
#include <vector>

#include "base/pose.h"
#include "tracker/camera_model.h"

namespace filum {

struct MarkerMount {
  int tool = 0;
  double side = 12e-3;  // [m], of the black square
  Pose X_MT;            // jaw tip in the marker's frame: centre, x right, y up, z out of the paper
};

struct MarkerOptions {
  std::map<int, MarkerMount> mounts;  // by marker
  double corner_noise = 0.2;          // [px], sigma
  double ambiguity = 0.6;             // refuse if the better pose's error is not below this share of the other's
  double residual = 0.35;             // [px], rms of the corners, at most: a good marker has 0.15, one with a side covered 0.4 and more
  double likeness = 0.90;             // with the printed marker, at least
  double rim = 0.75;                  // darkest side of the white rim over the brightest, at least: a finger lies on it otherwise
  double edge = 0.095;                // width of the edges over the side, at most: blur beyond it moves the corners
};

struct MarkerPose {
  int tool = 0, marker = 0;
  Pose X_CT;                                       // tip in the camera's frame: x right, y down, z forwards
  Eigen::Matrix<double, 6, 6> covariance;          // of the marker: position [m], rotation vector [rad], camera's frame
  double residual = 0.0;                           // [px], rms
};

struct MarkerCounts {
  std::uint64_t frames = 0, poses = 0, ambiguous = 0, poor = 0, unknown = 0, covered = 0, blurred = 0;
};

class MarkerTracker {
 public:
  MarkerTracker(const CameraModel& camera, const MarkerOptions& options) : camera_(camera), options_(options) {}
  /// Poses of the tools seen in a grey picture of the camera's size.
  std::vector<MarkerPose> find(const cv::Mat& grey);
  const MarkerCounts& counts() const { return counts_; }

 private:
  bool measurable(const cv::Mat& grey, const std::vector<cv::Point2f>& corners, int marker);
  bool pose_of(const std::vector<cv::Point2f>& corners, const MarkerMount& mount, MarkerPose& pose);
  CameraModel camera_;
  MarkerOptions options_;
  MarkerCounts counts_;
};

}  // namespace filum
