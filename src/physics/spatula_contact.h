#pragma once
// Spatula on tissue: which nodes of the surface the blade has hit, where it wants them, and what they push back with, after
// Hansen et al., Med. Image Anal. 8:23 (2004), section 6.
//
// Hit (space-time projection): seen from the blade, a node went from q0 (last step) to q1 (now). It is hit if that path
// crosses the surface, or the plane within `reach` of its border. For a blade that translates this is the paper's test of
// the projection along the global translation vector, without needing one vector for all nodes.
// Moved (Eq. 8, 9):  v_new = v_old + f(d) (v_spatula - v_old),   f(d) = 1 - r d,   r = 1 / reach,
// d distance past the border. Taken for v_old as the place the tissue would have without this node's contact, Eq. 8 is a
// spring of stiffness k f/(1-f) towards v_spatula, k the node's own stiffness: rigid under the blade, gone at the reach, and
// continuous between, so that the force does not jump when a node comes or goes, however long the blade rests. The paper
// allows for a law that is not linear: with (1 - r d)^4 a node takes its load later and more evenly, and the force of the 50
// spatulas (fig. 15) has no step above 2 % of its range; with Eq. 9 as printed the largest is 9 %, without partial projection 23 %. (Read with
// v_old = last step's place, repeated steps would pull every partial node all the way; with the rest place, a node at d = reach
// would be held where the free surface has long gone.) f/(1-f) is capped at kRigid.
// A blade pushes on tissue from outside only: what it would lift by a node beside its border is not hit.
// Friction: Coulomb along the surface, a bristle between the node and the blade. A node is let go when it would be pulled.
// Symbols: d, reach [m], k [N/m]. Valid: nodes move less than the blade's size in a step. Neglects: the blade's thickness,
// tissue touching itself. Test: spatula_contact_test.

#include <span>
#include <vector>

#include "physics/linear_fem.h"
#include "physics/spatula.h"

namespace filum {

struct SpatulaParameters {
  double reach = 2e-3;      // [m], 1/r of Eq. 9, "d_projection"; about two spacings of the nodes
  double power = 4.0;       // f(d) = (1 - r d)^power; 1 is Eq. 9 as printed
  double friction = 0.2;    // [-]
  bool partial = true;      // false: only nodes under the blade are moved (for comparison)
};

/// A blade in the scene and how it moved in this step.
struct MovingBlade {
  const RigidSurface* surface = nullptr;
  Pose X_before, X_now;     // of frame T in W
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // [N], [N m], of the tissue on the blade about its tip, frame W
};

/// A node of the tissue that a blade moves. Plain data: part of the state.
struct BladeContact {
  std::int32_t node = 0, blade = 0, triangle = 0, side = 1;  // side +1: tissue where the normal points
  double normal_force = 0.0;       // [N], >= 0 pressing
  double share = 1.0;              // f(d)
  Vec3 friction = Vec3::Zero();    // [N], of the blade on the node, frame W
  Vec3 anchor_T = Vec3::Zero();    // [m], where the bristle is fixed to the blade
  std::int32_t slipping = 0;
};

class SpatulaContact {
 public:
  static constexpr double kRigid = 300.0;  // largest stiffness of a contact over that of its node

  explicit SpatulaContact(const SpatulaParameters& parameters = {}) : parameters_(parameters) {}
  void reserve(std::size_t contacts);
  /// The surface a blade can touch; from it the outward normals at rest. Without it any side is touched.
  void set_surface(const TetMesh& mesh, std::span<const Triangle> surface);

  /// Drops and finds contacts and fills moved(). `candidates`: nodes of the surface near the blades, each once at most;
  /// `seen`: displacements at the last call [m], 3 x n.
  void update(const LinearFem& fem, const Points& u, const Points& seen, std::span<const MovingBlade> blades, std::span<const int> candidates,
              std::vector<BladeContact>& contacts) noexcept;
  std::vector<MovedNode>& moved() noexcept { return moved_; }
  /// After the step of the tissue: forces of the contacts and of the blades, from moved().
  void read(const LinearFem& fem, const Points& u, std::span<MovingBlade> blades, std::vector<BladeContact>& contacts) const noexcept;

 private:
  bool keep(const LinearFem& fem, const Points& u, std::span<const MovingBlade> blades, BladeContact& c) const noexcept;
  void find(const Vec3& q0, const Vec3& q1, const MovingBlade& blade, BladeContact c, std::vector<BladeContact>& contacts) const noexcept;
  MovedNode pull(const LinearFem& fem, const Points& u, const MovingBlade& blade, BladeContact& c) const noexcept;
  double share_at(double beyond) const noexcept;
  bool from_outside(const MovingBlade& blade, const BladeContact& c, const Vec3& normal_T, double beyond) const noexcept;

  SpatulaParameters parameters_;
  std::vector<MovedNode> moved_;
  Points outward_;  // unit, 3 x n, zero inside; 3 x 0 without a surface
};

/// What a device that holds the blade at one pivot and renders three forces can show (paper, section 6, figs. 12, 13):
/// `push` [N] along the handle, `turn` [N] across it at the tip, equal in moment about the pivot.
struct PivotForce {
  Vec3 push = Vec3::Zero(), turn = Vec3::Zero();
};
/// `tip_W`: the tip; `pivot_W`: where it is held; force and torque about the tip.
PivotForce pivot_force(const Vec3& tip_W, const Vec3& pivot_W, const Vec3& force, const Vec3& torque) noexcept;

}  // namespace filum
