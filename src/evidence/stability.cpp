#include "evidence/stability.h"

#include <Eigen/LU>
#include <complex>
#include <limits>

namespace filum {

HeldStiffness::HeldStiffness(const RodMaterial& m, const RodState& s, const HeldCoordinates& held, const Eigen::Matrix4Xd& springs) : matrix_(s.n) {
  const int n = s.n;
  ChainSlots chain;
  matrix_.begin_pattern(n);
  for (int i = 0; i + 1 < n; ++i) matrix_.connect(i, i + 1);
  for (int i = 0; i + 2 < n; ++i) matrix_.connect(i, i + 2);
  matrix_.analyse();
  for (int i = 0; i + 1 < n; ++i) chain.next.push_back(matrix_.find(i, i + 1));
  for (int i = 0; i + 2 < n; ++i) chain.second.push_back(matrix_.find(i, i + 2));
  matrix_.set_zero();
  const double stiff = 1e6 * (m.EA / s.rest_length[0] + m.EI);
  for (int i = 0; i < n; ++i) {
    Mat4 block = springs.col(i).asDiagonal();
    for (int c = 0; c < 4; ++c)
      if (held(c, i) || (c == 3 && i + 1 == n)) block(c, c) = stiff;
    matrix_.add_diagonal(i, block);
  }
  RodGeometry g(n);
  update_geometry(s, s.x, s.theta, g);
  add_elastic_hessian(m, s, g, Stiffness::exact, chain, matrix_);
  positive_ = matrix_.factor();
}

Eigen::Matrix4Xd HeldStiffness::moves(Eigen::Matrix4Xd loads) const {
  matrix_.solve(loads);
  return loads;
}

bool is_stable(const RodMaterial& m, const RodState& s, const HeldCoordinates& held) {
  return HeldStiffness(m, s, held, Eigen::Matrix4Xd::Zero(4, s.n)).positive();
}

double pinned_determinant(const RodMaterial& m, const RodState& s, const HeldCoordinates& held, double M) {
  const int node[2] = {1, s.n - 2};
  const double l = s.x(0, 1) - s.x(0, 0), k = 10.0 * m.EI / (l * l * l);
  Eigen::Matrix4Xd springs = Eigen::Matrix4Xd::Zero(4, s.n);
  for (const int i : node) springs.col(i).segment<2>(1).setConstant(k);
  const HeldStiffness stiffness(m, s, held, springs);
  if (!stiffness.positive()) return std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix2cd matrix = Eigen::Matrix2cd::Identity();
  for (int b = 0; b < 2; ++b) {
    Eigen::Matrix4Xd unit = Eigen::Matrix4Xd::Zero(4, s.n);
    unit(1, node[b]) = 1.0;
    const Eigen::Matrix4Xd moved = stiffness.moves(unit);
    for (int a = 0; a < 2; ++a)
      matrix(a, b) -= std::complex(moved(1, node[a]), moved(2, node[a])) * std::complex(k, (b == 0 ? -0.5 : 0.5) * M / (l * l));
  }
  return matrix.determinant().real();
}

double critical_load(double low, double high, const std::function<bool(double)>& stable) {
  if (!stable(low) || stable(high)) return std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace filum
