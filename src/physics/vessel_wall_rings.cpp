#include "physics/vessel_wall_rings.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace filum {
namespace {

constexpr double kAlike = 1e-6;  // of the greatest number: sectors that differ by less are alike
constexpr int kTogether = 4;     // columns of a product that Eigen works out side by side
constexpr int kColumns = 64;     // transformed at once, so that products need no memory of their own

/// A ring's matrix or its coupling with the ring before, written out.
struct Rings {
  int size;
  std::vector<Eigen::MatrixXd> own, before;
};

std::optional<Rings> write_out(int size, int rings, const std::vector<int>& slab, const std::vector<SlabFactor::Block>& blocks) {
  Rings r{size, {}, {}};
  r.own.assign(static_cast<std::size_t>(rings), Eigen::MatrixXd::Zero(size, size));
  r.before = r.own;
  for (const SlabFactor::Block& b : blocks) {
    const int row = slab[static_cast<std::size_t>(b.row)] - slab.front(), column = slab[static_cast<std::size_t>(b.column)] - slab.front();
    const int i = 3 * b.row - size * row, j = 3 * b.column - size * column;
    if (row != column && row != column + 1) return std::nullopt;
    auto& m = (row == column ? r.own : r.before)[static_cast<std::size_t>(row)];
    m.block<3, 3>(i, j) += b.value;
    if (row == column && i != j) m.block<3, 3>(j, i) += b.value.transpose();
  }
  return r;
}

bool is_odd(int number) noexcept { return number % 3 == 2; }

/// The matrices A_m of a matrix written out, m = 0 ... n/2, rows and columns as in a sector; nothing if its sectors or their mirror images differ.
std::optional<std::vector<Eigen::MatrixXd>> symbols(const Eigen::MatrixXd& a, int n, double greatest) {
  const int q = static_cast<int>(a.rows()) / n;
  for (int i = 1; i < n; ++i)
    for (int d = 0; d < n; ++d)
      if ((a.block(i * q, (i + d) % n * q, q, q) - a.block(0, d * q, q, q)).cwiseAbs().maxCoeff() > kAlike * greatest) return std::nullopt;
  std::vector<Eigen::MatrixXd> list;
  for (int m = 0; m <= n / 2; ++m) {
    Eigen::MatrixXd symbol = Eigen::MatrixXd::Zero(q, q), rest = symbol;
    for (int d = 0; d < n; ++d) {
      const double angle = 2.0 * std::numbers::pi * m * d / n, c = std::cos(angle), s = std::sin(angle);
      for (int j = 0; j < q; ++j)
        for (int i = 0; i < q; ++i) {
          const bool alike = is_odd(i) == is_odd(j);
          symbol(i, j) += a(i, d * q + j) * (alike ? c : is_odd(i) ? -s : s);
          rest(i, j) += a(i, d * q + j) * (alike ? s : c);
        }
    }
    if (rest.cwiseAbs().maxCoeff() > kAlike * greatest * n) return std::nullopt;
    list.push_back(std::move(symbol));
  }
  return list;
}

int wave_number(int mode, int n) noexcept { return mode <= n / 2 ? mode : mode - n / 2; }

/// Orthonormal: cos m phi for m = 0 ... n/2, then sin m phi for m = 1 ...; odd: what goes with them, sin and -cos (and the two that no sine is left for).
Eigen::MatrixXf transform(int n, int rows, bool odd) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(rows, n);
  for (int k = 0; k < n; ++k) {
    const int m = wave_number(k, n);
    const bool second = k > n / 2, alone = !second && (m == 0 || 2 * m == n);
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * std::numbers::pi * (m * i % n) / n;
      const double c = std::cos(angle), s = std::sin(angle);
      w(k, i) = (alone ? 1.0 : std::sqrt(2.0)) / std::sqrt(static_cast<double>(n)) * (alone ? c : odd ? (second ? -c : s) : (second ? s : c));
    }
  }
  return w.cast<float>();
}

