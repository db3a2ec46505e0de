#include "reconcile/structure.h"
#include "reconcile/rules.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "reconcile/transform.h"

namespace filum::reconcile {

Structure structure_of(const std::vector<Eigen::VectorXd>& white, int parameters, int length) {
  Structure best;
  Eigen::Index longest = 0, total = 0;
  for (const auto& w : white) longest = std::max(longest, w.size()), total += w.size();
  for (int L = length > 0 ? length : 1; L <= std::max<Eigen::Index>(1, longest / 3); L *= 2) {
    double sum = 0.0;
    int blocks = 0;
    for (const auto& w : white)
      for (Eigen::Index k = 0; k + L <= w.size(); k += L) {
        const double s = w.segment(k, L).sum();
        sum += s * s / L;
        ++blocks;
      }
    if (blocks < 4) break;
    const double free = std::max(2.0, blocks - parameters * std::min(1.0, 4.0 * blocks / static_cast<double>(total)));
    const double z = (sum - free) / std::sqrt(2.0 * free);
    if (z > best.z || length > 0) best = {sum - free, z, L, std::max(1.0, sum / free)};
    if (length > 0) break;
  }
  return best;
}

namespace {

/// What the mean of a standard normal variable's squares loses when the largest fiftieth of them is left out: 1 - 2 q phi(q) / 0.98, q = 2.3263.
constexpr double kTrimmedSquare = 0.8735;

/// Trimmed mean of squared differences at a lag: the largest fiftieth (events) is left out and made up for.
double variogram(const std::vector<Eigen::VectorXd>& records, int lag) {
  std::vector<double> d;
  for (const auto& r : records)
    for (Eigen::Index k = lag; k < r.size(); ++k)
      if (std::isfinite(r[k]) && std::isfinite(r[k - lag])) d.push_back(std::pow(r[k] - r[k - lag], 2));
  if (d.empty()) return 0.0;
  std::sort(d.begin(), d.end());
  const std::size_t keep = std::max<std::size_t>(1, d.size() - d.size() / 50);
  double sum = 0.0;
  for (std::size_t i = 0; i < keep; ++i) sum += d[i];
  return sum / static_cast<double>(keep) / (keep < d.size() ? kTrimmedSquare : 1.0);
}

}  // namespace

namespace {

/// Residuals of replicates less each other, over sqrt 2: what they have in common, the model's misfit, cancels.
std::vector<Eigen::VectorXd> replicate_differences(const Dataset& d, const Fit& fit, std::size_t output) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < d.trials.size(); ++i)
    if (!d.trials[i].repeat.empty() && i < fit.residual.size() && !fit.residual[i].empty()) groups[d.trials[i].repeat + d.protocol_text(d.trials[i])].push_back(i);
  std::vector<Eigen::VectorXd> out;
  for (const auto& [key, members] : groups)
    for (std::size_t k = 1; k < members.size(); ++k) {
      const Eigen::VectorXd &a = fit.residual[members[k]][output], &b = fit.residual[members[k - 1]][output];
      const Eigen::Index n = std::min(a.size(), b.size());
      if (n > 20 && 50 * std::abs(a.size() - b.size()) <= n) out.push_back((a.head(n) - b.head(n)) / std::numbers::sqrt2);
    }
  return out;
}

