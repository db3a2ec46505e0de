#include "physics/vessel_wall_pairs.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "base/rng.h"

using namespace filum;

namespace vessel_wall_pairs_test {

struct Case {
  int n = 40, most = 6;
  Eigen::MatrixXd A, P;
  Eigen::MatrixXf s;
  WallPairs pairs{40, 6};
  Rng rng{5};

  Eigen::VectorXd random() {
    Eigen::VectorXd v(n);
    for (int i = 0; i < n; ++i) v[i] = rng.normal();
    return v;
  }
  Case() : A(Eigen::MatrixXd::Identity(40, 40)), P(Eigen::MatrixXd::Identity(40, 40)), s(Eigen::MatrixXf::Zero(40, 6)) {
    for (int k = 0; k < 10; ++k) {
      const Eigen::VectorXd v = random(), w = random();
      A += 0.2 * v * v.transpose();
      P += 0.1 * w * w.transpose();
    }
  }
  void add(int p, const Eigen::VectorXd& move) {
    s.col(p) = move.cast<float>();
    pairs.answer(p) = (A * move).cast<float>();
    pairs.note(s, p);
  }
  Eigen::VectorXd direction(const Eigen::VectorXd& r) {
    Eigen::VectorXf d = r.cast<float>();
    pairs.before(s, d);
    d = Eigen::VectorXd(P.llt().solve(d.cast<double>())).cast<float>();
    pairs.after(s, d);
    return d.cast<double>();
  }
};

/// Algorithm 7.4 of Nocedal & Wright as printed.
Eigen::VectorXd two_loops(const Case& c, const std::vector<Eigen::VectorXd>& moves, Eigen::VectorXd q) {
  std::vector<double> alpha(moves.size());
  for (std::size_t i = moves.size(); i-- > 0;) {
    const Eigen::VectorXd y = c.A * moves[i];
    alpha[i] = moves[i].dot(q) / moves[i].dot(y);
    q -= alpha[i] * y;
  }
  Eigen::VectorXd d = c.P.llt().solve(q);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Eigen::VectorXd y = c.A * moves[i];
    d += (alpha[i] - y.dot(d) / moves[i].dot(y)) * moves[i];
  }
  return d;
}

TEST(VesselWallPairs, SameAsTheTwoLoopsWhenTheRingHasGoneRound) {
  Case c;
  std::vector<Eigen::VectorXd> moves;
  for (int k = 0; k < 9; ++k) {
    moves.push_back(c.random());
    c.add(k % c.most, moves.back());
    c.pairs.count(std::min(k + 1, c.most), k % c.most);
    if (static_cast<int>(moves.size()) > c.most) moves.erase(moves.begin());
    const Eigen::VectorXd r = c.random(), expected = two_loops(c, moves, r);
    EXPECT_LT((c.direction(r) - expected).norm(), 2e-4 * expected.norm()) << k;
  }
}

TEST(VesselWallPairs, TakenTogetherTheyAreAsOneByOne) {
  Case c;
  Eigen::MatrixXf answers = Eigen::MatrixXf::Zero(c.n, c.most);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(c.most, c.most);
  Eigen::VectorXd least = Eigen::VectorXd::Zero(c.most);
  for (int k = 0; k < 4; ++k) {
    c.add(k, c.random());
    answers.col(k) = c.pairs.answer(k);
    WallPairs::note(c.s, answers, k, products, least);
  }
  c.pairs.count(4, 3);
  const Eigen::VectorXd r = c.random(), expected = c.direction(r);
  WallPairs other(c.n, c.most);
  other.take(answers, products, least);
  other.count(4, 3);
  c.pairs = other;
  EXPECT_EQ((c.direction(r) - expected).norm(), 0.0);
  EXPECT_GT((c.P.llt().solve(r) - expected).norm(), 1e-2 * expected.norm());
}

/// A spring more is as if the matrix had it, of a place of three nodes and of none.
TEST(VesselWallPairs, ASpringMoreStiffensAllAnswers) {
  Case c, other;
  WallPlace place;
  place.node = {3, 5, 9, 3, 3, 3, 3, 3};
  place.weight.head<3>() = Eigen::Vector3d(0.2, 0.3, 0.5);
  const Mat3 stiffness = 7.0 * Vec3(1, 2, 2).normalized() * Vec3(1, 2, 2).normalized().transpose();
  for (int k = 0; k < 4; ++k) c.add(k, c.random());
  c.pairs.stiffen(c.s, place, stiffness);
  c.pairs.count(4, 3);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      other.A.block<3, 3>(3 * place.node[static_cast<std::size_t>(a)], 3 * place.node[static_cast<std::size_t>(b)]) += place.weight[a] * place.weight[b] * stiffness;
  for (int k = 0; k < 4; ++k) other.add(k, other.random());
  other.pairs.count(4, 3);
  const Eigen::VectorXd r = c.random(), expected = other.direction(r);
  EXPECT_LT((c.direction(r) - expected).norm(), 1e-4 * expected.norm());
}

TEST(VesselWallPairs, AnswerOfTheNewestPairGivesItsMove) {
  Case c;  // the secant equation
  for (int k = 0; k < 4; ++k) c.add(k, c.random());
  c.pairs.count(4, 3);
  const Eigen::VectorXd s = c.s.col(3).cast<double>();
  EXPECT_LT((c.direction(c.A * s) - s).norm(), 1e-4 * s.norm());
}

TEST(VesselWallPairs, PairsWithoutPositiveCurvatureAndForgottenOnesDoNothing) {
  Case c;
  const Eigen::VectorXd r = c.random(), plain = c.P.llt().solve(r);
  c.s.col(0) = c.random().cast<float>();
  c.pairs.answer(0) = -c.s.col(0);
  c.pairs.note(c.s, 0);
  c.pairs.count(1, 0);
  EXPECT_LT((c.direction(r) - plain).norm(), 1e-5 * plain.norm());
  c.add(1, c.random());
  c.pairs.count(2, 1);
  EXPECT_GT((c.direction(r) - plain).norm(), 1e-2 * plain.norm());
  c.pairs.forget();
  EXPECT_LT((c.direction(r) - plain).norm(), 1e-5 * plain.norm());
}

}  // namespace vessel_wall_pairs_test
