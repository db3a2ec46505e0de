#include "reconcile/hold_records.h"

#include <algorithm>

#include "reconcile/hold_bands.h"
#include "reconcile/thin.h"

namespace filum::reconcile {

LintSummary lint_hold(const Dataset& d, const HoldLintOptions& options) {
  LintSummary out{{
      {Effect::sensor_lag, "nothing is prescribed, so nothing can lag", "a tip moved by a known stage"},
      {Effect::sensor_drift, "a slow drift is part of the still hand and of the baseline", "a sensor on a fixed tip"}}, check_hardware(d)};
  double rate = 1e300, span = 0.0;
  for (const Trial& t : d.trials) {
    const double length = t.time[t.samples() - 1] - t.time[0];
    rate = std::min(rate, (t.samples() - 1) / length);
    span = std::max(span, length);
  }
  if (rate < options.tremor_sampling) out.not_testable.push_back({Effect::physiological_tremor, "sampled more slowly than twice 12 Hz", info(Effect::physiological_tremor).shows});
  if (hum_is_gone(d)) out.not_testable.push_back({Effect::mains_hum, "thinned behind a low-pass below 50 Hz", info(Effect::mains_hum).shows});
  if (span < options.pulsation_span) out.not_testable.push_back({Effect::pulsation, "records shorter than 5 s", info(Effect::pulsation).shows});
  return out;
}

HoldRecords hold_records(const RigModel& model, const NoiseOptions& options, NoiseSummary& noise, BaselineSummary& baseline) {
  const Dataset& d = model.data();
  Noise level;
  HoldRecords out{Fitter(model, {}), {}, {}, {}, {}, {}, {}};
  for (const std::string& name : d.outputs) {
    const double fs = model.full_scale(name), stated = d.channel(name).noise;
    out.stated.push_back(std::max(0.0, stated));
    level.output.push_back({stated > 0 ? stated : options.first * fs, 0.0, fs, stated > 0 ? "stated" : "fast part"});
  }
  out.fitter.set_noise(level);
  out.fitter.use.assign(d.trials.size(), true);
  out.base = out.fitter.fit({}, {}, {});
  for (std::size_t c = 0; c < d.outputs.size(); ++c) {
    std::vector<double> levels;
    for (std::size_t i = 0; i < d.trials.size(); ++i)
      if (!d.trials[i].hold_out) levels.push_back(spectrum(out.base.residual[i][c], d.trials[i].time, 0.0).sigma);
    if (out.stated[c] <= 0 || median(levels) > out.stated[c]) level.output[c].sigma = median(levels);
    out.sigma.push_back(level.output[c].sigma);
  }
  out.fitter.set_noise(level);
  out.all = spectra(d, out.base, out.sigma, false), out.held = spectra(d, out.base, out.sigma, true);
  out.fitted = out.base;
  for (std::size_t i = 0; i < d.trials.size(); ++i)
    if (d.trials[i].hold_out) out.fitted.residual[i].clear();
  noise.noise = std::move(level);
  baseline.fit = out.base;
  return out;
}

}  // namespace filum::reconcile
