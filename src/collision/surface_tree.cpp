#include "collision/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>

namespace filum {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();

using Quad = float __attribute__((vector_size(16)));
using QuadBits = std::int32_t __attribute__((vector_size(16)));

Quad load(const std::array<float, 4>& a) noexcept {
  Quad q;
  std::memcpy(&q, a.data(), sizeof q);
  return q;
}
bool any(const QuadBits& q) noexcept {
  std::array<std::uint64_t, 2> halves;
  std::memcpy(halves.data(), &q, sizeof q);
  return (halves[0] | halves[1]) != 0;
}

/// The least float that is no less, the greatest that is no more: a float lies beyond a number just when it lies beyond these.
float at_least(double v) noexcept {
  const auto f = static_cast<float>(v);
  return f < v ? std::nextafterf(f, std::numeric_limits<float>::infinity()) : f;
}
float at_most(double v) noexcept {
  const auto f = static_cast<float>(v);
  return f > v ? std::nextafterf(f, -std::numeric_limits<float>::infinity()) : f;
}

}  // namespace

SurfaceTree::SurfaceTree(std::vector<Triangle> triangles, const Points& nodes) : triangles_(std::move(triangles)), order_(triangles_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  Points centres(3, static_cast<int>(triangles_.size()));
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    centres.col(static_cast<int>(t)) = (nodes.col(triangles_[t][0]) + nodes.col(triangles_[t][1]) + nodes.col(triangles_[t][2])) / 3.0;
  nodes_.reserve(triangles_.size() + 1);
  nodes_.emplace_back();
  if (!triangles_.empty()) cut(0, 0, static_cast<int>(triangles_.size()), centres);
  list_corners();
  refit(nodes);
}

void SurfaceTree::list_corners() {
  for (const Triangle& t : triangles_) used_.insert(used_.end(), t.begin(), t.end());
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  placed_.assign(4 * used_.size(), 0.0f);
  for (Node& n : nodes_) {
    n.corner = static_cast<int>(corners_.size());
    for (int k = n.first; k < n.first + n.count; ++k)
      for (const int i : triangles_[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])])
        corners_.push_back(static_cast<int>(std::lower_bound(used_.begin(), used_.end(), i) - used_.begin()));
    std::sort(corners_.begin() + n.corner, corners_.end());
    corners_.erase(std::unique(corners_.begin() + n.corner, corners_.end()), corners_.end());
    n.corners = static_cast<int>(corners_.size()) - n.corner;
  }
}

void SurfaceTree::cut(int node, int first, int count, const Points& centres) {
  if (count <= kLeaf) {
    nodes_[static_cast<std::size_t>(node)].first = first;
    nodes_[static_cast<std::size_t>(node)].count = count;
    return;
  }
  Vec3 low = centres.col(order_[static_cast<std::size_t>(first)]), high = low;
  for (int k = first; k < first + count; ++k) {
    low = low.cwiseMin(centres.col(order_[static_cast<std::size_t>(k)]));
    high = high.cwiseMax(centres.col(order_[static_cast<std::size_t>(k)]));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
    return centres(axis, a) != centres(axis, b) ? centres(axis, a) < centres(axis, b) : a < b;
  });
  const int children = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  nodes_.emplace_back();
  nodes_[static_cast<std::size_t>(node)].first = children;
  cut(children, first, count / 2, centres);
  cut(children + 1, first + count / 2, count - count / 2, centres);
}

void SurfaceTree::refit(const Points& positions) noexcept {
  constexpr float kRounding = 1e-6f;  // of the largest coordinate: more than float rounds away
  for (std::size_t k = 0; k < used_.size(); ++k) {
    const double* const p = positions.data() + 3 * static_cast<std::ptrdiff_t>(used_[k]);
    for (std::size_t c = 0; c < 3; ++c) placed_[4 * k + c] = static_cast<float>(p[c]);
  }
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    Node& n = nodes_[k];
    std::array<float, 4> low, high;
    low.fill(kFar);
    high.fill(-kFar);
    if (n.count > 0) {
      for (int i = n.corner; i < n.corner + n.corners; ++i) {
        const float* const x = placed_.data() + 4 * static_cast<std::ptrdiff_t>(corners_[static_cast<std::size_t>(i)]);
        for (std::size_t c = 0; c < 4; ++c) {
          low[c] = std::min(low[c], x[c]);
          high[c] = std::max(high[c], x[c]);
        }
      }
      for (std::size_t c = 0; c < 4; ++c) {
        const float wide = kRounding * std::max(std::abs(low[c]), std::abs(high[c]));
        low[c] -= wide;
        high[c] += wide;
      }
    } else if (!triangles_.empty()) {
      const Node &a = nodes_[static_cast<std::size_t>(n.first)], &b = nodes_[static_cast<std::size_t>(n.first) + 1];
      for (std::size_t c = 0; c < 4; ++c) {
        low[c] = std::min(a.low[c], b.low[c]);
        high[c] = std::max(a.high[c], b.high[c]);
      }
    }
    n.low = low;
    n.high = high;
  }
}

/// Leaves whose box meets `box`, for as long as `take` wants more of them.
template <class Take>
void SurfaceTree::visit(const Box& box, const Take& take) const noexcept {
  if (triangles_.empty()) return;
  Quad low = Quad{} - kFar, high = Quad{} + kFar;
  for (int c = 0; c < 3; ++c) {
    low[c] = at_least(box.low[c]);
    high[c] = at_most(box.high[c]);
  }
  std::array<int, 64> stack;  // deeper than the tree: median cuts halve the count
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  while (depth > 0) {
    const Node& n = nodes_[static_cast<std::size_t>(stack[static_cast<std::size_t>(--depth)])];
    if (any((load(n.low) > high) | (load(n.high) < low))) continue;
    if (n.count == 0) {
      stack[static_cast<std::size_t>(depth++)] = n.first + 1;
      stack[static_cast<std::size_t>(depth++)] = n.first;
      continue;
    }
    if (!take(n)) return;
  }
}

void SurfaceTree::overlaps(const Box& box, std::vector<int>& found) const noexcept {
  visit(box, [&](const Node& n) {
    for (int t = n.first; t < n.first + n.count && found.size() < found.capacity(); ++t) found.push_back(order_[static_cast<std::size_t>(t)]);
    return found.size() < found.capacity();
  });
}

bool SurfaceTree::overlaps(const Box& box) const noexcept {
  bool met = false;
  visit(box, [&](const Node&) {
    met = true;
    return false;
  });
  return met;
}

}  // namespace filum
