#include "tracker/camera_guide.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace filum {
namespace {

constexpr double kMotion = 1.5e-3;  // of the picture's width, most that a corner moves between pictures of a board at rest
constexpr double kTilted = 0.35;    // [rad]
constexpr double kNear = 0.45, kFar = 0.30;  // width of the board over that of the picture
constexpr std::size_t kLeastViews = 10;
constexpr std::size_t kCellsOfNinth = 3;     // of six, that corners must have been in
constexpr std::size_t kNewCells = 4;

constexpr std::array<const char*, 9> kNinths = {"upper left", "upper middle", "upper right", "middle left", "middle",
                                                "middle right", "lower left", "lower middle", "lower right"};

std::size_t covered_in(const std::vector<bool>& cells, std::size_t ninth) {
  std::size_t n = 0;
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t c = 0; c < 3; ++c) n += cells[(2 * (ninth / 3) + r) * kCellColumns + 3 * (ninth % 3) + c] ? 1 : 0;
  return n;
}

std::vector<std::vector<cv::Point2f>> corners_of(const std::vector<BoardSight>& views) {
  std::vector<std::vector<cv::Point2f>> all;
  for (const BoardSight& v : views) all.push_back(v.corners);
  return all;
}

double length(const cv::Point2f& a, const cv::Point2f& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

BoardSight sight_of(std::vector<cv::Point2f> corners, const ChessBoard& board, const cv::Size& picture) {
  const auto columns = static_cast<std::size_t>(board.columns), rows = static_cast<std::size_t>(board.rows);
  // The detector may begin at either end: the four outer corners by where they stand in the picture.
  std::array<cv::Point2f, 4> outer = {corners[0], corners[columns - 1], corners[rows * columns - 1], corners[(rows - 1) * columns]};
  std::sort(outer.begin(), outer.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  const auto by_x = [](const auto& a, const auto& b) { return a.x < b.x; };
  std::sort(outer.begin(), outer.begin() + 2, by_x);
  std::sort(outer.begin() + 2, outer.end(), by_x);
  const double top = length(outer[0], outer[1]), bottom = length(outer[2], outer[3]), left = length(outer[0], outer[2]), right = length(outer[1], outer[3]);
  const double across = 0.5 * (top + bottom), down = 0.5 * (left + right), f = picture.width;
  const auto tilt = [&](double near, double far, double side) { return std::asin(std::clamp(std::log(near / far) * f / side, -1.0, 1.0)); };
  BoardSight sight;
  sight.size = std::max(across, down) / picture.width;
  sight.tilt_x = tilt(left, right, std::max(across, 1.0));
  sight.tilt_y = tilt(bottom, top, std::max(down, 1.0));
  sight.corners = std::move(corners);
  return sight;
}

std::vector<bool> CameraGuide::cells() const { return covered_cells(corners_of(views_), picture_); }

std::vector<CameraGuide::Wish> CameraGuide::wishes() const {
  std::vector<Wish> list;
  const std::vector<bool> seen = cells();
  for (std::size_t k = 0; k < kNinths.size(); ++k)
    list.push_back({std::string("the board in the ") + kNinths[k] + " of the picture", covered_in(seen, k) >= kCellsOfNinth});
  const auto wish = [&](const char* what, auto&& grants) {
    Wish& w = list.emplace_back();
    w.what = what;
    w.granted = std::any_of(views_.begin(), views_.end(), grants);
  };
  wish("its right edge tilted away from the camera", [](const BoardSight& v) { return v.tilt_x > kTilted; });
  wish("its left edge tilted away from the camera", [](const BoardSight& v) { return v.tilt_x < -kTilted; });
  wish("its upper edge tilted away from the camera", [](const BoardSight& v) { return v.tilt_y > kTilted; });
  wish("its lower edge tilted away from the camera", [](const BoardSight& v) { return v.tilt_y < -kTilted; });
  wish("the board near, half as wide as the picture", [](const BoardSight& v) { return v.size > kNear; });
  wish("the board far, less than a third as wide as the picture", [](const BoardSight& v) { return v.size < kFar; });
  return list;
}

std::optional<std::size_t> CameraGuide::next_wish() const {
  const std::vector<Wish> list = wishes();
  const auto open = std::find_if(list.begin(), list.end(), [](const Wish& w) { return !w.granted; });
  if (open != list.end()) return static_cast<std::size_t>(open - list.begin());
  return views_.size() < kLeastViews ? std::optional(list.size()) : std::nullopt;
}

bool CameraGuide::rests(const BoardSight& sight, double time) {
  double most = 0.0;
  if (now_)
    for (std::size_t k = 0; k < sight.corners.size(); ++k) most = std::max(most, length(sight.corners[k], now_->corners[k]));
  moving_ = !now_ || most > kMotion * picture_.width;
  if (moving_) rests_since_ = time;
  return time - rests_since_ >= kStill;
}

bool CameraGuide::shows_something_new(const BoardSight& sight) const {
  if (views_.size() >= kMostViews) return false;
  CameraGuide with = *this;
  with.views_.push_back(sight);
  const std::vector<Wish> before = wishes(), after = with.wishes();
  for (std::size_t k = 0; k < before.size(); ++k)
    if (after[k].granted && !before[k].granted) return true;
  const auto count = [](const std::vector<bool>& cells) { return static_cast<std::size_t>(std::count(cells.begin(), cells.end(), true)); };
  if (count(with.cells()) >= count(cells()) + kNewCells) return true;
  // Views for the least number: anywhere that no view was before.
  const bool elsewhere = std::all_of(views_.begin(), views_.end(), [&](const BoardSight& v) {
    return length(v.corners.front(), sight.corners.front()) > 0.05 * picture_.width || std::hypot(v.tilt_x - sight.tilt_x, v.tilt_y - sight.tilt_y) > 0.2;
  });
  return views_.size() < kLeastViews && elsewhere;
}

bool CameraGuide::look(const cv::Mat& grey, double time) {
  if (picture_.empty()) picture_ = grey.size();
  if (picture_ != grey.size())
    throw InputError("camera calibration", "picture", std::to_string(grey.cols) + " x " + std::to_string(grey.rows), "pictures of one size");
  std::vector<cv::Point2f> corners = find_board(grey, board_);
  if (corners.empty()) {
    now_.reset();
    return false;
  }
  BoardSight sight = sight_of(std::move(corners), board_, picture_);
  const bool take = rests(sight, time) && shows_something_new(sight);
  if (take) views_.push_back(sight);
  now_ = std::move(sight);
  return take;
}

void CameraGuide::undo() {
  if (!views_.empty()) views_.pop_back();
}

std::string CameraGuide::instruction() const {
  const auto open = next_wish();
  if (!open) return "Everything was shown: calibrate now";
  if (!now_) return "Show the whole board to the camera";
  const std::vector<Wish> list = wishes();
  const std::string wish = *open < list.size() ? list[*open].what : "the board from another side, " + std::to_string(kLeastViews - views_.size()) + " times more";
  return std::string(moving_ ? "Show " : "Keep it still, or show ") + wish;
}

CameraModel CameraGuide::calibrate() const {
  const std::vector<Wish> list = wishes();
  std::size_t ninths = 0, tilts = 0;
  for (std::size_t k = 0; k < 9; ++k) ninths += list[k].granted ? 1 : 0;
  for (std::size_t k = 9; k < 13; ++k) tilts += list[k].granted ? 1 : 0;
  if (ninths < 7) throw InputError("camera calibration", "views", std::to_string(ninths) + " of 9 parts of the picture covered", "at least 7: distortion is seen at the rim");
  if (tilts < 3) throw InputError("camera calibration", "views", "the board tilted to " + std::to_string(tilts) + " of 4 sides", "at least 3: focal length is told by tilts");
  return calibrate_views(corners_of(views_), picture_, board_);
}

}  // namespace filum
