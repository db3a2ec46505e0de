#pragma once
// A camera: pinhole with Brown's distortion, calibrated from pictures of a chessboard (Z. Zhang, IEEE PAMI 22 (2000) 1330, as
// OpenCV does it), kept in a file of format filum-camera/1. Test: camera_model_test.

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace filum {

struct CameraModel {
  int width = 0, height = 0;                 // [px]
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // [px]
  std::array<double, 5> distortion{};        // k1 k2 p1 p2 k3
  double residual = 0.0;                     // [px], rms of the calibration
  int views = 0;
  std::array<double, 4> uncertainty{};       // [px], one standard deviation of fx fy cx cy; 0 where not known
  double coverage = 0.0;                     // share of the picture's 9 x 6 cells in which corners were seen
  std::string camera, date;                  // whose, when; for people

  cv::Matx33d matrix() const { return {fx, 0, cx, 0, fy, cy, 0, 0, 1}; }
  /// Throws InputError.
  static CameraModel load(const std::string& path);
  static CameraModel parse(const std::string& text, const std::string& file_name);
  std::string text() const;
};

struct ChessBoard {
  int columns = 9, rows = 6;   // inner corners
  double square = 10e-3;       // [m]
};

/// Inner corners of the board in a grey picture, to sub-pixels; empty where not all are seen. Searched for in a picture of at most 960 px
/// across, since a large one without a board takes seconds.
std::vector<cv::Point2f> find_board(const cv::Mat& grey, const ChessBoard& board);

/// Cells of a 9 x 6 grid over the picture, row by row: true where corners of any view lie.
std::vector<bool> covered_cells(const std::vector<std::vector<cv::Point2f>>& views, const cv::Size& picture);
inline constexpr int kCellColumns = 9, kCellRows = 6;

/// From the corners of several views. Throws InputError with the reason when they do not support a calibration: too few, all from the
/// same side, residual above a pixel.
CameraModel calibrate_views(const std::vector<std::vector<cv::Point2f>>& views, const cv::Size& picture, const ChessBoard& board);

/// From grey pictures. Throws InputError with the reason when they do not support a calibration: too few with the whole
/// board, or as above.
CameraModel calibrate_camera(const std::vector<cv::Mat>& pictures, const ChessBoard& board);

}  // namespace filum
