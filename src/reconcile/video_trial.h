#pragma once
// Channels that a video of a trial gives: points with names, followed in its frames, turned into displacements of the rig.
//   suture-cantilever  clamp, tip: tip_drop (the picture's y is down), tip_reach
//   tissue-block       platen, base: displacement along the line from base to platen (shear: across it, to the right of the picture)
//   spatula-press      u1, u2 ...: how far each marker sank (the picture's y); blade: depth
// Covariances are carried along; distances are differences of points, so theirs add up. Test: video_trial_test.

#include "reconcile/dataset.h"

namespace filum {
class YamlNode;
}

namespace filum::reconcile {

struct VideoPoint {
  std::string name;
  double x = 0.0, y = 0.0;      // [px], in the first frame
};

struct VideoSetup {
  std::string file;             // path
  double scale = 0.0;           // [m], of a pixel
  double start = 0.0;           // [s], of the first frame, by the clock of the table beside it
  int patch = 21;               // [px]
  std::vector<VideoPoint> points;
};

/// Reads `video:` of a trial; refuses names that the rig does not know.
VideoSetup read_video(const YamlNode& node, const std::string& path, Rig rig);

struct VideoChannels {
  Eigen::VectorXd time;                          // [s]
  std::map<std::string, Eigen::VectorXd> value;  // [m], NaN where lost
  std::map<std::string, Eigen::VectorXd> sd;     // [m]
  std::vector<std::string> notices;
};

/// Follows the points. Throws InputError where the program has no tracker, the file is no video, or too much is lost.
VideoChannels follow_video(const VideoSetup& setup, Rig rig, const std::string& mode);

/// Names of the channels that follow_video() will give.
std::vector<std::string> channels_of(const VideoSetup& setup, Rig rig);

}  // namespace filum::reconcile
