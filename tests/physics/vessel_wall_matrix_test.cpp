// Parts of both kinds together: vessel_wall_rings_test.

#include "physics/vessel_wall_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <stdexcept>

#include "base/rng.h"

namespace filum {
namespace vessel_wall_matrix_test {

/// A tube that is the same all round, and a card whose blocks are made up.
struct Sample {
  VesselMesh mesh;
  std::vector<SlabFactor::Block> blocks;
  Eigen::MatrixXd dense;
  int card = 0;  // its first node

  void add(int i, int j, const Mat3& m) {
    blocks.push_back({i, j, m});
    dense.block<3, 3>(3 * i, 3 * j) += m;
    if (i != j) dense.block<3, 3>(3 * j, 3 * i) += m.transpose();
  }
  explicit Sample(int across = 4, int deep = 3) {
    TubeShape tube;
    tube.around = 10;  // more than RingFactor always works out whole
    tube.along = 3;
    mesh = make_tube(tube);
    card = mesh.n_nodes();
    CardShape shape;
    shape.across = across;
    shape.deep = deep;
    append(mesh, make_card(shape), {});
    dense = Eigen::MatrixXd::Zero(3 * mesh.n_nodes(), 3 * mesh.n_nodes());
    Rng rng(4);
    for (int i = 0; i < mesh.n_nodes(); ++i) add(i, i, Vec3(4.0, 5.0, 6.0).asDiagonal());
    for (int e = 0; e < mesh.n_elements(); ++e) {
      const auto& nodes = mesh.elements[static_cast<std::size_t>(e)];
      for (const int i : nodes)
        for (const int j : nodes) {
          if (i <= j) continue;
          Mat3 m = -0.1 * Mat3::Identity();
          if (i >= card)
            for (int k = 0; k < 9; ++k) m.data()[k] = 0.1 * rng.normal();
          add(i, j, m);
        }
    }
  }
};

TEST(VesselWallMatrix, SolvesAsTheWholeMatrixDoes) {
  const Sample s;
  WallMatrix matrix(s.mesh, s.blocks);
  ASSERT_TRUE(matrix.round(0));
  ASSERT_FALSE(matrix.round(1));
  const Eigen::VectorXf b = Eigen::VectorXf::Random(s.dense.rows());
  Eigen::VectorXf x = b;
  matrix.solve(x);
  const Eigen::VectorXd exact = s.dense.llt().solve(b.cast<double>());
  EXPECT_LT((x.cast<double>() - exact).norm(), 1e-5 * exact.norm());  // single precision, a condition number of a few
}

TEST(VesselWallMatrix, KeepsTheInverseOfBothKindsOfPart) {
  const Sample s;
  const WallMatrix matrix(s.mesh, s.blocks);
  const Eigen::MatrixXd inverse = s.dense.inverse();
  for (const auto& [from, to] : {std::pair{0, s.card}, {s.card, s.mesh.n_nodes()}}) {
    EXPECT_EQ(matrix.part_of(from), from == 0 ? 0 : 1);
    EXPECT_TRUE(matrix.known(matrix.part_of(from)));
    double worst = 0.0;
    for (int i = from; i < to; ++i)
      for (int j = from; j < to; ++j) worst = std::max(worst, (matrix.inverse(i, j).cast<double>() - inverse.block<3, 3>(3 * i, 3 * j)).cwiseAbs().maxCoeff());
    EXPECT_LT(worst, 1e-5 * inverse.cwiseAbs().maxCoeff());
  }
}

/// Several nodes of a part, in no order, a node twice, and again with others: nothing is left from the time before.
TEST(VesselWallMatrix, SubtractsTheAnswersToForcesAtSomeNodes) {
  const Sample s;
  WallMatrix matrix(s.mesh, s.blocks);
  for (const std::vector<int>& nodes : {std::vector<int>{s.card - 2, 3, s.card + 5, 3, 47, s.card + 7}, {s.card - 1, s.card}, {s.card + 1}}) {
    const Eigen::VectorXf f = Eigen::VectorXf::Random(3 * static_cast<Eigen::Index>(nodes.size())), before = Eigen::VectorXf::Random(s.dense.rows());
    Eigen::VectorXd load = Eigen::VectorXd::Zero(s.dense.rows());
    for (std::size_t k = 0; k < nodes.size(); ++k) load.segment<3>(3 * nodes[k]) += f.segment<3>(3 * static_cast<Eigen::Index>(k)).cast<double>();
    Eigen::VectorXf x = before;
    matrix.subtract(nodes, f, x);
    const Eigen::VectorXd exact = before.cast<double>() - s.dense.llt().solve(load);
    EXPECT_LT((x.cast<double>() - exact).norm(), 1e-5 * exact.norm());
  }
}

/// Of a card of more than 1200 nodes only the factors are kept.
TEST(VesselWallMatrix, KeepsNoInverseThatIsTooLarge) {
  VesselMesh mesh;
  CardShape shape;
  shape.across = 9;
  shape.deep = 60;
  mesh = make_card(shape);
  ASSERT_GT(mesh.n_nodes(), 1200);
  std::vector<SlabFactor::Block> blocks;
  for (int i = 0; i < mesh.n_nodes(); ++i) blocks.push_back({i, i, 2.0 * Mat3::Identity()});
  WallMatrix matrix(mesh, blocks);
  EXPECT_FALSE(matrix.known(0));
  Eigen::VectorXf x = Eigen::VectorXf::LinSpaced(3 * mesh.n_nodes(), 1.0f, 2.0f);
  const Eigen::VectorXf b = x;
  matrix.solve(x);
  EXPECT_LT((2.0f * x - b).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(VesselWallMatrix, RefusesNodesThatAreNotNumberedPartByPart) {
  Sample s;
  std::swap(s.mesh.node_part.front(), s.mesh.node_part.back());
  EXPECT_THROW(WallMatrix(s.mesh, s.blocks), std::invalid_argument);
}

}  // namespace vessel_wall_matrix_test
}  // namespace filum
