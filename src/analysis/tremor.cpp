#include "analysis/tremor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/numbers.h"
#include "training/metrics.h"

namespace filum {
namespace {

constexpr std::array<std::array<double, 2>, 4> kBands = {{{4.0, 6.0}, {6.0, 12.0}, {8.0, 12.0}, {12.0, 20.0}}};

std::vector<double> axis_of(const Points& p, int axis) {
  std::vector<double> x(static_cast<std::size_t>(p.cols()));
  for (Eigen::Index k = 0; k < p.cols(); ++k) x[static_cast<std::size_t>(k)] = p(axis, k);
  return x;
}

std::vector<double> high_passed(std::vector<double> x, double fs, double fc) {
  const std::vector<double> slow = low_pass(x, fs, fc);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] -= slow[k];
  return x;
}

/// Share of the power that the high-pass lets through: the low-pass run forwards and backwards has the response
/// 1 / (1 + (tan(pi f / fs) / tan(pi f_0 / fs))^4), 3 dB down at f_c = (sqrt 2 - 1)^(1/4) f_0.
double passed_power(double f, double fs, double fc) {
  const double f0 = fc / std::pow(std::numbers::sqrt2 - 1.0, 0.25);
  const double ratio = std::tan(std::numbers::pi * std::min(f, 0.499 * fs) / fs) / std::tan(std::numbers::pi * f0 / fs);
  const double taken = 1.0 / (1.0 + ratio * ratio * ratio * ratio);
  return (1.0 - taken) * (1.0 - taken);
}

Spectrum spectrum_of(const EvenPath& path, const TremorOptions& o, double high_pass) {
  std::vector<Spectrum> axes;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::vector<double>> stretches;
    for (const Points& p : path.stretches) {
      std::vector<double> x = axis_of(p, axis);
      stretches.push_back(high_pass > 0.0 ? high_passed(std::move(x), path.fs, high_pass) : std::move(x));
    }
    axes.push_back(welch(stretches, path.fs, o.welch));
  }
  Spectrum sum = sum_of(axes);
  for (std::size_t k = 0; high_pass > 0.0 && k < sum.density.size(); ++k)
    if (sum.frequency(k) > high_pass) sum.density[k] /= passed_power(sum.frequency(k), path.fs, high_pass);
  return sum;
}

std::string why_not(const EvenPath& path, const TremorOptions& o) {
  if (path.stretches.empty() || path.fs <= 0.0) return "no readings of the tool's position";
  if (path.jitter > o.longest_jitter) return "the sampling times jitter by more than 1 ms";
  if (path.seconds() < o.shortest) return "less than 10 s of readings without gaps";
  if (path.fs < 20.0) return "sampled at less than 20 Hz";
  return {};
}

void rms_and_range(const EvenPath& path, const TremorOptions& o, Tremor& result) {
  double square = 0.0, n = 0.0;
  Vec3 mean = Vec3::Zero();
  for (const Points& p : path.stretches) {
    for (int axis = 0; axis < 3; ++axis)
      for (double v : high_passed(axis_of(p, axis), path.fs, o.high_pass)) square += v * v;
    mean += p.rowwise().sum();
    n += static_cast<double>(p.cols());
  }
  mean /= n;
  result.rms = std::sqrt(square / n);
  for (const Points& p : path.stretches)
    result.range = std::max(result.range, (p.colwise() - mean).colwise().norm().maxCoeff());
}

TremorBand judge_band(double from, double to, const Spectrum& s, double fs, const Spectrum* floor,
                      const std::string& no_floor, double confidence) {
  TremorBand band{from, to, band_power(s, from, to, confidence), kNaN, false, kNaN, {}};
  const Interval noise = floor ? band_power(*floor, from, to, confidence) : Interval{kNaN, kNaN, kNaN};
  band.floor = noise.value;
  if (fs < 2.5 * to) {
    band.why = "sampled too slowly for this band";
  } else if (!floor) {
    band.why = no_floor;
  } else if (!(band.power.low > noise.high)) {
    band.why = "not above the device's noise floor";
  } else {
    band.resolved = true;
    band.rms = std::sqrt(band.power.value - noise.value);
  }
  return band;
}

}  // namespace