/// Of the columns from `from` on, and a few more, so that each is worked out among the same three as ever.
void multiply(const Eigen::MatrixXf& w, const Eigen::MatrixXf& x, Eigen::Index from, Eigen::MatrixXf& y) noexcept {
  for (Eigen::Index c = from / kTogether * kTogether; c < x.cols(); c += kColumns) {
    const Eigen::Index n = std::min<Eigen::Index>(kColumns, x.cols() - c);
    y.middleCols(c, n).noalias() = w * x.middleCols(c, n);
  }
}
void multiply_back(const Eigen::MatrixXf& w, const Eigen::MatrixXf& y, Eigen::MatrixXf& x) noexcept {
  for (Eigen::Index c = 0; c < x.cols(); c += kColumns) {
    const Eigen::Index n = std::min<Eigen::Index>(kColumns, x.cols() - c);
    x.middleCols(c, n).noalias() = w.transpose() * y.middleCols(c, n);
  }
}

}  // namespace

RingFactor::RingFactor(int sectors, int across, int rings)
    : sectors_(sectors), across_(across), rings_(rings), numbers_(3 * across), packs_((sectors + kLanes - 1) / kLanes) {
  const int rows = kLanes * packs_;
  to_even_ = transform(sectors, rows, false);
  to_odd_ = transform(sectors, rows, true);
  even_.setZero(sectors, 2 * across * rings);
  odd_.setZero(sectors, across * rings);
  even_modes_.setZero(rows, even_.cols());
  odd_modes_.setZero(rows, odd_.cols());
  inverse_.assign(static_cast<std::size_t>(packs_), Table::Zero(kLanes, rings * numbers_ * numbers_));
  before_ = inverse_;
  z_.assign(static_cast<std::size_t>(rings * numbers_), Lanes::Zero());
  w_ = z_;
}

std::optional<RingFactor> RingFactor::make(int sectors, const std::vector<int>& slab, const std::vector<SlabFactor::Block>& blocks) {
  const int n = static_cast<int>(slab.size());
  if (sectors < 3 || n == 0) return std::nullopt;
  const int rings = slab.back() - slab.front() + 1, across = n / (sectors * rings);
  if (across < 1 || across * sectors * rings != n) return std::nullopt;
  for (int i = 0; i < n; ++i)
    if (slab[static_cast<std::size_t>(i)] - slab.front() != i / (sectors * across)) return std::nullopt;
  const auto written = write_out(3 * sectors * across, rings, slab, blocks);
  if (!written) return std::nullopt;
  double greatest = 0.0;
  for (const auto& m : written->own) greatest = std::max(greatest, m.cwiseAbs().maxCoeff());
  RingFactor f(sectors, across, rings);
  std::vector<Eigen::MatrixXd> last;  // inverses of the ring before, of each wave number
  for (int ring = 0; ring < rings; ++ring) {
    const auto own = symbols(written->own[static_cast<std::size_t>(ring)], sectors, greatest);
    const auto before = symbols(written->before[static_cast<std::size_t>(ring)], sectors, greatest);
    if (!own || !before) return std::nullopt;
    std::vector<Eigen::MatrixXd> inverse;
    for (std::size_t m = 0; m < own->size(); ++m) {
      Eigen::MatrixXd s = 0.5 * ((*own)[m] + (*own)[m].transpose());
      if (ring > 0) s -= (*before)[m] * last[m] * (*before)[m].transpose();
      const Eigen::LLT<Eigen::MatrixXd> llt(s);
      if (llt.info() != Eigen::Success) return std::nullopt;
      inverse.push_back(llt.solve(Eigen::MatrixXd::Identity(s.rows(), s.cols())));
    }
    const int q = f.numbers_;
    for (int k = 0; k < sectors; ++k) {
      const auto m = static_cast<std::size_t>(wave_number(k, sectors));
      for (int i = 0; i < q; ++i)
        for (int j = 0; j < q; ++j) {
          const int at = (ring * q + i) * q + j;
          f.inverse_[static_cast<std::size_t>(k / kLanes)](k % kLanes, at) = static_cast<float>(inverse[m](i, j));
          f.before_[static_cast<std::size_t>(k / kLanes)](k % kLanes, at) = static_cast<float>((*before)[m](i, j));
        }
    }
    last = std::move(inverse);
  }
  return f;
}

float* RingFactor::mode(int ring, int number, int pack) noexcept {
  const int node = number / 3, c = number % 3;
  return is_odd(number) ? &odd_modes_(kLanes * pack, ring * across_ + node) : &even_modes_(kLanes * pack, 2 * (ring * across_ + node) + c);
}

