// Squares about the points are followed by pyramidal Lucas-Kanade (Bouguet 2001): first from the frame before, for the way, then from
// the frame in which the pattern was taken, so that errors do not add up. Coarser levels of the pyramid see what moves beside the pattern
// and little of a fine one: they are asked only where the finer ones do not match. What comes over the pattern from a side is left out
// (partial_match.h). Where the pattern has changed too much (a thread that turns), it is taken anew from the frame before and the
// covariances add up from there.
// Covariance of a match: 2 s^2 (sum of grad grad^T)^-1 over the square, s^2 the noise of a pixel from the mismatch left, doubled since
// both pictures are noisy (Szeliski, Computer Vision, 2nd ed., eq. 9.35; Pan et al., Meas. Sci. Technol. 20:062001, 2009, eq. 15).
// Valid: patterns that move in the picture's plane, brightness constant. Test: tests/video/tracks_test.cpp, rendered motion.

#include "video/tracks.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <opencv2/videoio.hpp>

#include "base/error.h"
#include "video/partial_match.h"

namespace filum {
namespace {

constexpr int kLevels = 3;
constexpr double kCoarser = 0.8;       // of a finer level's mismatch, below which a coarser one's is believed
constexpr double kGoodMatch = 0.08;    // mismatch over the pattern's own contrast, both rms, that is good whatever the noise
constexpr double kWorse = 1.4;         // than against the frame before, by which a match to the first look tells that the look has changed
constexpr double kLost = 0.7;
constexpr double kInView = 0.35;       // share of the square by which a pattern is followed that something covers
constexpr double kMostly = 0.8;        // share by which it is followed wherever the rest is
constexpr double kRagged = 0.3;        // share of the rest on the wrong side of a straight edge: what covers comes from a side
const cv::TermCriteria kStop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-4);

struct Followed {
  cv::Mat reference;                   // frame in which the pattern was taken
  cv::Point2f origin, now, step;       // [px]
  Eigen::Matrix2d carried = Eigen::Matrix2d::Zero();  // covariance of `origin`
  double clean = 0.0;                  // mismatch of the first match: noise
  bool covered = false, lost = false;
};

/// Sum of grad grad^T over the square, gradients by central differences.
Eigen::Matrix2d structure_tensor(const cv::Mat& patch) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (int y = 1; y + 1 < patch.rows; ++y)
    for (int x = 1; x + 1 < patch.cols; ++x) {
      const Eigen::Vector2d g(0.5 * (patch.at<float>(y, x + 1) - patch.at<float>(y, x - 1)), 0.5 * (patch.at<float>(y + 1, x) - patch.at<float>(y - 1, x)));
      sum += g * g.transpose();
    }
  return sum;
}

bool inside(const cv::Mat& frame, const cv::Point2f& p) { return p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(frame.cols - 1) && p.y <= static_cast<float>(frame.rows - 1); }

bool flow(const cv::Mat& from, const cv::Mat& to, const cv::Point2f& start, int side, int levels, cv::Point2f& at) {
  std::vector<cv::Point2f> a = {start}, b = {at};
  std::vector<unsigned char> found;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(from, to, a, b, found, error, cv::Size(side, side), levels, kStop, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-5);
  if (found[0] == 0 || !inside(to, b[0])) return false;
  at = b[0];
  return true;
}

struct Match {
  double mismatch = 0.0;                // over the pattern's contrast
  Eigen::Matrix2d covariance;           // [px2]
};

Match judge(const cv::Mat& reference, const cv::Point2f& origin, const cv::Mat& frame, const cv::Point2f& at, int side) {
  const cv::Mat a = square(reference, origin, side), b = square(frame, at, side);
  cv::Scalar mean, spread;
  cv::meanStdDev(a, mean, spread);
  const double n = static_cast<double>(side) * side, rms = cv::norm(a, b, cv::NORM_L2) / std::sqrt(n);
  const double noise2 = std::max(0.5 * rms * rms, kQuantisation * kQuantisation);  // of one picture
  const Eigen::Matrix2d S = structure_tensor(a) + 1e-9 * Eigen::Matrix2d::Identity();
  return {rms / std::max(spread[0], 1e-6), 2.0 * noise2 * S.inverse()};
}

