#include "physics/vessel_wall_rings.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "physics/vessel_wall_element.h"
#include "physics/vessel_wall_matrix.h"

using namespace filum;

namespace vessel_wall_rings_test {

/// Stiffness of a tube of two laws with fibres, on the ground and heavier from ring to ring, each node's numbers outward, along and around.
struct Tube {
  VesselMesh mesh;
  std::vector<SlabFactor::Block> blocks;
  Eigen::MatrixXd dense;

  Mat3 own(int i) const {
    const Vec3 out = Vec3(mesh.nodes(0, i), mesh.nodes(1, i), 0.0).normalized();
    Mat3 f;
    f << out, Vec3::UnitZ(), out.cross(Vec3::UnitZ());
    return f;
  }
  Tube(int around, int along, int through) {
    TubeShape shape;
    shape.around = around;
    shape.along = along;
    shape.through = through;
    shape.stretch = 1.1;
    shape.edge_grading = 2.0;
    mesh = make_tube(shape);
    WallLaw law;
    law.kind = WallLaw::Kind::fibres;
    law.mu = 1e4;
    law.lambda = 1e6;
    law.k1 = 2e4;
    law.beta = 0.6;
    WallLaw plain = law;
    plain.kind = WallLaw::Kind::neo_hookean;
    const WallElements elements(mesh, {{"media", 6e-5, law}, {"adventitia", 4e-5, plain}});
    const int n = 3 * mesh.n_nodes();
    dense = Eigen::MatrixXd::Zero(n, n);
    for (int e = 0; e < mesh.n_elements(); ++e) {
      const auto K = elements.stiffness(e, mesh.nodes, true);
      for (int a = 0; a < 8; ++a)
        for (int b = 0; b < 8; ++b) {
          const int i = mesh.elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)], j = mesh.elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(b)];
          if (i >= j) add(i, j, own(i).transpose() * K.block<3, 3>(3 * a, 3 * b) * own(j));
        }
    }
    for (int i = 0; i < mesh.n_nodes(); ++i) add(i, i, 5.0 * (1.0 + mesh.slab[static_cast<std::size_t>(i)]) * Mat3::Identity());
  }
  void add(int i, int j, const Mat3& m) {
    blocks.push_back({i, j, m});
    dense.block<3, 3>(3 * i, 3 * j) += m;
    if (i != j) dense.block<3, 3>(3 * j, 3 * i) += m.transpose();
  }
};

TEST(VesselWallRings, SolvesAsTheWholeMatrixDoes) {
  for (const auto& [around, along, through] : {std::array{8, 3, 1}, {9, 4, 2}, {24, 2, 1}, {3, 2, 1}}) {
    const Tube t(around, along, through);
    auto f = RingFactor::make(around, t.mesh.slab, t.blocks);
    ASSERT_TRUE(f) << around;
    const Eigen::VectorXf b = Eigen::VectorXf::Random(t.dense.rows());
    Eigen::VectorXf x = b;
    f->solve(x);
    const Eigen::VectorXd exact = t.dense.llt().solve(b.cast<double>());
    EXPECT_LT((x.cast<double>() - exact).norm(), 2e-5 * exact.norm()) << around;
  }
}

TEST(VesselWallRings, ColumnsOfOneSectorGiveTheWholeInverse) {
  const Tube t(9, 3, 2);
  auto f = RingFactor::make(9, t.mesh.slab, t.blocks);
  ASSERT_TRUE(f);
  f->keep_inverse();
  const Eigen::MatrixXd inverse = t.dense.inverse();
  double worst = 0.0;
  for (int i = 0; i < t.mesh.n_nodes(); ++i)
    for (int j = 0; j < t.mesh.n_nodes(); ++j)
      worst = std::max(worst, (f->inverse(i, j).cast<double>() - inverse.block<3, 3>(3 * i, 3 * j)).cwiseAbs().maxCoeff());
  EXPECT_LT(worst, 2e-5 * inverse.cwiseAbs().maxCoeff());
}

TEST(VesselWallRings, RefusesWhatIsNotTheSameAllRound) {
  Tube t(8, 3, 1);
  const std::vector<SlabFactor::Block> whole = t.blocks;
  t.add(5, 5, 1e-2 * t.dense.cwiseAbs().maxCoeff() * Mat3::Identity());  // one node is held a little
  EXPECT_FALSE(RingFactor::make(8, t.mesh.slab, t.blocks));
  t.blocks = whole;
  Mat3 skew = Mat3::Zero();
  skew(1, 2) = skew(2, 1) = 1e-2 * t.dense.cwiseAbs().maxCoeff();
  for (int i = 0; i < t.mesh.n_nodes(); ++i) t.add(i, i, skew);  // the same all round, but not in a mirror
  EXPECT_FALSE(RingFactor::make(8, t.mesh.slab, t.blocks));
  EXPECT_FALSE(RingFactor::make(7, t.mesh.slab, whole));
  EXPECT_FALSE(RingFactor::make(0, t.mesh.slab, whole));
  EXPECT_TRUE(RingFactor::make(8, t.mesh.slab, whole));
}

/// Two tubes and a card together, against one slab factor over all.
TEST(VesselWallMatrix, PartsOfBothKinds) {
  const Tube t(8, 3, 1);
  VesselMesh mesh = t.mesh;
  CardShape shape;
  shape.across = 4;
  shape.deep = 3;
  append(mesh, make_card(shape), {});
  append(mesh, t.mesh, {});
  std::vector<SlabFactor::Block> blocks = t.blocks;
  const int card = t.mesh.n_nodes(), second = mesh.n_nodes() - t.mesh.n_nodes();
  for (const SlabFactor::Block& b : t.blocks) blocks.push_back({b.row + second, b.column + second, b.value});
  for (int i = card; i < second; ++i) blocks.push_back({i, i, (2.0 + i % 3) * Mat3::Identity()});
  for (int i = card + 1; i < second; ++i)
    if (mesh.slab[static_cast<std::size_t>(i)] == mesh.slab[static_cast<std::size_t>(i) - 1]) blocks.push_back({i, i - 1, 0.3 * Mat3::Ones()});
  WallMatrix matrix(mesh, blocks);
  EXPECT_TRUE(matrix.round(0) && !matrix.round(1) && matrix.round(2));
  const Eigen::VectorXf b = Eigen::VectorXf::Random(3 * mesh.n_nodes());
  Eigen::VectorXf x = b, expected = b;
  matrix.solve(x);
  SlabFactor(mesh.slab, blocks).solve(expected);
  EXPECT_LT((x - expected).norm(), 2e-5f * expected.norm());
  const std::vector<int> nodes = {7, card + 4, second + 9};
  Eigen::VectorXf f = Eigen::VectorXf::Random(9), load = Eigen::VectorXf::Zero(b.size()), zero = load;
  for (int k = 0; k < 3; ++k) load.segment<3>(3 * nodes[static_cast<std::size_t>(k)]) = f.segment<3>(3 * k);
  matrix.subtract(nodes, f, zero);
  matrix.solve(load);
  EXPECT_LT((zero + load).norm(), 1e-5f * load.norm());
  EXPECT_LT((matrix.inverse(7, 7) * f.head<3>() - load.segment<3>(21)).norm(), 1e-5f * load.norm());
}

}  // namespace vessel_wall_rings_test
