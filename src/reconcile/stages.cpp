// One sentence a stage of the pipeline, in the order in which they run, so that a reader sees what each went by and what it left to the next.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "reconcile/hardware.h"
#include "reconcile/report.h"

namespace filum::reconcile {
namespace {

std::string text(const char* format, auto... values) {
  char out[300];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

std::string noise_summary(const Dataset& d, const Result& r) {
  std::string out;
  for (std::size_t c = 0; c < r.noise.output.size() && c < d.outputs.size(); ++c) {
    const OutputNoise& o = r.noise.output[c];
    out += text("%s%s %.2g %% of full scale, from %s", c == 0 ? "" : "; ", d.outputs[c].c_str(), 100.0 * o.sigma / std::max(o.full_scale, 1e-300), o.from.c_str());
  }
  return out;
}

std::string where_summary(const Result& r) {
  if (r.where.empty()) return "not asked for: nothing is missing";
  return text("most of it, %.0f %%, in %s, %s", 100.0 * r.where[0].share, r.where[0].trial.c_str(), r.where[0].phase.c_str());
}

std::string screen_summary(const Result& r) {
  const auto fitted = std::count_if(r.screened.begin(), r.screened.end(), [](const Screened& s) { return s.what == "fitted"; });
  const auto instruments = std::count_if(r.screened.begin(), r.screened.end(), [](const Screened& s) { return s.what == "fitted" && info(s.effect).stage == 0; });
  return text("%zu effects of this rig tested, %d fitted, %d of them instruments", r.screened.size(), static_cast<int>(fitted), static_cast<int>(instruments));
}

std::string fit_summary(const Result& r) {
  std::size_t most = 0;
  for (const Tried& t : r.tried) most = std::max(most, t.effects.size());
  return r.tried.empty() ? "no set of effects was worth a fit" : text("%zu sets compared, of %zu effects at most; overdispersion %.3g", r.tried.size(), most, r.dispersion);
}

std::string challenge_summary(const Result& r) {
  const auto counts = std::count_if(r.folds.begin(), r.folds.end(), [](const Fold& f) { return f.counts; });
  const std::string gap = text("gap %.3g before, %.3g after", r.held_out.before, r.held_out.after);
  return r.folds.empty() ? r.held_out_how : text("%zu folds, %d of them count (%s): ", r.folds.size(), static_cast<int>(counts), r.held_out_how.c_str()) + gap;
}

}  // namespace

std::vector<StageText> stages_of(const Dataset& d, const Result& r) {
  std::vector<StageText> out = {{"lint", text("%zu effects cannot show in these trials; %zu remarks on the hardware", r.not_testable.size(), check_hardware(d).size() + check_units(d, r.baseline).size())},
                                {"noise", noise_summary(d, r)}};
  if (!r.starts.starts.empty()) out.push_back({"baseline", text("%d of %zu starts ended at the same optimum; gap %.3g", r.starts.same(), r.starts.starts.size(), r.fit.before)});
  if (r.detection) out.push_back({"detect", text("p = %.2g in %d repetitions; beyond the noise %.2g %% of full scale", r.detection->p, r.detection->repetitions, 100.0 * r.detection->excess)});
  out.push_back({"localise", where_summary(r)});
  if (!r.screened.empty()) out.push_back({"screen", screen_summary(r)}), out.push_back({"fit", fit_summary(r)});
  out.push_back({"challenge", challenge_summary(r)});
  if (r.confirmation) out.push_back({"full re-simulation", r.confirmation->solver + (r.confirmation->ran ? r.confirmation->holds ? ": holds" : ": does not hold" : ": did not come to rest")});
  out.push_back({"decide", r.verdict + (r.partial ? ", partial" : "")});
  out.push_back({"next experiment", r.next ? r.next->protocol : "none needed, or none would part what is left"});
  return out;
}

}  // namespace filum::reconcile