/// Variance that a line leaves which a clock blurs that strays by a twentieth of its step (contract: jitter is ordinary): with the phase's
/// deviation p = 2 pi f s, the coherent line has exp(-p^2) of the power and the rest is white.
double line_remainder(const Fitter& fitter, const Fit& fit, std::size_t output) {
  Fit without = fit;
  double frequency = 0.0;
  for (std::size_t k = without.forms.size(); k-- > 0;)
    if (without.forms[k]->line) {
      frequency = std::max(frequency, without.params[k][0]);
      without.forms.erase(without.forms.begin() + static_cast<std::ptrdiff_t>(k));
      without.params.erase(without.params.begin() + static_cast<std::ptrdiff_t>(k));
    }
  if (frequency <= 0.0) return 0.0;
  double sum = 0.0;
  int records = 0;
  for (std::size_t i = 0; i < fit.predicted.size(); ++i) {
    if (fit.predicted[i].empty()) continue;
    std::vector<Eigen::VectorXd> plain;
    fitter.residual(static_cast<int>(i), fitter.setting(without, static_cast<int>(i)), nullptr, &plain);
    const Trial& t = fitter.model().data().trials[i];
    const double step = (t.time[t.samples() - 1] - t.time[0]) / (t.samples() - 1), phase = 2.0 * std::numbers::pi * frequency * assumed::kJitter * step;
    const double power = (fit.predicted[i][output] - plain[output]).squaredNorm() / static_cast<double>(t.samples());
    sum += power * std::expm1(std::min(phase * phase, 3.0));
    ++records;
  }
  return records > 0 && std::isfinite(sum) ? sum / records : 0.0;
}

/// Variance [SI2] that following a film adds to an output: its own, and that of filmed inputs by the output's travel over theirs.
double tracked_variance(const Dataset& d, const std::string& output, double full_scale) {
  double most = 0.0;
  for (const Trial& t : d.trials) {
    if (t.hold_out) continue;
    double variance = 0.0;
    for (const auto& [name, sd] : t.tracked) {
      double low = INFINITY, high = -INFINITY;
      for (const double v : t.at(name))
        if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
      const double slope = name == output ? 1.0 : d.channel(name).input && high > low ? full_scale / (high - low) : 0.0;
      variance += slope * slope * sd * sd;
    }
    most = std::max(most, variance);
  }
  return most;
}

}  // namespace

Noise estimate_noise(const Fitter& fitter, const Fit& fit) {
  Noise noise = fitter.noise();
  const Dataset& d = fitter.model().data();
  for (std::size_t c = 0; c < d.outputs.size(); ++c) {
    std::vector<Eigen::VectorXd> records = replicate_differences(d, fit, c);
    const bool replicates = !records.empty();
    double sum = 0.0;
    int n = 0;
    for (const auto& r : fit.residual) {
      if (r.empty()) continue;
      if (!replicates) records.push_back(r[c]);
      for (const double v : r[c])
        if (std::isfinite(v)) sum += v * v, ++n;
    }
    const double v1 = variogram(records, 1), v2 = variogram(records, 2), v4 = variogram(records, 4);
    OutputNoise& o = noise.output[c];
    const Channel& channel = d.channel(d.outputs[c]);
    const double film = tracked_variance(d, d.outputs[c], o.full_scale), floor = std::max(1e-5 * o.full_scale, std::sqrt(film));
    if (channel.noise > 0.0) {
      o.from = "stated";
      // jitter of the clock, steps of the converter and errors of a film may add to what is stated, but not anything
      const double most = assumed::kStatedMost * std::sqrt(channel.noise * channel.noise + line_remainder(fitter, fit, c) + film);
      o.sigma = std::max(std::clamp(std::sqrt(0.5 * v1), channel.noise, most), floor);
      o.rho = std::clamp(1.0 - 0.5 * v1 / (o.sigma * o.sigma), 0.0, 0.98);
      o.white = 0.0;
      // what replicates do not share is noise, slow or fast; a residual alone could be a slow misfit as well
      if (replicates) o = likeliest(records, o, std::max(channel.noise, floor), std::max(most, floor), assumed::kWhiteWorth);
      continue;
    }
    o.from = replicates ? "replicates" : "fast part";
    const double r2 = v1 > 0 ? v2 / v1 - 1.0 : 0.0, r4 = v2 > 0 ? std::sqrt(std::max(0.0, v4 / v2 - 1.0)) : 0.0;
    o.rho = std::clamp(0.5 * (r2 + r4) < assumed::kMemoryLeast ? 0.0 : 0.5 * (r2 + r4), 0.0, 0.97);
    o.sigma = std::max(std::sqrt(0.5 * v1 / (1.0 - o.rho)), floor);
    const double rms = n > 0 ? std::sqrt(sum / n) : o.sigma;
    if (o.sigma > rms && rms > floor) {  // the variogram cannot ask for more than is there
      o.sigma = rms;
      o.rho = std::clamp(1.0 - 0.5 * v1 / (rms * rms), 0.0, 0.97);
    }
    o.white = 0.0;
    if (replicates) o = likeliest(records, o, floor, std::max(rms, floor), assumed::kWhiteWorth);
    if (film > 0.0 && o.sigma <= floor) o.from = "tracking in the film";
  }
  return noise;
}

