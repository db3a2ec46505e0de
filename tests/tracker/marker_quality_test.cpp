#include "tracker/marker_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "tests/tracker/rendered.h"

namespace filum {
namespace marker_quality_test {

constexpr int kBlack = 20, kWhite = 220;

/// Marker 0 of the dictionary 4x4_50, white cells 1, as its authors publish it: not from our own drawing.
constexpr const char* kMarkerZero[4] = {"1011", "0101", "0011", "0010"};

/// With a white rim of two cells all round.
cv::Mat picture_of(int cell, int black = kBlack, int white = kWhite) {
  cv::Mat picture(10 * cell, 10 * cell, CV_8U, cv::Scalar(white));
  picture(cv::Rect(2 * cell, 2 * cell, 6 * cell, 6 * cell)).setTo(black);
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      if (kMarkerZero[r][c] == '1') picture(cv::Rect((c + 3) * cell, (r + 3) * cell, cell, cell)).setTo(white);
  return picture;
}

/// From the top left, clockwise; centres of pixels are whole numbers.
std::vector<cv::Point2f> corners_of(int cell) {
  const float low = 2.0f * static_cast<float>(cell) - 0.5f, high = 8.0f * static_cast<float>(cell) - 0.5f;
  return {{low, low}, {high, low}, {high, high}, {low, high}};
}

cv::Mat blurred(const cv::Mat& picture, double sigma) {
  cv::Mat out;
  cv::GaussianBlur(picture, out, {}, sigma);
  return out;
}

/// 10-90 % width of an edge blurred by a Gaussian over the marker's side: 2 x 1.2816 sigma.
double expected_edge(double sigma, int cell) { return 2.5631 * sigma / (6.0 * cell); }

/// A strip across the middle of one side, from outside the rim to within the border: top, left, bottom, right.
cv::Rect strip(int side, int cell, double from, double to) {
  const int begin = static_cast<int>(from * cell), size = static_cast<int>((to - from) * cell), along = 2 * cell, length = 6 * cell, far = 10 * cell - begin - size;
  if (side == 0) return {along, begin, length, size};
  if (side == 1) return {begin, along, size, length};
  if (side == 2) return {along, far, length, size};
  return {far, along, size, length};
}

TEST(MarkerQuality, AMarkerAsPrintedIsLikeItselfSharpAndHasItsRim) {
  const MarkerQuality q = quality_of(picture_of(24), corners_of(24), 0);
  EXPECT_GT(q.likeness, 0.999);
  EXPECT_NEAR(q.rim, 1.0, 1e-9);
  EXPECT_LT(q.edge, 0.012) << "a step between two of its twelve points a cell";
}

TEST(MarkerQuality, LightAndContrastDoNotCount) {
  const MarkerQuality bright = quality_of(picture_of(24, 0, 255), corners_of(24), 0), dim = quality_of(picture_of(24, 60, 100), corners_of(24), 0);
  EXPECT_NEAR(bright.likeness, dim.likeness, 1e-6);
  EXPECT_NEAR(bright.rim, dim.rim, 1e-6);
  EXPECT_NEAR(bright.edge, dim.edge, 1e-6);
}

TEST(MarkerQuality, AnotherMarkerOrOneTurnedIsUnlike) {
  const cv::Mat picture = picture_of(24);
  for (int other = 1; other < 50; ++other) EXPECT_LT(quality_of(picture, corners_of(24), other).likeness, 0.9) << other;
  auto turned = corners_of(24);
  for (int quarter = 1; quarter < 4; ++quarter) {
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    EXPECT_LT(quality_of(picture, turned, 0).likeness, 0.9) << quarter;
  }
}

TEST(MarkerQuality, AMarkerThatIsPartlyHiddenIsUnlike) {
  double before = 1.0;
  for (const int cells : {1, 2, 3}) {
    cv::Mat picture = picture_of(24);
    picture(cv::Rect(2 * 24, 2 * 24, 6 * 24, cells * 24)).setTo(kWhite);
    const double likeness = quality_of(picture, corners_of(24), 0).likeness;
    EXPECT_LT(likeness, before - 0.05) << cells;
    before = likeness;
  }
  EXPECT_LT(before, 0.7);
}

TEST(MarkerQuality, TheEdgeIsTheWidthOfTheBlurOverTheSide) {
  for (const double sigma : {4.0, 6.0}) EXPECT_NEAR(quality_of(blurred(picture_of(48), sigma), corners_of(48), 0).edge, expected_edge(sigma, 48), 0.06 * expected_edge(sigma, 48));
  const double near = quality_of(blurred(picture_of(48), 4.0), corners_of(48), 0).edge, far = quality_of(blurred(picture_of(24), 2.0), corners_of(24), 0).edge;
  EXPECT_NEAR(far, near, 0.06 * near) << "half as large and half as blurred";
}

TEST(MarkerQuality, TheMostBlurredOfTheFourSidesCounts) {
  constexpr int kCell = 48;
  const cv::Mat sharp = picture_of(kCell), soft = blurred(sharp, 6.0);
  for (int side = 0; side < 4; ++side) {
    cv::Mat picture = sharp.clone();
    soft(strip(side, kCell, 1.4, 2.6)).copyTo(picture(strip(side, kCell, 1.4, 2.6)));
    EXPECT_NEAR(quality_of(picture, corners_of(kCell), 0).edge, expected_edge(6.0, kCell), 0.06 * expected_edge(6.0, kCell)) << side;
  }
}

TEST(MarkerQuality, TheRimIsItsDarkestSideAboveBlack) {
  for (int side = 0; side < 4; ++side)
    for (const double left : {0.0, 0.25, 0.5, 0.9}) {
      cv::Mat picture = picture_of(24);
      picture(strip(side, 24, 0.0, 2.0)).setTo(kBlack + left * (kWhite - kBlack));
      EXPECT_NEAR(quality_of(picture, corners_of(24), 0).rim, left, 0.01) << side;
    }
}

TEST(MarkerQuality, WithoutContrastNothingIsSeen) {
  const MarkerQuality grey = quality_of(cv::Mat(240, 240, CV_8U, cv::Scalar(128)), corners_of(24), 0);
  EXPECT_EQ(grey.likeness, 0.0);
  EXPECT_EQ(grey.rim, 0.0);
  EXPECT_GT(grey.edge, 1.0) << "wider than the marker: no limit takes it for sharp";
  const MarkerQuality negative = quality_of(picture_of(24, kWhite, kBlack), corners_of(24), 0);
  EXPECT_LT(negative.likeness, -0.999);
  EXPECT_EQ(negative.rim, 0.0);
  EXPECT_GT(negative.edge, 1.0);
}

/// Its corners straighten it: what is tilted is no less like it, and blur in the picture is what counts.
TEST(MarkerQuality, ATiltedMarkerIsStraightened) {
  const CameraModel camera = plain_camera();
  constexpr double kSide = 24e-3;  // [m]
  Pose X_CM;
  X_CM.p = Vec3(0.002, -0.001, 0.12);
  X_CM.q = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 0.4, 0).normalized())) * Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
  cv::Mat big = blank2x(camera);
  draw(camera, picture_of(48), kSide * 10 / 6, kSide * 10 / 6, X_CM, big);
  cv::RNG random(1);
  std::vector<cv::Point2f> corners;
  for (const Vec3& corner : {Vec3(-1, 1, 0), Vec3(1, 1, 0), Vec3(1, -1, 0), Vec3(-1, -1, 0)}) {
    const cv::Point2d at = project(camera, X_CM * Vec3(0.5 * kSide * corner));
    corners.emplace_back(static_cast<float>(at.x), static_cast<float>(at.y));
  }
  const MarkerQuality sharp = quality_of(developed(big, 0.0, 0.0, random), corners, 0), soft = quality_of(developed(big, 3.0, 0.0, random), corners, 0);
  EXPECT_GT(sharp.likeness, 0.99);
  EXPECT_GT(sharp.rim, 0.99);
  EXPECT_LT(sharp.edge, 0.02);
  EXPECT_GT(soft.edge, 2.0 * sharp.edge);
}

}  // namespace marker_quality_test
}  // namespace filum
