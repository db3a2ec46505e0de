#include "physics/linear_fem_matrix.h"

#include <algorithm>
#include <cstring>

#include "base/ensure.h"

namespace filum {
namespace {

using Vec4d __attribute__((vector_size(32))) = double;

/// One column of a block as four doubles.
inline void load(const double* from, Vec4d& to) noexcept { std::memcpy(&to, from, sizeof to); }
inline void load(const float* from, Vec4d& to) noexcept {
  using Vec4f __attribute__((vector_size(16))) = float;
  Vec4f narrow;
  std::memcpy(&narrow, from, sizeof narrow);
  to = __builtin_convertvector(narrow, Vec4d);
}

}  // namespace

template <class T>
BlockMatrix<T>::BlockMatrix(const std::vector<std::vector<int>>& neighbours) {
  begin_.push_back(0);
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const auto self = std::lower_bound(neighbours[i].begin(), neighbours[i].end(), static_cast<int>(i));
    ENSURE(self != neighbours[i].end() && *self == static_cast<int>(i), "each row has its diagonal");
    diagonal_.push_back(begin_.back() + static_cast<int>(self - neighbours[i].begin()));
    column_.insert(column_.end(), neighbours[i].begin(), neighbours[i].end());
    begin_.push_back(static_cast<int>(column_.size()));
  }
  value_.assign(12 * column_.size(), T(0));
}

template <class T>
template <class S>
BlockMatrix<T>::BlockMatrix(const BlockMatrix<S>& o)
    : begin_(o.begin_), column_(o.column_), diagonal_(o.diagonal_), value_(o.value_.begin(), o.value_.end()) {}

template <class T>
std::size_t BlockMatrix<T>::find(int row, int column) const noexcept {
  const auto first = column_.begin() + begin_[static_cast<std::size_t>(row)];
  const auto last = column_.begin() + begin_[static_cast<std::size_t>(row) + 1];
  const auto at = std::lower_bound(first, last, column);
  return at != last && *at == column ? static_cast<std::size_t>(at - column_.begin()) : column_.size();
}

template <class T>
void BlockMatrix<T>::add(int row, int column, const Mat3& block) noexcept {
  const std::size_t k = find(row, column);
  ASSERT(k < column_.size(), "the pattern holds the block");
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) value_[12 * k + static_cast<std::size_t>(4 * c + r)] += static_cast<T>(block(r, c));
}

template <class T>
Mat3 BlockMatrix<T>::at(std::size_t k) const noexcept {
  Mat3 m;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) m(r, c) = static_cast<double>(value_[12 * k + static_cast<std::size_t>(4 * c + r)]);
  return m;
}

template <class T>
Mat3 BlockMatrix<T>::block(int row, int column) const noexcept {
  const std::size_t k = find(row, column);
  return k < column_.size() ? at(k) : Mat3::Zero();
}

template <class T>
Vec3 BlockMatrix<T>::sum(int from, int to, const Columns4& x) const noexcept {
  Vec4d s0 = {0, 0, 0, 0}, s1 = s0, s2 = s0, column;
  const double* const values = x.data();
  for (int k = from; k < to; ++k) {
    const double* const v = values + 4 * static_cast<std::ptrdiff_t>(column_[static_cast<std::size_t>(k)]);
    const T* const a = value_.data() + 12 * static_cast<std::ptrdiff_t>(k);
    load(a, column);
    s0 += column * v[0];
    load(a + 4, column);
    s1 += column * v[1];
    load(a + 8, column);
    s2 += column * v[2];
  }
  s0 += s1 + s2;
  return {s0[0], s0[1], s0[2]};
}

template <class T>
Vec3 BlockMatrix<T>::row_times(int i, const Columns4& x) const noexcept {
  return sum(begin_[static_cast<std::size_t>(i)], begin_[static_cast<std::size_t>(i) + 1], x);
}
template <class T>
Vec3 BlockMatrix<T>::row_times_low(int i, const Columns4& x) const noexcept {
  return sum(begin_[static_cast<std::size_t>(i)], diagonal_[static_cast<std::size_t>(i)], x);
}
template <class T>
Vec3 BlockMatrix<T>::row_times_high(int i, const Columns4& x) const noexcept {
  return sum(diagonal_[static_cast<std::size_t>(i)] + 1, begin_[static_cast<std::size_t>(i) + 1], x);
}

template <class T>
void BlockMatrix<T>::times(const Columns4& x, Columns4& y) const noexcept {
  for (int i = 0; i < n(); ++i) y.col(i).head<3>() = row_times(i, x);
}

template class BlockMatrix<double>;
template class BlockMatrix<float>;
template BlockMatrix<float>::BlockMatrix(const BlockMatrix<double>&);

}  // namespace filum
