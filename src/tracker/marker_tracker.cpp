#include "tracker/marker_tracker.h"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>

#include "tracker/marker_quality.h"

namespace filum {
namespace {

/// Corners of a marker in its own frame, in the order that the detector gives them: from the top left, clockwise.
std::vector<cv::Point3f> square(double side) {
  const auto h = static_cast<float>(0.5 * side);
  return {{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
}

Pose pose_of(const cv::Mat& rotation, const cv::Mat& translation) {
  cv::Matx33d R;
  cv::Rodrigues(rotation, R);
  Mat3 r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r(i, j) = R(i, j);
  Pose X;
  X.q = Quat(r).normalized();
  for (int i = 0; i < 3; ++i) X.p[i] = translation.at<double>(i);
  return X;
}

}  // namespace

bool MarkerTracker::pose_of(const std::vector<cv::Point2f>& corners, const MarkerMount& mount, MarkerPose& pose) {
  const std::vector<cv::Point3f> model = square(mount.side);
  const cv::Matx33d matrix = camera_.matrix();
  const cv::Mat distortion(1, 5, CV_64F, camera_.distortion.data());
  std::vector<cv::Mat> rotations, translations;
  std::vector<double> errors;
  cv::solvePnPGeneric(model, corners, matrix, distortion, rotations, translations, false, cv::SOLVEPNP_IPPE_SQUARE, cv::noArray(),
                      cv::noArray(), errors);
  if (rotations.empty()) return false;
  if (errors.size() > 1 && errors[0] > options_.ambiguity * errors[1] && errors[1] > 0.0) {
    ++counts_.ambiguous;
    return false;
  }
  cv::Mat r = rotations[0], t = translations[0];
  cv::solvePnPRefineLM(model, corners, matrix, distortion, r, t);
  std::vector<cv::Point2f> back;
  cv::Mat jacobian;  // 8 x (3 rotation, 3 translation, camera's own)
  cv::projectPoints(model, r, t, matrix, distortion, back, jacobian);
  double square_sum = 0.0;
  for (std::size_t k = 0; k < back.size(); ++k) square_sum += (back[k] - corners[k]).dot(back[k] - corners[k]);
  pose.residual = std::sqrt(square_sum / static_cast<double>(back.size()));
  if (!(pose.residual < options_.residual)) {
    ++counts_.poor;
    return false;
  }
  Eigen::Matrix<double, 8, 6> J;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 6; ++j) J(i, j) = jacobian.at<double>(i, j < 3 ? j + 3 : j - 3);
  pose.covariance = options_.corner_noise * options_.corner_noise * (J.transpose() * J).inverse();
  pose.X_CT = filum::pose_of(r, t) * mount.X_MT;
  return pose.X_CT.finite() && pose.covariance.allFinite();
}

bool MarkerTracker::measurable(const cv::Mat& grey, const std::vector<cv::Point2f>& corners, int marker) {
  const MarkerQuality q = quality_of(grey, corners, marker);
  if (q.edge > options_.edge) {
    ++counts_.blurred;
    return false;
  }
  if (q.likeness < options_.likeness || q.rim < options_.rim) {
    ++counts_.covered;
    return false;
  }
  return true;
}

std::vector<MarkerPose> MarkerTracker::find(const cv::Mat& grey) {
  ++counts_.frames;
  const cv::Ptr<cv::aruco::Dictionary> dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  const cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, dictionary, corners, ids, parameters);
  std::vector<MarkerPose> poses;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto mount = options_.mounts.find(ids[k]);
    if (mount == options_.mounts.end()) {
      ++counts_.unknown;
      continue;
    }
    MarkerPose pose;
    pose.tool = mount->second.tool;
    pose.marker = ids[k];
    if (!pose_of(corners[k], mount->second, pose) || !measurable(grey, corners[k], ids[k])) continue;
    poses.push_back(pose);
    ++counts_.poses;
  }
  return poses;
}

}  // namespace filum
