#pragma once
// Symmetric sparse matrix of 3x3 blocks in rows: what the elements are assembled into. Vectors are 4 x n with a zero fourth
// row, so that a block column is one vector operation.

#include <vector>

#include "base/pose.h"

namespace filum {

using Columns4 = Eigen::Matrix4Xd;  // 3 x n padded by a row of zeros

class BlockMatrix {
 public:
  /// `neighbours` of each row: sorted columns, the diagonal among them.
  explicit BlockMatrix(const std::vector<std::vector<int>>& neighbours = {});

  int n() const noexcept { return static_cast<int>(diagonal_.size()); }
  std::size_t n_blocks() const noexcept { return column_.size(); }
  void add(int row, int column, const Mat3& block) noexcept;
  Mat3 block(int row, int column) const noexcept;  // zero where there is none
  Mat3 diagonal(int row) const noexcept { return at(static_cast<std::size_t>(diagonal_[static_cast<std::size_t>(row)])); }
  const std::vector<int>& begins() const noexcept { return begin_; }
  const std::vector<int>& columns() const noexcept { return column_; }
  Mat3 at(std::size_t k) const noexcept { return value_[k]; }

  /// Row `i` of the matrix times x.
  Vec3 row_times(int i, const Columns4& x) const noexcept;
  void times(const Columns4& x, Columns4& y) const noexcept;

 private:
  std::size_t find(int row, int column) const noexcept;

  std::vector<int> begin_, column_, diagonal_;
  std::vector<Mat3> value_;
};

}  // namespace filum
