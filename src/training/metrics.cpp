#include "training/metrics.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "base/numbers.h"

namespace filum {
namespace {

std::vector<double> amplitude_spectrum(const std::vector<double>& signal, int padding) {
  const auto power = static_cast<int>(std::ceil(std::log2(static_cast<double>(signal.size())))) + padding;
  std::vector<double> padded = signal;
  padded.resize(std::size_t{1} << power, 0.0);
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, padded);
  std::vector<double> amplitude(spectrum.size());
  std::transform(spectrum.begin(), spectrum.end(), amplitude.begin(),
                 [](const auto& c) { return std::abs(c); });
  return amplitude;
}

/// Second-order low-pass section (bilinear transform with pre-warping).
struct Section {
  double b0, b1, b2, a1, a2;
  Section(double fs, double fc) {
    const double k = std::tan(std::numbers::pi * fc / fs), root2 = std::numbers::sqrt2;
    const double norm = 1.0 / (1.0 + root2 * k + k * k);
    b0 = k * k * norm;
    b1 = 2.0 * b0;
    b2 = b0;
    a1 = 2.0 * (k * k - 1.0) * norm;
    a2 = (1.0 - root2 * k + k * k) * norm;
  }
  /// In place, started in the steady state of the first value.
  void run(std::vector<double>& x) const {
    double x1 = x.front(), x2 = x1, y1 = x1, y2 = x1;
    for (double& value : x) {
      const double y = b0 * value + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
      x2 = x1;
      x1 = value;
      y2 = y1;
      y1 = y;
      value = y;
    }
  }
};

double mean_of(const std::vector<double>& x) {
  return x.empty() ? 0.0 : std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

/// Correlation of a[k] with b[k + lag].
double correlation_at(const std::vector<double>& a, const std::vector<double>& b, int lag) {
  const double ma = mean_of(a), mb = mean_of(b);
  const int n = static_cast<int>(std::min(a.size(), b.size()));
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (int k = std::max(0, -lag); k < n && k + lag < n; ++k) {
    const double x = a[static_cast<std::size_t>(k)] - ma, y = b[static_cast<std::size_t>(k + lag)] - mb;
    ab += x * y;
    aa += x * x;
    bb += y * y;
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : kNaN;
}

/// Peak of the smooth signal over the root mean square of what smoothing took away.
double signal_to_noise(const std::vector<double>& raw, const std::vector<double>& smooth) {
  double peak = 0.0, noise = 0.0;
  for (std::size_t k = 0; k < raw.size(); ++k) {
    peak = std::max(peak, std::abs(smooth[k]));
    noise += (raw[k] - smooth[k]) * (raw[k] - smooth[k]);
  }
  return peak / std::sqrt(noise / static_cast<double>(raw.size()) + 1e-300);
}

}  // namespace

double sparc(const std::vector<double>& speed, double fs, const SparcOptions& options) {
  if (speed.size() < 4) return kNaN;
  const std::vector<double> amplitude = amplitude_spectrum(speed, options.padding);
  const double largest = *std::max_element(amplitude.begin(), amplitude.end());
  if (!(largest > 0.0)) return kNaN;
  const double df = fs / static_cast<double>(amplitude.size());
  const auto count =
      std::min(amplitude.size(), static_cast<std::size_t>(std::floor(options.fc / df * (1 + 1e-12))) + 1);
  std::size_t first = count, last = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (amplitude[k] < options.amplitude * largest) continue;
    first = std::min(first, k);
    last = k;
  }
  if (first >= last) return kNaN;
  const double width = static_cast<double>(last - first);
  double length = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    length += std::hypot(1.0 / width, (amplitude[k + 1] - amplitude[k]) / largest);
  }
  return -length;
}

double ldlj(const std::vector<double>& speed, double fs) {
  if (speed.size() < 4) return kNaN;
  double peak = 0.0, sum = 0.0;
  for (double v : speed) peak = std::max(peak, std::abs(v));
  if (!(peak > 0.0)) return kNaN;
  const double dt = 1.0 / fs, duration = static_cast<double>(speed.size()) * dt;
  for (std::size_t k = 2; k < speed.size(); ++k) {
    const double jerk = (speed[k] - 2.0 * speed[k - 1] + speed[k - 2]) / (dt * dt);
    sum += jerk * jerk * dt;
  }
  return -std::log(duration * duration * duration / (peak * peak) * sum);
}

std::vector<double> low_pass(const std::vector<double>& signal, double fs, double fc) {
  if (signal.size() < 2 || fc >= 0.5 * fs) return signal;
  // Two passes of a second-order section are 3 dB down at (sqrt(2) - 1)^(1/4) of its own cut-off.
  const double corrected = std::min(fc / std::pow(std::numbers::sqrt2 - 1.0, 0.25), 0.49 * fs);
  const Section section(fs, corrected);
  const std::size_t n = signal.size(), pad = std::min(n - 1, static_cast<std::size_t>(3.0 * fs / fc));
  std::vector<double> x;
  x.reserve(n + 2 * pad);
  for (std::size_t k = pad; k > 0; --k) x.push_back(2.0 * signal.front() - signal[k]);
  x.insert(x.end(), signal.begin(), signal.end());
  for (std::size_t k = 1; k <= pad; ++k) x.push_back(2.0 * signal.back() - signal[n - 1 - k]);
  section.run(x);
  std::reverse(x.begin(), x.end());
  section.run(x);
  std::reverse(x.begin(), x.end());
  const auto begin = x.begin() + static_cast<std::ptrdiff_t>(pad);
  return {begin, begin + static_cast<std::ptrdiff_t>(n)};
}

