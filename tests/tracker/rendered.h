#pragma once
// Pictures of flat patterns with known pose: a homography from our own pinhole formula, drawn at twice the size and averaged
// down, then blurred and given noise.

#include <opencv2/imgproc.hpp>

#include "base/pose.h"
#include "tracker/camera_model.h"

namespace filum {

inline CameraModel plain_camera() {
  CameraModel c;
  c.width = 960;
  c.height = 600;
  c.fx = c.fy = 1000.0;
  c.cx = 480.0;
  c.cy = 300.0;
  return c;
}

inline cv::Point2d project(const CameraModel& c, const Vec3& p_C) {
  return {c.fx * p_C.x() / p_C.z() + c.cx, c.fy * p_C.y() / p_C.z() + c.cy};
}

/// `pattern` (grey) lies in the plane z = 0 of frame P, its picture's top left at (-w/2, h/2), x right, y up.
inline void draw(const CameraModel& c, const cv::Mat& pattern, double width, double height, const Pose& X_CP, cv::Mat& picture2x) {
  const double w = 0.5 * width, h = 0.5 * height;
  const Vec3 corners[4] = {{-w, h, 0}, {w, h, 0}, {w, -h, 0}, {-w, -h, 0}};
  cv::Point2f from[4], to[4];
  for (int k = 0; k < 4; ++k) {
    const cv::Point2d at = project(c, X_CP * corners[k]);
    // Pixel centres are whole numbers in both pictures: twice as large means 2 x + 0.5.
    to[k] = cv::Point2f(static_cast<float>(2.0 * at.x + 0.5), static_cast<float>(2.0 * at.y + 0.5));
    from[k] = cv::Point2f((k == 1 || k == 2) ? static_cast<float>(pattern.cols) - 0.5f : -0.5f,
                          (k >= 2) ? static_cast<float>(pattern.rows) - 0.5f : -0.5f);
  }
  cv::Mat drawn, mask;
  const cv::Mat H = cv::getPerspectiveTransform(from, to);
  cv::warpPerspective(pattern, drawn, H, picture2x.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::warpPerspective(cv::Mat(pattern.size(), CV_8U, cv::Scalar(255)), mask, H, picture2x.size(), cv::INTER_NEAREST);
  drawn.copyTo(picture2x, mask);
}

inline cv::Mat blank2x(const CameraModel& c) { return cv::Mat(2 * c.height, 2 * c.width, CV_8U, cv::Scalar(200)); }

inline cv::Mat developed(const cv::Mat& picture2x, double blur, double noise, cv::RNG& random) {
  cv::Mat picture;
  cv::resize(picture2x, picture, {}, 0.5, 0.5, cv::INTER_AREA);
  if (blur > 0.0) cv::GaussianBlur(picture, picture, {}, blur);
  cv::Mat grain(picture.size(), CV_16S);
  random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
  cv::Mat sum;
  cv::add(picture, grain, sum, cv::noArray(), CV_8U);
  return sum;
}

}  // namespace filum