void RingFactor::gather(const Eigen::Ref<Eigen::VectorXf>& b, int from) noexcept {
  from = kTogether * (from / kTogether);  // no fewer rings than multiply() reads
  const float* v = b.data() + static_cast<std::ptrdiff_t>(from) * sectors_ * numbers_;
  for (int r = from; r < rings_; ++r)
    for (int i = 0; i < sectors_; ++i)
      for (int k = r * across_; k < (r + 1) * across_; ++k, v += 3) {
        even_(i, 2 * k) = v[0];
        even_(i, 2 * k + 1) = v[1];
        odd_(i, k) = v[2];
      }
}

void RingFactor::scatter(Eigen::Ref<Eigen::VectorXf> b) const noexcept {
  float* v = b.data();
  for (int r = 0; r < rings_; ++r)
    for (int i = 0; i < sectors_; ++i)
      for (int k = r * across_; k < (r + 1) * across_; ++k, v += 3) {
        v[0] = even_(i, 2 * k);
        v[1] = even_(i, 2 * k + 1);
        v[2] = odd_(i, k);
      }
}

template <bool kTransposed>
void RingFactor::add(const Table& matrix, int at, const Lanes* in, float sign, Lanes* out) const noexcept {
  for (int i = 0; i < numbers_; ++i) {
    Lanes sum = Lanes::Zero();
    for (int j = 0; j < numbers_; ++j) sum += matrix.col(at + (kTransposed ? j * numbers_ + i : i * numbers_ + j)) * in[j];
    out[i] += sign * sum;
  }
}

/// Before ring `from` the forward pass would find zeros.
void RingFactor::solve_modes(int pack, int from) noexcept {
  const Table &inverse = inverse_[static_cast<std::size_t>(pack)], &before = before_[static_cast<std::size_t>(pack)];
  const int q = numbers_, square = q * q;
  for (int i = 0; i < from * q; ++i) w_[static_cast<std::size_t>(i)].setZero();
  for (int r = from; r < rings_; ++r) {
    Lanes *z = &z_[static_cast<std::size_t>(r * q)], *w = &w_[static_cast<std::size_t>(r * q)];
    for (int i = 0; i < q; ++i) {
      z[i] = Eigen::Map<const Lanes>(mode(r, i, pack));
      w[i].setZero();
    }
    if (r > 0) add<false>(before, r * square, w - q, -1.0f, z);
    add<false>(inverse, r * square, z, 1.0f, w);
  }
  for (int r = rings_ - 1; r-- > 0;) {
    Lanes *z = &z_[static_cast<std::size_t>(r * q)], *w = &w_[static_cast<std::size_t>(r * q)];
    for (int i = 0; i < q; ++i) z[i].setZero();
    add<true>(before, (r + 1) * square, w + q, 1.0f, z);
    add<false>(inverse, r * square, z, -1.0f, w);
  }
  for (int r = 0; r < rings_; ++r)
    for (int i = 0; i < q; ++i) Eigen::Map<Lanes>(mode(r, i, pack)) = w_[static_cast<std::size_t>(r * q + i)];
}

void RingFactor::solve(Eigen::Ref<Eigen::VectorXf> b, int from) noexcept {
  if (sectors_ <= kLanes) from = 0;  // products as small as what would be left Eigen works out another way, to other bits
  gather(b, from);
  multiply(to_even_, even_, 2 * across_ * from, even_modes_);
  multiply(to_odd_, odd_, across_ * from, odd_modes_);
  for (int pack = 0; pack < packs_; ++pack) solve_modes(pack, from);
  multiply_back(to_even_, even_modes_, even_);
  multiply_back(to_odd_, odd_modes_, odd_);
  scatter(b);
}

void RingFactor::keep_inverse() {
  columns_.resize(n_numbers(), numbers_ * rings_);
  for (int c = 0; c < columns_.cols(); ++c) {
    Eigen::VectorXf unit = Eigen::VectorXf::Unit(n_numbers(), c / numbers_ * sectors_ * numbers_ + c % numbers_);
    solve(unit);
    columns_.col(c) = unit;
  }
}

Eigen::Matrix3f RingFactor::inverse(int row, int column) const noexcept {
  const int a = row / across_, b = column / across_;  // sectors, counted over all rings
  const int turned = (a % sectors_ - b % sectors_ + sectors_) % sectors_;
  return columns_.block<3, 3>(numbers_ * (a / sectors_ * sectors_ + turned) + 3 * (row % across_), numbers_ * (b / sectors_) + 3 * (column % across_));
}

}  // namespace filum
