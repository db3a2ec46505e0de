#pragma once
// A chessboard as it is shown to a camera during a calibration: in each ninth of the picture, tilted to four sides, near and far.

#include <cmath>
#include <numbers>

#include "tests/tracker/rendered.h"

namespace filum {

/// A chessboard of 10 x 7 squares with a white rim of one square.
inline cv::Mat board_picture() {
  constexpr int kCell = 40;
  cv::Mat picture(9 * kCell, 12 * kCell, CV_8U, cv::Scalar(255));
  for (int r = 0; r < 7; ++r)
    for (int c = 0; c < 10; ++c)
      if ((r + c) % 2 == 0) picture(cv::Rect((c + 1) * kCell, (r + 1) * kCell, kCell, kCell)).setTo(10);
  return picture;
}

/// Board of 10 mm squares, its middle at pixel (u, v) and `distance` [m] away, turned by `about_x`, `about_y` [rad].
inline Pose board_at(const CameraModel& c, double u, double v, double distance, double about_x, double about_y) {
  Pose X;
  X.p = Vec3((u - c.cx) / c.fx * distance, (v - c.cy) / c.fy * distance, distance);
  X.q = Quat(Eigen::AngleAxisd(about_y, Vec3::UnitY())) * Quat(Eigen::AngleAxisd(about_x, Vec3::UnitX())) *
        Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
  return X;
}

inline cv::Mat picture_of_board(const CameraModel& c, const Pose& X, double blur, cv::RNG& random) {
  cv::Mat big = blank2x(c);
  draw(c, board_picture(), 0.12, 0.09, X, big);
  return developed(big, blur, 1.5, random);
}

/// All that a guide wants to be shown.
inline std::vector<Pose> whole_tour(const CameraModel& c) {
  std::vector<Pose> tour;
  const double w = c.width, h = c.height, f = c.fx / w;  // distances as for a focal length of one picture's width
  for (int k = 0; k < 9; ++k) tour.push_back(board_at(c, w * (0.19 + 0.31 * (k % 3)), h * (0.22 + 0.28 * (k / 3)), 0.29 * f, 0.15 * (k % 2), -0.12 * (k % 3)));
  for (const double tilt : {0.5, -0.5}) {
    tour.push_back(board_at(c, 0.5 * w, 0.5 * h, 0.21 * f, tilt, 0.0));
    tour.push_back(board_at(c, 0.5 * w, 0.5 * h, 0.21 * f, 0.0, tilt));
  }
  tour.push_back(board_at(c, 0.48 * w, 0.5 * h, 0.165 * f, 0.1, 0.1));
  return tour;
}

inline CameraModel small_camera() {
  CameraModel c;
  c.width = 640;
  c.height = 400;
  c.fx = c.fy = 667.0;
  c.cx = 324.0;
  c.cy = 197.0;
  return c;
}

}  // namespace filum
