#include "physics/vessel_wall_matrix.h"

#include <algorithm>

namespace filum {

WallMatrix::WallMatrix(const VesselMesh& mesh, const std::vector<SlabFactor::Block>& blocks) : part_of_(mesh.node_part) {
  work_.setZero(3 * mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes();) {
    const auto number = parts_.size();
    Part& p = parts_.emplace_back();
    p.first = i;
    while (i < mesh.n_nodes() && part_of_[static_cast<std::size_t>(i)] == static_cast<int>(number)) ++i;
    p.n = i - p.first;
    if (p.n == 0) throw std::invalid_argument("nodes are not numbered part by part");
    std::vector<SlabFactor::Block> own;
    for (const SlabFactor::Block& b : blocks)
      if (b.row >= p.first && b.row < i) own.push_back({b.row - p.first, b.column - p.first, b.value});
    const std::vector<int> slab(mesh.slab.begin() + p.first, mesh.slab.begin() + i);
    p.rings = number < mesh.sectors.size() ? RingFactor::make(mesh.sectors[number], slab, own) : std::nullopt;
    if (p.rings) {
      p.known = p.rings->inverse_size() <= kLargestRings;
      if (p.known) p.rings->keep_inverse();
      continue;
    }
    p.slabs = SlabFactor(slab, own);
    p.known = p.n <= kLargestSlabs;
    if (p.known) p.inverse = p.slabs.inverse(0, p.slabs.n_slabs());
  }
}

void WallMatrix::solve(Eigen::Ref<Eigen::VectorXf> b) noexcept {
  for (Part& p : parts_)
    if (p.rings)
      p.rings->solve(b.segment(3 * p.first, 3 * p.n));
    else
      p.slabs.solve(b.segment(3 * p.first, 3 * p.n));
}

Eigen::Matrix3f WallMatrix::inverse(int row, int column) const noexcept {
  const Part& p = parts_[static_cast<std::size_t>(part_of(row))];
  return p.rings ? p.rings->inverse(row - p.first, column - p.first) : Eigen::Matrix3f(p.inverse.block<3, 3>(3 * (row - p.first), 3 * (column - p.first)));
}

void WallMatrix::subtract(const std::vector<int>& nodes, const Eigen::VectorXf& f, Eigen::Ref<Eigen::VectorXf> x) noexcept {
  for (Part& p : parts_) p.asked = false;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    Part& p = parts_[static_cast<std::size_t>(part_of(nodes[j]))];
    const auto share = f.segment<3>(static_cast<Eigen::Index>(3 * j));
    if (!p.rings) {
      x.segment(3 * p.first, 3 * p.n).noalias() -= p.inverse.middleCols<3>(3 * (nodes[j] - p.first)) * share;
      continue;
    }
    if (!p.asked) work_.segment(3 * p.first, 3 * p.n).setZero();
    const int ring = p.rings->ring_of(nodes[j] - p.first);
    p.from = p.asked ? std::min(p.from, ring) : ring;
    p.asked = true;
    work_.segment<3>(3 * nodes[j]) += share;
  }
  for (Part& p : parts_) {
    if (!p.asked) continue;
    auto part = work_.segment(3 * p.first, 3 * p.n);
    p.rings->solve(part, p.from);
    x.segment(3 * p.first, 3 * p.n) -= part;
  }
}

}  // namespace filum
