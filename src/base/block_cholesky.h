#pragma once
// Sparse Cholesky factorisation of a symmetric positive definite matrix made of 4 x 4 blocks: the shape of every linear
// system of a discrete elastic rod (three coordinates and one twist angle a node). The block graph is a chain with a few
// long-range edges where strands touch, so a minimum-degree order keeps the factor nearly as sparse as the chain.
// Method: George & Liu, Computer Solution of Large Sparse Positive Definite Systems, 1981, ch. 5 (minimum degree on
// the elimination graph, kept as bit rows) and a right-looking block factorisation with a precomputed update map.
// Nothing allocates after the constructor as long as the fill stays below its reserve.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace filum {

using Mat4 = Eigen::Matrix4d;

/// The 3 x 3 block of the coordinates of a node, with nothing for its twist.
inline Mat4 pad(const Eigen::Matrix3d& k) noexcept {
  Mat4 m = Mat4::Zero();
  m.topLeftCorner<3, 3>() = k;
  return m;
}

class BlockCholesky {
 public:
  /// Where a block of the matrix lives; a slot found for (i, j) serves add() for exactly that order of i and j.
  struct Slot {
    int index = -1;
    bool transposed = false;
  };

  explicit BlockCholesky(int max_nodes);

  /// Starts a new pattern of `n` block rows (n <= max_nodes) with its diagonal only.
  void begin_pattern(int n) noexcept;
  /// Declares that block (i, j), i != j, may be non-zero. Repeats are harmless.
  void connect(int i, int j) noexcept;
  /// Orders and prepares the factor for the declared pattern. Costs about as much as one factorisation.
  void analyse() noexcept;

  Slot find(int i, int j) const noexcept;

  void set_zero() noexcept;
  void add_diagonal(int i, const Mat4& block) noexcept { diagonal_[position_[i]] += block; }
  void add(Slot slot, const Mat4& block) noexcept {
    if (slot.transposed)
      lower_[slot.index] += block.transpose();
    else
      lower_[slot.index] += block;
  }

  /// Factorises in place. False if a pivot block is not positive definite; the matrix must then be assembled again.
  bool factor() noexcept;
  /// Solves A x = b in place; b is 4 x n, one column a block row.
  void solve(Eigen::Ref<Eigen::Matrix4Xd> b) const noexcept;

  int size() const noexcept { return n_; }
  int n_blocks() const noexcept { return static_cast<int>(row_.size()); }  // off-diagonal blocks of the factor

 private:
  void order() noexcept;
  void build_structure() noexcept;
  void build_updates() noexcept;

  int n_ = 0;
  int words_ = 0;
  std::vector<std::uint64_t> graph_;   // n x words, adjacency of the pattern, original numbering
  std::vector<std::uint64_t> fill_;    // the same, with fill, as elimination goes on
  std::vector<int> order_;             // order_[k] = node eliminated k-th
  std::vector<int> position_;          // inverse of order_
  std::vector<int> degree_;
  std::vector<std::uint64_t> of_degree_;  // n x words, the remaining nodes of each degree
  std::vector<int> column_start_;      // n + 1
  std::vector<int> row_;               // positions, ascending in each column
  std::vector<int> update_;            // target block of each (a, b), a > b, pair of each column, column by column
  std::vector<Mat4> diagonal_;         // factor: L_kk^-1 (lower) after factor()
  std::vector<Mat4> lower_;            // L_ik
};

}  // namespace filum
