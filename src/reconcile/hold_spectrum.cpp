#include "reconcile/hold_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "reconcile/model.h"
#include "reconcile/transform.h"

namespace filum::reconcile {

Spectrum spectrum(const Eigen::VectorXd& residual, const Eigen::VectorXd& time, double sigma) {
  Spectrum s;
  const auto out = transform(residual);
  const auto n = out.size();
  s.n = static_cast<int>(n);
  const double span = (time[static_cast<Eigen::Index>(n) - 1] - time[0]) * static_cast<double>(n) / static_cast<double>(n - 1);
  s.step = 1.0 / span;
  s.rate = static_cast<double>(n) / span;
  std::vector<double> quiet;
  for (std::size_t k = 1; k < n / 2; ++k) {
    s.frequency.push_back(static_cast<double>(k) / span);
    s.power.push_back(std::norm(out[k]) / static_cast<double>(n));
    const double f = s.frequency.back();
    if (f > 1.5 && (f < 6.0 || f > 14.0)) quiet.push_back(s.power.back());
  }
  if (quiet.size() < 8) quiet = s.power;
  const double median_level = median(quiet) / std::log(2.0);
  s.sigma = sigma > 0 ? sigma : std::sqrt(median_level);
  for (double& p : s.power) p /= s.sigma * s.sigma;
  return s;
}

Band band(const std::vector<Spectrum>& all, double low, double high, double background) {
  Band b{low, high, 0, background, 0, 0, 0, 0, 0};
  double weighted = 0.0, top = 0.0;
  for (const Spectrum& s : all) {
    double most = 0.0;
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= low && s.frequency[k] <= high) {
        b.mean += s.power[k];
        weighted += s.power[k] * s.frequency[k];
        most = std::max(most, s.power[k]);
        ++b.bins;
      }
    top += most;
  }
  if (b.bins == 0) return b;
  b.centre = weighted / b.mean;
  b.top_share = top / b.mean;
  b.mean /= b.bins;
  const double q = b.mean / background;
  b.excess = (b.mean - background) * b.bins;
  b.evidence = q > 1.0 ? 2.0 * b.bins * (q - 1.0 - std::log(q)) : 0.0;
  return b;
}

double level(const std::vector<Spectrum>& all, double low, double high) {
  std::vector<double> p;
  for (const Spectrum& s : all)
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= low && s.frequency[k] <= high) p.push_back(s.power[k]);
  return p.empty() ? 1.0 : median(p) / std::log(2.0);
}

double squared_rms(const std::vector<Spectrum>& all, double low, double high, double background) {
  double sum = 0.0;
  for (const Spectrum& s : all) {
    double p = 0.0;
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= low && s.frequency[k] <= high) p += (s.power[k] - background) * s.sigma * s.sigma;
    sum += 2.0 * p / s.n;
  }
  return std::max(0.0, sum / static_cast<double>(all.size()));
}

}  // namespace filum::reconcile
