#pragma once
// Grey pictures from a camera, a video or numbered pictures, with the time of each. Test: picture_source_test.

#include <chrono>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>

namespace filum {

class PictureSource {
 public:
  /// `source`: number of a camera ("0"), a video, or pictures named like view_%03d.png. Throws InputError.
  explicit PictureSource(const std::string& source);
  /// False at the end of a video, when a camera was pulled out, or at what cannot be decoded.
  bool read(cv::Mat& grey);
  /// [s], of the last picture since the source was opened: a camera's by the clock, a video's by its frame rate.
  double seconds() const { return seconds_; }
  bool is_camera() const { return camera_; }

 private:
  cv::VideoCapture capture_;
  cv::Mat frame_;
  bool camera_ = false;
  double period_ = 0.1;   // [s], of a video
  double seconds_ = 0.0;
  std::size_t frames_ = 0;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace filum
