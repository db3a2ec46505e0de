#pragma once
// Points of a video followed through its frames, with the covariance of where they are. No OpenCV here: this is what others see.
// The library is loaded only when a dataset holds a video (reconcile/plugin.h), so nothing else needs OpenCV.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace filum {

struct VideoTask {
  std::string file;
  std::vector<Eigen::Vector2d> points;  // [px], in the first frame: x to the right, y down, centre of a pixel at whole numbers
  int patch = 21;                       // [px], side of the square that is followed, odd
};

struct PointTrack {
  Eigen::Matrix2Xd position;            // [px], of each frame; NaN where lost
  Eigen::Matrix3Xd covariance;          // [px2], xx, xy, yy
  int restarts = 0;                     // times the pattern had changed so much that it was taken anew
  int covered = 0;                      // frames in which it was followed by the part of it that nothing covered
  std::string lost = {};                   // why it was lost; empty: it never was
};

struct VideoTracks {
  Eigen::VectorXd time;                 // [s], of each frame, the first at 0
  std::vector<PointTrack> points;
  int width = 0, height = 0;            // [px]
};

/// Throws InputError for a file that is no video, or a point outside the picture or without pattern.
VideoTracks track_video(const VideoTask& task);

/// What the module filum_video.so exports.
using TrackVideo = void (*)(const VideoTask&, VideoTracks&);
inline constexpr const char* kTrackVideo = "filum_track_video";

}  // namespace filum
