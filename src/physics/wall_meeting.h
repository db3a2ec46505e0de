#pragma once
// Contact of wall with wall: nodes near a cut edge against the surface of another part, pushed out of it by
//   U = k/2 sum o^2,  o = -n . (x_i - sum_k w_k x_k) > 0,
// x_k the corners of a face that node i stands before at the start of the step (a cut face if there is one, else the nearest) and n its normal there (node
// to face, both ways; Wriggers, Computational Contact Mechanics, 2006, sec. 6). Pairs are found once a step among nodes within `reach` of a face, touching or not, so that what
// touches during the step is met in it. The potential is part of the wall's own step: both sides move in one equilibrium.
// Coulomb friction holds what touched at the start of the step where it then was, by a bristle that gives limit / stick before it slips; its normal force is that of
// the start. Edges drawn over each other would else slide past the faces that they were paired with, and back in the next step, for ever.
// A lumen that is nearly shut meets itself: where a ring of inner nodes spans less than kNearlyShut of its first area, its nodes are paired with the
// inner faces across from them (an eighth of a turn away at least).
// Neglects: outer faces of one part against each other, nodes further than two rows from the cut against other parts. Test: wall_meeting_test.

#include <array>
#include <vector>

#include "collision/surface_tree.h"
#include "physics/vessel_mesh.h"

namespace filum {

inline constexpr double kNearlyShut = 0.4;

struct WallMeeting {
  int node = 0;
  Triangle face;
  Vec3 weight = Vec3::Zero();  // of the face's corners
  Vec3 normal = Vec3::Zero();  // unit, out of the face
  Vec3 from = Vec3::Zero();    // [m], x_i - sum_k w_k x_k at the start of the step
  double limit = 0.0;          // [N], of friction
};

class WallMeetings {
 public:
  WallMeetings() = default;
  WallMeetings(const VesselMesh& mesh, double reach, double stiffness);

  /// Pairs at x, to whose shape the tree's boxes have been fitted. Allocates nothing.
  void find(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x) noexcept;
  void clear() noexcept { n_ = 0; }
  /// Energy [J]; forces [N] are added to `force`.
  double add_forces(const Points& x, Points& force) const noexcept;

  int size() const noexcept { return n_; }
  const WallMeeting& operator[](int k) const noexcept { return list_[static_cast<std::size_t>(k)]; }
  double overlap(int k, const Points& x) const noexcept;  // [m], negative: apart
  double stiffness() const noexcept { return stiffness_; }
  double reach() const noexcept { return reach_; }

 private:
  Vec3 apart(const WallMeeting& m, const Points& x) const noexcept;
  void close_lumen(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x) noexcept;
  bool meet_across(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x, int node, WallMeeting& m) noexcept;
  bool meet(const VesselMesh& mesh, const SurfaceTree& tree, const Points& x, int node, WallMeeting& m) noexcept;

  double reach_ = 0.0, stiffness_ = 0.0;   // [m], [N/m]
  std::vector<std::vector<int>> rim_;      // of each part: nodes near its cut edge
  struct Ring {
    std::vector<int> nodes;                // of a lumen, in turn
    double area = 0.0;                     // [m2], at first
  };
  std::vector<Ring> rings_;
  std::vector<int> around_;                // of each inner node: which of its ring (rings past an opening begin behind it)
  std::vector<int> turn_;                  // of each part: nodes of a whole ring
  double across_ = 0.0;                    // [m], how far from the wall across is looked for
  std::vector<WallMeeting> list_;
  std::vector<int> found_;
  int n_ = 0;
};

}  // namespace filum
