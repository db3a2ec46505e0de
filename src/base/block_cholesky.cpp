#include "base/block_cholesky.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/stage_clock.h"

namespace filum {
namespace {

constexpr int kReservePerNode = 24;  // blocks a column; a tight knot of 300 nodes uses about 8

/// L^-1 of the Cholesky factor L of the symmetric 4 x 4 matrix in `a` (lower half read), written over it. Without loops, which
/// take longer than what they repeat.
bool invert_factor(Mat4& a) noexcept {
  const double p0 = a(0, 0), r0 = 1.0 / std::sqrt(p0);
  const double l10 = a(1, 0) * r0, l20 = a(2, 0) * r0, l30 = a(3, 0) * r0;
  const double p1 = a(1, 1) - l10 * l10, r1 = 1.0 / std::sqrt(p1);
  const double l21 = (a(2, 1) - l20 * l10) * r1, l31 = (a(3, 1) - l30 * l10) * r1;
  const double p2 = a(2, 2) - l20 * l20 - l21 * l21, r2 = 1.0 / std::sqrt(p2);
  const double l32 = (a(3, 2) - l30 * l20 - l31 * l21) * r2;
  const double p3 = a(3, 3) - l30 * l30 - l31 * l31 - l32 * l32, r3 = 1.0 / std::sqrt(p3);
  const auto positive = [&](double pivot, int j) { return pivot > 1e-13 * std::abs(a(j, j)); };
  if (!positive(p0, 0) || !positive(p1, 1) || !positive(p2, 2) || !positive(p3, 3)) return false;
  const double i10 = -l10 * r0 * r1, i21 = -l21 * r1 * r2, i32 = -l32 * r2 * r3;
  const double i20 = -(l20 * r0 + l21 * i10) * r2, i31 = -(l31 * r1 + l32 * i21) * r3;
  a.col(0) << r0, i10, i20, -(l30 * r0 + l31 * i10 + l32 * i20) * r3;
  a.col(1) << 0.0, r1, i21, i31;
  a.col(2) << 0.0, 0.0, r2, i32;
  a.col(3) << 0.0, 0.0, 0.0, r3;
  return true;
}

/// The first bit set from `from` on, round about; -1 if none is.
int next_bit(const std::uint64_t* row, int words, int from) noexcept {
  for (int k = 0, w = from / 64; k <= words; ++k, w = w + 1 < words ? w + 1 : 0) {
    std::uint64_t bits = row[w];
    if (k == 0) bits &= ~std::uint64_t{0} << (from % 64);
    if (bits != 0) return w * 64 + std::countr_zero(bits);
  }
  return -1;
}

}  // namespace

BlockCholesky::BlockCholesky(int max_nodes) {
  const auto n = static_cast<std::size_t>(max_nodes);
  const std::size_t words = (n + 63) / 64;
  graph_.reserve(n * words);
  fill_.reserve(n * words);
  order_.reserve(n);
  position_.reserve(n);
  degree_.reserve(n);
  of_degree_.reserve(n * words);
  column_start_.reserve(n + 1);
  row_.reserve(n * kReservePerNode);
  update_.reserve(n * kReservePerNode * 8);
  diagonal_.reserve(n);
  lower_.reserve(n * kReservePerNode);
}

void BlockCholesky::begin_pattern(int n) noexcept {
  n_ = n;
  words_ = (n + 63) / 64;
  graph_.assign(static_cast<std::size_t>(n) * words_, 0);
}

void BlockCholesky::connect(int i, int j) noexcept {
  graph_[static_cast<std::size_t>(i) * words_ + j / 64] |= std::uint64_t{1} << (j % 64);
  graph_[static_cast<std::size_t>(j) * words_ + i / 64] |= std::uint64_t{1} << (i % 64);
}

void BlockCholesky::analyse() noexcept {
  order();
  build_structure();
  build_updates();
  diagonal_.resize(static_cast<std::size_t>(n_));
  lower_.resize(row_.size());
}

// Minimum degree: eliminate the node with the fewest neighbours, join its neighbours to each other, repeat. Of several
// such nodes the next one along the chain goes first. Nodes of each degree are kept as bit rows, so that it is found at once.
void BlockCholesky::order() noexcept {
  fill_ = graph_;
  order_.clear();
  position_.assign(static_cast<std::size_t>(n_), -1);
  degree_.assign(static_cast<std::size_t>(n_), 0);
  of_degree_.assign(static_cast<std::size_t>(n_) * words_, 0);
  const auto row = [&](std::vector<std::uint64_t>& rows, int i) { return &rows[static_cast<std::size_t>(i) * words_]; };
  const auto bit = [](int i) { return std::uint64_t{1} << (i % 64); };
  const auto place = [&](int i) {
    const std::uint64_t* neighbours = row(fill_, i);
    degree_[i] = 0;
    for (int w = 0; w < words_; ++w) degree_[i] += std::popcount(neighbours[w]);
    row(of_degree_, degree_[i])[i / 64] |= bit(i);
  };
  const auto displace = [&](int i) { row(of_degree_, degree_[i])[i / 64] &= ~bit(i); };
  for (int i = 0; i < n_; ++i) place(i);
  int least = 0;  // no remaining node has a degree below this
  for (int best = 0; static_cast<int>(order_.size()) < n_;) {
    int next = -1;
    for (; (next = next_bit(row(of_degree_, least), words_, best)) < 0; ++least) {}
    best = next;
    displace(best);
    position_[best] = static_cast<int>(order_.size());
    order_.push_back(best);
    const std::uint64_t* gone = row(fill_, best);
    for (int w = 0; w < words_; ++w) {
      for (std::uint64_t bits = gone[w]; bits != 0; bits &= bits - 1) {
        const int j = w * 64 + std::countr_zero(bits);
        std::uint64_t* other = row(fill_, j);
        for (int u = 0; u < words_; ++u) other[u] |= gone[u];
        other[j / 64] &= ~bit(j);
        other[best / 64] &= ~bit(best);
        displace(j);
        place(j);
      }
    }
    least = std::max(0, least - 1);
  }
}

void BlockCholesky::build_structure() noexcept {
  column_start_.clear();
  row_.clear();
  for (int k = 0; k < n_; ++k) {
    column_start_.push_back(static_cast<int>(row_.size()));
    const std::uint64_t* row = &fill_[static_cast<std::size_t>(order_[k]) * words_];
    for (int w = 0; w < words_; ++w)
      for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1)
        row_.push_back(position_[w * 64 + std::countr_zero(bits)]);
    std::sort(row_.begin() + column_start_.back(), row_.end());
  }
  column_start_.push_back(static_cast<int>(row_.size()));
}

