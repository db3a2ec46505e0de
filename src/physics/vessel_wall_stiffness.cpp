// Matrices, strains and stresses of the wall's elements, one element at a time: for the prefactored matrix, validation, pictures.

#include <Eigen/LU>
#include <cmath>

#include "physics/vessel_wall_forms.h"

namespace filum {
namespace {

using Eight = Eigen::Matrix<double, 8, 1>;

/// Column m: derivatives of the corner weights' product m; corner a has x_a = sum_m sign c_m, so c = x P, P_am = sign / 8.
EightEight corners_to_products() noexcept {
  EightEight p;
  for (int a = 0; a < 8; ++a)
    for (int m = 0; m < 8; ++m) {
      int minus = 0;
      for (int bit = 1; bit < 8; bit <<= 1) minus += (m & bit) && !(a & bit);
      p(a, m) = minus % 2 ? -0.125 : 0.125;
    }
  return p;
}

Corners gather(const std::array<int, 8>& nodes, const Points& x) noexcept {
  Corners c;
  for (int a = 0; a < 8; ++a) c.col(a) = x.col(nodes[static_cast<std::size_t>(a)]);
  return c;
}

using Gradients = Eigen::Matrix<double, 24, 6>;

Gradients gradients(const CovariantForms& forms, const Corners& x) noexcept {
  Gradients b;
  for (std::size_t m = 0; m < 6; ++m) {
    const Corners g = 2.0 * x * forms[m];
    b.col(static_cast<int>(m)) = g.reshaped();
  }
  return b;
}

}  // namespace

Eigen::Matrix<double, 8, 3> product_derivatives(const Vec3& l) noexcept {
  const double x = l.x(), y = l.y(), z = l.z();
  Eigen::Matrix<double, 8, 3> d;
  d << 0, 0, 0, 1, 0, 0, 0, 1, 0, y, x, 0, 0, 0, 1, z, 0, x, 0, z, y, y * z, x * z, x * y;
  return d;
}

Eight corner_weights(const Vec3& l) noexcept {
  Eight w;
  for (int a = 0; a < 8; ++a)
    w[a] = 0.125 * (1.0 + ((a & 1) ? l.x() : -l.x())) * (1.0 + ((a & 2) ? l.y() : -l.y())) * (1.0 + ((a & 4) ? l.z() : -l.z()));
  return w;
}

CovariantForms covariant_forms(const Vec3& local) noexcept {
  static const EightEight P = corners_to_products();
  const auto d = product_derivatives(local);
  const auto sym = [](const Eight& a, const Eight& b) { return EightEight(0.5 * (a * b.transpose() + b * a.transpose())); };
  CovariantForms q;
  q[0] = sym(d.col(0), d.col(0));
  q[1] = sym(d.col(1), d.col(1));
  q[3] = sym(d.col(0), d.col(1));
  q[4].setZero();
  q[5].setZero();
  for (const double s : {-1.0, 1.0}) {
    const auto side = product_derivatives(Vec3(0, s, 0)), front = product_derivatives(Vec3(s, 0, 0));
    q[5] += 0.5 * (1.0 + s * local.y()) * sym(side.col(0), side.col(2));
    q[4] += 0.5 * (1.0 + s * local.x()) * sym(front.col(1), front.col(2));
  }
  const Eight middle = Eight::Unit(4), sides = product_derivatives(Vec3(local.x(), local.y(), 0)).col(2) - middle;
  q[2] = middle * middle.transpose() + 2.0 * sym(middle, sides);
  for (EightEight& form : q) form = (P * form * P.transpose()).eval();
  return q;
}

/// Calls use(law, forms, C, weight and geometry, J, dJ) at every Gauss point of an element.
template <class Use>
void WallElements::each_point(std::size_t e, const Corners& corners, const Use& use) const noexcept {
  for (const WallStation& s : rows_[static_cast<std::size_t>(row_of_[e])].stations)
    for (const double eta : {-kGauss, kGauss})
      for (const double xi : {-kGauss, kGauss}) {
        const CovariantForms forms = covariant_forms(Vec3(xi, eta, s.zeta));
        const Six C = covariant(forms, corners);
        const Scalars p = scalars(rest_[e], Vec3(xi, eta, s.zeta), s.share, layers_[static_cast<std::size_t>(s.layer)].law);
        Six dJ;
        const double J = volume_ratio(p.geometry, C.data(), dJ.data());
        use(constants_[static_cast<std::size_t>(s.layer)], forms, C, p, J, dJ);
      }
}

double WallElements::mean_pressure(std::size_t e, const Corners& corners) const noexcept {
  double filled = 0.0;
  each_point(e, corners, [&](const LawConstants&, const CovariantForms&, const Six&, const Scalars& p, double J, const Six&) { filled += p.weight * J; });
  return rows_[static_cast<std::size_t>(row_of_[e])].lambda_mean * (filled / volume_[e] - 1.0);
}

double WallElements::energy(int element, const Points& x) const noexcept {
  const auto e = static_cast<std::size_t>(element);
  double sum = 0.0, filled = 0.0;
  each_point(e, gather(nodes_of_[e], x), [&](const LawConstants& law, const CovariantForms&, const Six& C, const Scalars& p, double J, const Six& dJ) {
    Six T;
    sum += p.weight * law_energy(law, p.geometry, C.data(), J, dJ.data(), T.data());
    filled += p.weight * J;
  });
  const double change = filled / volume_[e] - 1.0;
  return sum + 0.5 * rows_[static_cast<std::size_t>(row_of_[e])].lambda_mean * volume_[e] * change * change;
}

WallElements::Stiffness WallElements::stiffness(int element, const Points& x, bool taut) const noexcept {
  const auto e = static_cast<std::size_t>(element);
  const Corners corners = gather(nodes_of_[e], x);
  const double pressure = mean_pressure(e, corners);
  Stiffness K = Stiffness::Zero();
  Eigen::Matrix<double, 24, 1> swelling = Eigen::Matrix<double, 24, 1>::Zero();  // gradient of the volume by the points' J
  each_point(e, corners, [&](const LawConstants& law, const CovariantForms& forms, const Six& C, const Scalars& p, double J, const Six& dJ) {
    const Gradients B = gradients(forms, corners);
    Six T;
    law_energy(law, p.geometry, C.data(), J, dJ.data(), T.data());
    T += pressure * dJ;
    const SixSix D = law_tangent(law, p.geometry, C, taut) + pressure * volume_ratio_tangent(p.geometry, C);
    K.noalias() += p.weight * B * D * B.transpose();
    swelling += p.weight * B * dJ;
    EightEight geometric = EightEight::Zero();
    for (std::size_t m = 0; m < 6; ++m) geometric += 2.0 * p.weight * T[static_cast<int>(m)] * forms[m];
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) K.block<3, 3>(3 * a, 3 * b).diagonal().array() += geometric(a, b);
  });
  return K + rows_[static_cast<std::size_t>(row_of_[e])].lambda_mean / volume_[e] * swelling * swelling.transpose();
}

