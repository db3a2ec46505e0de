#pragma once
// A printed marker, to be drawn into pictures.

#include <opencv2/core.hpp>

#include "tracker/marker_sheet.h"

namespace filum {

/// The marker with its white rim of two cells, 24 pixels a cell.
inline cv::Mat picture_of(int marker) {
  constexpr int kCell = 24;
  cv::Mat picture(10 * kCell, 10 * kCell, CV_8U, cv::Scalar(255));
  const auto cells = marker_cells(marker);
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c)
      if (cells[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)])
        picture(cv::Rect((c + 2) * kCell, (r + 2) * kCell, kCell, kCell)).setTo(20);
  return picture;
}

}  // namespace filum
