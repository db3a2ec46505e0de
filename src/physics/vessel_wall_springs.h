#pragma once
// Springs at material points, brought into the wall's first matrix: (P + J^T S J)^-1 = P^-1 - C L (I + L^T W L)^-1 L^T C^T with
// C = P^-1 J^T, W = J C, S = L L^T (Woodbury). A needle or thread in its track is a hundred times stiffer than the tissue about it; left
// out of P, each such point costs the iteration several rounds. P never changes, so its inverse is kept (WallMatrix), in
// single precision, and only what joins the springs' own nodes is read to make the correction: springs that come and go within a step are
// cheap, the more so since what joins two springs is remembered for the step. Parts whose inverse is not kept go without. Test: vessel_wall_springs_test.

#include <array>
#include <span>
#include <vector>

#include "physics/vessel_wall_matrix.h"

namespace filum {

struct WallSpring {
  std::array<int, 8> node;
  Eigen::Matrix<double, 8, 1> weight;
  Mat3 stiffness;  // [N/m]
};

class WallSprings {
 public:
  static constexpr int kMost = 24;            // springs: more are left to the iteration

  WallSprings() = default;
  explicit WallSprings(int n_nodes);

  /// No springs, and other directions from now on.
  void clear() noexcept;
  /// No springs, directions as before: what is known of springs that are added again is not worked out again.
  void gather_again() noexcept { n_ = 0; }
  /// False if there is no room or the part's inverse is not kept. `turn` maps the matrix's directions into those of the present. P is one and the same in every call.
  bool add(const WallSpring& spring, const std::vector<Mat3>& turn, const WallMatrix& P) noexcept;
  /// After the last add(). False if the correction cannot be made; then correct() does nothing.
  bool prepare(const WallMatrix& P) noexcept;
  /// From P^-1 b to (P + J^T S J)^-1 b, in place, in the matrix's own directions.
  void correct(WallMatrix& P, Eigen::Ref<Eigen::VectorXf> x) noexcept;
  int size() const noexcept { return n_; }

 private:
  static constexpr int kKept = 2 * kMost;     // springs of one step that are remembered
  static constexpr int kNodes = 12 * kMost;   // nodes among which the inverse is

  struct Spring {
    WallSpring given;
    int n = 0;                              // corners whose weight is not zero
    std::array<int, 8> node;                // these
    std::array<Eigen::Matrix3f, 8> blocks;  // of J
    std::span<const int> corners() const noexcept { return {node.data(), static_cast<std::size_t>(n)}; }
    Eigen::Matrix3f root;                   // L
  };
  const Spring& spring(int k) const noexcept { return kept_[static_cast<std::size_t>(active_[static_cast<std::size_t>(k)])]; }
  int find(const WallSpring& spring) const noexcept;
  int room() noexcept;
  Eigen::Vector3f at(const Spring& s, const Eigen::Ref<const Eigen::VectorXf>& x) const noexcept;

  void number_nodes() noexcept;
  void gather_inverse(const WallMatrix& P) noexcept;
  void couple(int j) noexcept;
  char& known(int row, int column) noexcept { return known_[static_cast<std::size_t>(row * kKept + column)]; }

  std::vector<Spring> kept_;
  std::array<int, kMost> active_{};  // of kept_: the springs there are
  int n_kept_ = 0;
  Eigen::MatrixXf pair_;             // L^T W L among kept_, where known
  std::vector<char> known_;

  std::vector<int> nodes_;   // that springs stand on
  std::vector<int> mark_;    // of each node: its first row in share_, -1: none
  std::vector<int> among_;   // nodes that near_ is about
  std::vector<int> row_;     // of each node: its first row in near_, -1: none
  Eigen::MatrixXf near_;     // P^-1 among among_
  Eigen::MatrixX3f moved_;   // of it, by the unit loads of one spring
  Eigen::VectorXf share_;    // [N], on nodes_
  Eigen::MatrixXf small_;    // I + L^T W L, factored
  Eigen::VectorXf load_;
  bool first_ = true;        // set of springs since clear()
  int n_ = 0;
  bool ready_ = false;
};

}  // namespace filum
