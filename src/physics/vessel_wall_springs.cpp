#include "physics/vessel_wall_springs.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace filum {

WallSprings::WallSprings(const SlabFactor& factor, const VesselMesh& mesh) : part_of_(mesh.node_part) {
  springs_.resize(kMost);
  int largest = 0;
  for (int i = 0; i < mesh.n_nodes();) {
    int end = i;
    while (end < mesh.n_nodes() && part_of_[static_cast<std::size_t>(end)] == part_of_[static_cast<std::size_t>(i)]) ++end;
    Part p;
    p.first = i;
    const int slab = mesh.slab.front();
    if (end - i <= kLargestPart) {
      p.inverse = factor.inverse(mesh.slab[static_cast<std::size_t>(i)] - slab, mesh.slab[static_cast<std::size_t>(end) - 1] - slab + 1);
      largest = std::max(largest, 3 * (end - i));
    }
    parts_.push_back(std::move(p));
    i = end;
  }
  columns_.resize(largest, 3 * kMost);
  small_.resize(3 * kMost, 3 * kMost);
  load_.resize(3 * kMost);
}

bool WallSprings::add(const WallSpring& spring, const std::vector<Mat3>& turn) noexcept {
  const int part = part_of_[static_cast<std::size_t>(spring.node[0])];
  if (n_ == kMost || parts_[static_cast<std::size_t>(part)].inverse.size() == 0) return false;
  Spring& s = springs_[static_cast<std::size_t>(n_++)];
  s.part = part;
  s.node = spring.node;
  for (std::size_t a = 0; a < 8; ++a)
    s.blocks[a] = (spring.weight[static_cast<int>(a)] * turn[static_cast<std::size_t>(spring.node[a])]).cast<float>();
  Eigen::SelfAdjointEigenSolver<Mat3> eigen;
  eigen.computeDirect(spring.stiffness);
  s.root = (eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal()).cast<float>();
  return true;
}

Eigen::Vector3f WallSprings::at(const Spring& s, const Eigen::Ref<const Eigen::VectorXf>& x) const noexcept {
  Eigen::Vector3f u = Eigen::Vector3f::Zero();
  for (std::size_t a = 0; a < 8; ++a) u += s.blocks[a] * x.segment<3>(3 * s.node[a]);
  return u;
}

bool WallSprings::prepare() noexcept {
  ready_ = false;
  if (n_ == 0) return false;
  for (int k = 0; k < n_; ++k) {
    const Spring& s = springs_[static_cast<std::size_t>(k)];
    const Part& p = parts_[static_cast<std::size_t>(s.part)];
    auto column = columns_.block(0, 3 * k, p.inverse.rows(), 3);
    column.setZero();
    for (std::size_t a = 0; a < 8; ++a) {
      const Eigen::Matrix3f J = s.blocks[a].transpose() * s.root;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) column.col(c) += J(r, c) * p.inverse.col(3 * (s.node[a] - p.first) + r);
    }
  }
  for (int i = 0; i < n_; ++i) {
    const Spring& s = springs_[static_cast<std::size_t>(i)];
    for (int j = 0; j < n_; ++j) {
      auto block = small_.block<3, 3>(3 * i, 3 * j);
      block.setZero();
      if (springs_[static_cast<std::size_t>(j)].part == s.part) {
        const int first = parts_[static_cast<std::size_t>(s.part)].first;
        Eigen::Matrix3f u = Eigen::Matrix3f::Zero();
        for (std::size_t a = 0; a < 8; ++a) u += s.blocks[a] * columns_.block<3, 3>(3 * (s.node[a] - first), 3 * j);
        block = s.root.transpose() * u;
      }
      if (i == j) block += Eigen::Matrix3f::Identity();
    }
  }
  Eigen::Ref<Eigen::MatrixXf> used = small_.topLeftCorner(3 * n_, 3 * n_);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>> llt(used);
  ready_ = llt.info() == Eigen::Success;
  return ready_;
}

void WallSprings::correct(Eigen::Ref<Eigen::VectorXf> x) noexcept {
  if (!ready_) return;
  for (int k = 0; k < n_; ++k) {
    const Spring& s = springs_[static_cast<std::size_t>(k)];
    load_.segment<3>(3 * k) = s.root.transpose() * at(s, x);
  }
  auto load = load_.head(3 * n_);
  const auto factor = small_.topLeftCorner(3 * n_, 3 * n_);
  factor.triangularView<Eigen::Lower>().solveInPlace(load);
  factor.transpose().triangularView<Eigen::Upper>().solveInPlace(load);
  for (int k = 0; k < n_; ++k) {
    const Part& p = parts_[static_cast<std::size_t>(springs_[static_cast<std::size_t>(k)].part)];
    for (int c = 0; c < 3; ++c) x.segment(3 * p.first, p.inverse.rows()) -= load[3 * k + c] * columns_.col(3 * k + c).head(p.inverse.rows());
  }
}

}  // namespace filum