WallElements::Strain WallElements::strain(int element, const Points& x) const noexcept {
  const auto e = static_cast<std::size_t>(element);
  const CovariantForms forms = covariant_forms(Vec3::Zero());
  const Six C = covariant(forms, gather(nodes_of_[e], x)), G = covariant(forms, rest_[e]);
  return {std::sqrt(C[0] / G[0]), std::sqrt(C[1] / G[1]), std::sqrt(C[2] / G[2]), std::sqrt(matrix_of(C).determinant() / matrix_of(G).determinant())};
}

Mat3 WallElements::stress(int element, const Vec3& local, const Points& x) const noexcept {
  const auto e = static_cast<std::size_t>(element);
  const Corners corners = gather(nodes_of_[e], x);
  const auto layer = static_cast<std::size_t>(layer_at(element, local.z()));
  const Six C = covariant(covariant_forms(local), corners);
  const Scalars p = scalars(rest_[e], local, 1.0, layers_[layer].law);
  Six dJ, T;
  const double J = volume_ratio(p.geometry, C.data(), dJ.data());
  law_energy(constants_[layer], p.geometry, C.data(), J, dJ.data(), T.data());
  T += mean_pressure(e, corners) * dJ;
  const Mat3 g = corners * corners_to_products() * product_derivatives(local);
  Mat3 S = matrix_of(T);
  S.diagonal() *= 2.0;
  return g * S * g.transpose() / J;
}

int WallElements::layer_at(int element, double zeta) const noexcept {
  const auto& span = rows_[static_cast<std::size_t>(row_of_[static_cast<std::size_t>(element)])].span;
  double total = 0.0, inner = 0.0;
  for (const WallLayer& l : layers_) total += l.thickness;
  const double depth = total * (span[0] + 0.5 * (zeta + 1.0) * (span[1] - span[0]));
  for (std::size_t k = 0; k + 1 < layers_.size(); ++k) {
    inner += layers_[k].thickness;
    if (depth < inner) return static_cast<int>(k);
  }
  return static_cast<int>(layers_.size()) - 1;
}

}  // namespace filum