/// Where the square about `last` went, from the finest level that finds it; mismatch above 1 where none does.
Match way_of(const cv::Mat& before, const cv::Mat& frame, const cv::Point2f& last, int side, cv::Point2f& way) {
  const cv::Point2f guess = way;
  Match best{2.0, Eigen::Matrix2d::Identity()};
  for (int levels = 0; levels <= kLevels && best.mismatch > kGoodMatch; ++levels) {
    cv::Point2f at = guess;
    if (!flow(before, frame, last, side, levels, at)) continue;
    const Match m = judge(before, last, frame, at, side);
    if (m.mismatch < (best.mismatch > 1.0 ? 1.0 : kCoarser) * best.mismatch) best = m, way = at;
  }
  return best;
}

enum class Sight { whole, nearly_whole, part, covered, changed };

/// The pattern where it was taken first, in this frame: whole, in part beside what covers it, too little of it, or changed.
Sight look(const Followed& f, const cv::Mat& frame, const cv::Point2f& way, double step_mismatch, int side, cv::Point2f& at, Match& match) {
  at = way;
  const bool found = flow(f.reference, frame, f.origin, side, 0, at) && cv::norm(at - way) < 0.25 * side;
  if (found) match = judge(f.reference, f.origin, frame, at, side);
  const double good = std::max(kGoodMatch, kWorse * f.clean);
  if (found && match.mismatch < good) return Sight::whole;
  const PartialMatch part = match_in_part(f.reference, f.origin, frame, way, side);
  const bool edge = part.ragged < kRagged;
  if ((edge || part.share > kMostly) && part.mismatch < good && cv::norm(part.at - way) < 0.25 * side && inside(frame, part.at)) {
    at = part.at;
    match = {part.mismatch, part.covariance};
    return part.share > kMostly ? Sight::nearly_whole : part.share > kInView ? Sight::part : Sight::covered;
  }
  if (f.covered) return Sight::covered;
  return found && match.mismatch < kWorse * step_mismatch ? Sight::whole : Sight::changed;
}

void lose(Followed& f, PointTrack& track, const std::string& why) {
  f.lost = true;
  track.lost = why;
}

void follow(Followed& f, const cv::Mat& before, const cv::Mat& frame, int side, PointTrack& track, Eigen::Index k) {
  track.position.col(k).setConstant(std::numeric_limits<double>::quiet_NaN());
  track.covariance.col(k).setConstant(std::numeric_limits<double>::quiet_NaN());
  if (f.lost) return;
  const cv::Point2f last = f.now;
  cv::Point2f way = last + f.step, at;
  if (!inside(frame, way)) way = last;
  const Match step = way_of(before, frame, last, side, way);
  if (step.mismatch > 1.0) way = last + f.step;
  Match match = step;
  const Sight sight = look(f, frame, way, step.mismatch, side, at, match);
  if (sight == Sight::covered) return lose(f, track, "something came over it");
  if (sight == Sight::changed) {
    if (step.mismatch > kLost) return lose(f, track, inside(frame, last + 2 * f.step) ? "it was not found again a frame later" : "it left the picture");
    match = judge(f.reference, f.origin, before, last, side);
    f.carried += match.covariance;
    f.reference = before.clone();
    f.origin = last;
    at = way;
    match = step;
    ++track.restarts;
  }
  if (f.clean == 0.0) f.clean = match.mismatch;
  f.covered = sight == Sight::part;
  track.covered += f.covered ? 1 : 0;
  f.step = at - last;
  f.now = at;
  const Eigen::Matrix2d C = f.carried + match.covariance;
  track.position.col(k) << at.x, at.y;
  track.covariance.col(k) << C(0, 0), C(0, 1), C(1, 1);
}

