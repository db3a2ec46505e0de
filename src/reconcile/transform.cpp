#include "reconcile/transform.h"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

constexpr double kMostOperations = 2e7;

Eigen::Index largest_factor(Eigen::Index n) {
  Eigen::Index largest = 1;
  for (Eigen::Index p = 2; p * p <= n; ++p)
    while (n % p == 0) largest = p, n /= p;
  return std::max(largest, n);
}

}  // namespace

Eigen::Index transformed_length(Eigen::Index n) {
  if (static_cast<double>(n) * static_cast<double>(largest_factor(n)) <= kMostOperations) return n;
  while (largest_factor(n) > 7) --n;
  return n;
}

std::vector<std::complex<double>> transform(const Eigen::VectorXd& v) {
  std::vector<double> x;
  for (Eigen::Index k = 0; k < transformed_length(v.size()); ++k) x.push_back(std::isfinite(v[k]) ? v[k] : 0.0);
  std::vector<std::complex<double>> out;
  Eigen::FFT<double> fft;
  fft.fwd(out, x);
  return out;
}

}  // namespace filum::reconcile
