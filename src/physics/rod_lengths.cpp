#include "physics/rod_lengths.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kMostExcess = 1e-3;  // [-], of an edge's length: it then turns by 0.045 rad

}  // namespace

RodLengths::RodLengths(int capacity)
    : along_(Points::Zero(3, capacity)), excess_(Eigen::VectorXd::Zero(capacity)), diagonal_(excess_), beside_(excess_) {}

void RodLengths::keep(const RodState& s, const Points& x, const Eigen::VectorXd& inverse_mass, EdgeLength which,
                      Eigen::Matrix4Xd& move) noexcept {
  const int edges = s.n - 1;
  double most = 0.0;
  for (int j = 0; j < edges; ++j) {
    const Vec3 before = x.col(j + 1) - x.col(j), change = (move.col(j + 1) - move.col(j)).head<3>();
    const Vec3 after = before + change;
    const double old_length = before.norm(), length = after.norm();
    const bool whole = s.alive[j] != 0 && old_length > 0.0 && length > 0.0;
    along_.col(j) = whole ? Vec3(after / length) : Vec3::Zero();
    const double meant = which == EdgeLength::first_order && whole ? before.dot(change) / old_length : 0.0;
    excess_[j] = whole ? length - old_length - meant : 0.0;
    if (whole) most = std::max(most, std::abs(excess_[j]) / old_length);
    diagonal_[j] = inverse_mass[j] + inverse_mass[j + 1];
    if (!whole || diagonal_[j] == 0.0) diagonal_[j] = 1.0;
    if (j > 0) beside_[j - 1] = -inverse_mass[j] * along_.col(j - 1).dot(along_.col(j));
  }
  if (most > kMostExcess) return;
  for (int j = 1; j < edges; ++j) {  // the system is tridiagonal: Thomas's elimination
    const double factor = beside_[j - 1] / diagonal_[j - 1];
    diagonal_[j] -= factor * beside_[j - 1];
    excess_[j] -= factor * excess_[j - 1];
  }
  for (int j = edges - 1; j >= 0; --j) {
    if (j + 1 < edges) excess_[j] -= beside_[j] * excess_[j + 1];
    excess_[j] /= diagonal_[j];
    const Vec3 pull = excess_[j] * along_.col(j);
    move.col(j).head<3>() += inverse_mass[j] * pull;
    move.col(j + 1).head<3>() -= inverse_mass[j + 1] * pull;
  }
}

}  // namespace filum