double replicate_scatter(const Dataset& d, const Fit& loose) {
  std::map<std::string, std::vector<double>> groups;
  for (std::size_t i = 0; i < d.trials.size(); ++i)
    if (!d.trials[i].repeat.empty() && !d.trials[i].hold_out)
      groups[d.trials[i].repeat + d.protocol_text(d.trials[i])].push_back(loose.log_scale[i]);
  double sum = 0.0;
  int freedom = 0;
  for (const auto& [key, v] : groups) {
    double mean = 0.0;
    for (const double x : v) mean += x / static_cast<double>(v.size());
    for (const double x : v) sum += (x - mean) * (x - mean);
    freedom += static_cast<int>(v.size()) - 1;
  }
  // few groups say little: the contract's 5-10 % is the second voice
  if (freedom == 0) return assumed::kScatterAlone;
  const double s = std::sqrt(sum / freedom);
  return std::clamp(s * (1.0 + 1.0 / freedom), assumed::kScatterLow, assumed::kScatterHigh);
}

double replicate_dispersion(const Fitter& fitter, const Fit& fit, int length) {
  const Dataset& d = fitter.model().data();
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < d.trials.size(); ++i)
    if (!d.trials[i].repeat.empty() && i < fit.white.size() && fit.white[i].size() > 0)
      groups[d.trials[i].repeat + d.protocol_text(d.trials[i])].push_back(i);
  std::vector<Eigen::VectorXd> difference;
  for (const auto& [key, members] : groups)
    for (std::size_t k = 1; k < members.size(); ++k) {
      const auto &a = fit.white[members[k]], &b = fit.white[members[k - 1]];
      if (a.size() == b.size()) difference.push_back((a - b) / std::numbers::sqrt2);
    }
  if (difference.empty()) return 1.0;
  return structure_of(difference, static_cast<int>(difference.size()), length).dispersion;
}

Window strongest_window(const std::vector<Eigen::VectorXd>& white) {
  Window best;
  Eigen::VectorXd sum;
  for (std::size_t i = 0; i < white.size(); ++i) {
    const Eigen::Index n = white[i].size();
    sum.resize(n + 1);
    sum[0] = 0.0;
    for (Eigen::Index k = 0; k < n; ++k) sum[k + 1] = sum[k] + white[i][k];
    for (Eigen::Index L = 4; L <= n; L *= 2)
      for (Eigen::Index k = 0; k + L <= n; k += L / 4) {
        const double value = std::abs(sum[k + L] - sum[k]) / std::sqrt(static_cast<double>(L));
        if (value > best.value) best = {value, i, k, L};
      }
  }
  return best;
}

double chi2_tail(double x, int freedom) {
  if (!(x > 0.0)) return 1.0;
  double sum = 0.0, log_term = -0.5 * x;
  for (int j = 0; j < freedom / 2; ++j) {
    sum += std::exp(log_term);
    log_term += std::log(0.5 * x) - std::log(j + 1.0);
  }
  return std::min(1.0, sum);
}

