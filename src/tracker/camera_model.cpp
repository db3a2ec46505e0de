#include "tracker/camera_model.h"

#include <cmath>
#include <cstdio>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/yaml_file.h"

namespace filum {
namespace {

constexpr int kViews = 8;            // at least
constexpr double kResidual = 1.0;    // [px], at most
constexpr double kTilt = 0.35;       // [rad], spread of the board's normals, at least

CameraModel read(const YamlNode& file) {
  file.choice("format", {"filum-camera/1"});
  CameraModel c;
  c.width = file.integer("width", 16, 20000);
  c.height = file.integer("height", 16, 20000);
  c.fx = file.number("fx", Range::positive());
  c.fy = file.number("fy", Range::positive());
  c.cx = file.number("cx");
  c.cy = file.number("cy");
  const std::vector<double> d = file.quantities("distortion", "-");
  if (d.size() != c.distortion.size()) file.refuse("distortion", "five numbers: k1, k2, p1, p2, k3");
  std::copy(d.begin(), d.end(), c.distortion.begin());
  c.residual = file.number("residual", Range::not_negative());
  c.views = file.integer("views", 0, 100000);
  file.finish();
  return c;
}

std::vector<cv::Point3f> board_points(const ChessBoard& board) {
  std::vector<cv::Point3f> points;
  for (int r = 0; r < board.rows; ++r)
    for (int c = 0; c < board.columns; ++c)
      points.emplace_back(static_cast<float>(c * board.square), static_cast<float>(r * board.square), 0.0f);
  return points;
}

/// Largest angle between the board's normals in any two views. [rad]
double tilt_spread(const std::vector<cv::Mat>& rotations) {
  double most = 0.0;
  std::vector<cv::Vec3d> normals;
  for (const cv::Mat& r : rotations) {
    cv::Matx33d R;
    cv::Rodrigues(r, R);
    normals.emplace_back(R(0, 2), R(1, 2), R(2, 2));
    for (const cv::Vec3d& n : normals) most = std::max(most, std::acos(std::min(1.0, std::abs(n.dot(normals.back())))));
  }
  return most;
}

}  // namespace

CameraModel CameraModel::load(const std::string& path) { return read(YamlNode::load(path)); }
CameraModel CameraModel::parse(const std::string& text, const std::string& file_name) { return read(YamlNode::parse(text, file_name)); }

std::string CameraModel::text() const {
  char out[600];
  std::snprintf(out, sizeof out,
                "format: filum-camera/1\nwidth: %d\nheight: %d\nfx: %.9g\nfy: %.9g\ncx: %.9g\ncy: %.9g\n"
                "distortion: [%.9g, %.9g, %.9g, %.9g, %.9g]\nresidual: %.6g\nviews: %d\n",
                width, height, fx, fy, cx, cy, distortion[0], distortion[1], distortion[2], distortion[3], distortion[4], residual, views);
  return out;
}

CameraModel calibrate_camera(const std::vector<cv::Mat>& pictures, const ChessBoard& board) {
  std::vector<std::vector<cv::Point2f>> seen;
  const cv::Size pattern(board.columns, board.rows);
  for (const cv::Mat& picture : pictures) {
    std::vector<cv::Point2f> corners;
    if (picture.size() != pictures.front().size() || !cv::findChessboardCorners(picture, pattern, corners)) continue;
    cv::cornerSubPix(picture, corners, {5, 5}, {-1, -1}, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3});
    seen.push_back(corners);
  }
  const std::string found = std::to_string(seen.size()) + " of " + std::to_string(pictures.size()) + " pictures";
  if (static_cast<int>(seen.size()) < kViews)
    throw InputError("camera calibration", "pictures", found + " show the whole board", "at least " + std::to_string(kViews));
  const std::vector<std::vector<cv::Point3f>> points(seen.size(), board_points(board));
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> rotations, translations;
  CameraModel c;
  c.residual = cv::calibrateCamera(points, seen, pictures.front().size(), matrix, distortion, rotations, translations);
  if (tilt_spread(rotations) < kTilt)
    throw InputError("camera calibration", "pictures", "the board is seen from nearly the same side in all", "views tilted by at least 20 deg");
  if (!(c.residual < kResidual))
    throw InputError("camera calibration", "residual", std::to_string(c.residual) + " px", "below 1 px: sharp pictures of a flat board");
  c.width = pictures.front().cols;
  c.height = pictures.front().rows;
  c.fx = matrix.at<double>(0, 0);
  c.fy = matrix.at<double>(1, 1);
  c.cx = matrix.at<double>(0, 2);
  c.cy = matrix.at<double>(1, 2);
  for (int i = 0; i < 5; ++i) c.distortion[static_cast<std::size_t>(i)] = distortion.at<double>(i);
  c.views = static_cast<int>(seen.size());
  return c;
}

}  // namespace filum
