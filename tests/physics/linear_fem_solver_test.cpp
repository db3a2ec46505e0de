// The systems of the tissue's steps against a dense Cholesky factorisation, for both kinds of numbers and all kinds of movers.

#include "physics/linear_fem_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>

#include "physics/linear_fem.h"

namespace filum {
namespace linear_fem_solver_test {

struct Problem {
  std::unique_ptr<LinearFem> fem;
  std::vector<char> held;
  Eigen::VectorXd mass;
  double scale = 2.5;
  Columns4 b;
  std::vector<MovedNode> moved;
};

/// A block held at one side; one node prescribed, two pulled, all the others free under uneven loads.
Problem problem(int cells) {
  const TetMesh mesh = box_mesh(Vec3::Zero(), Vec3(0.03, 0.02, 0.01), cells, cells, cells);
  Problem p{std::make_unique<LinearFem>(mesh, std::vector<FemMaterial>{FemMaterial{}}, FemOptions{}), {}, {}, 2.5, {}, {}};
  const int n = mesh.n_nodes();
  p.mass = 4e4 * p.fem->mass();
  p.b = Columns4::Zero(4, n);
  for (int i = 0; i < n; ++i) {
    p.held.push_back(mesh.nodes(0, i) < 1e-9);
    p.b.col(i).head<3>() = 1e-3 * Vec3(std::sin(3.0 * i), std::cos(7.0 * i), std::sin(5.0 * i));
  }
  p.moved = {{n - 1, true, Vec3(1e-3, -2e-3, 5e-4)}, {n - 3, false, Vec3(0, 0, -2e-3), 300.0 * Vec3(0, 0, 1).asDiagonal().toDenseMatrix()}, {n / 2, false, Vec3(1e-3, 0, 0), 5.0 * Mat3::Identity()}};
  return p;
}

Columns4 cholesky(const Problem& p) {
  const BlockMatrix& K = p.fem->stiffness();
  const int n = K.n();
  constexpr double kHold = 1e11;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  Eigen::VectorXd b(3 * n);
  for (int i = 0; i < n; ++i) {
    b.segment<3>(3 * i) = p.b.col(i).head<3>();
    for (int j = 0; j < n; ++j) A.block<3, 3>(3 * i, 3 * j) = p.scale * K.block(i, j);
    A.block<3, 3>(3 * i, 3 * i) += (p.mass[i] + (p.held[static_cast<std::size_t>(i)] ? kHold : 0.0)) * Mat3::Identity();
  }
  for (const MovedNode& m : p.moved) {
    const Mat3 S = m.prescribed ? Mat3(kHold * Mat3::Identity()) : m.stiffness;
    A.block<3, 3>(3 * m.node, 3 * m.node) += S;
    b.segment<3>(3 * m.node) += S * m.target;
  }
  const Eigen::VectorXd x = A.llt().solve(b);
  Columns4 u = Columns4::Zero(4, n);
  u.topRows<3>() = Eigen::Map<const Points>(x.data(), 3, n);
  return u;
}

template <class T>
void expect_the_answer(int cells, FemSolverOptions::Method method, double relative, double error) {
  Problem p = problem(cells);
  const Columns4 answer = cholesky(p);
  FemSystem<T> system(p.fem->stiffness());
  system.set(p.scale, p.mass, p.held);
  FemSolverOptions options;
  options.method = method;
  options.relative = relative;
  options.max_iterations = 5000;
  Columns4 u = Columns4::Zero(4, p.b.cols());
  const FemSummary summary = system.solve(p.b, u, p.moved, options);
  EXPECT_TRUE(summary.converged) << summary.relative;
  EXPECT_LT((u - answer).norm(), error * answer.norm());
  EXPECT_EQ(u.col(p.moved[0].node).head<3>(), p.moved[0].target);
  // what the movers give is what is missing
  for (const MovedNode& m : p.moved) {
    const Vec3 missing = p.scale * p.fem->stiffness().row_times(m.node, u) + p.mass[m.node] * u.col(m.node).head<3>() - p.b.col(m.node).head<3>();
    EXPECT_LT((m.force - missing).norm(), 20.0 * relative * missing.norm() + 20.0 * summary.residual) << m.node;
  }
  // the same right side as a load and a product, from another first guess
  Columns4 w = 0.3 * answer, f = p.b, again = 0.7 * answer;
  for (const MovedNode& m : p.moved) again.col(m.node).setZero();
  for (int i = 0; i < u.cols(); ++i) f.col(i).head<3>() -= p.fem->stiffness().row_times(i, w);
  EXPECT_TRUE(system.solve(f, &w, again, p.moved, options).converged);
  EXPECT_LT((again - answer).norm(), error * answer.norm());
}

using Method = FemSolverOptions::Method;

TEST(FemSystem, ConjugateGradientsGiveTheAnswerOfCholesky) {
  for (const int cells : {1, 2, 6}) expect_the_answer<double>(cells, Method::conjugate_gradients, 1e-10, 1e-7);
}

TEST(FemSystem, GaussSeidelGivesTheAnswerOfCholesky) {
  for (const int cells : {1, 2, 5}) expect_the_answer<double>(cells, Method::gauss_seidel, 1e-9, 1e-6);
}

TEST(FemSystem, FloatCostsSweepsNotAccuracy) {
  for (const int cells : {1, 2, 6}) expect_the_answer<float>(cells, Method::conjugate_gradients, 1e-8, 3e-6);
}

TEST(FemSystem, NothingToDoTakesNoIteration) {
  Problem p = problem(3);
  FemSystem<float> system(p.fem->stiffness());
  system.set(p.scale, p.mass, p.held);
  Columns4 b = Columns4::Zero(4, p.b.cols()), u = b;
  const FemSummary summary = system.solve(b, u, {}, {});
  EXPECT_EQ(summary.iterations, 0);
  EXPECT_TRUE(summary.converged);
  EXPECT_EQ(u.norm(), 0.0);
}

}  // namespace linear_fem_solver_test
}  // namespace filum
