#include "reconcile/video_trial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/yaml_file.h"
#include "reconcile/plugin.h"
#include "video/tracks.h"

namespace filum::reconcile {
namespace {

bool is_u(const std::string& name) { return name.size() >= 2 && name[0] == 'u' && std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; }); }

bool known_point(Rig rig, const std::string& name) {
  switch (rig) {
    case Rig::suture_cantilever: return name == "clamp" || name == "tip";
    case Rig::tissue_block: return name == "platen" || name == "base";
    case Rig::spatula_press: return name == "blade" || is_u(name);
    default: return false;
  }
}

std::string wanted_points(Rig rig) {
  switch (rig) {
    case Rig::suture_cantilever: return "points named clamp and tip";
    case Rig::tissue_block: return "points named base and platen";
    case Rig::spatula_press: return "points named u1, u2 ..., or blade";
    default: return "no video: " + info(rig).name + " has none";
  }
}

VideoTracks track(const VideoSetup& setup) {
  std::string why;
  const auto function = reinterpret_cast<TrackVideo>(module_function("filum_video", kTrackVideo, &why));
  if (function == nullptr)
    throw InputError(setup.file, "file", "a video", "a .csv file: this build follows no videos (install libopencv-dev and build again)" + (why.empty() ? "" : "; " + why));
  VideoTask task;
  task.file = setup.file;
  task.patch = setup.patch;
  for (const VideoPoint& p : setup.points) task.points.emplace_back(p.x, p.y);
  VideoTracks tracks;
  function(task, tracks);
  return tracks;
}

/// What a point's track gives in a direction, with its variance.
struct Along {
  Eigen::VectorXd value, variance;  // [px], [px2]
};

Along along(const PointTrack& t, const Eigen::Vector2d& e) {
  return {t.position.transpose() * e, (e.x() * e.x() * t.covariance.row(0) + 2 * e.x() * e.y() * t.covariance.row(1) + e.y() * e.y() * t.covariance.row(2)).transpose()};
}

void put(VideoChannels& out, const std::string& name, const VideoSetup& s, const Eigen::VectorXd& value, const Eigen::VectorXd& variance) {
  out.value[name] = s.scale * value;
  out.sd[name] = s.scale * variance.cwiseMax(0.0).cwiseSqrt();
}

/// Refuses a film of which a point is lost for more than a fifth, with where, when and why; says what was lost of others.
void say_what_was_lost(const VideoSetup& setup, const VideoTracks& tracks, VideoChannels& out) {
  for (std::size_t i = 0; i < setup.points.size(); ++i) {
    const PointTrack& t = tracks.points[i];
    const std::string& name = setup.points[i].name;
    const Eigen::Index frames = tracks.time.size();
    if (!t.lost.empty()) {
      Eigen::Index k = 0;  // the last frame in which it was seen
      while (k + 1 < frames && t.position.col(k + 1).allFinite()) ++k;
      char found[200];
      std::snprintf(found, sizeof found, "lost after frame %ld of %ld (%.2f s) at x %.0f, y %.0f: %s", static_cast<long>(k) + 1, static_cast<long>(frames), tracks.time[k], t.position(0, k), t.position(1, k), t.lost.c_str());
      if (5 * (frames - 1 - k) > frames)
        throw InputError(setup.file, "point " + name, found, "a pattern that stays in view: a point further from what covers it or from the picture's border, a smaller `patch`, more frames a second, or a film that ends there");
      out.notices.push_back("point " + name + " " + found);
    }
    if (t.covered > 0) out.notices.push_back("something came over the pattern at " + name + ": in " + std::to_string(t.covered) + " of " + std::to_string(frames) + " frames it was followed by the part in view");
    if (t.restarts > 0) out.notices.push_back("the pattern at " + name + " changed and was taken anew " + std::to_string(t.restarts) + " times: its errors add up from there");
  }
}

}  // namespace

VideoSetup read_video(const YamlNode& node, const std::string& path, Rig rig) {
  VideoSetup s;
  s.file = path;
  s.scale = node.quantity("scale", "m", Range::positive());
  s.start = node.quantity_or("start", "s", 0.0);
  s.patch = node.integer_or("patch", 21, 7, 101);
  if (s.patch % 2 == 0) node.refuse("patch", "an odd number of pixels");
  for (const YamlNode& p : node.items("points")) {
    s.points.push_back({p.text("name"), p.number("x"), p.number("y")});
    if (!known_point(rig, s.points.back().name)) p.refuse("name", wanted_points(rig));
    for (std::size_t i = 0; i + 1 < s.points.size(); ++i)
      if (s.points[i].name == s.points.back().name) p.refuse("name", "each point once");
  }
  if (channels_of(s, rig).empty()) node.refuse("points", wanted_points(rig));
  return s;
}

std::vector<std::string> channels_of(const VideoSetup& setup, Rig rig) {
  const auto has = [&](const char* name) { return std::any_of(setup.points.begin(), setup.points.end(), [&](const VideoPoint& p) { return p.name == name; }); };
  if (rig == Rig::suture_cantilever) return has("clamp") && has("tip") ? std::vector<std::string>{"tip_drop", "tip_reach"} : std::vector<std::string>{};
  if (rig == Rig::tissue_block) return has("platen") && has("base") ? std::vector<std::string>{"displacement"} : std::vector<std::string>{};
  std::vector<std::string> out;
  for (const VideoPoint& p : setup.points) out.push_back(p.name == "blade" ? "depth" : p.name);
  return out;
}

VideoChannels follow_video(const VideoSetup& setup, Rig rig, const std::string& mode) {
  const VideoTracks tracks = track(setup);
  VideoChannels out;
  out.time = (tracks.time.array() + setup.start).matrix();
  const auto point = [&](const std::string& name) -> const PointTrack& {
    const auto at = std::find_if(setup.points.begin(), setup.points.end(), [&](const VideoPoint& p) { return p.name == name; });
    return tracks.points[static_cast<std::size_t>(at - setup.points.begin())];
  };
  const Eigen::Vector2d right(1, 0), down(0, 1);
  if (rig == Rig::suture_cantilever) {
    for (const auto& [name, e] : {std::pair<std::string, Eigen::Vector2d>{"tip_drop", down}, {"tip_reach", right}}) {
      const Along tip = along(point("tip"), e), clamp = along(point("clamp"), e);
      const Eigen::VectorXd gap = tip.value - clamp.value;
      put(out, name, setup, name == "tip_reach" ? Eigen::VectorXd(gap.cwiseAbs()) : gap, tip.variance + clamp.variance);
    }
  } else if (rig == Rig::tissue_block) {
    const PointTrack &platen = point("platen"), &base = point("base");
    const Eigen::Vector2d up = (platen.position.col(0) - base.position.col(0)).normalized();
    Eigen::Vector2d across(-up.y(), up.x());
    if (across.x() < 0) across = -across;
    const Eigen::Vector2d e = mode == "shear" ? across : up;
    const Along a = along(platen, e), b = along(base, e);
    const Eigen::VectorXd gap = a.value - b.value;
    put(out, "displacement", setup, (gap.array() - gap[0]).matrix(), a.variance + b.variance);
  } else {
    for (const VideoPoint& p : setup.points) {
      const Along sunk = along(point(p.name), down);
      put(out, p.name == "blade" ? "depth" : p.name, setup, (sunk.value.array() - sunk.value[0]).matrix(), sunk.variance);
    }
  }
  say_what_was_lost(setup, tracks, out);
  return out;
}

}  // namespace filum::reconcile
