#pragma once
// Tree of axis-aligned boxes over the triangles of a surface that deforms: the shape of the tree is chosen once (median cuts
// of the rest shape), the boxes are refitted from the leaves up each step. Boxes are in float, widened by their rounding.
// Measured beside FCL's trees by `filum bench blade-collision`; see DECISIONS.md for why this one is used.
// Test: surface_tree_test.

#include <array>
#include <span>
#include <vector>

#include "base/tet_mesh.h"

namespace filum {

struct Box {
  Vec3 low, high;
};

class SurfaceTree {
 public:
  SurfaceTree(std::vector<Triangle> triangles, const Points& nodes);

  /// Boxes around the triangles at these positions [m]. Allocates nothing.
  void refit(const Points& nodes) noexcept;
  /// Appends the triangles whose leaf's box meets `box`, in a fixed order, up to the capacity of `found`.
  void overlaps(const Box& box, std::vector<int>& found) const noexcept;
  /// Whether there are any.
  bool overlaps(const Box& box) const noexcept;
  const std::vector<Triangle>& triangles() const noexcept { return triangles_; }

 private:
  static constexpr int kLeaf = 4;  // triangles
  struct Node {
    std::array<float, 4> low, high;
    int first = 0, count = 0;  // leaf: triangles order_[first ...]; inner: children first and first + 1, count 0
    int corner = 0, corners = 0;  // of a leaf: corners_[corner ...]
  };
  template <class Take>
  void visit(const Box& box, const Take& take) const noexcept;
  void cut(int node, int first, int count, const Points& centres);

  void list_corners();

  std::vector<Triangle> triangles_;
  std::vector<int> order_;
  std::vector<int> used_;      // nodes of the triangles, ascending
  std::vector<float> placed_;  // four numbers for each of them: where it is
  std::vector<int> corners_;   // of each leaf, places in `used_`, each once
  std::vector<Node> nodes_;  // children come after their parent
};

}  // namespace filum
