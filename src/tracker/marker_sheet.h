#pragma once
// Markers to print, as SVG in millimetres. Test: marker_tracker_test reads what it draws.

#include <string>
#include <vector>

namespace filum {

/// Black squares of side `side_mm`, a white rim of a quarter of it, four in a row, each with its number and size.
std::string marker_sheet_svg(const std::vector<int>& markers, double side_mm);
/// Rows of a marker's 6 x 6 cells, border included; 1 black.
std::vector<std::vector<int>> marker_cells(int marker);

}  // namespace filum
