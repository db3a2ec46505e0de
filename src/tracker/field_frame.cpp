#include "tracker/field_frame.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace filum {

void FieldFrame::begin() {
  n_ = elsewhere_ = 0;
  sum_.setZero();
  turn_.setZero();
  square_ = 0.0;
  X_WC_.reset();
}

void FieldFrame::take(const Pose& X_CW) {
  if (X_WC_) {
    const bool moved = (X_CW.p - X_CW_.p).norm() > kMoved || X_CW.q.angularDistance(X_CW_.q) > kTurned;
    elsewhere_ = moved ? elsewhere_ + 1 : 0;
    if (elsewhere_ < kBelieveAfter) return;
    ++lost_;
    begin();
  }
  Eigen::Vector4d q = X_CW.q.coeffs();
  if (q.dot(turn_) < 0.0) q = -q;
  turn_ += q;
  sum_ += X_CW.p;
  square_ += X_CW.p.squaredNorm();
  if (++n_ < kSightings) return;
  X_CW_.p = sum_ / n_;
  X_CW_.q.coeffs() = turn_.normalized();
  spread_ = std::sqrt(std::max(0.0, square_ / n_ - X_CW_.p.squaredNorm()));
  X_WC_ = X_CW_.inverse();
}

Pivot pivot_of(const std::vector<Pose>& poses) {
  if (poses.size() < 20) throw InputError("pivot", "poses", std::to_string(poses.size()), "at least 20 of the marker");
  const auto n = static_cast<Eigen::Index>(poses.size());
  Eigen::MatrixXd A(3 * n, 6);
  Eigen::VectorXd b(3 * n);
  Pivot pivot;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Pose& X = poses[static_cast<std::size_t>(i)];
    A.block<3, 3>(3 * i, 0) = X.q.toRotationMatrix();
    A.block<3, 3>(3 * i, 3) = -Mat3::Identity();
    b.segment<3>(3 * i) = -X.p;
    for (const Pose& other : poses) pivot.turned = std::max(pivot.turned, X.q.angularDistance(other.q));
  }
  if (pivot.turned < 0.5) throw InputError("pivot", "turn", std::to_string(pivot.turned) + " rad", "the handle turned by at least 0.5 rad, about two axes");
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  if (qr.rank() < 6) throw InputError("pivot", "turn", "turned about one axis only", "the handle turned about two axes");
  const Eigen::VectorXd x = qr.solve(b);
  pivot.tip = x.head<3>();
  pivot.residual = std::sqrt((A * x - b).squaredNorm() / static_cast<double>(n));
  if (!(pivot.residual < 2e-3)) throw InputError("pivot", "residual", std::to_string(1e3 * pivot.residual) + " mm", "below 2 mm: the tip has to stay in its hollow");
  return pivot;
}

}  // namespace filum
