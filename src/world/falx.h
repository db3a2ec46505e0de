#pragma once
// The falx between the hemispheres: a stiff sheet in a plane y = const that neither tissue nor blade crosses.
//   tissue  a node of the fissure that has come through is pulled back to the plane by a spring of kFalxStiffness times its own
//           stiffness, which is let go once the node has come back: what is left through is a thirtieth of what one node gives
//   blade   is put back as a whole along y until none of its points is beyond the sheet; the hand feels kFalxHold times the way
// Symbols: y, z [m], k [N/m]. Neglects: the give of the sheet (a dura fold of a millimetre moves under a retractor), friction on it, its
// edge. Test: falx_test.

#include <vector>

#include "world/brain_model.h"

namespace filum {

inline constexpr double kFalxStiffness = 30.0;  // times the node's own
inline constexpr double kFalxHold = 500.0;      // [N/m], felt by a hand that pushes a blade against the sheet
inline constexpr double kFalxStrongest = 5.0;   // [N], of it at most
inline constexpr double kFalxClearance = 1e-5;  // [m], kept by a blade, so that it has a side

/// Nodes that the sheet keeps on their side.
class FalxContact {
 public:
  FalxContact() = default;
  /// Nodes of the surface that lie beside the sheet at rest, up to `kBeside` away.
  FalxContact(const FalxSheet& sheet, const TetMesh& mesh, const std::vector<int>& surface_nodes, const std::vector<int>& held);

  /// Appends the springs of the nodes that have come through.
  void append(const LinearFem& fem, const Points& u, std::vector<MovedNode>& moved) const noexcept;
  std::size_t size() const noexcept { return nodes_.size(); }

 private:
  struct Node {
    int node = 0;
    double side = 1.0;
  };
  FalxSheet sheet_;
  std::vector<Node> nodes_;
};

/// The pose put back to the side of the sheet on which the blade was, judged by its points; `before` was on one side.
Pose beside_falx(const FalxSheet& sheet, const RigidSurface& blade, const Pose& before, const Pose& now) noexcept;

}  // namespace filum
