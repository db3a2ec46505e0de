#include "base/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace filum {
namespace block_cholesky_test {

/// A random positive definite chain matrix with `extra` long-range blocks, in both our form and dense.
struct Pair {
  BlockCholesky sparse;
  Eigen::MatrixXd dense;
};

Pair random_chain(int n, int extra, unsigned seed) {
  std::mt19937 gen(seed);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> pick(0, n - 1);
  Pair p{BlockCholesky(n), Eigen::MatrixXd::Zero(4 * n, 4 * n)};
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i + 1 < n; ++i) edges.emplace_back(i, i + 1);
  for (int i = 0; i + 2 < n; ++i) edges.emplace_back(i, i + 2);
  for (int k = 0; k < extra; ++k) {
    const int i = pick(gen), j = pick(gen);
    if (i != j) edges.emplace_back(i, j);
  }
  p.sparse.begin_pattern(n);
  for (auto [i, j] : edges) p.sparse.connect(i, j);
  p.sparse.analyse();
  p.sparse.set_zero();
  for (auto [i, j] : edges) {
    Mat4 b;
    for (double& v : b.reshaped()) v = normal(gen);
    p.sparse.add(p.sparse.find(i, j), b);
    p.dense.block<4, 4>(4 * i, 4 * j) += b;
    p.dense.block<4, 4>(4 * j, 4 * i) += b.transpose();
  }
  const double shift = p.dense.cwiseAbs().rowwise().sum().maxCoeff();
  for (int i = 0; i < n; ++i) {
    p.sparse.add_diagonal(i, shift * Mat4::Identity());
    p.dense.block<4, 4>(4 * i, 4 * i) += shift * Mat4::Identity();
  }
  return p;
}

TEST(BlockCholesky, SolvesLikeADenseFactorisation) {
  for (unsigned seed = 1; seed < 20; ++seed) {
    const int n = 5 + static_cast<int>(seed) * 7;  // one word of the bit rows to three
    Pair p = random_chain(n, static_cast<int>(seed), seed);
    ASSERT_TRUE(p.sparse.factor());
    Eigen::Matrix4Xd b = Eigen::Matrix4Xd::Random(4, n);
    const Eigen::VectorXd expected = p.dense.llt().solve(Eigen::Map<Eigen::VectorXd>(b.data(), 4 * n));
    p.sparse.solve(b);
    EXPECT_LT((Eigen::Map<Eigen::VectorXd>(b.data(), 4 * n) - expected).norm(), 1e-12 * (1 + expected.norm()));
  }
}

TEST(BlockCholesky, AChainFillsNothing) {
  BlockCholesky c(500);
  c.begin_pattern(500);
  for (int i = 0; i + 1 < 500; ++i) c.connect(i, i + 1);
  for (int i = 0; i + 2 < 500; ++i) c.connect(i, i + 2);
  c.analyse();
  EXPECT_EQ(c.n_blocks(), 499 + 498);
}

TEST(BlockCholesky, RefusesAnIndefiniteMatrix) {
  BlockCholesky c(3);
  c.begin_pattern(3);
  c.connect(0, 1);
  c.connect(1, 2);
  c.analyse();
  c.set_zero();
  for (int i = 0; i < 3; ++i) c.add_diagonal(i, Mat4::Identity());
  c.add(c.find(0, 1), 2.0 * Mat4::Identity());
  EXPECT_FALSE(c.factor());
}

TEST(BlockCholesky, AnUndeclaredBlockIsNotFound) {
  BlockCholesky c(4);
  c.begin_pattern(4);
  c.connect(0, 1);
  c.analyse();
  EXPECT_LT(c.find(0, 3).index, 0);
  EXPECT_GE(c.find(1, 0).index, 0);
}

}  // namespace block_cholesky_test
}  // namespace filum
