#include "physics/vessel_wall_factor.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

namespace filum {

SlabFactor::SlabFactor(const std::vector<int>& slab, const std::vector<Block>& blocks) {
  for (std::size_t i = 0; i < slab.size(); ++i) {
    if (i == 0 || slab[i] != slab[i - 1]) slabs_.emplace_back().first = 3 * static_cast<int>(i);
    slabs_.back().size += 3;
  }
  const auto index = [&](int node) { return static_cast<std::size_t>(slab[static_cast<std::size_t>(node)] - slab.front()); };
  std::vector<Eigen::MatrixXd> own(slabs_.size());
  for (std::size_t k = 0; k < slabs_.size(); ++k) own[k] = Eigen::MatrixXd::Zero(slabs_[k].size, slabs_[k].size);
  for (const Block& b : blocks) {
    const std::size_t r = index(b.row), c = index(b.column);
    if (r > c + 1 || r < c) throw std::invalid_argument("a block joins slabs that are not neighbours");
    if (r == c) {
      const int i = 3 * b.row - slabs_[r].first, j = 3 * b.column - slabs_[r].first;
      own[r].block<3, 3>(i, j) += b.value;
      if (i != j) own[r].block<3, 3>(j, i) += b.value.transpose();
      continue;
    }
    auto& list = slabs_[r].before;
    const auto same = [&](const Coupling& o) { return o.row == 3 * b.row && o.column == 3 * b.column; };
    const auto found = std::find_if(list.begin(), list.end(), same);
    if (found != list.end())
      found->value += b.value.cast<float>();
    else
      list.push_back({3 * b.row, 3 * b.column, b.value.cast<float>()});
  }
  Eigen::MatrixXd inverse, spread;
  for (std::size_t k = 0; k < slabs_.size(); ++k) {
    if (!slabs_[k].before.empty()) {
      const Slab& last = slabs_[k - 1];
      spread.setZero(slabs_[k].size, last.size);  // C S^-1
      for (const Coupling& c : slabs_[k].before)
        spread.middleRows<3>(c.row - slabs_[k].first) += c.value.cast<double>() * inverse.middleRows<3>(c.column - last.first);
      for (const Coupling& c : slabs_[k].before)
        own[k].middleCols<3>(c.row - slabs_[k].first) -= spread.middleCols<3>(c.column - last.first) * c.value.cast<double>().transpose();
    }
    const Eigen::LLT<Eigen::MatrixXd> llt(own[k]);
    if (llt.info() != Eigen::Success) throw std::invalid_argument("the matrix is not positive definite");
    inverse = llt.solve(Eigen::MatrixXd::Identity(slabs_[k].size, slabs_[k].size));
    slabs_[k].inverse = inverse.cast<float>();
  }
  work_.resize(3 * static_cast<int>(slab.size()));
}

void SlabFactor::solve(Eigen::Ref<Eigen::VectorXf> b) noexcept {
  for (std::size_t k = 0; k < slabs_.size(); ++k) {
    const Slab& s = slabs_[k];
    for (const Coupling& c : s.before) b.segment<3>(c.row).noalias() -= c.value * work_.segment<3>(c.column);
    work_.segment(s.first, s.size).noalias() = s.inverse * b.segment(s.first, s.size);
  }
  b = work_;
  for (std::size_t k = slabs_.size(); k-- > 1;) {
    const Slab &s = slabs_[k], &last = slabs_[k - 1];
    if (s.before.empty()) continue;
    auto spread = work_.segment(last.first, last.size);  // its own entries have been handed on
    spread.setZero();
    for (const Coupling& c : s.before) spread.segment<3>(c.column - last.first).noalias() += c.value.transpose() * b.segment<3>(c.row);
    b.segment(last.first, last.size).noalias() -= last.inverse * spread;
  }
}

Eigen::MatrixXf SlabFactor::inverse(int first, int last) const {
  const int begin = slabs_[static_cast<std::size_t>(first)].first;
  const int n = slabs_[static_cast<std::size_t>(last) - 1].first + slabs_[static_cast<std::size_t>(last) - 1].size - begin;
  Eigen::MatrixXf b = Eigen::MatrixXf::Identity(n, n), spread;
  for (int k = first; k < last; ++k) {
    const Slab& s = slabs_[static_cast<std::size_t>(k)];
    for (const Coupling& c : s.before) b.middleRows<3>(c.row - begin) -= c.value * b.middleRows<3>(c.column - begin);
    b.middleRows(s.first - begin, s.size) = (s.inverse * b.middleRows(s.first - begin, s.size)).eval();
  }
  for (int k = last - 1; k > first; --k) {
    const Slab &s = slabs_[static_cast<std::size_t>(k)], &before = slabs_[static_cast<std::size_t>(k) - 1];
    spread.setZero(before.size, n);
    for (const Coupling& c : s.before) spread.middleRows<3>(c.column - before.first) += c.value.transpose() * b.middleRows<3>(c.row - begin);
    b.middleRows(before.first - begin, before.size) -= before.inverse * spread;
  }
  return b;
}

}  // namespace filum