namespace {

constexpr std::size_t kPlaces = 4000, kMostPlaces = 400'000;  // frequencies in which a line is looked for; the second in long records
constexpr Eigen::Index kLongRecord = 20'000;                  // samples, from which one transform stands for a sum at each frequency
constexpr double kManySums = 5e7;

/// What a sinusoid of free phase takes off the sum of squares, at each frequency.
std::vector<double> sinusoids(const Eigen::VectorXd& time, const Eigen::VectorXd& r, const std::vector<double>& frequency) {
  std::vector<double> out(frequency.size(), 0.0);
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    const double w = 2.0 * std::numbers::pi * frequency[k];
    double sc = 0, ss = 0, sy = 0, cy = 0, cc = 0;
    for (Eigen::Index n = 0; n < r.size(); ++n) {
      if (!std::isfinite(r[n])) continue;
      const double phase = w * (time[n] - time[0]), si = std::sin(phase), co = std::cos(phase);
      ss += si * si, cc += co * co, sc += si * co, sy += si * r[n], cy += co * r[n];
    }
    const double det = ss * cc - sc * sc;
    if (det <= 1e-6 * (ss + cc) * (ss + cc)) continue;
    const double a = (sy * cc - cy * sc) / det, b = (cy * ss - sy * sc) / det;
    out[k] = a * sy + b * cy;
  }
  return out;
}

}  // namespace

Line strongest_line(const Fitter& fitter, const Fit& fit, double low, double high) {
  const Dataset& d = fitter.model().data();
  Line best;
  double span = 0.0, shortest = 1e300;
  Eigen::Index longest = 0;
  for (const Trial& t : d.trials) {
    span = std::max(span, t.time[t.samples() - 1] - t.time[0]);
    shortest = std::min(shortest, t.time[t.samples() - 1] - t.time[0]);
    longest = std::max<Eigen::Index>(longest, t.samples());
  }
  const double step = 0.3 / span;
  // a narrow band may lie wholly below the peak of a short record: the background is taken on both sides of it
  const double beside = low > 5.0 ? std::min(8.0 / shortest, 3.0) : step;
  std::vector<double> power, frequency;
  int columns = 0;
  for (double f = std::max(low - beside, 0.5 * step); f <= high + beside + 1e-12 && frequency.size() < (longest < kLongRecord ? kPlaces : kMostPlaces); f += step) frequency.push_back(f);
  power.assign(frequency.size(), 0.0);
  for (std::size_t i = 0; i < d.trials.size(); ++i) {
    if (i >= fit.residual.size() || fit.residual[i].empty()) continue;
    const Trial& t = d.trials[i];
    for (std::size_t c = 0; c < d.outputs.size(); ++c) {
      // amplitude of the raw residual over the noise's spectrum at that frequency
      const OutputNoise& o = fitter.noise().output[c];
      const Eigen::VectorXd& r = fit.residual[i][c];
      const double dt = (t.time[t.samples() - 1] - t.time[0]) / (t.samples() - 1);
      columns += 2;
      const bool many = longest >= kLongRecord && static_cast<double>(r.size()) * static_cast<double>(frequency.size()) > kManySums;
      const std::vector<double> taken = many ? line_powers(t.time, r, frequency) : sinusoids(t.time, r, frequency);
      for (std::size_t k = 0; k < frequency.size(); ++k) power[k] += taken[k] / (o.sigma * o.sigma * o.spectrum(2.0 * std::numbers::pi * frequency[k] * dt));
    }
  }
  // what rises towards the end of the band is a slope, no line
  const auto top = [&](std::size_t k) { return (k == 0 || power[k] >= power[k - 1]) && (k + 1 == power.size() || power[k] >= power[k + 1]); };
  const double background = std::max(1.0, median(power) / std::max(1.0, columns - 0.7));
  for (std::size_t k = 0; k < power.size(); ++k)
    if (frequency[k] >= low && frequency[k] <= high && top(k) && power[k] / background > best.gain) best = {frequency[k], power[k] / background, columns, background};
  // of more places noise makes a stronger one: by 2 ln of their number
  if (frequency.size() > kPlaces) best.gain = std::max(0.0, best.gain - 2.0 * std::log(static_cast<double>(frequency.size()) / static_cast<double>(kPlaces)));
  return best;
}

}  // namespace filum::reconcile