double EvenPath::seconds() const {
  Eigen::Index n = 0;
  for (const Points& p : stretches) n += p.cols();
  return fs > 0.0 ? static_cast<double>(n) / fs : 0.0;
}

bool Tremor::resolved() const {
  return std::any_of(bands.begin(), bands.end(), [](const TremorBand& b) { return b.resolved; });
}

Tremor tremor_of(const EvenPath& path, const std::optional<EvenPath>& clamped, const TremorOptions& o) {
  Tremor result;
  result.why = why_not(path, o);
  if (!result.why.empty()) return result;
  result.spectrum = spectrum_of(path, o, o.high_pass);
  if (result.spectrum.segments == 0.0) {
    result.why = "no stretch without gaps is as long as one segment";
    return result;
  }
  result.measured = true;
  rms_and_range(path, o, result);
  result.peak = peak_between(result.spectrum, 4.0, std::min(20.0, 0.45 * path.fs));
  const Spectrum whole = spectrum_of(path, o, 0.0);
  result.relative_power = band_power(whole, 8.0, 12.0).value / band_power(whole, 0.5, 25.0).value;
  std::string no_floor = "noise floor not measured: record the same device with its tool clamped and name that recording (--clamped)";
  std::optional<Spectrum> floor;
  if (clamped) {
    no_floor = why_not(*clamped, o);
    if (no_floor.empty()) floor = spectrum_of(*clamped, o, o.high_pass);
    if (floor && floor->segments == 0.0) floor.reset();
    if (!floor) no_floor = "the clamped recording gives no noise floor: " + (no_floor.empty() ? "too short" : no_floor);
  }
  for (const auto& [from, to] : kBands) {
    result.bands.push_back(judge_band(from, to, result.spectrum, path.fs, floor ? &*floor : nullptr, no_floor,
                                      o.welch.confidence));
  }
  if (!result.resolved()) result.why = result.bands[2].why;
  return result;
}

EvenPath even_path(const std::vector<double>& t, const Points& p) {
  EvenPath path;
  if (t.size() < 3) return path;
  std::vector<double> steps;
  for (std::size_t k = 1; k < t.size(); ++k) steps.push_back(t[k] - t[k - 1]);
  const double period = spread_of(steps).median;
  if (!(period > 0.0)) return path;
  path.fs = 1.0 / period;
  double square = 0.0, counted = 0.0;
  for (std::size_t first = 0; first + 1 < t.size();) {
    std::size_t last = first;
    while (last + 1 < t.size() && t[last + 1] - t[last] < 1.5 * period) ++last;
    if (last + 1 < t.size()) ++path.gaps;
    const auto n = static_cast<Eigen::Index>(std::floor((t[last] - t[first]) / period + 1e-9)) + 1;
    Points even(3, n);
    std::size_t k = first;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double at = t[first] + static_cast<double>(i) * period;
      while (k + 1 < last && t[k + 1] <= at) ++k;
      const std::size_t next = std::min(k + 1, last);
      const double share = next == k ? 0.0 : std::clamp((at - t[k]) / (t[next] - t[k]), 0.0, 1.0);
      even.col(i) = (1.0 - share) * p.col(static_cast<Eigen::Index>(k)) + share * p.col(static_cast<Eigen::Index>(next));
    }
    for (std::size_t j = first + 1; j <= last; ++j, counted += 1.0)
      square += (t[j] - t[j - 1] - period) * (t[j] - t[j - 1] - period);
    if (n > 1) {
      path.stretches.push_back(std::move(even));
      path.starts.push_back(t[first]);
    }
    first = last + 1;
  }
  path.jitter = counted > 0.0 ? std::sqrt(square / counted) : 0.0;
  return path;
}

}  // namespace filum
