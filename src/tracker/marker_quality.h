#pragma once
// Whether a marker's picture can be measured: is it all there, and is it sharp. Corners alone do not tell: a finger along one side moves that
// side, and blur draws all of them inwards; both look like a smaller marker, farther away.
//
//   likeness  correlation of the marker, straightened by its corners, with what was printed (black cells, white cells, white rim)
//   rim       darkest side of the white rim over the brightest, both above black
//   edge      10-90 % width of the border's edges, largest of the four sides, over the marker's side
//
// Tests: marker_quality_test, marker_tracker_test.

#include <opencv2/core.hpp>
#include <vector>

namespace filum {

struct MarkerQuality {
  double likeness = 0.0;
  double rim = 0.0;
  double edge = 1.0;
};

/// `corners` as the detector gives them: from the marker's top left, clockwise.
MarkerQuality quality_of(const cv::Mat& grey, const std::vector<cv::Point2f>& corners, int marker);

}  // namespace filum