void check_point(const VideoTask& task, const cv::Mat& frame, const Eigen::Vector2d& p, std::size_t i) {
  const std::string field = "points[" + std::to_string(i) + "]", found = std::to_string(p.x()) + ", " + std::to_string(p.y());
  const int half = task.patch / 2;
  if (p.x() < half || p.y() < half || p.x() > frame.cols - 1 - half || p.y() > frame.rows - 1 - half)
    throw InputError(task.file, field, found, "a point at least " + std::to_string(half) + " pixels inside the picture of " + std::to_string(frame.cols) + " x " + std::to_string(frame.rows));
  const cv::Mat patch = square(frame, cv::Point2f(static_cast<float>(p.x()), static_cast<float>(p.y())), task.patch);
  const Eigen::Matrix2d S = structure_tensor(patch);
  const double least = 0.5 * (S.trace() - std::sqrt(std::pow(S(0, 0) - S(1, 1), 2) + 4 * S(0, 1) * S(0, 1)));
  if (least < 4.0 * task.patch * task.patch) throw InputError(task.file, field, found, "a marker or texture about it that stands out in both directions");
}

}  // namespace

VideoTracks track_video(const VideoTask& task) {
  cv::VideoCapture video(task.file);
  if (!video.isOpened()) throw InputError(task.file, "video", "a file that cannot be opened", "a video that OpenCV can read");
  const double rate = video.get(cv::CAP_PROP_FPS);
  VideoTracks out;
  std::vector<double> time;
  std::vector<std::vector<Eigen::Matrix<double, 5, 1>>> rows(task.points.size());
  std::vector<Followed> followed;
  cv::Mat colour, frame, before;
  while (video.read(colour)) {
    if (colour.channels() == 1) frame = colour.clone();
    else cv::cvtColor(colour, frame, cv::COLOR_BGR2GRAY);
    const double stamp = 1e-3 * video.get(cv::CAP_PROP_POS_MSEC);
    time.push_back(rate > 0 ? static_cast<double>(time.size()) / rate : stamp);
    const bool first = before.empty();
    for (std::size_t i = 0; i < task.points.size(); ++i) {
      PointTrack one{Eigen::Matrix2Xd(2, 1), Eigen::Matrix3Xd(3, 1)};
      if (first) {
        check_point(task, frame, task.points[i], i);
        const cv::Point2f p(static_cast<float>(task.points[i].x()), static_cast<float>(task.points[i].y()));
        followed.push_back({frame.clone(), p, p, {0, 0}});
        one.position.col(0) = task.points[i];
        one.covariance.setZero();  // displacements count from here
        out.points.emplace_back();
      } else {
        follow(followed[i], before, frame, task.patch, one, 0);
      }
      out.points[i].restarts += one.restarts;
      out.points[i].covered += one.covered;
      if (!one.lost.empty()) out.points[i].lost = one.lost;
      rows[i].emplace_back();
      rows[i].back() << one.position.col(0), one.covariance.col(0);
    }
    out.width = frame.cols;
    out.height = frame.rows;
    before = frame.clone();
  }
  if (time.size() < 4) throw InputError(task.file, "frames", std::to_string(time.size()), "at least 4 frames");
  out.time = Eigen::Map<Eigen::VectorXd>(time.data(), static_cast<Eigen::Index>(time.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto n = static_cast<Eigen::Index>(rows[i].size());
    out.points[i].position.resize(2, n);
    out.points[i].covariance.resize(3, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      out.points[i].position.col(k) = rows[i][static_cast<std::size_t>(k)].head<2>();
      out.points[i].covariance.col(k) = rows[i][static_cast<std::size_t>(k)].tail<3>();
    }
  }
  return out;
}

}  // namespace filum

extern "C" void filum_track_video(const filum::VideoTask& task, filum::VideoTracks& tracks) { tracks = filum::track_video(task); }
