#include "physics/linear_fem_matrix.h"

#include <algorithm>

#include "base/ensure.h"

namespace filum {

BlockMatrix::BlockMatrix(const std::vector<std::vector<int>>& neighbours) {
  begin_.push_back(0);
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const auto self = std::lower_bound(neighbours[i].begin(), neighbours[i].end(), static_cast<int>(i));
    ENSURE(self != neighbours[i].end() && *self == static_cast<int>(i), "each row has its diagonal");
    diagonal_.push_back(begin_.back() + static_cast<int>(self - neighbours[i].begin()));
    column_.insert(column_.end(), neighbours[i].begin(), neighbours[i].end());
    begin_.push_back(static_cast<int>(column_.size()));
  }
  value_.assign(column_.size(), Mat3::Zero());
}

std::size_t BlockMatrix::find(int row, int column) const noexcept {
  const auto first = column_.begin() + begin_[static_cast<std::size_t>(row)];
  const auto last = column_.begin() + begin_[static_cast<std::size_t>(row) + 1];
  const auto at = std::lower_bound(first, last, column);
  return at != last && *at == column ? static_cast<std::size_t>(at - column_.begin()) : column_.size();
}

void BlockMatrix::add(int row, int column, const Mat3& block) noexcept {
  const std::size_t k = find(row, column);
  ASSERT(k < column_.size(), "the pattern holds the block");
  value_[k] += block;
}

Mat3 BlockMatrix::block(int row, int column) const noexcept {
  const std::size_t k = find(row, column);
  return k < column_.size() ? value_[k] : Mat3::Zero();
}

Vec3 BlockMatrix::row_times(int i, const Columns4& x) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (int k = begin_[static_cast<std::size_t>(i)]; k < begin_[static_cast<std::size_t>(i) + 1]; ++k)
    sum += value_[static_cast<std::size_t>(k)] * x.col(column_[static_cast<std::size_t>(k)]).head<3>();
  return sum;
}

void BlockMatrix::times(const Columns4& x, Columns4& y) const noexcept {
  for (int i = 0; i < n(); ++i) y.col(i).head<3>() = row_times(i, x);
}

}  // namespace filum
