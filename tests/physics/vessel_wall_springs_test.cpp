#include "physics/vessel_wall_springs.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "base/rng.h"
#include "physics/vessel_wall_element.h"

using namespace filum;

namespace vessel_wall_springs_test {

/// A made-up positive definite matrix on the graph of a small tube, springs at points of it: against a dense solution.
TEST(VesselWallSprings, CorrectsToTheSpringsOwnMatrix) {
  TubeShape shape;
  shape.around = 6;
  shape.along = 3;
  const VesselMesh mesh = make_tube(shape);
  Rng rng(2);
  std::vector<SlabFactor::Block> blocks;
  const int n = 3 * mesh.n_nodes();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  const auto add = [&](int i, int j, const Mat3& m) {
    blocks.push_back({i, j, m});
    A.block<3, 3>(3 * i, 3 * j) += m;
    if (i != j) A.block<3, 3>(3 * j, 3 * i) += m.transpose();
  };
  for (int i = 0; i < mesh.n_nodes(); ++i) add(i, i, (3.0 + rng.uniform()) * Mat3::Identity());
  for (const auto& nodes : mesh.elements)
    for (const int i : nodes)
      for (const int j : nodes)
        if (i > j) add(i, j, 0.02 * rng.normal() * Mat3::Identity());
  WallMatrix matrix(mesh, blocks);
  WallSprings springs(mesh.n_nodes());
  std::vector<Mat3> turn(static_cast<std::size_t>(mesh.n_nodes()));
  for (std::size_t i = 0; i < turn.size(); ++i) turn[i] = Eigen::AngleAxisd(0.1 * static_cast<double>(i), Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const int e : {2, 7, 11}) {
    const WallSpring s{mesh.elements[static_cast<std::size_t>(e)], corner_weights(Vec3(0.2, -0.4, 0.6)),
                       Vec3(400, 400, 0).asDiagonal()};  // free along one direction
    ASSERT_TRUE(springs.add(s, turn, matrix));
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, n);
    for (int a = 0; a < 8; ++a) {
      const int i = s.node[static_cast<std::size_t>(a)];
      J.middleCols<3>(3 * i) += s.weight[a] * turn[static_cast<std::size_t>(i)];
    }
    A += J.transpose() * s.stiffness * J;
  }
  ASSERT_TRUE(springs.prepare(matrix));
  const Eigen::VectorXf b = Eigen::VectorXf::Random(n);
  Eigen::VectorXf x = b;
  matrix.solve(x);
  springs.correct(matrix, x);
  const Eigen::VectorXd exact = A.llt().solve(b.cast<double>());
  EXPECT_LT((x.cast<double>() - exact).norm(), 2e-4 * exact.norm());
}

TEST(VesselWallSprings, NothingToCorrectWithoutSprings) {
  TubeShape shape;
  const VesselMesh mesh = make_tube(shape);
  std::vector<SlabFactor::Block> blocks;
  for (int i = 0; i < mesh.n_nodes(); ++i) blocks.push_back({i, i, Mat3::Identity()});
  WallMatrix matrix(mesh, blocks);
  WallSprings springs(mesh.n_nodes());
  EXPECT_FALSE(springs.prepare(matrix));
  Eigen::VectorXf x = Eigen::VectorXf::Ones(3 * mesh.n_nodes());
  springs.correct(matrix, x);
  EXPECT_EQ(x.minCoeff(), 1.0f);
  EXPECT_EQ(x.maxCoeff(), 1.0f);
}

/// Springs that come and go among others that stay, more of them in turn than are remembered: as if all were new.
TEST(VesselWallSprings, KnownAgainIsAsNew) {
  TubeShape shape;
  shape.around = 6;
  shape.along = 3;
  const VesselMesh mesh = make_tube(shape);
  std::vector<SlabFactor::Block> blocks;
  for (int i = 0; i < mesh.n_nodes(); ++i) blocks.push_back({i, i, 4.0 * Mat3::Identity()});
  for (const auto& nodes : mesh.elements)
    for (const int i : nodes)
      for (const int j : nodes)
        if (i > j) blocks.push_back({i, j, 0.1 * Mat3::Identity()});
  WallMatrix matrix(mesh, blocks);
  const std::vector<Mat3> turn(static_cast<std::size_t>(mesh.n_nodes()), Mat3(Eigen::AngleAxisd(0.3, Vec3::UnitY())));
  WallSprings springs(mesh.n_nodes());
  const Eigen::VectorXf b = Eigen::VectorXf::LinSpaced(3 * mesh.n_nodes(), -1.0f, 2.0f);
  for (int round = 0; round < 80; ++round) {
    WallSprings fresh(mesh.n_nodes());
    springs.gather_again();
    for (int k = 0; k < 4; ++k) {
      const int e = k == 2 ? 3 + round % 5 : 4 * k;
      const Mat3 stiffness = Vec3(300 + (k == 1 ? round : 0), 200, 100).asDiagonal();
      for (WallSprings* s : {&springs, &fresh}) ASSERT_TRUE(s->add({mesh.elements[static_cast<std::size_t>(e)], corner_weights(Vec3(0.1 * k, -0.4, 0.6)), stiffness}, turn, matrix));
    }
    ASSERT_TRUE(springs.prepare(matrix) && fresh.prepare(matrix));
    Eigen::VectorXf x = b, y = b;
    matrix.solve(x);
    springs.correct(matrix, x);
    matrix.solve(y);
    fresh.correct(matrix, y);
    ASSERT_EQ((x - y).cwiseAbs().maxCoeff(), 0.0f) << round;
    ASSERT_GT((x - b).cwiseAbs().maxCoeff(), 0.01f);
  }
}

}  // namespace vessel_wall_springs_test
