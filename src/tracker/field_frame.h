#pragma once
// Where the field of the scene lies before the camera: a marker on the table is its frame W (x to the right, y away from the trainee, z up
// out of the paper). Mean of the first sightings, then fixed, since neither camera nor table moves; where later sightings say otherwise
// the frame is given up and measured again, and no tool has a pose meanwhile. Test: field_frame_test.

#include <optional>
#include <vector>

#include "base/pose.h"

namespace filum {

class FieldFrame {
 public:
  /// A sighting of the field's marker in the camera's frame.
  void take(const Pose& X_CW);
  /// Camera's frame to the field's, once it is known.
  const std::optional<Pose>& X_WC() const { return X_WC_; }
  /// [m], rms distance of the sightings from their mean.
  double spread() const { return spread_; }
  int times_lost() const { return lost_; }

  static constexpr int kSightings = 20;
  static constexpr double kMoved = 3e-3;  // [m]
  static constexpr double kTurned = 0.05; // [rad]
  static constexpr int kBelieveAfter = 10; // sightings elsewhere, in a row

 private:
  void begin();
  int n_ = 0, elsewhere_ = 0, lost_ = 0;
  Vec3 sum_ = Vec3::Zero();
  double square_ = 0.0;
  Eigen::Vector4d turn_ = Eigen::Vector4d::Zero();  // sum of quaternions on one side
  std::optional<Pose> X_WC_;
  Pose X_CW_;
  double spread_ = 0.0;
};

/// The tip of a tool in its marker's frame, from poses of the marker while the tip rests in a hollow and the handle is turned about:
///   R_i t + p_i = c for all i,  least squares for tip t and hollow c.
struct Pivot {
  Vec3 tip = Vec3::Zero();  // [m]
  double residual = 0.0;    // [m], rms of R_i t + p_i - c
  double turned = 0.0;      // [rad], largest angle between two poses
};
/// Throws InputError when the poses do not support it: fewer than 20, turned by less than 0.5 rad, residual above 2 mm.
Pivot pivot_of(const std::vector<Pose>& X_CM);

}  // namespace filum
