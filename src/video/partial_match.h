#pragma once
// A pattern of which something covers a part (the edge of a platen, a blade, a drop): shift by least squares over the pixels that still agree, found anew in each
// iteration (Hager & Belhumeur, IEEE Trans. PAMI 20:1025, 1998, section 5; weights 0 or 1). A pixel agrees where the mismatch about it is below three times that of
// the best third. Valid: a third of the square or more in view, start within about a quarter of the pattern's wave. Test: tracks_test.

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace filum {

/// A square of this side about a point between pixels, 32-bit floats.
cv::Mat square(const cv::Mat& frame, const cv::Point2f& centre, int side);

inline constexpr double kQuantisation = 0.29;  // [grey levels], rms of rounding to whole levels

struct PartialMatch {
  cv::Point2f at;                // [px]
  double share = 0.0;            // of the square that agrees
  double mismatch = 1.0;         // there, rms over the pattern's contrast
  double ragged = 1.0;           // share of what disagrees that no straight edge parts from what agrees: 0 where something comes over it from a side
  Eigen::Matrix2d covariance;    // [px2]
};

PartialMatch match_in_part(const cv::Mat& reference, const cv::Point2f& origin, const cv::Mat& frame, const cv::Point2f& start, int side);

}  // namespace filum
