#pragma once
// The path of one tool through its keys: position and grip by monotone cubic, arcs about an axis with
// minimum-jerk timing (T. Flash and N. Hogan, J. Neurosci. 5 (1985) 1688-1703), orientation by slerp with
// smoothstep timing.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/pose.h"
#include "devices/device.h"
#include "devices/hand_tremor.h"
#include "devices/sight.h"

namespace filum {

/// The tip goes round an axis on its way to a key; radius and height along the axis change linearly with the
/// angle.
struct PoseArc {
  Vec3 centre_W = Vec3::Zero();  // [m], a point on the axis
  Vec3 axis_W = Vec3::UnitY();   // unit; right-hand rule gives the positive sense
  double turns = 0.0;            // [1], signed
};

struct PoseKey {
  double t = 0.0;              // [s]
  Vec3 p_W = Vec3::Zero();     // [m], jaw tip
  Quat q = Quat::Identity();   // unit; z towards the handle, x the way the jaws open
  double grip_angle = 0.0;     // [rad]
  double grip_force = 0.0;     // [N]
  std::uint32_t buttons = 0;   // held from this key to the next
  bool stop = false;           // velocity is zero here
  std::optional<PoseArc> arc;  // how the tip gets here from the key before
  std::string say;             // told to the trainee from here to the next key that says something
  int look = -1;               // of the track's looks, in whose frame pose and arc are; -1 the scene
  double until_pull = 0.0;     // [N], the hand stops on its way here when it feels as much; 0 never
  bool keeps_place = false;    // gives no place of its own, nor (next) a direction: those of the key before
  bool keeps_turn = false;
};

/// What the hand looks at when it sets out for the first of the keys given in its frame, that is at the key before.
struct PoseLook {
  Look at;
  bool follow = false;          // it goes on looking until it has got to the last of these keys
  std::optional<double> bring;  // [m], arc of the needle: the keys are poses of the needle there, and the tool carries it as it then holds it
};

/// Point at fraction s of the arc from p0 to p1 (both [m], frame W).
Vec3 arc_point(const PoseArc& arc, const Vec3& p0, const Vec3& p1, double s) noexcept;

/// Whole turns from p0 to p1 about the arc's axis that come nearest to arc.turns.
double fitting_turns(const PoseArc& arc, const Vec3& p0, const Vec3& p1) noexcept;

/// Where the tip ends when it goes round by arc.turns from p0, to `radius` [m] and `rise` [m] further along
/// the axis.
Vec3 arc_end(const PoseArc& arc, const Vec3& p0, double radius, double rise) noexcept;

/// Distance of a point from the arc's axis [m].
double axis_distance(const PoseArc& arc, const Vec3& p) noexcept;

/// Keys must be non-empty with strictly growing times. at() allocates nothing. A key whose look has not been taken yet stays where the
/// hand then stands, at rest.
class PoseTrack {
 public:
  PoseTrack(int tool, std::vector<PoseKey> keys, bool has_grip_force, std::vector<PoseLook> looks = {});

  /// The next look to be taken, null if there is none (left), and when [s].
  const PoseLook* next_look() const noexcept { return taken_ < looks_.size() ? &looks_[taken_] : nullptr; }
  double look_time() const noexcept;
  /// Takes it: X_WF is the frame seen; X_AT the tool in the frame of the needle it brings, identity if it brings none.
  void set_out(const Pose& X_WF, const Pose& X_AT);
  /// What the hand follows at time t [s] on its way, null if nothing (left).
  const PoseLook* followed(double t) const noexcept;
  /// Moves the frame that is followed towards where it is seen now, as far as a hand gets in `dt` [s]. Allocates nothing.
  void follow(const Pose& X_WF, double dt) noexcept;
  /// [N], at which the hand stops on its way at time t [s]; 0: it does not.
  double stops_at_pull(double t) const noexcept;
  /// It stops where it is at time t [s] and stays for the rest of the way to the next key. Allocates nothing.
  void halt(double t) noexcept;

  /// Adds a tremor to the tip from now on.
  void shake(const HandTremor& tremor) { tremor_ = tremor; }

  int tool() const noexcept { return tool_; }
  const std::vector<PoseKey>& keys() const noexcept { return keys_; }
  /// Sample at time t [s]; before the first key the first pose, after the last key the last.
  DeviceSample at(double t) const noexcept;
  /// Index of the last key at or before t; 0 before the first.
  std::size_t key_at(double t) const noexcept;

 private:
  DeviceSample steady_at(double t) const noexcept;
  std::size_t first_of(std::size_t look) const noexcept;
  void place_keys(std::size_t look) noexcept;
  void keep_from(std::size_t i) noexcept;
  void smooth() noexcept;
  bool at_rest(std::size_t i, bool tip) const noexcept;
  Vec3 tip_in_segment(std::size_t i, double u) const noexcept;

  int tool_;
  std::vector<PoseKey> keys_;          // those of looks not taken yet rest where the hand is
  std::vector<PoseKey> written_;       // as read, in their frames
  std::vector<PoseLook> looks_;
  std::size_t taken_ = 0;              // looks
  Pose X_WF_, X_AT_;                   // of the last look taken
  std::size_t halted_ = 0;             // key on the way to which the hand stopped last
  bool has_grip_force_;
  std::optional<HandTremor> tremor_;
  std::vector<Vec3> tip_slopes_;      // [m/s]
  std::vector<double> angle_slopes_;  // [rad/s]
  std::vector<double> force_slopes_;  // [N/s]
};

}  // namespace filum
