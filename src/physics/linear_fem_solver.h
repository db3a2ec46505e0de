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
// Both work on the nodes that are not held, scaled by the Cholesky factors of the diagonal blocks, R_i^-1 A_ij R_j^-T, so that
// D is the identity but at moved nodes, and in an order of their own: Cuthill-McKee (ACM Nat. Conf. 1969), cut into four
// stretches that are dealt out in turn, since a sweep whose every row waits for the row before is slow (linear_fem_rows.h).
// The matrix and the vectors of conjugate gradients are of type T; the residual is summed in double, and iterations begin
// anew from it until it is small enough, so that float costs sweeps, not accuracy.
// Only the change from the first guess g is solved for: its right side b - A g is one product, also where b itself is a load and a
// product, b = f + K w, as in a step: b - A g = f - m g + K (w - s g).
// Stops when |b - A u| over the nodes that are not prescribed falls below `relative` times |f| + |reactions|, |f| over the nodes that
// are not held, or below `absolute`.  Tests: linear_fem_test (against Cholesky).

#include <span>
#include <vector>

#include "physics/linear_fem_matrix.h"
#include "physics/linear_fem_rows.h"

namespace filum {

/// A node that something rigid moves.
struct MovedNode {
  int node = 0;
  bool prescribed = true;
  Vec3 target = Vec3::Zero();      // [m], displacement
  Mat3 stiffness = Mat3::Zero();   // [N/m], symmetric positive semidefinite; not used if prescribed
  Vec3 outward = Vec3::Zero();     // unit, the way a mover that only pushes does so; zero: it holds
  double speed = 0.0;              // [m/s], of the mover that way
  Vec3 force = Vec3::Zero();       // [N], of the mover on the node; set by the solver
};

struct FemSolverOptions {
  enum class Method { gauss_seidel, conjugate_gradients };
  Method method = Method::conjugate_gradients;
  double relative = 1e-3;   // residual at which to stop
  double absolute = 0.0;    // [N], or at which
  int max_iterations = 400;
  double relaxation = 1.0;  // of Gauss-Seidel, 0 < w < 2
  bool symmetric = false;   // Gauss-Seidel sweeps forward and back in turn
};

struct FemSummary {
  bool converged = false;
  bool sound = true;        // all numbers finite
  int iterations = 0;       // sweeps or iterations of conjugate gradients
  double first = 0.0;       // relative residual of the first guess
  double relative = 0.0;    // residual reached
  double residual = 0.0;    // [N], largest unbalanced force of a node
};

template <class T>
class FemSystem {
 public:
  /// K must outlive the system. Call set() before the first solve and whenever K, s, m or the held nodes change.
  explicit FemSystem(const BlockMatrix& K) : K_(K) {}
  void set(double scale, const Eigen::VectorXd& mass, const std::vector<char>& held);

  /// `u` holds the first guess and then the answer; zero at held nodes. Allocates nothing.
  FemSummary solve(const Columns4& f, Columns4& u, std::span<MovedNode> moved, const FemSolverOptions& options) noexcept { return solve(f, nullptr, u, moved, options); }
  /// The same with f + K w on the right side; w zero at held nodes that nobody moves.
  FemSummary solve(const Columns4& f, const Columns4* w, Columns4& u, std::span<MovedNode> moved, const FemSolverOptions& options) noexcept;

 private:
  /// The diagonal of a moved node, scaled, by columns; `inverse` 0 where it is prescribed.
  struct Moved {
    std::array<T, 12> diagonal{}, inverse{};
    Mat3 block = Mat3::Identity(), spring = Mat3::Zero();
    Vec3 pull = Vec3::Zero();  // spring times target
    int position = 0;
    bool prescribed = false;
  };
  void order(const std::vector<char>& held);
  bool deal(const std::vector<int>& list, int streams);
  void fill();
  template <class Number>
  void gather(const Columns4& f, const Columns4* w, const Columns4& guess, std::vector<Number>& y) noexcept;
  bool place(std::span<const MovedNode> moved, const Columns4& guess) noexcept;
  void lift() noexcept;
  double scale_of(const Columns4& f) const noexcept;
  static constexpr int kGroup = TriangleRows<T>::kGroup;
  int groups() const noexcept { return static_cast<int>(node_of_.size()) / kGroup; }
  template <class Number>
  void product(int group, const Number* x, Vec3* rows) const noexcept;  // of the scaled matrix without movers
  double residual(bool moves, double& largest) noexcept;
  double sweep(double w, bool back) noexcept;
  int gauss_seidel(const FemSolverOptions& o, double enough, double& left, double& largest) noexcept;
  int conjugate_gradients(const FemSolverOptions& o, double enough, double& left, double& largest) noexcept;
  void forward() noexcept;                             // r <- (D+L)^-1 r
  double begin_direction() noexcept;                   // p = D r
  void backward(const T* from, T* to) const noexcept;  // (D+U) to = from
  double apply() noexcept;                             // q = (D+L)^-1 A (D+U)^-1 p; returns p.q
  double advance(double alpha) noexcept;               // x += alpha p, r -= alpha q; returns r.D r
  void turn(double beta) noexcept;                     // p = D r + beta p
  double norm_of_lower() const noexcept;               // |(D+L) r|, of the unscaled residual
  void times_diagonal(std::size_t position, Four<T>& v) const noexcept;
  void over_diagonal(std::size_t position, Four<T>& v) const noexcept;
  void forces(const Columns4& f, const Columns4* w, const Columns4& u, std::span<MovedNode> moved) const noexcept;

  const BlockMatrix& K_;
  double scale_ = 1.0;
  Eigen::VectorXd mass_;
  std::vector<int> node_of_, position_of_;  // position in the sweep <-> node, -1 nobody's, held
  TriangleRows<T> low_, high_;              // strict triangles; groups of `high_` from the last to the first
  std::vector<Mat3> root_, root_inverse_;   // R_i of each position
  std::vector<int> special_;                // position -> index in moved_, -1 none
  std::vector<Moved> moved_;
  std::vector<double> b_, u_;               // scaled, four numbers a position: right side of the change, and the change
  std::vector<T> r_, p_, q_, t_, x_;
};

}  // namespace filum
