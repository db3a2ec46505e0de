#pragma once
// One strict triangle of a matrix of 3x3 blocks, in the order in which a sweep reads it: nine numbers and a column a block,
// nothing between them. A step of the tissue is bound by how fast this is read, so `T` is float in the trainer.
// Vectors are four numbers a node, the fourth 0; what a kernel leaves in a fourth lane is cleared where it is stored.

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "base/pose.h"

// four doubles are handed on between functions of one file only: how, without AVX, need not agree with other compilers
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace filum {

template <class T>
struct FourOf {
  using Four __attribute__((vector_size(4 * sizeof(T)))) = T;
};
template <class T>
using Four = typename FourOf<T>::Four;

template <class T>
inline Four<T> load_four(const T* from) noexcept {
  Four<T> to;
  std::memcpy(&to, from, sizeof to);
  return to;
}
/// Stores with a zero in the fourth place.
template <class T>
inline void store_three(Four<T> v, T* to) noexcept {
  v[3] = T(0);
  std::memcpy(to, &v, sizeof v);
}
/// The same, as other numbers.
template <class Number, class T>
inline Four<Number> load_as(const T* from) noexcept {
  if constexpr (sizeof(Number) == sizeof(T)) return load_four(from);
  else return __builtin_convertvector(load_four(from), Four<Number>);
}

/// Nine numbers, by columns, times a vector.
template <class T>
inline Four<T> times_three(const T* m, const Four<T>& v) noexcept {
  return load_four(m) * v[0] + load_four(m + 3) * v[1] + load_four(m + 6) * v[2];
}

/// Rows in groups of four that do not meet each other, so that a sweep has four rows under way: of a group, the first block of
/// each row, then the second of each; shorter rows are filled up with zero blocks.
template <class T>
class TriangleRows {
 public:
  static constexpr int kGroup = 4;
  using Row = std::vector<std::pair<int, Mat3>>;  // column, block

  void clear() {
    begin_.assign(1, 0);
    column_.clear();
    value_.clear();
  }
  void add(const std::array<Row, kGroup>& rows) {
    std::size_t longest = 0;
    for (const Row& row : rows) longest = std::max(longest, row.size());
    for (std::size_t k = 0; k < longest; ++k)
      for (const Row& row : rows) {
        column_.push_back(k < row.size() ? row[k].first : 0);
        for (int c = 0; c < 9; ++c) value_.push_back(k < row.size() ? static_cast<T>(row[k].second.data()[c]) : T(0));
      }
    begin_.push_back(static_cast<int>(column_.size()) / kGroup);
  }
  void finish() { value_.insert(value_.end(), 3, T(0)); }  // the last column is read four wide

  /// The rows of a group times x; `Number`, float or double, is what is summed in.
  template <class Number>
  void times(int group, const Number* x, Four<Number>* out) const noexcept {
    Four<Number> s0[kGroup] = {}, s1[kGroup] = {}, s2[kGroup] = {};
    const int first = begin_[static_cast<std::size_t>(group)], last = begin_[static_cast<std::size_t>(group) + 1];
    const int* column = column_.data() + kGroup * static_cast<std::ptrdiff_t>(first);
    const T* a = value_.data() + 9 * kGroup * static_cast<std::ptrdiff_t>(first);
    for (int k = first; k < last; ++k)
#pragma GCC unroll 4
      for (int l = 0; l < kGroup; ++l, ++column, a += 9) {
        const Number* const v = x + 4 * static_cast<std::ptrdiff_t>(*column);
        s0[l] += load_as<Number>(a) * v[0];
        s1[l] += load_as<Number>(a + 3) * v[1];
        s2[l] += load_as<Number>(a + 6) * v[2];
      }
#pragma GCC unroll 4
    for (int l = 0; l < kGroup; ++l) out[l] = s0[l] + s1[l] + s2[l];
  }

 private:
  std::vector<int> begin_ = {0}, column_;  // begin_ counts blocks of one row
  std::vector<T> value_;
};

}  // namespace filum

#pragma GCC diagnostic pop
