#include "video/partial_match.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace filum {
namespace {

constexpr int kMostSteps = 30, kAbout = 5;  // [px], over which a pixel's mismatch is averaged
constexpr double kAgrees = 3.0;
constexpr double kInterpolation = 0.03;  // of the contrast, what sampling between pixels leaves of a fine pattern

/// Which pixels agree, from the difference of the squares; and how many.
int agreeing(const cv::Mat& difference, double contrast, std::vector<char>& agrees) {
  cv::Mat mean;
  cv::boxFilter(difference.mul(difference), mean, CV_32F, cv::Size(kAbout, kAbout), cv::Point(-1, -1), true, cv::BORDER_REFLECT);
  std::vector<float> sorted(mean.begin<float>(), mean.end<float>());
  const auto third = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 6);  // the middle of the best third
  std::nth_element(sorted.begin(), third, sorted.end());
  const double limit = kAgrees * kAgrees * std::max(static_cast<double>(*third), std::pow(kInterpolation * contrast, 2));
  agrees.assign(sorted.size(), 0);
  int n = 0;
  for (int y = 1; y + 1 < mean.rows; ++y)
    for (int x = 1; x + 1 < mean.cols; ++x)
      if (mean.at<float>(y, x) <= limit) agrees[static_cast<std::size_t>(y * mean.cols + x)] = 1, ++n;
  return n;
}

/// See PartialMatch::ragged; the edge lies across the line from the square's middle to that of the n pixels that agree.
double raggedness(const std::vector<char>& agrees, int side, int n, const Eigen::Vector2d& middle) {
  const Eigen::Vector2d along = middle - Eigen::Vector2d::Constant(0.5 * (side - 1));
  std::vector<std::pair<double, char>> pixels;
  for (int y = 1; y + 1 < side; ++y)
    for (int x = 1; x + 1 < side; ++x) pixels.emplace_back(-along.dot(Eigen::Vector2d(x, y)), agrees[static_cast<std::size_t>(y * side + x)]);
  std::sort(pixels.begin(), pixels.end());
  const auto wrong = std::count_if(pixels.begin(), pixels.begin() + n, [](const auto& p) { return p.second == 0; });
  return static_cast<double>(wrong) / std::max(1.0, static_cast<double>(pixels.size()) - n);
}

}  // namespace

cv::Mat square(const cv::Mat& frame, const cv::Point2f& centre, int side) {
  cv::Mat out;
  cv::getRectSubPix(frame, cv::Size(side, side), centre, out, CV_32F);
  return out;
}

PartialMatch match_in_part(const cv::Mat& reference, const cv::Point2f& origin, const cv::Mat& frame, const cv::Point2f& start, int side) {
  const cv::Mat a = square(reference, origin, side);
  cv::Scalar mean, contrast;
  cv::meanStdDev(a, mean, contrast);
  PartialMatch out;
  out.at = start;
  std::vector<char> agrees;
  for (int step = 0; step < kMostSteps; ++step) {
    const cv::Mat difference = square(frame, out.at, side) - a;
    const int n = agreeing(difference, contrast[0], agrees);
    Eigen::Matrix2d S = 1e-9 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d pull = Eigen::Vector2d::Zero(), middle = Eigen::Vector2d::Zero();
    double sum = 0.0;
    for (int y = 1; y + 1 < side; ++y)
      for (int x = 1; x + 1 < side; ++x) {
        if (agrees[static_cast<std::size_t>(y * side + x)] == 0) continue;
        const double d = difference.at<float>(y, x);
        const Eigen::Vector2d g(0.5 * (a.at<float>(y, x + 1) - a.at<float>(y, x - 1)), 0.5 * (a.at<float>(y + 1, x) - a.at<float>(y - 1, x)));
        S += g * g.transpose();
        pull += d * g;
        middle += Eigen::Vector2d(x, y);
        sum += d * d;
      }
    const double many = std::max(n, 1);
    out.share = n / std::pow(side - 2.0, 2);
    out.mismatch = std::sqrt(sum / many) / std::max(contrast[0], 1e-6);
    out.covariance = 2.0 * std::max(0.5 * sum / many, kQuantisation * kQuantisation) * S.inverse();
    const Eigen::Vector2d move = -S.inverse() * pull;
    if (!(move.norm() < side)) return out.share = 0.0, out;
    if (move.norm() < 1e-3 || step + 1 == kMostSteps) {
      out.ragged = raggedness(agrees, side, n, middle / many);
      break;
    }
    out.at += cv::Point2f(static_cast<float>(move.x()), static_cast<float>(move.y()));
  }
  return out;
}

}  // namespace filum
