// Tight knots against theory.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "evidence/braid_knot.h"
#include "evidence/problem_list.h"

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

/// n^2 F h^2/(mu B) at n^2 h/e, e the shortening (the closed form of the paper's loop).
double jawed_force(double scaled_h_over_e) {
  double low = 0.01, high = 1.0 - 1e-12;
  double x = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double m = 0.5 * (low + high);
    const Eigen::Vector2d KE = elliptic(m);
    x = 8.0 * (KE[0] - KE[1]) / m - 4.0 * KE[0];
    const double here = x > 0.0 ? x * x / ((x + 4.0 * KE[0]) * 8.0 * std::sqrt(3.0) * kPi * kPi) : 0.0;
    (here < scaled_h_over_e ? low : high) = m;
  }
  return x * x * x / (96.0 * std::sqrt(3.0) * kPi * kPi);
}

/// Median of F/F_theory while a knot of 2n + 1 crossings is drawn from h/e = `from` to `to`; the pull slides the braid all the time.
double overhand_ratio(int n, double from, double to) {
  constexpr double mu = 0.119;  // of the paper's fit
  BraidKnot knot(n, mu);
  const RodMaterial& m = knot.probe.rod.material;
  std::vector<double> ratios;
  for (int k = 0; k < 30000; ++k) {
    if (!knot.pull(0.02).sound) return std::numeric_limits<double>::quiet_NaN();
    const double h_over_e = m.radius / knot.shortening();
    if (h_over_e > to) break;
    if (h_over_e > from) ratios.push_back(n * n * knot.tension() * m.radius * m.radius / (mu * m.EI) / jawed_force(n * n * h_over_e));
  }
  if (ratios.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
  return ratios[ratios.size() / 2];
}

}  // namespace

void list_knots(ProblemList& list) {
  struct Case {
    int n;
    double from, to;  // h/e
    const char* range;
    double tolerance;  // for n = 3 that of the paper's range of validity; the others are reported, the theory is for large n
  };
  for (const Case& c : {Case{1, 0.006, 0.0115, "0.006 to 0.0115", 0.4}, Case{2, 0.0036, 0.006, "0.0036 to 0.006", 0.4},
                        Case{3, 0.0024, 0.0032, "0.0024 to 0.0032", 0.15}, Case{4, 0.0019, 0.0023, "0.0019 to 0.0023", 0.4}}) {
    ValidationProblem p;
    p.name = "overhand-knot-" + std::to_string(c.n);
    p.source = "Jawed, Dieleman, Audoly & Reis, Phys. Rev. Lett. 115:118302, 2015; a theory for many crossings and thin rods";
    p.quantity = "median F/F_theory, " + std::to_string(2 * c.n + 1) + " crossings, mu = 0.119, h/e from " + c.range;
    p.expected = 1.0;
    p.tolerance = c.tolerance;
    list.push_back({p, [c](ValidationProblem& r) { r.got = overhand_ratio(c.n, c.from, c.to); }});
  }
}

}  // namespace filum