void BlockCholesky::build_updates() noexcept {
  update_.clear();
  for (int k = 0; k < n_; ++k) {
    for (int b = column_start_[k]; b < column_start_[k + 1]; ++b) {
      int target = column_start_[row_[b]];
      for (int a = b + 1; a < column_start_[k + 1]; ++a) {
        while (row_[target] != row_[a]) ++target;
        update_.push_back(target);
      }
    }
  }
}

BlockCholesky::Slot BlockCholesky::find(int i, int j) const noexcept {
  int p = position_[i];
  int q = position_[j];
  const bool transposed = p < q;  // the factor keeps the lower half: row position above column position
  if (transposed) std::swap(p, q);
  const auto begin = row_.begin() + column_start_[q];
  const auto end = row_.begin() + column_start_[q + 1];
  const auto found = std::lower_bound(begin, end, p);
  if (found == end || *found != p) return {};
  return {static_cast<int>(found - row_.begin()), transposed};
}

void BlockCholesky::set_zero() noexcept {
  for (Mat4& m : diagonal_) m.setZero();
  for (Mat4& m : lower_) m.setZero();
}

bool BlockCholesky::factor() noexcept {
  const StageScope stage("linear system");
  const int* update = update_.data();
  for (int k = 0; k < n_; ++k) {
    Mat4& inverse = diagonal_[k];
    if (!invert_factor(inverse)) return false;
    const int begin = column_start_[k];
    const int end = column_start_[k + 1];
    for (int b = begin; b < end; ++b) lower_[b] = (lower_[b] * inverse.transpose()).eval();
    for (int b = begin; b < end; ++b) {
      const Mat4 lb = lower_[b].transpose();
      diagonal_[row_[b]].noalias() -= lower_[b] * lb;
      for (int a = b + 1; a < end; ++a) lower_[*update++].noalias() -= lower_[a] * lb;
    }
  }
  return true;
}

void BlockCholesky::solve(Eigen::Ref<Eigen::Matrix4Xd> b) const noexcept {
  const StageScope stage("linear system");
  for (int k = 0; k < n_; ++k) {
    auto y = b.col(order_[k]);
    const Eigen::Vector4d solved = diagonal_[k] * y;
    y = solved;
    for (int a = column_start_[k]; a < column_start_[k + 1]; ++a)
      b.col(order_[row_[a]]).noalias() -= lower_[a] * solved;
  }
  for (int k = n_ - 1; k >= 0; --k) {
    Eigen::Vector4d y = b.col(order_[k]);
    for (int a = column_start_[k]; a < column_start_[k + 1]; ++a)
      y.noalias() -= lower_[a].transpose() * b.col(order_[row_[a]]);
    b.col(order_[k]).noalias() = diagonal_[k].transpose() * y;
  }
}

}  // namespace filum
