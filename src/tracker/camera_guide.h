#pragma once
// Leads through the calibration of a camera: looks at one picture after another, takes a view of the board when it is held still and
// shows something that was still wanted, and says what to show next. Wanted are, as for any calibration after Zhang (camera_model.h):
// the board in each ninth of the picture (distortion is seen at the rim), tilted to four sides (a board seen straight from one distance
// cannot tell focal length from distance), and near and far. Tilts are told from the lengths of opposite sides of the board by
//   sin tilt = ln(length / opposite length) f / width,   f taken as the picture's width,
// which is good to some ten degrees and decides nothing but when a view is taken; the fit judges by the tilts it finds.
// Owns no camera and asks nobody. Test: camera_guide_test.

#include <optional>
#include <string>
#include <vector>

#include "tracker/camera_model.h"

namespace filum {

/// What a picture of the board shows of it.
struct BoardSight {
  std::vector<cv::Point2f> corners;
  double size = 0.0;           // width of the board over that of the picture
  double tilt_x = 0.0;         // [rad], right edge farther away than the left one
  double tilt_y = 0.0;         // [rad], upper edge (of the picture) farther away than the lower one
};
BoardSight sight_of(std::vector<cv::Point2f> corners, const ChessBoard& board, const cv::Size& picture);

class CameraGuide {
 public:
  explicit CameraGuide(const ChessBoard& board) : board_(board) {}

  /// Looks at a grey picture taken at `time` [s]; true when a view of it was taken. Throws InputError when the size changes.
  bool look(const cv::Mat& grey, double time);
  /// Takes the last view back.
  void undo();
  /// All that is wanted was shown.
  bool complete() const { return !next_wish().has_value(); }
  /// What to do now, in a sentence.
  std::string instruction() const;
  /// The calibration. Throws InputError with what is missing, or what the fit says.
  CameraModel calibrate() const;

  struct Wish {
    std::string what;     // "the board in the upper left of the picture"
    bool granted = false;
  };
  std::vector<Wish> wishes() const;
  const std::vector<BoardSight>& views() const { return views_; }
  /// The board in the last picture, if it was all there.
  const std::optional<BoardSight>& now() const { return now_; }
  std::vector<bool> cells() const;
  const cv::Size& picture() const { return picture_; }

  static constexpr double kStill = 0.3;         // [s] that the board rests before a view is taken
  static constexpr std::size_t kMostViews = 60;

 private:
  std::optional<std::size_t> next_wish() const;
  bool rests(const BoardSight& sight, double time);
  bool shows_something_new(const BoardSight& sight) const;

  ChessBoard board_;
  cv::Size picture_;
  std::vector<BoardSight> views_;
  std::optional<BoardSight> now_;
  bool moving_ = false;
  double rests_since_ = 0.0;   // [s]
};

}  // namespace filum
