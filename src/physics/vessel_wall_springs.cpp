#include "physics/vessel_wall_springs.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace filum {

WallSprings::WallSprings(int n_nodes) {
  kept_.resize(kKept);
  pair_.resize(3 * kKept, 3 * kKept);
  known_.assign(kKept * kKept, 0);
  mark_.assign(static_cast<std::size_t>(n_nodes), -1);
  row_ = mark_;
  nodes_.reserve(8 * kMost);
  among_.reserve(kNodes);
  near_.resize(3 * kNodes, 3 * kNodes);
  moved_.resize(3 * kNodes, 3);
  share_.resize(24 * kMost);
  small_.resize(3 * kMost, 3 * kMost);
  load_.resize(3 * kMost);
}

void WallSprings::clear() noexcept {
  n_ = n_kept_ = 0;
  first_ = true;
}

int WallSprings::find(const WallSpring& spring) const noexcept {
  for (int k = 0; k < n_kept_; ++k) {
    const WallSpring& s = kept_[static_cast<std::size_t>(k)].given;
    if (s.node == spring.node && s.weight == spring.weight && s.stiffness == spring.stiffness) return k;
  }
  return -1;
}

/// A place in kept_, of a spring that is not there at present if need be.
int WallSprings::room() noexcept {
  int k = n_kept_;
  if (k < kKept)
    ++n_kept_;
  else
    for (k = 0; std::find(active_.begin(), active_.begin() + n_, k) != active_.begin() + n_;) ++k;
  for (int i = 0; i < kKept; ++i) known(i, k) = known(k, i) = 0;
  return k;
}

bool WallSprings::add(const WallSpring& spring, const std::vector<Mat3>& turn, const WallMatrix& P) noexcept {
  if (n_ == kMost || !P.known(P.part_of(spring.node[0]))) return false;
  int& place = active_[static_cast<std::size_t>(n_)];
  place = find(spring);
  if (place < 0) {
    place = room();
    Spring& s = kept_[static_cast<std::size_t>(place)];
    s.given = spring;
    s.n = 0;
    for (std::size_t a = 0; a < 8; ++a) {
      const double weight = spring.weight[static_cast<int>(a)];
      if (weight == 0.0) continue;
      s.node[static_cast<std::size_t>(s.n)] = spring.node[a];
      s.blocks[static_cast<std::size_t>(s.n++)] = (weight * turn[static_cast<std::size_t>(spring.node[a])]).cast<float>();
    }
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(spring.stiffness);
    s.root = (eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal()).cast<float>();
  }
  ++n_;
  return true;
}

Eigen::Vector3f WallSprings::at(const Spring& s, const Eigen::Ref<const Eigen::VectorXf>& x) const noexcept {
  Eigen::Vector3f u = Eigen::Vector3f::Zero();
  for (std::size_t a = 0; a < s.corners().size(); ++a) u += s.blocks[a] * x.segment<3>(3 * s.node[a]);
  return u;
}

void WallSprings::number_nodes() noexcept {
  for (const int i : nodes_) mark_[static_cast<std::size_t>(i)] = -1;
  nodes_.clear();
  for (int k = 0; k < n_; ++k)
    for (const int i : spring(k).corners()) {
      int& place = mark_[static_cast<std::size_t>(i)];
      if (place >= 0) continue;
      place = 3 * static_cast<int>(nodes_.size());
      nodes_.push_back(i);
    }
}

