#include "tracker/camera_model.h"

#include <algorithm>
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
  c.camera = file.text_or("camera", "");
  c.date = file.text_or("date", "");
  c.coverage = file.number_or("coverage", 0.0, Range::between(0.0, 1.0));
  if (file.has("uncertainty")) {
    const std::vector<double> u = file.quantities("uncertainty", "-", Range::not_negative());
    if (u.size() != c.uncertainty.size()) file.refuse("uncertainty", "four numbers: of fx, fy, cx, cy");
    std::copy(u.begin(), u.end(), c.uncertainty.begin());
  }
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
  char out[900];
  std::snprintf(out, sizeof out,
                "format: filum-camera/1\nwidth: %d\nheight: %d\nfx: %.9g\nfy: %.9g\ncx: %.9g\ncy: %.9g\n"
                "distortion: [%.9g, %.9g, %.9g, %.9g, %.9g]\nresidual: %.6g\nviews: %d\ncoverage: %.3g\nuncertainty: [%.4g, %.4g, %.4g, %.4g]\n",
                width, height, fx, fy, cx, cy, distortion[0], distortion[1], distortion[2], distortion[3], distortion[4], residual, views, coverage,
                uncertainty[0], uncertainty[1], uncertainty[2], uncertainty[3]);
  std::string words;
  for (const auto& [key, value] : {std::pair{"camera", camera}, {"date", date}}) {
    std::string quoted;
    for (const char c : value)
      if (c >= ' ' && c != '"' && c != '\\') quoted += c;
    if (!quoted.empty()) words += std::string(key) + ": \"" + quoted + "\"\n";
  }
  return out + words;
}

std::vector<cv::Point2f> find_board(const cv::Mat& grey, const ChessBoard& board) {
  constexpr int kAcross = 960;
  const double scale = std::min(1.0, static_cast<double>(kAcross) / grey.cols);
  cv::Mat small = grey;
  if (scale < 1.0) cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<cv::Point2f> corners;
  const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  if (!cv::findChessboardCorners(small, {board.columns, board.rows}, corners, flags)) return {};
  for (cv::Point2f& c : corners) {  // the middles of pixels are whole numbers in both
    c.x = static_cast<float>((c.x + 0.5) / scale - 0.5);
    c.y = static_cast<float>((c.y + 0.5) / scale - 0.5);
  }
  cv::cornerSubPix(grey, corners, {5, 5}, {-1, -1}, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3});
  return corners;
}

std::vector<bool> covered_cells(const std::vector<std::vector<cv::Point2f>>& views, const cv::Size& picture) {
  std::vector<bool> cells(static_cast<std::size_t>(kCellColumns * kCellRows), false);
  for (const auto& view : views)
    for (const cv::Point2f& p : view) {
      const int column = std::clamp(static_cast<int>(p.x * kCellColumns / static_cast<float>(picture.width)), 0, kCellColumns - 1);
      const int row = std::clamp(static_cast<int>(p.y * kCellRows / static_cast<float>(picture.height)), 0, kCellRows - 1);
      cells[static_cast<std::size_t>(row * kCellColumns + column)] = true;
    }
  return cells;
}

CameraModel calibrate_views(const std::vector<std::vector<cv::Point2f>>& views, const cv::Size& picture, const ChessBoard& board) {
  if (static_cast<int>(views.size()) < kViews)
    throw InputError("camera calibration", "views", std::to_string(views.size()) + " of the whole board", "at least " + std::to_string(kViews));
  const std::vector<std::vector<cv::Point3f>> points(views.size(), board_points(board));
  cv::Mat matrix, distortion, deviations, unused;
  std::vector<cv::Mat> rotations, translations;
  CameraModel c;
  c.residual = cv::calibrateCamera(points, views, picture, matrix, distortion, rotations, translations, deviations, unused, unused);
  if (tilt_spread(rotations) < kTilt)
    throw InputError("camera calibration", "pictures", "the board is seen from nearly the same side in all", "views tilted by at least 20 deg");
  if (!(c.residual < kResidual))
    throw InputError("camera calibration", "residual", std::to_string(c.residual) + " px", "below 1 px: sharp pictures of a flat board");
  c.width = picture.width;
  c.height = picture.height;
  c.fx = matrix.at<double>(0, 0);
  c.fy = matrix.at<double>(1, 1);
  c.cx = matrix.at<double>(0, 2);
  c.cy = matrix.at<double>(1, 2);
  for (int i = 0; i < 5; ++i) c.distortion[static_cast<std::size_t>(i)] = distortion.at<double>(i);
  for (int i = 0; i < 4; ++i) c.uncertainty[static_cast<std::size_t>(i)] = deviations.at<double>(i);
  c.views = static_cast<int>(views.size());
  const std::vector<bool> cells = covered_cells(views, picture);
  c.coverage = static_cast<double>(std::count(cells.begin(), cells.end(), true)) / static_cast<double>(cells.size());
  return c;
}

CameraModel calibrate_camera(const std::vector<cv::Mat>& pictures, const ChessBoard& board) {
  std::vector<std::vector<cv::Point2f>> views;
  for (const cv::Mat& picture : pictures) {
    if (picture.size() != pictures.front().size()) continue;
    auto corners = find_board(picture, board);
    if (!corners.empty()) views.push_back(std::move(corners));
  }
  if (static_cast<int>(views.size()) < kViews)
    throw InputError("camera calibration", "pictures", std::to_string(views.size()) + " of " + std::to_string(pictures.size()) + " pictures show the whole board", "at least " + std::to_string(kViews));
  return calibrate_views(views, pictures.front().size(), board);
}

}  // namespace filum
