#include "tracker/guide_program.h"

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <thread>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/utc_stamp.h"
#include "tracker/camera_guide.h"
#include "tracker/picture_source.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kEvery{150};  // between two states
constexpr int kPreviewAcross = 480;               // [px]

/// Lines of standard input as they come.
class Commands {
 public:
  /// The next one, empty if there is none yet; "quit" at the end of input.
  std::string next() {
    for (;;) {
      if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
        std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return line;
      }
      pollfd ready{STDIN_FILENO, POLLIN, 0};
      if (::poll(&ready, 1, 0) <= 0) return {};
      char bytes[256];
      const ssize_t got = ::read(STDIN_FILENO, bytes, sizeof bytes);
      if (got <= 0 || text_.size() > 4096) return "quit";
      text_.append(bytes, static_cast<std::size_t>(got));
    }
  }

 private:
  std::string text_;
};

Json result_json(const CameraModel& c) {
  return {{"residual_px", c.residual}, {"views", c.views}, {"coverage", c.coverage}, {"width", c.width}, {"height", c.height},
          {"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx}, {"cy", c.cy}, {"uncertainty", c.uncertainty}, {"distortion", c.distortion}};
}

class GuideProgram {
 public:
  explicit GuideProgram(const GuideOptions& o) : options_(o), guide_(board(o)), source_(o.source) {}

  int run() {
    auto due = Clock::now();
    for (std::string command; (command = commands_.next()) != "quit";) {
      const bool told = !command.empty();
      if (command == "undo") guide_.undo();
      if (command == "calibrate") calibrate();
      const bool took = state_ == "looking" && look();
      if (told || took || Clock::now() >= due) {
        due = Clock::now() + kEvery;
        preview();
        say();
      }
      if (state_ != "looking") std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return 0;
  }

 private:
  static ChessBoard board(const GuideOptions& o) {
    ChessBoard b;
    b.square = 1e-3 * o.square;
    return b;
  }

  bool look() {
    if (!source_.read(grey_)) {
      state_ = "ended";  // a video is over; a camera was pulled out
      return true;
    }
    const bool took = guide_.look(grey_, source_.seconds());
    if (took) trouble_.clear();  // what was missing may be there now
    return took;
  }

  void calibrate() {
    try {
      CameraModel camera = guide_.calibrate();
      camera.camera = options_.camera;
      camera.date = utc_stamp("%Y-%m-%d");
      const std::string path = options_.folder + "/camera-" + utc_stamp("%Y%m%d-%H%M%S") + ".yaml";
      std::ofstream file(path);
      file << camera.text();
      if (!file.flush()) throw InputError(path, "file", "a write error", "a folder that can be written");
      result_ = result_json(camera);
      file_ = path;
      trouble_.clear();
      state_ = "done";
    } catch (const InputError& error) {
      trouble_ = error.field + ": " + error.value + "; wanted: " + error.expected;
    }
  }

  void preview() {
    if (grey_.empty() || state_ == "done") return;
    const double scale = static_cast<double>(kPreviewAcross) / grey_.cols;
    cv::Mat small, shown;
    cv::resize(grey_, small, {}, scale, scale, cv::INTER_AREA);
    cv::cvtColor(small, shown, cv::COLOR_GRAY2BGR);
    const std::vector<bool> cells = guide_.cells();
    for (int k = 0; k < kCellColumns * kCellRows; ++k) {
      if (!cells[static_cast<std::size_t>(k)]) continue;
      const int x = k % kCellColumns * shown.cols / kCellColumns, y = k / kCellColumns * shown.rows / kCellRows;
      cv::Mat cell = shown(cv::Rect(x, y, shown.cols / kCellColumns, shown.rows / kCellRows));
      cv::addWeighted(cell, 0.75, cv::Mat(cell.size(), cell.type(), cv::Scalar(178, 114, 0)), 0.25, 0.0, cell);
    }
    if (guide_.now())
      for (const cv::Point2f& p : guide_.now()->corners)
        cv::circle(shown, {static_cast<int>(p.x * scale), static_cast<int>(p.y * scale)}, 3, cv::Scalar(0, 159, 230), cv::FILLED);
    const std::string path = options_.folder + "/preview.jpg", next = options_.folder + "/next.jpg";
    std::error_code ignored;  // an old preview is shown if the disk is full
    if (cv::imwrite(next, shown)) std::filesystem::rename(next, path, ignored);
    ++pictures_;
  }

  /// A state that nobody takes is left out: the next one is newer anyway, and a command must not wait behind it.
  void say() const {
    pollfd room{STDOUT_FILENO, POLLOUT, 0};
    if (::poll(&room, 1, 0) <= 0) return;
    Json wishes = Json::array();
    for (const CameraGuide::Wish& w : guide_.wishes()) wishes.push_back({{"what", w.what}, {"granted", w.granted}});
    constexpr double kDegree = std::numbers::pi / 180.0;
    const auto& now = guide_.now();
    const Json json = {{"state", state_},
                       {"instruction", state_ == "looking" ? guide_.instruction() : ""},
                       {"complete", guide_.complete()},
                       {"views", guide_.views().size()},
                       {"wishes", wishes},
                       {"board", now ? Json({{"size", now->size}, {"tilt_x_deg", now->tilt_x / kDegree}, {"tilt_y_deg", now->tilt_y / kDegree}}) : Json(nullptr)},
                       {"picture", pictures_},
                       {"trouble", trouble_},
                       {"file", file_},
                       {"result", result_}};
    std::printf("%s\n", json.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
    std::fflush(stdout);
  }

  const GuideOptions options_;
  CameraGuide guide_;
  PictureSource source_;
  Commands commands_;
  cv::Mat grey_;
  std::string state_ = "looking", trouble_, file_;
  Json result_ = nullptr;
  std::uint64_t pictures_ = 0;
};

}  // namespace

int run_guide(const GuideOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (!is_folder(options.folder)) throw InputError("--folder", "folder", options.folder, "a folder that can be made");
  return GuideProgram(options).run();
}

}  // namespace filum
