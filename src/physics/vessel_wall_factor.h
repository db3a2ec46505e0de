#pragma once
// A symmetric positive definite matrix of 3 x 3 blocks whose rows fall into slabs that couple with the next slab only (rings of a
// tube, columns of a card), factored once: S_k = A_kk - C_k S_k-1^-1 C_k^T. The inverses of S are kept dense in single
// precision, the couplings C sparse: a solve reads each inverse twice, grows linearly with the number of slabs, and is meant as the
// first matrix of an iteration, not as a solver. Test: vessel_wall_factor_test.

#include <Eigen/Core>
#include <vector>

#include "base/pose.h"

namespace filum {

class SlabFactor {
 public:
  struct Block {
    int row, column;  // nodes; each pair once, row >= column
    Mat3 value;
  };

  SlabFactor() = default;
  /// `slab` of each node, ascending. Blocks may repeat and are summed. Throws std::invalid_argument if a block joins slabs further
  /// apart or the matrix is not positive definite.
  SlabFactor(const std::vector<int>& slab, const std::vector<Block>& blocks);

  /// x = A^-1 b for 3 n numbers, in place. Allocates nothing.
  void solve(Eigen::Ref<Eigen::VectorXf> b) noexcept;
  /// A^-1 over the numbers of the slabs [first, last), which must not couple with others.
  Eigen::MatrixXf inverse(int first, int last) const;
  int n_slabs() const noexcept { return static_cast<int>(slabs_.size()); }

 private:
  struct Coupling {
    int row, column;  // first numbers (3 x node), row in the slab, column in the one before
    Eigen::Matrix3f value;
  };
  struct Slab {
    int first = 0, size = 0;       // numbers
    Eigen::MatrixXf inverse;
    std::vector<Coupling> before;  // to the slab before
  };
  std::vector<Slab> slabs_;
  Eigen::VectorXf work_;
};

}  // namespace filum
