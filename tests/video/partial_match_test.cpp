// On films: tracks_test.

#include "video/partial_match.h"

#include <gtest/gtest.h>

#include <functional>

#include "rendered.h"

namespace filum {
namespace partial_match_test {

constexpr int kSide = 21, kSize = 80;
constexpr float kMiddle = 40.0f;

/// Grey levels of a picture by pixel.
cv::Mat picture(const std::function<double(double, double)>& grey) {
  cv::Mat out(kSize, kSize, CV_8U);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) out.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(128.0 + grey(x, y));
  return out;
}

const Eigen::Vector2d kShift(0.63, -0.41);

std::function<double(double, double)> moved(const Waves& pattern) {
  return [&pattern](double x, double y) { return pattern(x - kShift.x(), y - kShift.y()); };
}

PartialMatch match(const cv::Mat& reference, const cv::Mat& frame) { return match_in_part(reference, {kMiddle, kMiddle}, frame, {kMiddle, kMiddle}, kSide); }

Eigen::Vector2d miss(const PartialMatch& m) { return Eigen::Vector2d(m.at.x, m.at.y) - Eigen::Vector2d(kMiddle, kMiddle) - kShift; }

TEST(PartialMatch, SquareIsReadBetweenPixels) {
  const cv::Mat ramp = picture([](double x, double y) { return x - 2.0 * y; });
  const cv::Mat s = square(ramp, {40.25f, 39.5f}, 5);
  EXPECT_NEAR(s.at<float>(2, 2), 128.0 + 40.25 - 79.0, 1e-3);
  EXPECT_NEAR(s.at<float>(0, 4), 128.0 + 42.25 - 75.0, 1e-3);
}

TEST(PartialMatch, FindsAShiftOfAPartOfAPixel) {
  const Waves pattern(3);
  const PartialMatch m = match(picture(pattern), picture(moved(pattern)));
  EXPECT_LT(miss(m).norm(), 0.03);  // what sampling between pixels leaves
  EXPECT_GT(m.share, 0.9);
  EXPECT_LT(m.mismatch, 0.1);
}

/// The lower third of the square is under something else, from an edge on: what is seen is found as before.
TEST(PartialMatch, LooksPastWhatCoversAPart) {
  const Waves pattern(3), cover(9);
  const auto seen = moved(pattern);
  const PartialMatch m = match(picture(pattern), picture([&](double x, double y) { return y > 44.0 ? cover(x, y) : seen(x, y); }));
  EXPECT_LT(miss(m).norm(), 0.05);
  EXPECT_GT(m.share, 0.5);
  EXPECT_LT(m.share, 0.8);
  EXPECT_LT(m.ragged, 0.2) << "a straight edge";
}

TEST(PartialMatch, AnotherPatternMatchesBadly) {
  const Waves pattern(3), other(9);
  EXPECT_GT(match(picture(pattern), picture(other)).mismatch, 0.5);
}

}  // namespace partial_match_test
}  // namespace filum
