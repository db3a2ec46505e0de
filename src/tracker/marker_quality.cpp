#include "tracker/marker_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tracker/marker_sheet.h"

namespace filum {
namespace {

constexpr int kCell = 12;                  // pixels of a straightened cell
constexpr int kRim = 1;                    // cells of the white rim that are looked at
constexpr int kCells = 6 + 2 * kRim;
constexpr int kSide = kCells * kCell;

cv::Mat straightened(const cv::Mat& grey, const std::vector<cv::Point2f>& corners) {
  const auto low = static_cast<float>(kRim * kCell) - 0.5f, high = static_cast<float>((kRim + 6) * kCell) - 0.5f;
  const cv::Point2f to[4] = {{low, low}, {high, low}, {high, high}, {low, high}};
  cv::Mat flat;
  cv::warpPerspective(grey, flat, cv::getPerspectiveTransform(corners.data(), to), {kSide, kSide}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  flat.convertTo(flat, CV_32F);
  return flat;
}

cv::Mat printed(int marker) {
  const auto cells = marker_cells(marker);
  cv::Mat picture(kSide, kSide, CV_32F, cv::Scalar(1.0));
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c)
      if (cells[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)])
        picture(cv::Rect((c + kRim) * kCell, (r + kRim) * kCell, kCell, kCell)).setTo(0.0);
  return picture;
}

double correlation(const cv::Mat& a, const cv::Mat& b) {
  const cv::Mat x = a - cv::mean(a)[0], y = b - cv::mean(b)[0];
  const double size = cv::norm(x) * cv::norm(y);
  return size > 0.0 ? x.dot(y) / size : 0.0;
}

/// Brightness across one side, from the middle of the rim to the middle of the border, mean along the side's middle four cells.
std::array<double, kCell> across(const cv::Mat& flat, int side) {
  std::array<double, kCell> profile{};
  const int begin = (kRim + 1) * kCell, end = (kRim + 5) * kCell;
  for (int k = 0; k < kCell; ++k) {
    const int in = kRim * kCell - kCell / 2 + k, at = side < 2 ? in : kSide - 1 - in;
    const cv::Mat line = side % 2 == 0 ? flat.row(at).colRange(begin, end) : flat.col(at).rowRange(begin, end);
    profile[static_cast<std::size_t>(k)] = cv::mean(line)[0];
  }
  return profile;
}

/// [cell], distance between the places where a falling profile crosses 90 % and 10 % of its height.
double width_of(const std::array<double, kCell>& profile) {
  const double high = profile.front(), low = profile.back();
  if (!(high > low)) return kCells;
  const auto crossing = [&](double share) {
    const double level = low + share * (high - low);
    for (std::size_t k = 1; k < profile.size(); ++k)
      if (profile[k] <= level) return static_cast<double>(k) - (level - profile[k]) / std::max(1e-9, profile[k - 1] - profile[k]);
    return static_cast<double>(profile.size());
  };
  return (crossing(0.1) - crossing(0.9)) / kCell;
}

}  // namespace

MarkerQuality quality_of(const cv::Mat& grey, const std::vector<cv::Point2f>& corners, int marker) {
  MarkerQuality q;
  const cv::Mat flat = straightened(grey, corners);
  q.likeness = correlation(flat, printed(marker));
  double black = 255.0, darkest = 255.0, brightest = 0.0;
  q.edge = 0.0;
  for (int side = 0; side < 4; ++side) {
    const auto profile = across(flat, side);
    black = std::min(black, profile.back());
    darkest = std::min(darkest, profile.front());
    brightest = std::max(brightest, profile.front());
    q.edge = std::max(q.edge, width_of(profile) / 6.0);
  }
  q.rim = brightest > black ? (darkest - black) / (brightest - black) : 0.0;
  return q;
}

}  // namespace filum