/// The inverse among the nodes that springs stand on, and those of the step's earlier sets; nothing between parts.
void WallSprings::gather_inverse(const WallMatrix& P) noexcept {
  const auto fresh = static_cast<std::size_t>(std::count_if(nodes_.begin(), nodes_.end(), [&](int i) { return row_[static_cast<std::size_t>(i)] < 0; }));
  if (among_.size() + fresh > kNodes || (first_ && among_.size() + fresh > nodes_.size())) {
    for (const int i : among_) row_[static_cast<std::size_t>(i)] = -1;
    among_.clear();
  }
  first_ = false;
  const auto take_in = [&](int n) {
    const int row = row_[static_cast<std::size_t>(n)] = 3 * static_cast<int>(among_.size());
    among_.push_back(n);
    for (std::size_t i = 0; i < among_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(3 * i);
      const bool joined = P.part_of(among_[i]) == P.part_of(n);
      near_.block<3, 3>(k, row) = joined ? P.inverse(among_[i], n) : Eigen::Matrix3f(Eigen::Matrix3f::Zero());
      near_.block<3, 3>(row, k) = joined ? P.inverse(n, among_[i]) : Eigen::Matrix3f(Eigen::Matrix3f::Zero());
    }
  };
  for (int k = n_; k-- > 0;)  // those of the last springs first: couple() reads no further than it must
    for (const int n : spring(k).corners())
      if (row_[static_cast<std::size_t>(n)] < 0) take_in(n);
}

/// What is not yet known of the j-th spring's column of L^T W L.
void WallSprings::couple(int j) noexcept {
  const int column = active_[static_cast<std::size_t>(j)];
  const Spring& s = spring(j);
  int used = 0;  // rows of near_ that are asked for
  for (int i = j; i < n_; ++i)
    if (known(active_[static_cast<std::size_t>(i)], column) == 0)
      for (const int node : spring(i).corners()) used = std::max(used, row_[static_cast<std::size_t>(node)] + 3);
  bool ready = false;
  for (int i = j; i < n_; ++i) {
    const int row = active_[static_cast<std::size_t>(i)];
    if (known(row, column) != 0) continue;
    auto moved = moved_.topRows(used);
    if (!ready) moved.setZero();
    for (std::size_t a = 0; a < s.corners().size() && !ready; ++a) {
      const Eigen::Matrix3f J = s.blocks[a].transpose() * s.root;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) moved.col(c) += J(r, c) * near_.col(row_[static_cast<std::size_t>(s.node[a])] + r).head(used);
    }
    ready = true;
    const Spring& t = spring(i);
    Eigen::Matrix3f u = Eigen::Matrix3f::Zero();
    for (std::size_t a = 0; a < t.corners().size(); ++a) u += t.blocks[a] * moved.block<3, 3>(row_[static_cast<std::size_t>(t.node[a])], 0);
    pair_.block<3, 3>(3 * row, 3 * column) = t.root.transpose() * u;
    known(row, column) = 1;
  }
}

bool WallSprings::prepare(const WallMatrix& P) noexcept {
  ready_ = false;
  if (n_ == 0) return false;
  number_nodes();
  gather_inverse(P);
  for (int j = 0; j < n_; ++j) {
    couple(j);
    for (int i = j; i < n_; ++i)
      small_.block<3, 3>(3 * i, 3 * j) = pair_.block<3, 3>(3 * active_[static_cast<std::size_t>(i)], 3 * active_[static_cast<std::size_t>(j)]);
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
    const Spring& s = spring(k);
    load_.segment<3>(3 * k) = s.root.transpose() * at(s, x);
  }
  auto load = load_.head(3 * n_);
  const auto factor = small_.topLeftCorner(3 * n_, 3 * n_);
  factor.triangularView<Eigen::Lower>().solveInPlace(load);
  factor.transpose().triangularView<Eigen::Upper>().solveInPlace(load);
  share_.head(static_cast<Eigen::Index>(3 * nodes_.size())).setZero();
  for (int k = 0; k < n_; ++k) {
    const Spring& s = spring(k);
    const Eigen::Vector3f f = s.root * load.segment<3>(3 * k);
    for (std::size_t a = 0; a < s.corners().size(); ++a) share_.segment<3>(mark_[static_cast<std::size_t>(s.node[a])]) += s.blocks[a].transpose() * f;
  }
  P.subtract(nodes_, share_, x);
}

}  // namespace filum
