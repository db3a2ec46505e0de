// Values with 95 % intervals from the curvature at the optimum (widened by the overdispersion).

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "reconcile/estimate.h"
#include "reconcile/rules.h"

namespace filum::reconcile {
namespace {

constexpr double kTwoSided = 1.96;

Estimate estimate(const std::string& name, const std::string& unit, double value, double sd, bool logarithmic, double low, double high, double form = assumed::kForm) {
  if (!std::isfinite(sd)) return {name, unit, value, low, high};
  sd = logarithmic ? std::hypot(assumed::kWiden * sd, form) : std::hypot(assumed::kWiden * sd, form * std::abs(value));
  if (logarithmic) return {name, unit, value, std::max(low, value * std::exp(-kTwoSided * std::min(sd, 20.0))), std::min(high, value * std::exp(kTwoSided * std::min(sd, 20.0)))};
  return {name, unit, value, std::max(low, value - kTwoSided * sd), std::min(high, value + kTwoSided * sd)};
}

double deviation(const Fit& f, std::size_t k, double dispersion) {
  const auto i = static_cast<Eigen::Index>(k);
  return i < f.covariance.rows() ? std::sqrt(std::max(0.0, f.covariance(i, i)) * dispersion) : 0.0;
}

/// Share of a line that a clock blurs which strays by a twentieth of its step (contract: jitter is ordinary): exp((2 pi f s)^2/2) - 1.
double line_blur(const Dataset& d, double frequency) {
  std::vector<double> steps;
  for (const Trial& t : d.trials) steps.push_back((t.time[t.samples() - 1] - t.time[0]) / (t.samples() - 1));
  const double phase = 6.283185307179586 * frequency * assumed::kJitter * median(steps);
  return std::expm1(std::min(0.5 * phase * phase, 3.0));
}

/// Amplitude of the line of a form from the free columns: mean over the records, of the output in which it stands out most (each has its own unit).
Estimate amplitude(const Fitter& fitter, const Fit& f, const Form& form, const std::vector<double>& p) {
  const Dataset& d = fitter.model().data();
  std::vector<std::vector<double>> of(d.outputs.size());
  for (std::size_t i = 0; i < f.residual.size(); ++i)
    for (std::size_t c = 0; c < f.residual[i].size(); ++c) {
      // what the model without the line leaves, projected on the line
      Fit without = f;
      const auto at = static_cast<std::size_t>(std::find(f.forms.begin(), f.forms.end(), &form) - f.forms.begin());
      without.forms.erase(without.forms.begin() + static_cast<std::ptrdiff_t>(at));
      without.params.erase(without.params.begin() + static_cast<std::ptrdiff_t>(at));
      std::vector<Eigen::VectorXd> raw;
      fitter.residual(static_cast<int>(i), fitter.setting(without, static_cast<int>(i)), &raw);
      const Trial& t = d.trials[i];
      Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
      Eigen::Vector2d b = Eigen::Vector2d::Zero();
      for (Eigen::Index n = 0; n < raw[c].size(); ++n) {
        if (!std::isfinite(raw[c][n])) continue;
        const double phase = 6.283185307179586 * p[0] * (t.time[n] - t.time[0]);
        const Eigen::Vector2d v(std::cos(phase), std::sin(phase));
        A += v * v.transpose();
        b += v * raw[c][n];
      }
      of[c].push_back(A.ldlt().solve(b).norm());
    }
  std::size_t at = 0;
  const auto stands_out = [&](std::size_t c) { return median(of[c]) / fitter.noise().output[c].sigma; };
  for (std::size_t c = 1; c < of.size(); ++c)
    if (stands_out(c) > stands_out(at)) at = c;
  const std::vector<double>& all = of[at];
  const double mid = median(all);
  double var = 0.0;
  for (const double a : all) var += (a - mid) * (a - mid) / std::max<double>(1.0, static_cast<double>(all.size()) - 1.0);
  const double half = assumed::kLineWiden * kTwoSided * std::sqrt(var / static_cast<double>(std::max<std::size_t>(1, all.size()))) + assumed::kForm * mid;
  const double blur = line_blur(d, p[0]);
  std::string unit = "-";
  for (const ChannelInfo& c : info(d.rig).channels)
    if (c.name == d.outputs[at]) unit = c.unit;
  return {"amplitude", unit, mid, std::max(0.0, mid - half), mid + half + blur * mid};
}

}  // namespace

std::vector<Estimate> baseline_estimates(const Fitter& fitter, const Fit& fit, double dispersion) {
  std::vector<Estimate> out;
  const auto& base = fitter.model().baseline();
  const Dataset& d = fitter.model().data();
  std::vector<double> scale;
  for (const double s : fit.log_scale) scale.push_back(std::exp(s));
  for (std::size_t i = 0; i < base.size(); ++i) {
    if (!fitter.model().fitted(static_cast<int>(i))) {
      const auto m = fitter.model().measured(static_cast<int>(i), fit.base, scale);
      if (std::isfinite(m.high)) out.push_back({base[i].name, base[i].unit, m.value, m.low, m.high});
      continue;
    }
    const auto& free = fitter.free_baseline();
    const auto at = std::find(free.begin(), free.end(), static_cast<int>(i));
    if (at == free.end()) continue;
    const double sd = deviation(fit, static_cast<std::size_t>(at - free.begin()), dispersion);
    out.push_back(estimate(base[i].name, base[i].unit, fit.base[i], sd, base[i].logarithmic, fitter.low(static_cast<int>(i)), fitter.high(static_cast<int>(i))));
  }
  (void)d;
  return out;
}

std::vector<NamedEffect> effect_estimates(const Fitter& fitter, const Fit& fit, double dispersion) {
  std::vector<NamedEffect> out;
  std::size_t k = fitter.free_baseline().size();
  for (std::size_t f = 0; f < fit.forms.size(); ++f) {
    const Form& form = *fit.forms[f];
    NamedEffect named{form.effect, form.text, {}};
    for (std::size_t i = 0; i < form.params.size(); ++i, ++k) {
      const ParamSpec& p = form.params[i];
      Estimate e = estimate(p.name, p.unit, fit.params[f][i], deviation(fit, k, dispersion), p.logarithmic, p.low, p.high, form.effect == Effect::mains_hum ? assumed::kClock : assumed::kForm);
      if (p.times_baseline >= 0) {
        const double b = fit.base[static_cast<std::size_t>(p.times_baseline)];
        e.value *= b, e.low *= b, e.high *= b;
      }
      named.parameters.push_back(e);
    }
    if (form.effect == Effect::speed_dependent_friction && form.kind <= 2)
      for (const Estimate& e : baseline_estimates(fitter, fit, dispersion)) named.parameters.push_back({"mu_k", "-", e.value, e.low, e.high});
    if (form.effect == Effect::layer_rupture)
      for (const Estimate& e : baseline_estimates(fitter, fit, dispersion))
        if (e.name == "puncture_force") named.parameters.insert(named.parameters.begin(), {"force_1", "N", e.value, e.low, e.high});
    if (form.line) named.parameters.push_back(amplitude(fitter, fit, form, fit.params[f]));
    out.push_back(std::move(named));
  }
  return out;
}

void widen_by_forms(std::vector<NamedEffect>& effects, const std::vector<NamedEffect>& others) {
  for (NamedEffect& e : effects)
    for (const NamedEffect& o : others) {
      if (o.effect != e.effect) continue;
      for (Estimate& p : e.parameters)
        for (const Estimate& q : o.parameters)
          if (q.name == p.name && q.unit == p.unit && std::isfinite(q.value)) p.low = std::min(p.low, q.value), p.high = std::max(p.high, q.value);
    }
}

}  // namespace filum::reconcile
