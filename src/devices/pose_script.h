#pragma once
// A scripted demonstration: for each tool a list of keys (time, jaw tip, handle direction, grip) read from a
// file of format filum-demonstration/1. It moves device poses and grip and nothing else; the format is
// described in pose_script.cpp. Keys may be given relative to what the hand sees when it sets out for them (sight.h, demonstrator.h).

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "devices/pose_track.h"

namespace filum {

class YamlNode;

class PoseScript {
 public:
  /// Throws InputError naming file and line, field, value and what was expected.
  static PoseScript load(const std::string& path);
  static PoseScript parse(std::string_view text, const std::string& file_name);

  const std::string& title() const noexcept { return title_; }
  bool has_tool(int tool) const noexcept;
  /// One more than the highest tool index the script moves.
  int n_tools() const noexcept;
  /// [s], time of the last key of any tool.
  double duration() const noexcept { return duration_; }
  /// Pose, grip and buttons at time t [s]; has_pose is false for a tool that the script does not move.
  /// Allocates nothing.
  DeviceSample at(int tool, double t) const noexcept;
  /// What is being told to the trainee at time t [s]; empty if nothing.
  const std::string& say(int tool, double t) const noexcept;
  /// The keys of a tool that the script moves.
  const PoseTrack& track(int tool) const { return *tracks_.at(static_cast<std::size_t>(tool)); }
  PoseTrack& track(int tool) { return *tracks_.at(static_cast<std::size_t>(tool)); }

 private:
  explicit PoseScript(const YamlNode& file);

  std::string title_;
  std::array<std::optional<PoseTrack>, kMaxTools> tracks_;
  double duration_ = 0.0;  // [s]
};

}  // namespace filum
