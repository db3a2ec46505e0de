#include "reconcile/hold_bands.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

/// What least squares leaves of a record when sine and cosine of these frequencies are free.
double left_without(const Eigen::VectorXd& time, const std::vector<double>& frequencies, Eigen::VectorXd& r) {
  const auto m = 2 * static_cast<Eigen::Index>(frequencies.size());
  Eigen::MatrixXd B(r.size(), m);
  Eigen::VectorXd y = r;
  for (Eigen::Index n = 0; n < r.size(); ++n) {
    const bool there = std::isfinite(r[n]);
    if (!there) y[n] = 0.0;
    for (Eigen::Index k = 0; k < m; k += 2) {
      const double phase = 6.283185307179586 * frequencies[static_cast<std::size_t>(k / 2)] * (time[n] - time[0]);
      B(n, k) = there ? std::cos(phase) : 0.0;
      B(n, k + 1) = there ? std::sin(phase) : 0.0;
    }
  }
  const Eigen::MatrixXd A = B.transpose() * B;
  r -= B * (A + 1e-9 * A.trace() * Eigen::MatrixXd::Identity(m, m)).ldlt().solve(B.transpose() * y);
  double sum = 0.0;
  for (const double v : r)
    if (std::isfinite(v)) sum += v * v;
  return sum;
}

}  // namespace

Band tremor_band(const std::vector<Spectrum>& all) {
  Band best;
  const double around = std::max(0.5, 0.5 * (level(all, 3.5, 6.5) + level(all, 13.5, 18.0)));
  for (const double half : {0.2, 0.4, 0.8, 1.4, 2.0})
    for (double f = 7.8; f <= 12.2; f += 0.1) {
      const Band b = band(all, f - half, f + half, around);
      if (b.evidence > best.evidence) best = b;
    }
  return best;
}

void add_line(const Fitter& fitter, const Fit& base, const Form& form, double low, double high, const std::vector<Spectrum>& all, const HoldScreenOptions& options, std::vector<Found>& found, std::vector<Screened>* looked) {
  const Line line = strongest_line(fitter, base, low, high);
  const double needed = line.columns + options.line_spread * std::sqrt(2.0 * line.columns) + options.line_gain;
  const auto say = [&](const std::string& what) {
    if (looked != nullptr) looked->push_back({form.effect, form.text, line.gain, NAN, what});
  };
  if (line.gain < needed) return say("not fitted: the strongest line takes less than " + std::to_string(static_cast<int>(needed)) + " off chi-squared");
  // at the edge of its band it is the skirt of what lies beyond
  if (form.effect == Effect::pulsation && std::min(line.frequency - low, high - line.frequency) < all[0].step) return say("not fitted: the strongest line stands at the edge of its band, the skirt of what lies beyond");
  const double w = 2.5 * all[0].step;
  const double rate = all[0].rate;
  double at = std::fmod(line.frequency, rate);  // where it appears when folded
  if (at > 0.5 * rate) at = rate - at;
  const double around = level(all, std::max(0.05, at - 12 * w), at + 12 * w);
  const Band narrow = band(all, at - w, at + w, around), wide = band(all, std::max(0.0, at - 10 * w), at + 10 * w, around);
  if (narrow.excess < options.line_share * wide.excess) return say("not fitted: what stands out is a band, not a line");
  say("fitted");
  found.push_back({form.effect, &form, at - w, at + w, line.frequency, squared_rms(all, at - w, at + w, around), line.gain, narrow.bins});
}

Fit without_lines(const Dataset& d, const Fit& base, const std::vector<Found>& found) {
  Fit out = base;
  for (std::size_t i = 0; i < out.residual.size(); ++i)
    for (Eigen::VectorXd& r : out.residual[i])
      for (const Found& f : found) {
        if (f.form == nullptr) continue;
        const double span = d.trials[i].time[d.trials[i].samples() - 1] - d.trials[i].time[0];
        Eigen::VectorXd best = r;
        double least = 1e300;
        for (int k = -4; k <= 4; ++k) {  // the line was found on a grid of 0.3/span
          const double at = f.frequency + 0.05 * k / span;
          Eigen::VectorXd trial = r;
          const double sum = left_without(d.trials[i].time, f.effect == Effect::pulsation ? std::vector<double>{at, 2 * at, 3 * at} : std::vector<double>{at}, trial);
          if (sum < least) least = sum, best = trial;
        }
        r = best;
      }
  return out;
}

void add_hum(const Fitter& fitter, const Fit& base, const Form& form, const std::vector<Spectrum>& all, const HoldScreenOptions& options, std::vector<Found>& found, std::vector<Screened>* looked) {
  std::vector<Found> both;
  std::vector<Screened> own;
  const auto look = [&](const Fit& in) {
    both.clear(), own.clear();
    for (const double f : {50.0, 60.0}) add_line(fitter, in, form, f - 0.2, f + 0.2, all, options, both, &own);
    std::stable_sort(both.begin(), both.end(), [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
  };
  look(base);
  std::vector<Found> stronger;
  for (const Found& f : found)
    if (!both.empty() && f.evidence > both[0].evidence && std::abs(std::abs(std::remainder(both[0].frequency, all[0].rate)) - f.frequency) < 8.0 * all[0].step) stronger.push_back(f);
  if (!stronger.empty()) look(without_lines(fitter.model().data(), base, stronger));
  if (looked != nullptr) looked->insert(looked->end(), own.begin(), own.end());
  if (!both.empty()) found.push_back(both[0]);
}

Band leftover(const std::vector<Spectrum>& all, const std::vector<Found>& found) {
  Band worst;
  std::vector<Spectrum> rest = all;
  for (Spectrum& s : rest)
    for (const Found& f : found)
      for (std::size_t k = s.power.size(); k-- > 0;)
        if (s.frequency[k] >= f.low - 2 * s.step && s.frequency[k] <= f.high + 2 * s.step)
          s.power.erase(s.power.begin() + static_cast<std::ptrdiff_t>(k)), s.frequency.erase(s.frequency.begin() + static_cast<std::ptrdiff_t>(k));
  const double top = all[0].frequency.back();
  for (double f = std::max(0.12, 4.0 * all[0].step); f < top; f *= 1.6) {
    const Band b = band(rest, f, std::min(top, 1.6 * f), 1.0);
    if (b.evidence > worst.evidence) worst = b;
  }
  return worst;
}

std::vector<Spectrum> spectra(const Dataset& d, const Fit& base, const std::vector<double>& sigma, bool held) {
  std::vector<Spectrum> all;
  for (std::size_t i = 0; i < base.residual.size(); ++i)
    if (!base.residual[i].empty() && d.trials[i].hold_out == held)
      for (std::size_t c = 0; c < base.residual[i].size(); ++c) all.push_back(spectrum(base.residual[i][c], d.trials[i].time, sigma[c]));
  return all;
}

Gap gap_in(const std::vector<Spectrum>& all, const std::vector<Found>& found) {
  double before = 0.0, after = 0.0;
  for (const Spectrum& s : all)
    for (std::size_t k = 0; k < s.power.size(); ++k) {
      const bool named = std::any_of(found.begin(), found.end(), [&](const Found& f) { return s.frequency[k] >= f.low && s.frequency[k] <= f.high; });
      before += s.power[k];
      after += named ? std::min(1.0, s.power[k]) : s.power[k];
    }
  double n = 0;
  for (const Spectrum& s : all) n += static_cast<double>(s.power.size());
  return n > 0 ? Gap{std::sqrt(before / n), std::sqrt(after / n)} : Gap{};
}

}  // namespace filum::reconcile
