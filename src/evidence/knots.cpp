// Tight knots against theory.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "evidence/problem_list.h"
#include "evidence/pulled_knot.h"

namespace filum {
namespace {

constexpr double kPi = std::numbers::pi;

/// Complete elliptic integrals of the parameter m: K (.x) and E (.y), by the arithmetic-geometric mean.
Eigen::Vector2d elliptic(double m) {
  double a = 1.0, b = std::sqrt(1.0 - m), sum = 0.5 * m, power = 0.5;
  for (int k = 0; k < 30; ++k) {
    const double c = 0.5 * (a - b), mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
    power *= 2.0;
    sum += power * c * c;
  }
  const double K = 0.5 * kPi / a;
  return {K, K * (1.0 - sum)};
}

/// F h^2/(mu B) of an overhand knot of unknotting number 1 at h/e, e the shortening (the closed form of the
/// paper's loop).
double jawed_force(double h_over_e) {
  double low = 0.01, high = 1.0 - 1e-12;
  double x = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double m = 0.5 * (low + high);
    const Eigen::Vector2d KE = elliptic(m);
    x = 8.0 * (KE[0] - KE[1]) / m - 4.0 * KE[0];
    const double here = x > 0.0 ? x * x / ((x + 4.0 * KE[0]) * 8.0 * std::sqrt(3.0) * kPi * kPi) : 0.0;
    (here < h_over_e ? low : high) = m;
  }
  return x * x * x / (96.0 * std::sqrt(3.0) * kPi * kPi);
}

/// Median of F/F_theory while the knot is drawn from h/e = 3e-3 to 1e-2; the pull slides the braid all the
/// time.
double overhand_ratio() {
  constexpr double mu = 0.3;
  PulledKnot knot(201, mu, 1e-3);
  const RodMaterial& m = knot.probe.rod.material;
  std::vector<double> ratios;
  for (int k = 0; k < 12000; ++k) {
    if (!knot.pull(0.03).sound) return std::numeric_limits<double>::quiet_NaN();
    const double h_over_e = m.radius / knot.shortening();
    if (h_over_e > 1e-2) break;
    if (h_over_e > 3e-3)
      ratios.push_back(knot.tension() * m.radius * m.radius / (mu * m.EI) / jawed_force(h_over_e));
  }
  if (ratios.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                   ratios.end());
  return ratios[ratios.size() / 2];
}

}  // namespace

void list_knots(ProblemList& list) {
  ValidationProblem p;
  p.name = "overhand-knot-1";
  p.source =
      "Jawed, Dieleman, Audoly & Reis, Phys. Rev. Lett. 115:118302, 2015; stated there for more crossings "
      "than the three here";
  p.quantity = "median F/F_theory, n = 1, mu = 0.3, h/e from 0.003 to 0.01";
  p.expected = 1.0;
  p.tolerance = 0.4;
  list.push_back({p, [](ValidationProblem& r) { r.got = overhand_ratio(); }});
}

}  // namespace filum
