#pragma once
// Limited-memory BFGS in products with whole matrices: from pairs of moves s and answers y and a first inverse P^-1 that the caller applies,
//   d = V^T P^-1 V r + S R^-T D R^-1 S^T r,   V = 1 - Y R^-1 S^T,   R the upper triangle of S^T Y, D its diagonal
// (Byrd, Nocedal & Schnabel, Math. Prog. 63:129, 1994): what the two loops of Nocedal & Wright's algorithm 7.4 work out one pair after the other, and
// read twice as often. Vectors in single precision: they only steer. Allocates nothing after its making. Test: vessel_wall_pairs_test.

#include <array>
#include <vector>

#include "physics/wall_load.h"

namespace filum {

class WallPairs {
 public:
  WallPairs() = default;
  /// Vectors of n numbers, at most `most` pairs, each in a column of the caller's S of as many.
  WallPairs(int n, int most);

  /// [N], of pair p, to be written before note(p).
  Eigen::MatrixXf::ColXpr answer(int p) noexcept { return answers_.col(p); }
  /// Pair p is new. The curvature must be positive, else a pair stays unused.
  void note(const Eigen::MatrixXf& s, int p) noexcept;
  /// The same of others' answers: its products with the moves, and the curvature below which it is not used [J].
  static void note(const Eigen::MatrixXf& s, const Eigen::MatrixXf& answers, int p, Eigen::MatrixXd& products, Eigen::VectorXd& least) noexcept;
  /// All are, with these answers and what note() found of them.
  void take(const Eigen::MatrixXf& answers, const Eigen::MatrixXd& products, const Eigen::VectorXd& least) noexcept;
  /// What the answers would be with this much more stiffness [N/m] at a place. Then comes count().
  void stiffen(const Eigen::MatrixXf& s, const WallPlace& place, const Mat3& stiffness) noexcept;
  /// The last n pairs up to column `newest` of the ring count from now on.
  void count(int n, int newest) noexcept;
  void forget() noexcept { order_.clear(); }

  /// r becomes V r: then comes P^-1.
  void before(const Eigen::MatrixXf& s, Eigen::VectorXf& r) noexcept;
  /// z = P^-1 V r becomes d.
  void after(const Eigen::MatrixXf& s, Eigen::VectorXf& z) noexcept;

 private:
  Eigen::MatrixXf answers_;           // Y
  Eigen::MatrixXd products_;          // s_i . y_j
  Eigen::VectorXd least_;             // [J], s . y below which a pair is not used
  std::vector<int> order_;            // columns, the oldest pair first
  Eigen::VectorXf each_;              // a number for each pair
  Eigen::VectorXd alpha_, gamma_;
  Eigen::Matrix3Xf moved_, pulled_;   // of stiffen(): a column for each pair
};

}  // namespace filum
