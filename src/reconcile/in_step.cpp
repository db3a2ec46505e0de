#include "reconcile/in_step.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace filum::reconcile {
namespace {

double span_of(const Trial& t) { return t.time[t.samples() - 1] - t.time[0]; }

/// Normal equations of a cosine and a sine against a residual, over the noise's spectrum.
struct Projection {
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  int records = 0;
  double power = 0.0;  // of each record by itself, summed
  double together() const { return b.dot(A.ldlt().solve(b)); }
};

Projection project(const Trial& t, const Eigen::VectorXd& r, const OutputNoise& noise, double frequency) {
  Projection out;
  const double w = 2.0 * std::numbers::pi * frequency;
  for (Eigen::Index n = 0; n < r.size(); ++n) {
    if (!std::isfinite(r[n])) continue;
    const double phase = w * (t.time[n] - t.time[0]);
    const Eigen::Vector2d v(std::cos(phase), std::sin(phase));
    out.A += v * v.transpose();
    out.b += v * r[n];
  }
  const double density = noise.sigma * noise.sigma * noise.spectrum(w * span_of(t) / (t.samples() - 1));
  out.A /= density, out.b /= density;
  out.records = 1;
  out.power = out.together();
  return out;
}

}  // namespace

double folded(const Trial& t, double frequency) {
  const double rate = (t.samples() - 1) / span_of(t), rest = std::fmod(frequency, rate);
  return std::min(rest, rate - rest);
}

double period_of(const Eigen::VectorXd& time, const Eigen::VectorXd& x) {
  const double low = x.minCoeff(), range = x.maxCoeff() - low, middle = low + 0.5 * range;
  if (!(range > 0.0)) return 0.0;
  double first[2] = {0.0, 0.0}, last[2] = {0.0, 0.0}, crossed = time[0];
  int passages[2] = {0, 0}, side = 0;
  for (Eigen::Index n = 0; n < x.size(); ++n) {
    if (n > 0 && (x[n] > middle) != (x[n - 1] > middle)) crossed = time[n];
    const int now = x[n] > middle + 0.1 * range ? 1 : x[n] < middle - 0.1 * range ? -1 : side;
    if (side != 0 && now != side) {
      const int way = now > 0 ? 1 : 0;
      (passages[way]++ == 0 ? first[way] : last[way]) = crossed;
    }
    side = now;
  }
  const int between = std::max(0, passages[0] - 1) + std::max(0, passages[1] - 1);
  double sum = 0.0;
  for (int way = 0; way < 2; ++way)
    if (passages[way] > 1) sum += last[way] - first[way];
  return between > 0 ? sum / between : time[time.size() - 1] - time[0];
}

bool on_harmonic(const Dataset& d, const Trial& t, double frequency, int harmonics) {
  const double at = folded(t, frequency);
  return std::any_of(d.channels.begin(), d.channels.end(), [&](const Channel& c) {
    if (!c.input || c.name == "time" || !t.has(c.name) || !t.at(c.name).allFinite()) return false;
    const double period = period_of(t.time, t.at(c.name)), order = std::round(at * period);
    return period > 0.0 && order <= harmonics && std::abs(at - order / period) < 1.0 / span_of(t);
  });
}

Shared shared_line(const Fitter& fitter, const Fit& fit, double frequency, const std::vector<bool>& records) {
  const Dataset& d = fitter.model().data();
  std::map<std::pair<std::string, std::size_t>, Projection> groups;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!records[i] || i >= fit.residual.size()) continue;
    const Trial& t = d.trials[i];
    for (std::size_t c = 0; c < fit.residual[i].size(); ++c) {
      const Projection one = project(t, fit.residual[i][c], fitter.noise().output[c], folded(t, frequency));
      Projection& all = groups[{t.repeat + d.protocol_text(t), c}];
      all.A += one.A, all.b += one.b, all.power += one.power, all.records += 1;
    }
  }
  Shared out;
  for (const auto& [key, all] : groups) out.lost += all.power - all.together(), out.saved += 2 * (all.records - 1);
  return out;
}

}  // namespace filum::reconcile
