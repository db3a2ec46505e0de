#include "reconcile/baseline.h"

#include <algorithm>
#include <set>

namespace filum::reconcile {
namespace {

/// Far from the optimum the records' own scales would take up what all have in common (a ravine from which steps lead back slowly): as good as one at first.
constexpr double kHeldScatter = 1e-4;

}  // namespace

int BaselineSummary::same() const {
  return static_cast<int>(std::count_if(starts.begin(), starts.end(), [](const BaselineStart& s) { return s.same; }));
}

std::vector<std::vector<double>> baseline_starts(const Fitter& fitter, const std::vector<double>& guess, const BaselineOptions& options) {
  std::vector<std::vector<double>> out{guess};
  if (fitter.free_baseline().empty()) return out;
  for (const bool up : {false, true}) {
    std::vector<double> x = guess;
    for (const int i : fitter.free_baseline()) {
      const ParameterInfo& p = fitter.model().baseline()[static_cast<std::size_t>(i)];
      const bool ratio = !p.logarithmic && p.high - p.low <= 1.0;
      double& v = x[static_cast<std::size_t>(i)];
      if (ratio) v = p.low + (up ? 0.75 : 0.25) * (p.high - p.low);
      else v *= up ? options.factor : 1.0 / options.factor;
      v = std::clamp(v, fitter.low(i), fitter.high(i));
    }
    out.push_back(std::move(x));
  }
  return out;
}

Fit best_start(const Fitter& fitter, const std::vector<double>& guess, const Fit* warm, int threads, const BaselineOptions& options, BaselineSummary& summary) {
  const auto starts = baseline_starts(fitter, guess, options);
  std::vector<Fit> fits(starts.size());
  Fitter alike(fitter);
  Noise noise = fitter.noise();
  noise.scatter = noise.gain_scatter = kHeldScatter;
  alike.set_noise(std::move(noise));
  parallel(threads, starts.size(), [&](std::size_t i) {
    const Fit first = i == 0 && warm != nullptr ? *warm : alike.fit({}, starts[i], {});
    fits[i] = fitter.fit({}, first.base, {}, {}, &first);
  });
  const auto best = std::min_element(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.chi2 < b.chi2; });
  summary.starts.clear();
  for (std::size_t i = 0; i < fits.size() && !fitter.free_baseline().empty(); ++i)
    summary.starts.push_back({starts[i], fits[i].base, fits[i].chi2, fits[i].chi2 - best->chi2 <= std::max(options.same, options.share * best->chi2)});
  return *best;
}

BaselineSummary fit_baseline(Fitter& fitter, const NoiseSummary& measured, const BaselineOptions& options, const Run& run) {
  const Dataset& d = fitter.model().data();
  BaselineSummary out;
  const Fit loose = best_start(fitter, fitter.model().guess(), &measured.loose, run.threads, options, out);
  Noise noise = estimate_noise(fitter, loose);
  noise.scatter = d.rig == Rig::forceps_bridge ? assumed::kScatterLow : replicate_scatter(d, loose);
  // the geometric factor of a blade is an estimate: where two blades are compared it is free within reason
  std::set<double> blades;
  for (const Trial& t : d.trials) blades.insert(t.size("blade_width") * t.size("blade_length"));
  if (blades.size() > 1) noise.scatter = std::max(noise.scatter, options.blade_scatter);
  fitter.set_noise(std::move(noise));
  out.fit = fitter.fit({}, loose.base, {}, {}, &loose);
  return out;
}

}  // namespace filum::reconcile
