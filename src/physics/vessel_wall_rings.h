#pragma once
// A symmetric positive definite matrix on rings of like sectors that couple with the next ring only, each ring with the same answer wherever round it
// one begins, and mirrored the same (a tube at rest, in directions of its own: outward, along, around): block-circulant, so that Fourier's modes
// round the rings (Davis, Circulant Matrices, 1979, th. 3.2.4 and 5.6.4) part it into one small matrix for each wave number m,
//   x_i = (e cos m phi_i, o sin m phi_i) and (e sin m phi_i, -o cos m phi_i),   A_m = sum_d [ B_ee cos, B_eo sin; -B_oe sin, B_oo cos ](m phi_d),
// e outward and along, o around; from ring to ring as SlabFactor does it. What that reads is the square of a sector's numbers, not of a ring's:
// a tube of 24 sectors is solved in a tenth of the time. Test: vessel_wall_rings_test.

#include <optional>

#include "physics/vessel_wall_factor.h"

namespace filum {

class RingFactor {
 public:
  /// `sectors` round each ring; nodes ring by ring, sector by sector, and each with outward, along and around as its numbers.
  /// Nothing if the matrix is not so made (to 1e-6 of its greatest number), not even if it is not positive definite.
  static std::optional<RingFactor> make(int sectors, const std::vector<int>& slab, const std::vector<SlabFactor::Block>& blocks);

  /// x = A^-1 b, in place; b is zero before ring `from`. Allocates nothing.
  void solve(Eigen::Ref<Eigen::VectorXf> b, int from = 0) noexcept;
  int ring_of(int node) const noexcept { return node / (sectors_ * across_); }
  /// Block of A^-1 that joins two nodes; after keep_inverse().
  Eigen::Matrix3f inverse(int row, int column) const noexcept;
  /// Works out the columns of A^-1 of one sector: the others are the same, turned.
  void keep_inverse();
  int n_numbers() const noexcept { return 3 * sectors_ * across_ * rings_; }
  /// Numbers that keep_inverse() keeps.
  std::size_t inverse_size() const noexcept { return static_cast<std::size_t>(n_numbers()) * static_cast<std::size_t>(3 * across_ * rings_); }

 private:
  static constexpr int kLanes = 8;  // wave numbers worked out at once
  using Lanes = Eigen::Array<float, kLanes, 1>;
  using Table = Eigen::Array<float, kLanes, Eigen::Dynamic>;

  RingFactor(int sectors, int across, int rings);
  void gather(const Eigen::Ref<Eigen::VectorXf>& b, int from) noexcept;
  void scatter(Eigen::Ref<Eigen::VectorXf> b) const noexcept;
  void solve_modes(int pack, int from) noexcept;
  float* mode(int ring, int number, int pack) noexcept;
  template <bool kTransposed>
  void add(const Table& matrix, int at, const Lanes* in, float sign, Lanes* out) const noexcept;

  int sectors_, across_, rings_, numbers_, packs_;  // nodes across a sector, 3 times that, eights of modes
  Eigen::MatrixXf to_even_, to_odd_;    // modes x sectors
  Eigen::MatrixXf even_, odd_;          // by sector, a column for each number of a ring
  Eigen::MatrixXf even_modes_, odd_modes_;
  std::vector<Table> inverse_, before_;  // of each pack: ring after ring, row after row
  std::vector<Lanes> z_, w_;             // of one pack
  Eigen::MatrixXf columns_;              // of A^-1
};

}  // namespace filum
