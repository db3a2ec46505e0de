#pragma once
// How far the edges of a thread may move before its near pairs must be found again, have moved since, and would move.
//
// Every bound on what can come into touch is a sum of two such lengths: the distance of two edges falls by no more than the points of both
// move, and no point of an edge moves farther than one of its ends. Most of a thread lies still while a part of it flies, so they are kept for
// each edge. Nothing allocates after the constructor. Test: rod_travel_test.

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace filum {

class RodTravel {
 public:
  explicit RodTravel(int node_capacity)
      : reach(Eigen::VectorXd::Zero(node_capacity)), gone_(reach), stride_(reach) {}

  Eigen::VectorXd reach;  // [m], of each edge: how far it may move from where its pairs were found

  /// The thread (of n nodes) is where its pairs were found.
  void start(int n) noexcept {
    edges_ = n - 1;
    gone_.head(edges_).setZero();
  }
  /// Sets the move in question: 4 x n [m], the fourth row (twist) does not count.
  void look_along(const Eigen::Matrix4Xd& move) noexcept {
    double here = move.col(0).head<3>().norm();
    for (int j = 0; j < edges_; ++j) {
      const double next = move.col(j + 1).head<3>().norm();
      stride_[j] = std::max(here, next);
      here = next;
    }
  }
  /// The thread went `fraction` of the move in question.
  void went(double fraction) noexcept { gone_.head(edges_) += fraction * stride_.head(edges_); }

  double gone(int edge) const noexcept { return gone_[edge]; }      // [m], since start()
  double stride(int edge) const noexcept { return stride_[edge]; }  // [m], of the whole move in question
  double farthest() const noexcept { return edges_ > 0 ? stride_.head(edges_).maxCoeff() : 0.0; }

  /// Largest part of the move in question, at most 1, that stays within reach.
  double within_reach() const noexcept {
    double fraction = 1.0;
    for (int j = 0; j < edges_; ++j)
      if (gone_[j] + fraction * stride_[j] > reach[j]) fraction = std::max(0.0, reach[j] - gone_[j]) / stride_[j];
    return fraction;
  }

 private:
  int edges_ = 0;
  Eigen::VectorXd gone_, stride_;
};

}  // namespace filum
