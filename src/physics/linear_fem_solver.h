#pragma once
// Solvers of the linear system of one step of the tissue,
//   A u = b,   A = s K + diag(m) + supports,
// where some nodes are moved by something rigid: prescribed, u_i = t_i, or pulled towards t_i by a stiffness S_i. Both
// methods give the same answer; what they need for it differs.
//   gauss_seidel         Eq. 7 of Hansen et al. on 3x3 blocks: u_i <- u_i + w D_i^-1 (b_i - sum_j A_ij u_j), D_i = A_ii + S_i;
//                        w = 1 is the paper's, 1 < w < 2 over-relaxes (SOR); `symmetric` sweeps there and back
//   conjugate_gradients  preconditioned by one symmetric Gauss-Seidel sweep, M = (D+L) D^-1 (D+U). With Eisenstat's
//                        identity (SIAM J. Sci. Stat. Comput. 2:1, 1981) an iteration costs one sweep, not two products:
//                        (D+L)^-1 A (D+U)^-1 v = t + (D+L)^-1 (v - D t),  t = (D+U)^-1 v
// Stops when |b - A u| over the nodes that are not prescribed falls below `relative` times |b| + |reactions|.
// Tests: linear_fem_solver_test (against Cholesky), linear_fem_test.

#include <span>
#include <vector>

#include "physics/linear_fem_matrix.h"

namespace filum {

/// A node that something rigid moves.
struct MovedNode {
  int node = 0;
  bool prescribed = true;
  Vec3 target = Vec3::Zero();      // [m], displacement
  Mat3 stiffness = Mat3::Zero();   // [N/m], symmetric positive semidefinite; not used if prescribed
  Vec3 force = Vec3::Zero();       // [N], of the mover on the node; set by the solver
};

struct FemSolverOptions {
  enum class Method { gauss_seidel, conjugate_gradients };
  Method method = Method::conjugate_gradients;
  double relative = 1e-3;   // residual at which to stop
  int max_iterations = 400;
  double relaxation = 1.0;  // of Gauss-Seidel, 0 < w < 2
  bool symmetric = false;   // Gauss-Seidel sweeps forward and back in turn
};

struct FemSummary {
  bool converged = false;
  bool sound = true;        // all numbers finite
  int iterations = 0;       // sweeps or iterations of conjugate gradients
  double relative = 0.0;    // residual reached
  double residual = 0.0;    // [N], largest unbalanced force of a node
};

template <class T>
class FemSystem {
 public:
  /// K must outlive the system. Call set() before the first solve and whenever K, s, m or the held nodes change.
  explicit FemSystem(const BlockMatrix<T>& K);
  void set(double scale, const Eigen::VectorXd& mass, const std::vector<char>& held);

  /// `u` holds the first guess and then the answer; zero at held nodes. Allocates nothing.
  FemSummary solve(const Columns4& b, Columns4& u, std::span<MovedNode> moved, const FemSolverOptions& options) noexcept;

 private:
  void place(std::span<const MovedNode> moved, Columns4& u) noexcept;
  void lift(std::span<const MovedNode> moved) noexcept;
  double scale_of(const Columns4& b, const Columns4& u, std::span<const MovedNode> moved) const noexcept;
  Vec3 unbalanced(int i, const Columns4& b, const Columns4& u) const noexcept;
  double residual(const Columns4& b, const Columns4& u, double& largest) noexcept;
  double sweep(const Columns4& b, Columns4& u, double w, bool back) noexcept;
  int gauss_seidel(const Columns4& b, Columns4& u, const FemSolverOptions& o, double scale) noexcept;
  int conjugate_gradients(const Columns4& b, Columns4& u, const FemSolverOptions& o, double scale) noexcept;
  void forward(const Columns4& r, Columns4& y) const noexcept;   // (D+L) y = r
  void backward(const Columns4& r, Columns4& y) const noexcept;  // (D+U) y = r
  void apply(const Columns4& v, Columns4& w) noexcept;           // w = (D+L)^-1 A (D+U)^-1 v
  double norm_of_lower(const Columns4& r) const noexcept;        // |(D+L) r|

  const BlockMatrix<T>& K_;
  double scale_ = 1.0;
  Eigen::VectorXd mass_;
  std::vector<char> held_;               // nodes that do not move
  std::vector<Mat3> diagonal_, inverse_; // of A and, at moved nodes, of A + S; inverse 0 where the node is held or prescribed
  std::vector<Mat3> saved_diagonal_, saved_inverse_;
  std::vector<Vec3> support_;            // [N], S (t - u) belongs to the right side: S t of each moved node
  std::vector<int> support_of_;          // node -> index in support_, -1 none
  std::vector<Mat3> support_stiffness_;
  Columns4 r_, p_, w_, t_, x_;
};

}  // namespace filum
