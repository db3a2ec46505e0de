#include "reconcile/transform.h"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace filum::reconcile {
namespace {

constexpr double kMostOperations = 2e7;
constexpr double kCell = 0.04;     // of the grid of times, over one period of half the band
constexpr double kPadding = 8.0;   // steps in frequency to one over the record's length

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

std::vector<double> line_powers(const Eigen::VectorXd& time, const Eigen::VectorXd& v, const std::vector<double>& frequency) {
  const double middle = 0.5 * (frequency.front() + frequency.back()), half = 0.5 * (frequency.back() - frequency.front());
  const double span = time[time.size() - 1] - time[0], cell = kCell / std::max(half, 1.0 / span);
  std::size_t cells = 1;
  while (static_cast<double>(cells) * cell < kPadding * span) cells *= 2;
  std::vector<std::complex<double>> grid(cells), out;
  double n = 0.0;
  for (Eigen::Index k = 0; k < v.size(); ++k) {
    if (!std::isfinite(v[k])) continue;
    const double t = time[k] - time[0];
    grid[static_cast<std::size_t>(std::lround(t / cell))] += std::polar(v[k], -2.0 * std::numbers::pi * middle * t);
    n += 1.0;
  }
  Eigen::FFT<double> fft;
  fft.fwd(out, grid);
  const auto at = [&](std::ptrdiff_t bin) { return out[static_cast<std::size_t>(bin < 0 ? bin + static_cast<std::ptrdiff_t>(cells) : bin)]; };
  std::vector<double> power;
  for (const double f : frequency) {
    const double place = (f - middle) * cell * static_cast<double>(cells), below = std::floor(place);
    const auto bin = static_cast<std::ptrdiff_t>(below);
    power.push_back(n > 0.0 ? 2.0 * std::norm((1.0 - (place - below)) * at(bin) + (place - below) * at(bin + 1)) / n : 0.0);
  }
  return power;
}

}  // namespace filum::reconcile
