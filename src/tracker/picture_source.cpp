#include "tracker/picture_source.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/error.h"

namespace filum {
namespace {

constexpr int kMostPixels = 20000;  // across or down

bool is_number(const std::string& text) { return !text.empty() && text.size() < 4 && text.find_first_not_of("0123456789") == std::string::npos; }

}  // namespace

PictureSource::PictureSource(const std::string& source) : camera_(is_number(source)), start_(std::chrono::steady_clock::now()) {
  bool open = false;
  try {
    open = camera_ ? capture_.open(std::stoi(source)) : capture_.open(source);
    const double rate = open && !camera_ ? capture_.get(cv::CAP_PROP_FPS) : 0.0;
    if (std::isfinite(rate) && rate >= 1.0 && rate <= 1000.0) period_ = 1.0 / rate;
  } catch (const cv::Exception&) {
    open = false;
  }
  if (!open) throw InputError("--source", camera_ ? "camera" : "video", source, "number of a camera that is plugged in, or a video that can be decoded");
}

bool PictureSource::read(cv::Mat& grey) {
  try {
    if (!capture_.read(frame_) || frame_.empty() || frame_.cols > kMostPixels || frame_.rows > kMostPixels) return false;
    if (frame_.depth() != CV_8U) frame_.convertTo(frame_, CV_8U, frame_.depth() == CV_16U ? 1.0 / 256.0 : 1.0);
    if (frame_.channels() == 1) frame_.copyTo(grey);
    else cv::cvtColor(frame_, grey, frame_.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  } catch (const cv::Exception&) {
    return false;
  }
  seconds_ = camera_ ? std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() : static_cast<double>(frames_) * period_;
  ++frames_;
  return true;
}

}  // namespace filum
