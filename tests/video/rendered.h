#pragma once
// Films of patterns whose motion is known exactly: a pattern is a sum of waves, evaluated where each pixel came from.

#include <array>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/rng.h"

namespace filum {

struct Waves {
  std::array<std::array<double, 4>, 10> wave{};  // kx, ky [rad/px], phase, height
  explicit Waves(std::uint64_t seed) {
    Rng rng(seed);
    for (auto& w : wave) {
      const double k = 6.283 / (6.0 + 14.0 * rng.uniform()), turn = 6.283 * rng.uniform();
      w = {k * std::cos(turn), k * std::sin(turn), 6.283 * rng.uniform(), 18.0};
    }
  }
  double operator()(double x, double y) const {
    double sum = 0.0;
    for (const auto& w : wave) sum += w[3] * std::sin(w[0] * x + w[1] * y + w[2]);
    return sum;
  }
};

/// Where the pattern's point that is seen at (x, y) in frame k was in frame 0.
using Origin = std::function<std::array<double, 2>(double x, double y, int k)>;

inline bool render(const std::string& path, int frames, int width, int height, double noise, const Waves& pattern, const Origin& origin, std::uint64_t seed, const char* codec = "FFV1",
                   double rate = 25.0) {
  cv::VideoWriter out(path, cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), rate, cv::Size(width, height), true);
  if (!out.isOpened()) return false;
  Rng rng(seed);
  for (int k = 0; k < frames; ++k) {
    cv::Mat frame(height, width, CV_8UC3);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto from = origin(x, y, k);
        const auto v = cv::saturate_cast<unsigned char>(128.0 + pattern(from[0], from[1]) + noise * rng.normal());
        frame.at<cv::Vec3b>(y, x) = {v, v, v};
      }
    out.write(frame);
  }
  return true;
}

}  // namespace filum
