#pragma once
// Takes the second-order stretch out of a move of a thread's nodes.
//
// A straight move that turns edges also lengthens them, by |dx|^2 / 2L, and a thread resists that some thousand times as stiffly as it
// does turning: Newton's method, which moves along straight lines, spends every second iteration taking it back. Here the move m is
// replaced by m + d, with d the least in the norm of the masses, |d|_M, that gives each edge the length asked for to first order:
//   d = -M^-1 J^T y,   (J M^-1 J^T) y = c,   J_j = edge direction after the move, c_j = its length there less the length asked for
// (fast projection: Goldenthal, Harmon, Fattal, Bercovier, Grinspun, "Efficient Simulation of Inextensible Cloth", ACM TOG 26(3):49,
// 2007, sec. 4.2, one pass). The system is tridiagonal; cost is linear in nodes and nothing allocates after the constructor.
// It changes where the solver looks, never what it solves. Tests: rod_lengths_test.

#include <Eigen/Core>

#include "physics/elastic_rod.h"

namespace filum {

enum class EdgeLength {
  unchanged,    // as before the move
  first_order,  // as before the move, plus what the move adds to first order: stretch that is meant
};

class RodLengths {
 public:
  explicit RodLengths(int node_capacity);

  /// A move that lengthens an edge by more than a thousandth is left as it is: one pass does not get it right.
  /// `move` [m] is 4 x n, its fourth row (twist) stays; nodes with inverse mass 0 [1/kg] stay as moved.
  void keep(const RodState& s, const Points& x, const Eigen::VectorXd& inverse_mass, EdgeLength which, Eigen::Matrix4Xd& move) noexcept;

 private:
  Points along_;                                  // unit, edges after the move
  Eigen::VectorXd excess_, diagonal_, beside_;    // [m], [1/kg], [1/kg] (edge j with j + 1)
};

}  // namespace filum
