#include "anatomy/brain_mesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/error.h"

namespace filum {
namespace brain_mesher_test {

/// Shares of a ball of grey, 45 mm in radius, about white of 30 mm.
BrainScan ball() {
  constexpr int n = 60;
  constexpr double voxel = 2e-3;
  BrainScan s;
  s.grid.size = {n, n, n};
  s.grid.step = voxel * Mat3::Identity();
  s.grid.first = Vec3::Constant(-0.5 * voxel * (n - 1));
  const auto share = [](double r, double at) { return static_cast<float>(std::clamp(0.5 + (at - r) / 4e-3, 0.0, 1.0)); };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double r = s.grid.place(Vec3(i, j, k)).norm();
        s.brain.push_back(share(r, 45e-3));
        s.white.push_back(share(r, 30e-3));
      }
  return s;
}

TEST(BrainMesher, ACylinderOfABallHasItsVolumeAndFrame) {
  Window w;
  w.at = Vec3(0.01, 0.02, 0.08);
  w.radius = 20e-3;
  w.depth = 25e-3;
  w.fine = 3e-3;
  w.coarse = 5e-3;
  const BrainRegion r = mesh_region(ball(), w, "ball");
  const Vec3 out = w.at.normalized();
  EXPECT_LT((r.origin - 45e-3 * out).norm(), 1e-3);
  EXPECT_LT((r.axes.col(2) - out).norm(), 1e-12);
  EXPECT_NEAR(r.axes.determinant(), 1.0, 1e-12);
  // disc of height h0 = depth - (R - sqrt(R^2 - a^2)) and the cap above it
  const double R = 45e-3, a = 20e-3, rise = R - std::sqrt(R * R - a * a), cap = std::numbers::pi * rise * rise * (R - rise / 3.0);
  const double volume = std::numbers::pi * a * a * (w.depth - rise) + cap;
  EXPECT_NEAR(r.grey + r.white, volume, 0.04 * volume);
  EXPECT_GT(r.white, 0.1 * volume);
  EXPECT_GT(r.grey, 0.3 * volume);
  const MeshQuality q = mesh_quality(r.mesh);
  EXPECT_GT(q.worst_shape, 0.02);
  EXPECT_GT(q.mean_shape, 0.6);
  EXPECT_LT(r.mesh.nodes.row(2).maxCoeff(), 1e-3);
  EXPECT_GT(r.mesh.nodes.row(2).minCoeff(), -w.depth - 1e-3);
}

TEST(BrainMesher, WindowsThatShowNothingAreRefused) {
  Window w;
  EXPECT_THROW(mesh_region(ball(), w, "ball"), InputError);  // the middle
  w.at = Vec3(0, 0, 0.1);
  w.radius = -1.0;
  EXPECT_THROW(mesh_region(ball(), w, "ball"), InputError);
}

TEST(BrainMesher, Colin27) {
  const std::string scan = "/usr/share/mricron/templates/ch2bet.nii.gz";
  if (!std::filesystem::exists(scan)) GTEST_SKIP() << "SKIPPED: install mricron-data to mesh a real head (" << scan << ")";
  ScanOptions o;
  o.extracted = true;
  const BrainScan s = find_brain(read_nifti(scan), o, scan);
  EXPECT_GT(s.volume, 1.2e-3);  // [m3]
  EXPECT_LT(s.volume, 2.2e-3);
  Window w;
  w.at = Vec3(-0.045, 0.045, 0.04);
  w.radius = 25e-3;
  w.depth = 25e-3;
  w.fine = 3e-3;
  const BrainRegion r = mesh_region(s, w, scan);
  EXPECT_GT(r.mesh.n_nodes(), 500);
  EXPECT_LT(r.dropped, r.mesh.n_tets() / 50);
  EXPECT_GT(mesh_quality(r.mesh).worst_shape, 0.01);
  EXPECT_GT(r.grey, 0.0);
  EXPECT_GT(r.white, 0.0);
  // the whole head, scalp and all: the brain found in it is the one that somebody else has cut out
  const std::string head = "/usr/share/mricron/templates/ch2.nii.gz";
  EXPECT_NEAR(find_brain(read_nifti(head), {}, head).volume, s.volume, 0.1 * s.volume);
}

}  // namespace brain_mesher_test
}  // namespace filum