std::vector<double> speed_of(const Points& path, double fs) {
  const Eigen::Index n = path.cols();
  std::vector<double> speed(static_cast<std::size_t>(n), 0.0);
  for (Eigen::Index k = 0; k < n && n > 1; ++k) {
    const Eigen::Index before = std::max<Eigen::Index>(k - 1, 0), after = std::min(k + 1, n - 1);
    speed[static_cast<std::size_t>(k)] =
        (path.col(after) - path.col(before)).norm() * fs / static_cast<double>(after - before);
  }
  return speed;
}

double path_length(const Points& path) {
  double sum = 0.0;
  for (Eigen::Index k = 1; k < path.cols(); ++k) sum += (path.col(k) - path.col(k - 1)).norm();
  return sum;
}

std::vector<Segment> movements(const std::vector<double>& speed, double fs, const MovementOptions& options) {
  std::vector<Segment> found;
  const std::vector<double> smooth = low_pass(speed, fs, options.cut_off);
  const auto shortest = static_cast<std::size_t>(options.shortest * fs);
  for (std::size_t k = 0; k < smooth.size();) {
    if (!(smooth[k] >= options.rest)) {  // nor what is not a number
      ++k;
      continue;
    }
    Segment segment{k, k};
    double peak = 0.0;
    for (; segment.end < smooth.size() && smooth[segment.end] >= options.rest; ++segment.end) {
      peak = std::max(peak, smooth[segment.end]);
    }
    if (peak > options.threshold && segment.size() >= shortest) found.push_back(segment);
    k = segment.end;
  }
  return found;
}

double idle_time(const std::vector<double>& speed, double fs, const MovementOptions& options) {
  const std::vector<double> smooth = low_pass(speed, fs, options.cut_off);
  const auto still = std::count_if(smooth.begin(), smooth.end(), [&](double v) { return v < options.rest; });
  return static_cast<double>(still) / fs;
}

Spread spread_of(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
               values.end());
  if (values.empty()) return {kNaN, kNaN, kNaN, 0};
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double q) {
    const double at = q * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
  };
  return {quantile(0.5), quantile(0.25), quantile(0.75), static_cast<int>(values.size())};
}

Smoothness smoothness_of(const std::vector<double>& speed, double fs, const std::vector<Segment>& segments) {
  const std::vector<double> smooth = low_pass(speed, fs, 20.0);
  std::vector<double> sparcs, ldljs;
  for (const Segment& s : segments) {
    const double duration = static_cast<double>(s.size()) / fs;
    if (duration < 0.3 || duration > 10.0) continue;
    const auto cut = [&s](const std::vector<double>& x) {
      return std::vector<double>(x.begin() + static_cast<std::ptrdiff_t>(s.begin),
                                 x.begin() + static_cast<std::ptrdiff_t>(s.end));
    };
    sparcs.push_back(sparc(cut(speed), fs));
    if (signal_to_noise(cut(speed), cut(smooth)) >= kLdljSignalToNoise)
      ldljs.push_back(ldlj(cut(smooth), fs));
  }
  return {spread_of(std::move(sparcs)), spread_of(std::move(ldljs))};
}

Bimanual bimanual(const Points& first, const Points& second, double fs, const MovementOptions& options) {
  Bimanual result;
  const double first_path = path_length(first), second_path = path_length(second);
  if (first_path + second_path > 0.0) result.dominance = second_path / (first_path + second_path);
  const std::vector<double> a = low_pass(speed_of(first, fs), fs, options.cut_off);
  const std::vector<double> b = low_pass(speed_of(second, fs), fs, options.cut_off);
  const std::size_t n = std::min(a.size(), b.size());
  if (n == 0) return result;
  std::size_t both = 0;
  for (std::size_t k = 0; k < n; ++k) both += a[k] >= options.rest && b[k] >= options.rest ? 1 : 0;
  result.both_moving = static_cast<double>(both) / static_cast<double>(n);
  result.correlation = kNaN;
  const int reach = static_cast<int>(0.5 * fs);
  for (int lag = -reach; lag <= reach; ++lag) {
    const double c = correlation_at(a, b, lag);
    if (std::isnan(c) || c <= (std::isnan(result.correlation) ? -2.0 : result.correlation)) continue;
    result.correlation = c;
    result.lag = lag / fs;
  }
  return result;
}

std::vector<double> force_peaks(const std::vector<double>& force, double threshold) {
  std::vector<double> peaks;
  bool above = false;
  for (double f : force) {
    if (f > threshold) {
      if (!above) peaks.push_back(f);
      peaks.back() = std::max(peaks.back(), f);
    }
    above = f > threshold;
  }
  return peaks;
}

}  // namespace filum
