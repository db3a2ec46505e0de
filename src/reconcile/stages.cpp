#include "reconcile/stages.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "reconcile/report.h"

namespace filum::reconcile {
namespace {

using Values = nlohmann::ordered_json;

std::string text(const char* format, auto... values) {
  char out[400];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

Values whole(double v) { return std::isfinite(v) ? Values(v) : Values(nullptr); }

Stage lint_stage(const Dataset& d, const Result& r) {
  const std::size_t hidden = static_cast<std::size_t>(std::count_if(r.lint.not_testable.begin(), r.lint.not_testable.end(), [](const NotTestable& n) { return n.hidden; }));
  const LintOptions& o = r.rules.lint;
  const Values options = d.rig == Rig::tip_hold ? Values{{"tremor_sampling", kHoldRules.lint.tremor_sampling}, {"pulsation_span", kHoldRules.lint.pulsation_span}}
                                                : Values{{"masked", o.masked}, {"testable", o.testable}, {"noise", o.noise}};
  return {"lint", options, {{"not_testable", r.lint.not_testable.size()}, {"hidden", hidden}, {"hardware_remarks", r.lint.hardware.size()}},
          text("%zu effects cannot show in these trials; %zu remarks on the hardware", r.lint.not_testable.size(), r.lint.hardware.size() + r.decide.units.size())};
}

/// Of each output its standard deviation over full scale and where it is from.
Values noise_values(const Dataset& d, const Noise& noise, std::string& sentence) {
  Values out = Values::object();
  for (std::size_t c = 0; c < noise.output.size() && c < d.outputs.size(); ++c) {
    const OutputNoise& o = noise.output[c];
    const double share = o.sigma / std::max(o.full_scale, 1e-300);
    out[d.outputs[c]] = whole(share);
    sentence += text("%s%s %.2g %% of full scale, from %s", c == 0 ? "" : "; ", d.outputs[c].c_str(), 100.0 * share, o.from.c_str());
  }
  return out;
}

Stage noise_stage(const Dataset& d, const Result& r) {
  Stage out{"noise", {{"first", r.rules.noise.first}, {"first_scatter", r.rules.noise.first_scatter}}, Values::object(), ""};
  std::string at_first;
  out.found["first"] = noise_values(d, r.noise.noise, at_first);
  out.found["last"] = noise_values(d, r.fit.noise, out.summary);
  return out;
}

Stage baseline_stage(const Dataset& d, const Result& r) {
  const BaselineSummary& b = r.baseline;
  if (d.rig == Rig::tip_hold) return {"baseline", Values::object(), {{"gap", whole(r.decide.gap.before)}}, text("a slow polynomial in each record; gap %.3g", r.decide.gap.before)};
  const BaselineOptions& o = r.rules.baseline;
  return {"baseline", {{"factor", o.factor}, {"same", o.same}, {"share", o.share}, {"blade_scatter", o.blade_scatter}},
          {{"starts", b.starts.size()}, {"same", b.same()}, {"chi2", whole(b.fit.chi2)}, {"samples", b.fit.samples}, {"gap", whole(r.decide.gap.before)}},
          b.starts.empty() ? text("nothing is free; gap %.3g", r.decide.gap.before) : text("%d of %zu starts ended at the same optimum; gap %.3g", b.same(), b.starts.size(), r.decide.gap.before)};
}

Values screen_options(const Dataset& d, const Result& r) {
  const HoldScreenOptions& h = kHoldRules.screen;
  if (d.rig == Rig::tip_hold)
    return {{"line_spread", h.line_spread}, {"line_gain", h.line_gain}, {"line_share", h.line_share}, {"tremor_gain", h.tremor_gain}, {"tremor_power", h.tremor_power}, {"tremor_top", h.tremor_top},
            {"tremor_low", h.tremor_low}, {"tremor_high", h.tremor_high}, {"clipped_least", h.clipped_least}, {"clipped_share", h.clipped_share}, {"clipped_times", h.clipped_times}};
  const ScreenOptions& o = r.rules.screen;
  return {{"share", o.share}, {"least", o.least}, {"most", o.most}, {"forms", o.forms}};
}

Stage screen_stage(const Dataset& d, const Result& r) {
  const auto& all = r.screen.effects;
  const auto fitted = std::count_if(all.begin(), all.end(), [](const Screened& s) { return s.what == "fitted"; });
  const auto instruments = std::count_if(all.begin(), all.end(), [](const Screened& s) { return s.what == "fitted" && info(s.effect).stage == 0; });
  return {"screen", screen_options(d, r), {{"tested", all.size()}, {"starts", r.screen.chosen.size()}, {"fitted", fitted}, {"instruments", instruments}},
          text("%zu effects of this rig tested, %d fitted, %d of them instruments", all.size(), static_cast<int>(fitted), static_cast<int>(instruments))};
}

Values compare_options(const CompareOptions& o) {
  return {{"materiality", o.materiality}, {"accept_evidence", o.accept_evidence}, {"accept_p", o.accept_p}, {"explained", o.explained}, {"pair_evidence", o.pair_evidence}, {"pair_share", o.pair_share}, {"most_effects", o.most_effects}};
}

Stage fit_stage(const Dataset& d, const Result& r) {
  const FitOptions& o = r.rules.fit;
  Values options = Values::object();
  if (d.rig != Rig::tip_hold) {
    options = {{"look_further", o.look_further}, {"kept_most", o.kept_most}, {"pair_parents", o.pair_parents}, {"pair_effects", o.pair_effects}, {"triple_parents", o.triple_parents}, {"triple_effects", o.triple_effects}};
    options.update(compare_options(r.rules.compare));
  }
  return {"fit", options, {{"fits", r.fit.fits}, {"sets", r.fit.sets}, {"most_effects", r.fit.most}, {"overdispersion", whole(r.fit.dispersion)}},
          r.fit.sets == 0 ? "no set of effects was worth a fit" : text("%zu sets compared, of %zu effects at most; overdispersion %.3g", r.fit.sets, r.fit.most, r.fit.dispersion)};
}

Stage detect_stage(const Dataset& d, const Result& r) {
  const DetectSummary& s = *r.detect;
  return {"detect", d.rig == Rig::tip_hold ? Values{{"repetitions", kHoldRules.detect.repetitions}} : Values{{"p", r.rules.detect.p}, {"repetitions", r.rules.detect.repetitions}},
          {{"p", s.p}, {"chance", s.chance}, {"statistic", whole(s.statistic)}, {"score", whole(s.score)}, {"excess", whole(s.excess)}, {"trial", s.trial}, {"from", whole(s.from)}, {"to", whole(s.to)}},
          text("p = %.2g in %d repetitions; beyond the noise %.2g %% of full scale", s.p, s.repetitions, 100.0 * s.excess)};
}

Stage localise_stage(const Result& r) {
  const LocaliseOptions& o = r.rules.localise;
  Stage out{"localise", {{"parts", o.parts}, {"most_cells", o.most_cells}}, {{"cells", r.localise.cells.size()}, {"bins", r.localise.by.size()}}, "not asked for: nothing is missing"};
  if (r.localise.cells.empty()) return out;
  const Cell& c = r.localise.cells[0];
  out.found.update({{"trial", c.trial}, {"phase", c.phase}, {"range", c.range}, {"share", whole(c.share)}});
  out.summary = text("most of it, %.0f %%, in %s, %s", 100.0 * c.share, c.trial.c_str(), c.phase.c_str());
  return out;
}

Stage challenge_stage(const Dataset& d, const Result& r) {
  const ChallengeOptions& o = r.rules.challenge;
  const ChallengeSummary& c = r.challenge;
  const auto counts = std::count_if(c.folds.begin(), c.folds.end(), [](const Fold& f) { return f.counts; });
  Stage out{"challenge", d.rig == Rig::tip_hold ? Values{{"samples", kHoldRules.challenge.samples}} : Values{{"judged", o.judged}, {"folds", o.folds}, {"rate_apart", o.rate_apart}, {"unlearnt", o.unlearnt}},
            {{"how", c.how}, {"folds", c.folds.size()}, {"count", counts}, {"judged", c.done}, {"explained", whole(c.explained)}, {"before", whole(c.gap.before)}, {"after", whole(c.gap.after)}}, c.how};
  if (!c.folds.empty()) out.summary = text("%zu folds, %d of them count (%s): gap %.3g before, %.3g after", c.folds.size(), static_cast<int>(counts), c.how.c_str(), c.gap.before, c.gap.after);
  return out;
}

Stage confirm_stage(const Result& r) {
  const ConfirmSummary& c = *r.confirm;
  return {"full re-simulation", {{"rounds", r.rules.confirm.rounds}, {"rest", r.rules.confirm.rest}},
          {{"solver", c.solver}, {"ran", c.ran}, {"holds", c.holds}, {"difference", whole(c.difference)}, {"mesh", whole(c.mesh)}, {"share", whole(c.share)}},
          c.solver + (c.ran ? c.holds ? ": holds" : ": does not hold" : ": did not come to rest")};
}

Stage decide_stage(const Dataset& d, const Result& r) {
  const DecideOptions& o = r.rules.decide;
  const HoldDecideOptions& h = kHoldRules.decide;
  const Values options = d.rig == Rig::tip_hold ? Values{{"materiality", r.rules.compare.materiality}, {"left_gain", h.left_gain}, {"left_power", h.left_power}, {"named_share", h.named_share}}
                                                : Values{{"structure", o.structure}, {"held_out", o.held_out}, {"tie", o.tie}, {"aside_tie", o.aside_tie}, {"untestable_tie", o.untestable_tie},
                                                         {"partial_structure", o.partial_structure}, {"partial_share", o.partial_share}, {"gain_most", o.gain_most}, {"refit", o.refit}};
  Values named = Values::array();
  for (const NamedEffect& e : r.decide.effects) named.push_back(info(e.effect).name);
  return {"decide", options, {{"verdict", r.decide.verdict}, {"partial", r.decide.partial}, {"effects", named}, {"not_told_apart", r.decide.alike_sets.size()}, {"gap_after", whole(r.decide.gap.after)}}, r.decide.verdict + (r.decide.partial ? ", partial" : "")};
}

Stage describe_stage(const Result& r) {
  const DescribeOptions& o = r.rules.describe;
  Values terms = Values::array();
  for (const Term& t : r.describe.shape) terms.push_back(t.name);
  return {"describe", {{"resamplings", o.resamplings}, {"chosen", o.chosen}, {"terms", o.terms}}, {{"terms", terms}},
          r.describe.shape.empty() ? "not asked for: nothing is left unexplained" : text("%zu terms; the most stable: %s", r.describe.shape.size(), r.describe.shape[0].name.c_str())};
}

Stage next_stage(const Result& r) {
  const NextOptions& o = r.rules.next;
  Stage out{"next experiment", {{"records", o.records}, {"likely", o.likely}, {"tie", r.rules.decide.tie}}, Values::object(), "none needed, or none would part what is left"};
  if (r.next) out.found = {{"protocol", r.next->protocol}, {"chance", r.next->chance}}, out.summary = r.next->protocol;
  return out;
}

}  // namespace

std::vector<Stage> stages_of(const Dataset& d, const Result& r) {
  std::vector<Stage> out = {lint_stage(d, r), noise_stage(d, r), baseline_stage(d, r), screen_stage(d, r), fit_stage(d, r)};
  if (r.detect) out.push_back(detect_stage(d, r));
  out.push_back(challenge_stage(d, r));
  if (r.confirm) out.push_back(confirm_stage(r));
  for (Stage& s : std::vector<Stage>{decide_stage(d, r), localise_stage(r), describe_stage(r), next_stage(r)}) out.push_back(std::move(s));
  std::string files;
  for (const std::string& f : files_of(r)) files += (files.empty() ? "" : ", ") + f;
  out.push_back({"write", Values::object(), {{"files", files_of(r)}}, files});
  return out;
}

}  // namespace filum::reconcile
