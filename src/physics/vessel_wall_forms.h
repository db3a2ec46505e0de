#pragma once
// The wall element's interpolation in scalar form: C_ij = sum_ab Q^ij_ab x_a . x_b over pairs of corners, with the assumed
// parts of vessel_wall_element.h in Q. Everything but the fast forces is worked out from these six matrices.

#include <array>

#include "physics/vessel_wall_element.h"

namespace filum {

using EightEight = Eigen::Matrix<double, 8, 8>;
using CovariantForms = std::array<EightEight, 6>;

CovariantForms covariant_forms(const Vec3& local) noexcept;

inline Six covariant(const CovariantForms& forms, const Corners& x) noexcept {
  Six C;
  for (std::size_t m = 0; m < 6; ++m) C[static_cast<int>(m)] = (x * forms[m]).cwiseProduct(x).sum();
  return C;
}

inline Mat3 matrix_of(const Six& C) noexcept {
  Mat3 m;
  m << C[0], C[3], C[5], C[3], C[1], C[4], C[5], C[4], C[2];
  return m;
}

}  // namespace filum
