#include "physics/vessel_wall_factor.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "base/rng.h"

using namespace filum;

namespace vessel_wall_factor_test {

struct Sample {
  std::vector<int> slab = {0, 0, 0, 1, 1, 2, 2, 2, 5, 5};  // the last two stand apart
  std::vector<SlabFactor::Block> blocks;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(30, 30);
  Sample() {
    Rng rng(1);
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j <= i; ++j) {
        if (slab[static_cast<std::size_t>(i)] - slab[static_cast<std::size_t>(j)] > 1) continue;
        Mat3 m;
        for (int k = 0; k < 9; ++k) m.data()[k] = rng.normal();
        if (i == j) m = (m + m.transpose() + 40.0 * Mat3::Identity()).eval();
        blocks.push_back({i, j, m});
        dense.block<3, 3>(3 * i, 3 * j) = m;
        dense.block<3, 3>(3 * j, 3 * i) = m.transpose();
      }
    slab = {0, 0, 0, 1, 1, 2, 2, 2, 3, 3};
  }
};

TEST(VesselWallFactor, Solves) {
  const Sample s;
  SlabFactor f(s.slab, s.blocks);
  const Eigen::VectorXf b = Eigen::VectorXf::Random(30);
  Eigen::VectorXf x = b;
  f.solve(x);
  EXPECT_LT((s.dense * x.cast<double>() - b.cast<double>()).norm(), 1e-5 * b.norm());
  EXPECT_EQ(f.n_slabs(), 4);
}

TEST(VesselWallFactor, RefusesWhatItCannotHold) {
  Sample s;
  s.blocks.push_back({8, 0, Mat3::Identity()});
  EXPECT_THROW(SlabFactor(s.slab, s.blocks), std::invalid_argument);
  s.blocks.back() = {0, 0, -100.0 * Mat3::Identity()};
  EXPECT_THROW(SlabFactor(s.slab, s.blocks), std::invalid_argument);
}

}  // namespace vessel_wall_factor_test
