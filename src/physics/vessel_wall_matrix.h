#pragma once
// The wall's first matrix, part by part: tubes by Fourier's modes round their rings (RingFactor), other parts slab by slab (SlabFactor), each with
// what its inverse says between single nodes where that is not too large to keep. Test: vessel_wall_rings_test.

#include "physics/vessel_mesh.h"
#include "physics/vessel_wall_rings.h"

namespace filum {

class WallMatrix {
 public:
  WallMatrix() = default;
  /// Numbers of a node in the directions in which the blocks are given; in a tube these must be outward, along and around for it to gain.
  WallMatrix(const VesselMesh& mesh, const std::vector<SlabFactor::Block>& blocks);

  /// x = P^-1 b, in place. Allocates nothing.
  void solve(Eigen::Ref<Eigen::VectorXf> b) noexcept;
  int part_of(int node) const noexcept { return part_of_[static_cast<std::size_t>(node)]; }
  /// Is the inverse of a part kept?
  bool known(int part) const noexcept { return parts_[static_cast<std::size_t>(part)].known; }
  /// Block of P^-1 between two nodes of a part whose inverse is kept.
  Eigen::Matrix3f inverse(int row, int column) const noexcept;
  /// x -= P^-1 f, f three numbers at each of the nodes, which are of parts whose inverse is kept.
  void subtract(const std::vector<int>& nodes, const Eigen::VectorXf& f, Eigen::Ref<Eigen::VectorXf> x) noexcept;
  bool round(int part) const noexcept { return parts_[static_cast<std::size_t>(part)].rings.has_value(); }

 private:
  static constexpr int kLargestSlabs = 1200;            // nodes of a part without rings whose inverse is kept
  static constexpr std::size_t kLargestRings = 8000000;  // numbers kept of one with rings
  struct Part {
    int first = 0, n = 0;  // node
    std::optional<RingFactor> rings;
    SlabFactor slabs;
    Eigen::MatrixXf inverse;  // of one without rings
    bool known = false, asked = false;
    int from = 0;             // first ring asked about
  };
  std::vector<Part> parts_;
  std::vector<int> part_of_;
  Eigen::VectorXf work_;
};

}  // namespace filum
