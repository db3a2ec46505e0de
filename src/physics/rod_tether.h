#pragma once
// Points of the thread that something soft holds: the swage of a needle (thread's end), and the rings of a needle track that the
// thread runs through.
//
//   U = 1/2 d^T K d + phi(u) + c/(2 dt) (u - u_0)^2,   d = x(arc) - anchor,   u = d . along
// K is the stiffness of what holds the point, condensed to it: for a body of a few coordinates q with stiffness H, K = (J H^-1 J^T)^-1, so
// that thread and body move as if they were solved together (static condensation; exact for a linear body). phi is Coulomb friction
// along the thread with an elastic stick range (friction.h): k_t u^2/2 up to the limit, |u| times the limit beyond; c is a speed term.
// With `across` the tether is a surface: friction acts in the plane of both directions, u being the length of the slip (isotropic Coulomb), without drag, and
// K only pushes, along x across. Newton's tangent of a slip has no stiffness along it: from a slip the iteration goes past the place where friction would stick, is
// thrown back, and so on. Once a slip has turned round within a step, its matrix is that of the parabola that touches the energy there and lies above it
// everywhere, limit/|u| in the whole plane (majorant: Hunter & Lange, Am. Stat. 58:30, 2004), whose steps never lead past the least.
// A ring stays where it is and the thread slides through it: its material coordinate goes back by what was slid.
// Neglects: bending moments at a held point. Test: rod_tether_test.

#include <vector>

#include "base/block_cholesky.h"
#include "physics/elastic_rod.h"

namespace filum {

struct RodTether {
  double arc = 0.0;                  // [m], material coordinate; ignored at the end
  bool at_end = false;               // holds the last node
  Vec3 anchor = Vec3::Zero();        // [m], frame W, at the end of the step
  Mat3 stiffness = Mat3::Zero();     // [N/m], positive semidefinite
  Vec3 along = Vec3::Zero();         // unit, direction of growing arc; zero: no friction
  Vec3 across = Vec3::Zero();        // unit, normal to `along`: surface in their plane; zero: a ring
  double limit = 0.0;                // [N], Coulomb friction
  double stick = 0.0;                // [N/m], before it slips
  double drag = 0.0;                 // [N s/m]
  double start = 0.0;                // [m], u at the start of the step
  bool one_way = false;              // resists u > 0 only
  // Results
  int edge = 0;
  double s = 0.0;
  Vec3 force = Vec3::Zero();         // [N], on the thread
  double slid = 0.0;                 // [m], of the thread through the ring, towards growing arc; in a plane its length
  // Of the step's iterations
  Vec3 slip = Vec3::Zero();          // [m], in a plane
  bool turned = false;               // it has turned round
};

class RodTethers {
 public:
  explicit RodTethers(int capacity) { list.reserve(static_cast<std::size_t>(capacity)); }
  std::vector<RodTether> list;

  void locate(const RodState& s) noexcept;
  double energy(const Points& x, double dt) const noexcept;
  void add_gradient(const Points& x, double dt, Eigen::Matrix4Xd& gradient) noexcept;
  void add_stiffness(const Points& x, double dt, const ChainSlots& chain, BlockCholesky& matrix) const noexcept;
};

}  // namespace filum
