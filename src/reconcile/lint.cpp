#include "reconcile/lint.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "reconcile/thin.h"

namespace filum::reconcile {
namespace {

/// Why an effect is not testable; no words: it is.
struct Reason {
  std::string why;
  bool hidden = false;  // NotTestable
};

/// Reasons that follow from the list of trials.
std::string missing_condition(const Dataset& d, Effect e) {
  std::set<std::string> modes, sides;
  std::set<double> lateral, aspect;
  for (const Trial& t : d.trials) {
    modes.insert(t.word("mode"));
    sides.insert(t.word("orientation"));
    const double width = d.rig == Rig::spatula_press ? t.size("blade_width") : t.size("diameter", t.size("width"));
    lateral.insert(std::round(1e6 * width) + 1e6 * std::round(1e6 * t.size("height")));
    aspect.insert(std::round(1e3 * width / std::max(t.size("height"), 1e-9)));
  }
  switch (e) {
    case Effect::tension_compression_asymmetry:
      return modes.count("compression") && modes.count("tension") ? "" : "not both tension and compression";
    case Effect::platen_friction: return aspect.size() > 1 ? "" : "one width-to-height ratio only: friction looks like a higher modulus";
    case Effect::poroelastic_drainage: return lateral.size() > 1 ? "" : "one specimen size only: drainage looks like relaxation";
    case Effect::rest_curvature: return sides.size() > 1 ? "" : "one orientation only: curvature looks like a different weight";
    default: return "";
  }
}

Reason clock_condition(const Dataset& d, Effect e, const LintOptions& options) {
  double rate = 1e300, span = 0.0;
  for (const Trial& t : d.trials) {
    if (!t.clocked) return {"no time channel"};
    const double length = t.time[t.samples() - 1] - t.time[0];
    rate = std::min(rate, (t.samples() - 1) / length);
    span = std::max(span, length);
  }
  if (e == Effect::pulsation && (rate < options.heart_sampling || span < options.heart_span)) return {"records too short or sampled too slowly for a heart beat", true};
  if (e == Effect::physiological_tremor && rate < options.tremor_sampling) return {"sampled more slowly than twice 8 Hz", true};
  if (e == Effect::mains_hum && hum_is_gone(d)) return {"thinned behind a low-pass below 50 Hz", true};
  if (e == Effect::mains_hum && (rate < options.hum_sampling || span * rate < options.hum_samples)) return {"too few samples: sampled so slowly that 50 Hz folds onto anything", true};
  return {};
}

/// Reasons that follow from the clearest signature an effect could leave in these records; `seen`: its squared signal to noise.
Reason signature_condition(const Score* clearest, double seen, const LintOptions& options) {
  if (clearest == nullptr) return {"these trials never bring it about"};
  if (clearest->seen <= 0.0 && clearest->imitated <= 0.0) return {"these trials never bring it about", true};
  if (clearest->imitated > options.masked) return {"a change of the baseline's own parameters imitates it (masked to " + std::to_string(static_cast<int>(std::floor(1000 * clearest->imitated)) / 10) + " %)", true};
  if (seen < options.testable) return {"even a strong effect would change these records by less than their noise", true};
  return {};
}

/// Of each effect the start that these inputs show most clearly, in noise of a stated share of full scale; `clearer`: how much clearer where less is stated.
std::map<Effect, Score> clearest_scores(const RigModel& model, const std::vector<Form>& forms, const LintOptions& options, double& clearer) {
  const Dataset& d = model.data();
  Noise noise;
  clearer = 1.0;
  for (const std::string& name : d.outputs) {
    const double fs = model.full_scale(name);
    noise.output.push_back({options.noise * fs, 0.0, fs, ""});
    if (const double stated = d.channel(name).noise; stated > 0.0) clearer = std::max(clearer, std::pow(options.noise * fs / stated, 2));
  }
  Fitter fitter(model, noise);
  Fit base;
  base.base = model.guess();
  base.log_scale.assign(d.trials.size(), 0.0);
  base.log_gain.assign(d.trials.size(), 0.0);
  base.instrument.assign(d.outputs.size(), 1.0);
  const ScoreTests tests(fitter, base);
  std::map<Effect, Score> best;
  for (const Form& f : forms)
    for (const auto& start : f.starts) {
      const Score s = tests.score(f, start);
      if (auto at = best.find(f.effect); at == best.end() || s.seen > at->second.seen) best[f.effect] = s;
    }
  return best;
}

}  // namespace

LintSummary lint(const RigModel& model, const std::vector<Form>& forms, const LintOptions& options) {
  const Dataset& d = model.data();
  double clearer = 1.0;
  const auto best = clearest_scores(model, forms, options, clearer);
  std::set<Effect> lines;
  for (const Form& f : forms)
    if (f.line) lines.insert(f.effect);
  LintSummary out{{}, check_hardware(d)};
  for (const Effect e : effects_of(d.rig)) {
    Reason reason{missing_condition(d, e)};
    const bool line = lines.count(e) > 0 || e == Effect::physiological_tremor;
    if (line || e == Effect::sensor_lag || e == Effect::sensor_drift)
      if (reason.why.empty()) reason = clock_condition(d, e, options);
    if (reason.why.empty() && !line) {
      const auto at = best.find(e);
      const Score* clearest = at == best.end() ? nullptr : &at->second;
      reason = signature_condition(clearest, clearest == nullptr ? 0.0 : clearest->seen * clearer, options);
    }
    if (!reason.why.empty()) out.not_testable.push_back({e, reason.why, info(e).shows, reason.hidden});
  }
  return out;
}

std::vector<Form> nameable(std::vector<Form> forms, const LintSummary& lint) {
  std::erase_if(forms, [&](const Form& f) {
    return std::any_of(lint.not_testable.begin(), lint.not_testable.end(), [&](const NotTestable& n) { return n.effect == f.effect && n.hidden; });
  });
  return forms;
}

}  // namespace filum::reconcile
