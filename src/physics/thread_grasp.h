#pragma once
// Thread held between the flat pads of an instrument: each pad presses with the grip force N, the thread's points between the
// pads are held by an elastic stick range, and slide along the pads when the pull exceeds Coulomb's limit 2 mu N
// (friction.h; two pads, hence the factor two). A point dragged off the pad is let go.
// The grip is spread over the points that lie between the pads, given by material coordinate so that they survive
// a change of resolution. Neglects: torsional friction of the pads; compression of the thread. Test: thread_grasp_test.

#include <utility>
#include <vector>

#include "physics/rod_contact.h"

namespace filum {

/// The pads of one instrument, at the origin of the tool frame T (thread pinched where x = 0).
struct Pads {
  double half_width = 0.15e-3;  // [m], |y| of the pad
  double length = 1.5e-3;       // [m], 0 <= z <= length
  double friction = 0.25;       // [-], nylon on knurled steel
  double stiffness = 5e3;       // [N/m], of the held point, each
};

/// One held point of the thread. Part of the state.
struct GraspPoint {
  int tool = -1;
  double arc = 0.0;              // [m], material coordinate
  Vec3 anchor_T = Vec3::Zero();  // [m], where the pads hold it, tool frame
};

inline constexpr int kGraspPointsPerTool = 3;

/// Everything the step needs of one tool's grasp.
struct GraspTool {
  Pads pads;
  Pose X_now;                   // pose of T in W at present
  double grip_force = 0.0;      // [N], each pad
  Vec3 force = Vec3::Zero();    // [N], of the thread on the tool
  Vec3 torque = Vec3::Zero();   // [N m], about the origin of T
};

/// A grasp point located on the present mesh.
struct HeldPoint {
  int edge = 0;
  double s = 0.0;
  double share = 1.0;           // of the grip force of its tool
  GraspPoint point;
  FrictionPoint friction;
  Vec3 slid = Vec3::Zero();     // [m], how far it has slid along the pads in this step, frame W
};

class ThreadGrasps {
 public:
  explicit ThreadGrasps(int n_tools);
  std::vector<GraspTool> tools;

  /// Finds the edges that hold the points' material coordinates.
  void locate(const std::vector<GraspPoint>& points, const RodState& s) noexcept;
  double energy(const Points& x) const noexcept;
  void add_gradient(const Points& x, Eigen::Matrix4Xd& gradient) noexcept;
  void add_stiffness(const ChainSlots& chain, BlockCholesky& matrix) const noexcept;
  /// After the step: anchors follow what slid; points that left the pads are removed. Returns the number still held.
  int update_points(std::vector<GraspPoint>& points) const noexcept;

  const std::vector<HeldPoint>& held() const noexcept { return held_; }

 private:
  std::vector<HeldPoint> held_;
};

/// Points of the thread that lie between closed pads at X_WT: evenly spread over the stretch inside. Appends to `points`,
/// at most kGraspPointsPerTool. Returns how many were added.
int grasp_between(const Pads& pads, const Pose& X_WT, int tool, const RodState& s, double reach, std::vector<GraspPoint>& points) noexcept;

/// Edge and fraction of a material coordinate [m].
std::pair<int, double> locate_arc(const RodState& s, double arc) noexcept;
/// [m], where that place of the thread is.
inline Vec3 at_arc(const RodState& s, double arc) noexcept {
  const auto [edge, f] = locate_arc(s, arc);
  return (1.0 - f) * s.x.col(edge) + f * s.x.col(edge + 1);
}

}  // namespace filum
