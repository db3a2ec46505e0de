#include "evidence/stability.h"

#include <limits>

namespace filum {

bool is_stable(const RodMaterial& m, const RodState& s, const Eigen::Array<bool, 4, Eigen::Dynamic>& held) {
  const int n = s.n;
  BlockCholesky matrix(n);
  ChainSlots chain;
  matrix.begin_pattern(n);
  for (int i = 0; i + 1 < n; ++i) matrix.connect(i, i + 1);
  for (int i = 0; i + 2 < n; ++i) matrix.connect(i, i + 2);
  matrix.analyse();
  for (int i = 0; i + 1 < n; ++i) chain.next.push_back(matrix.find(i, i + 1));
  for (int i = 0; i + 2 < n; ++i) chain.second.push_back(matrix.find(i, i + 2));
  matrix.set_zero();
  const double stiff = 1e6 * (m.EA / s.rest_length[0] + m.EI);
  for (int i = 0; i < n; ++i) {
    Mat4 block = Mat4::Zero();
    for (int c = 0; c < 4; ++c)
      if (held(c, i) || (c == 3 && i + 1 == n)) block(c, c) = stiff;
    matrix.add_diagonal(i, block);
  }
  RodGeometry g(n);
  update_geometry(s, s.x, s.theta, g);
  add_elastic_hessian(m, s, g, Stiffness::exact, chain, matrix);
  return matrix.factor();
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
