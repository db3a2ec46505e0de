#include "tracker/marker_sheet.h"

#include <cstdio>
#include <opencv2/aruco.hpp>

namespace filum {

std::vector<std::vector<int>> marker_cells(int marker) {
  const cv::Ptr<cv::aruco::Dictionary> dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  cv::Mat picture;
  cv::aruco::drawMarker(dictionary, marker, 6, picture, 1);  // one pixel a cell
  std::vector<std::vector<int>> cells(6, std::vector<int>(6));
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) cells[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = picture.at<unsigned char>(r, c) < 128 ? 1 : 0;
  return cells;
}

std::string marker_sheet_svg(const std::vector<int>& markers, double side) {
  constexpr int kInRow = 4;
  const double cell = side / 6.0, pitch = 1.5 * side + 8.0;
  const double rows = static_cast<double>((markers.size() + kInRow - 1) / kInRow);
  char line[256];
  std::snprintf(line, sizeof line, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.2fmm\" height=\"%.2fmm\" viewBox=\"0 0 %.2f %.2f\">\n",
                kInRow * pitch, rows * pitch, kInRow * pitch, rows * pitch);
  std::string svg = line;
  for (std::size_t k = 0; k < markers.size(); ++k) {
    const double x = static_cast<double>(k % kInRow) * pitch + 0.25 * side, y = static_cast<double>(k / kInRow) * pitch + 0.25 * side;
    const auto cells = marker_cells(markers[k]);
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) {
        if (cells[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] == 0) continue;
        std::snprintf(line, sizeof line, "<rect x=\"%.3f\" y=\"%.3f\" width=\"%.3f\" height=\"%.3f\"/>\n", x + c * cell, y + r * cell, cell * 1.002, cell * 1.002);
        svg += line;
      }
    std::snprintf(line, sizeof line, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"3\" font-family=\"sans-serif\">%d, %.4g mm</text>\n", x,
                  y + 1.25 * side + 4.0, markers[k], side);
    svg += line;
  }
  return svg + "</svg>\n";
}

}  // namespace filum
