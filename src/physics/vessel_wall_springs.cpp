#include "physics/vessel_wall_springs.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace filum {

WallSprings::WallSprings(int n_nodes) {
  springs_.resize(kMost);
  mark_.assign(static_cast<std::size_t>(n_nodes), -1);
  nodes_.reserve(8 * kMost);
  near_.resize(24 * kMost, 24 * kMost);
  moved_.resize(24 * kMost, 3);
  share_.resize(24 * kMost);
  small_.resize(3 * kMost, 3 * kMost);
  load_.resize(3 * kMost);
}

bool WallSprings::add(const WallSpring& spring, const std::vector<Mat3>& turn, const WallMatrix& P) noexcept {
  if (n_ == kMost || !P.known(P.part_of(spring.node[0]))) return false;
  Spring& s = springs_[static_cast<std::size_t>(n_++)];
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

/// The inverse among the nodes that springs stand on; nothing between parts.
void WallSprings::gather_inverse(const WallMatrix& P) noexcept {
  for (const int i : nodes_) mark_[static_cast<std::size_t>(i)] = -1;
  nodes_.clear();
  for (int k = 0; k < n_; ++k)
    for (const int i : springs_[static_cast<std::size_t>(k)].node) {
      int& place = mark_[static_cast<std::size_t>(i)];
      if (place >= 0) continue;
      place = 3 * static_cast<int>(nodes_.size());
      nodes_.push_back(i);
    }
  for (std::size_t j = 0; j < nodes_.size(); ++j)
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      auto block = near_.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j));
      if (P.part_of(nodes_[i]) == P.part_of(nodes_[j]))
        block = P.inverse(nodes_[i], nodes_[j]);
      else
        block.setZero();
    }
}

bool WallSprings::prepare(const WallMatrix& P) noexcept {
  ready_ = false;
  if (n_ == 0) return false;
  gather_inverse(P);
  const auto used = static_cast<Eigen::Index>(3 * nodes_.size());
  for (int j = 0; j < n_; ++j) {
    const Spring& s = springs_[static_cast<std::size_t>(j)];
    auto moved = moved_.topRows(used);
    moved.setZero();
    for (std::size_t a = 0; a < 8; ++a) {
      const Eigen::Matrix3f J = s.blocks[a].transpose() * s.root;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) moved.col(c) += J(r, c) * near_.col(mark_[static_cast<std::size_t>(s.node[a])] + r).head(used);
    }
    for (int i = j; i < n_; ++i) {
      const Spring& t = springs_[static_cast<std::size_t>(i)];
      Eigen::Matrix3f u = Eigen::Matrix3f::Zero();
      for (std::size_t a = 0; a < 8; ++a) u += t.blocks[a] * moved.block<3, 3>(mark_[static_cast<std::size_t>(t.node[a])], 0);
      small_.block<3, 3>(3 * i, 3 * j) = t.root.transpose() * u;
    }
    small_.block<3, 3>(3 * j, 3 * j) += Eigen::Matrix3f::Identity();
  }
  Eigen::Ref<Eigen::MatrixXf> lower = small_.topLeftCorner(3 * n_, 3 * n_);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>> llt(lower);
  ready_ = llt.info() == Eigen::Success;
  return ready_;
}

void WallSprings::correct(WallMatrix& P, Eigen::Ref<Eigen::VectorXf> x) noexcept {
  if (!ready_) return;
  for (int k = 0; k < n_; ++k) {
    const Spring& s = springs_[static_cast<std::size_t>(k)];
    load_.segment<3>(3 * k) = s.root.transpose() * at(s, x);
  }
  auto load = load_.head(3 * n_);
  const auto factor = small_.topLeftCorner(3 * n_, 3 * n_);
  factor.triangularView<Eigen::Lower>().solveInPlace(load);
  factor.transpose().triangularView<Eigen::Upper>().solveInPlace(load);
  share_.head(static_cast<Eigen::Index>(3 * nodes_.size())).setZero();
  for (int k = 0; k < n_; ++k) {
    const Spring& s = springs_[static_cast<std::size_t>(k)];
    const Eigen::Vector3f f = s.root * load.segment<3>(3 * k);
    for (std::size_t a = 0; a < 8; ++a) share_.segment<3>(mark_[static_cast<std::size_t>(s.node[a])]) += s.blocks[a].transpose() * f;
  }
  P.subtract(nodes_, share_, x);
}

}  // namespace filum
