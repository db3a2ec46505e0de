#include "reconcile/thin.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/error.h"

namespace filum::reconcile {
namespace {

constexpr double kRollOff = 0.2;  // between 0.4 and 0.6 of the new rate
constexpr double kBeta = 3.0;     // Kaiser's window
constexpr int kLeast = 64;       // samples of a record that must be left
constexpr int kLobes = 40;        // new samples to either side

/// Kaiser's window needs the modified Bessel function I0, by its series.
double bessel(double x) {
  double sum = 1.0, term = 1.0;
  for (int k = 1; term > 1e-16 * sum; ++k) sum += term *= 0.25 * x * x / (static_cast<double>(k) * k);
  return sum;
}

/// Response of the root-raised-cosine filter at x new samples from the middle; 0/0 in the middle and where 4 b x = 1.
double root_raised_cosine(double x) {
  using std::numbers::pi;
  constexpr double b = kRollOff;
  if (x < 1e-9) return 1.0 - b + 4.0 * b / pi;
  const double pole = 1.0 - 16.0 * b * b * x * x;
  if (std::abs(pole) < 1e-6) return b / std::numbers::sqrt2 * ((1.0 + 2.0 / pi) * std::sin(0.25 * pi / b) + (1.0 - 2.0 / pi) * std::cos(0.25 * pi / b));
  return (std::sin(pi * x * (1.0 - b)) + 4.0 * b * x * std::cos(pi * x * (1.0 + b))) / (pi * x * pole);
}

/// Weights at 0, 1 ... samples from the middle.
std::vector<double> low_pass(int m) {
  std::vector<double> out;
  const int reach = kLobes * m;
  for (int k = 0; k <= reach; ++k) {
    const double part = static_cast<double>(k) / (reach + 1);
    out.push_back(root_raised_cosine(static_cast<double>(k) / m) * bessel(kBeta * std::sqrt(1.0 - part * part)) / bessel(kBeta));
  }
  return out;
}

/// Where the straight line through the first samples of v starts; `step` -1: the last ones, from the end.
double end_of(const Eigen::VectorXd& v, Eigen::Index count, int step) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (Eigen::Index k = 0; k < std::min(count, v.size()); ++k) {
    const double value = step > 0 ? v[k] : v[v.size() - 1 - k], at = static_cast<double>(k);
    if (std::isfinite(value)) n += 1, x += at, y += value, xx += at * at, xy += at * value;
  }
  const double determinant = n * xx - x * x;
  return determinant > 0.0 ? (xx * y - x * xy) / determinant : n > 0 ? y / n : NAN;
}

/// The record turned about its ends (where straight lines through 4 m samples end): what is straight goes on straight, and an end is no noisier than the rest.
Eigen::VectorXd extended(const Eigen::VectorXd& v, Eigen::Index reach, int m) {
  const double first = end_of(v, 4 * m, 1), last = end_of(v, 4 * m, -1);
  Eigen::VectorXd out = Eigen::VectorXd::Constant(v.size() + 2 * reach, NAN);
  out.segment(reach, v.size()) = v;
  for (Eigen::Index k = 1; k <= std::min(reach, v.size() - 1); ++k) out[reach - k] = 2.0 * first - v[k], out[reach + v.size() - 1 + k] = 2.0 * last - v[v.size() - 1 - k];
  return out;
}

/// Means of m neighbours: rougher, but never out of order.
Eigen::VectorXd means(const Eigen::VectorXd& v, int m) {
  Eigen::VectorXd out(v.size() / m);
  for (Eigen::Index n = 0; n < out.size(); ++n) out[n] = v.segment(n * m, m).mean();
  return out;
}

bool ascending(const Eigen::VectorXd& t) {
  for (Eigen::Index k = 1; k < t.size(); ++k)
    if (!(t[k] > t[k - 1])) return false;
  return true;
}

/// A clock with jumps would come out of the low-pass out of order: such a record is thinned by means.
void thin_trial(Trial& t, int m) {
  const Eigen::VectorXd time = thinned(t.time, m);
  const bool ordered = ascending(time);
  t.time = ordered ? time : means(t.time, m);
  for (auto& [name, v] : t.data) v = ordered ? thinned(v, m) : means(v, m);
}

}  // namespace

Eigen::VectorXd thinned(const Eigen::VectorXd& v, int m) {
  const auto weights = low_pass(m);
  const auto reach = static_cast<Eigen::Index>(weights.size()) - 1;
  const Eigen::VectorXd record = extended(v, reach, m);
  double whole = -weights[0];
  for (const double w : weights) whole += 2.0 * w;
  Eigen::VectorXd out((v.size() + m - 1) / m);
  for (Eigen::Index n = 0; n < out.size(); ++n) {
    double weight = 0.0, sum = 0.0;
    for (Eigen::Index k = -reach; k <= reach; ++k) {
      const double w = weights[static_cast<std::size_t>(std::abs(k))], value = record[reach + n * m + k];
      if (std::isfinite(value)) weight += w, sum += w * value;
    }
    out[n] = weight > 0.5 * whole ? sum / weight : NAN;
  }
  return out;
}

void thin(Dataset& d, int most) {
  double all = 0.0;
  for (const Trial& t : d.trials) all += t.samples();
  const int m = static_cast<int>(std::ceil(all / most));
  if (m < 2) return;
  for (Trial& t : d.trials) {
    if (t.samples() < kLeast * m) throw InputError(d.folder + "/" + t.file, "rows", std::to_string(t.samples()), "at least " + std::to_string(kLeast * m) + ", since records of so many samples in all are thinned to one in " + std::to_string(m));
    thin_trial(t, m);
  }
  d.thinned = m;
  for (Channel& c : d.channels) c.noise = 0.0;
  char text[300];
  std::snprintf(text, sizeof text, "%.0f samples in all are more than the %d that are fitted: every record was thinned to one in %d behind a low-pass; what is faster than 0.4 of the new rate is weakened, than 0.6 gone, and the noise of a sample is estimated anew", all, most, m);
  d.note(text);
}

bool hum_is_gone(const Dataset& d) {
  double rate = 0.0;
  for (const Trial& t : d.trials) rate = std::max(rate, (t.samples() - 1) / (t.time[t.samples() - 1] - t.time[0]));
  return d.thinned > 1 && rate * 0.5 * (1.0 + kRollOff) < 49.0;
}

}  // namespace filum::reconcile
