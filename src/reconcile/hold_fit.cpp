#include "reconcile/hold_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

/// What a sine of this frequency takes off chi-squared beside the slow polynomial, and its amplitude: mean over records and outputs with weight; folded
/// to nearly nothing, or near half the sampling rate, it is hardly seen, and the weight says so.
struct LineFit {
  double gain = 0.0, amplitude = 0.0, half = INFINITY;  // half: of the interval [m]
};
LineFit line_fit(const Dataset& d, const Fit& base, const Noise& noise, double frequency) {
  LineFit out;
  double sum = 0.0, weight = 0.0, spread = 0.0;
  std::vector<std::pair<double, double>> all;
  for (std::size_t i = 0; i < base.residual.size(); ++i)
    for (std::size_t c = 0; c < base.residual[i].size(); ++c) {
      Eigen::Matrix<double, 6, 6> N = Eigen::Matrix<double, 6, 6>::Zero();
      Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero(), v;
      const Eigen::VectorXd &r = base.residual[i][c], &time = d.trials[i].time;
      for (Eigen::Index n = 0; n < r.size(); ++n) {
        if (!std::isfinite(r[n])) continue;
        const double since = time[n] - time[0], phase = 6.283185307179586 * frequency * since, u = 2.0 * since / (time[time.size() - 1] - time[0]) - 1.0;
        v << std::cos(phase), std::sin(phase), 1.0, u, 1.5 * u * u - 0.5, (2.5 * u * u - 1.5) * u;
        N += v * v.transpose();
        right += v * r[n];
      }
      const Eigen::Matrix<double, 4, 2> slow = N.bottomRightCorner<4, 4>().ldlt().solve(N.bottomLeftCorner<4, 2>());
      const Eigen::Matrix2d A = N.topLeftCorner<2, 2>() - N.topRightCorner<2, 4>() * slow;
      const Eigen::Vector2d b = right.head<2>() - slow.transpose() * right.tail<4>();
      const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(A).eigenvalues()[0], variance = std::pow(noise.output[c].sigma, 2);
      if (!(least > 1e-6 * N.trace())) continue;
      const Eigen::Vector2d x = A.ldlt().solve(b);
      out.gain += x.dot(b) / variance;
      all.emplace_back(x.norm(), least / variance);
      sum += all.back().first * all.back().second;
      weight += all.back().second;
    }
  if (weight <= 0.0) return out;
  out.amplitude = sum / weight;
  for (const auto& [a, w] : all) spread += w * (a - out.amplitude) * (a - out.amplitude) / weight;
  out.half = 1.4 * 1.96 * std::sqrt(1.0 / weight + spread / static_cast<double>(all.size())) + 0.02 * out.amplitude;
  return out;
}

/// Amplitude at the frequency that takes most off; the interval holds those of all frequencies that do nearly as well. `frequency` was found on a grid of
/// 0.3/span, between whose points a sine loses up to 4 % of its amplitude (sin x/x), and is brought to the best; folded to a few cycles a record it is sought wider.
Estimate line_amplitude(const Dataset& d, const Fit& base, const Noise& noise, double& frequency) {
  double span = 1e-300, rate = 1.0;
  for (const Trial& t : d.trials) span = std::max(span, t.time[t.samples() - 1] - t.time[0]), rate = (t.samples() - 1) / (t.time[t.samples() - 1] - t.time[0]);
  const double folded = std::abs(std::remainder(frequency, 0.5 * rate)) * span;  // from nothing or half the rate [1/span]
  const double step = folded < 5.0 ? 0.05 : 0.02;
  const int reach = folded < 5.0 ? 60 : 20;
  std::vector<std::pair<double, LineFit>> near;
  for (int k = -reach; k <= reach; ++k) near.emplace_back(frequency + step * k / span, line_fit(d, base, noise, frequency + step * k / span));
  const auto best = std::max_element(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.second.gain < b.second.gain; });
  const LineFit& top = best->second;
  if (!std::isfinite(top.half)) return {"amplitude", "m", 0.0, 0.0, INFINITY};
  Estimate e{"amplitude", "m", top.amplitude, top.amplitude - top.half, top.amplitude + top.half};
  for (const auto& [f, fit] : near)
    if (fit.gain > top.gain - 3.84 && std::isfinite(fit.half)) e.low = std::min(e.low, fit.amplitude - fit.half), e.high = std::max(e.high, fit.amplitude + fit.half);
  e.low = std::max(0.0, e.low);
  frequency = best->first;
  return e;
}

NamedEffect named_line(const Found& f, const Estimate& line) {
  const double rms = std::sqrt(f.power), share = 1.96 / std::sqrt(std::max(2.0, 2.0 * f.bins));
  const double width = 0.5 * (f.high - f.low) / std::sqrt(std::max(1.0, 0.5 * f.bins));
  NamedEffect out{f.effect, "", {{"frequency", "Hz", f.frequency, f.frequency - 1.96 * width, f.frequency + 1.96 * width}}};
  if (f.effect == Effect::physiological_tremor) {
    out.form = "narrow band of random phase";
    const double few = std::max(1.6 * share, 0.06);  // neighbouring bins of a narrow band are not independent
    out.parameters.push_back({"rms", "m", rms, rms * (1.0 - few), rms * (1.0 + few)});
  } else {
    out.form = f.form->text;
    out.parameters.push_back(line);
  }
  return out;
}

}  // namespace

HoldFitSummary fit_hold(const HoldRecords& records, HoldScreenSummary& screened, const Run& run) {
  const Dataset& d = records.fitter.model().data();
  HoldFitSummary out;
  if (screened.clipped) out.effects.push_back(*screened.clipped);
  std::vector<Found>& found = screened.found;
  for (Found& f : found) {
    stop_if_cancelled(run);
    out.tried.push_back({{f.effect}, "", -f.evidence, 1.0, true, "taken"});
    if (std::any_of(out.effects.begin(), out.effects.end(), [&](const NamedEffect& e) { return e.effect == f.effect; })) continue;
    std::vector<Found> others;
    std::copy_if(found.begin(), found.end(), std::back_inserter(others), [&](const Found& o) { return o.effect != f.effect; });
    const Estimate amplitude = f.form == nullptr ? Estimate{} : line_amplitude(d, without_lines(d, records.fitted, others), records.fitter.noise(), f.frequency);
    out.effects.push_back(named_line(f, amplitude));
  }
  const bool tremor = std::any_of(found.begin(), found.end(), [](const Found& f) { return f.effect == Effect::physiological_tremor; });
  if (screened.tremor.evidence > 4.0 && !tremor)
    out.tried.push_back({{Effect::physiological_tremor}, "", -screened.tremor.evidence, 0.0, false, "no band of random phase between 8 and 12 Hz stands out enough"});
  return out;
}

}  // namespace filum::reconcile
