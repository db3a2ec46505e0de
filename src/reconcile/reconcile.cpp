#include <chrono>

#include "reconcile/choose.h"
#include "reconcile/result.h"

namespace filum::reconcile {
namespace {

/// The sets that the data do not tell apart, by what could: nullopt where one is named alone, or none.
std::optional<NextSummary> next_of(const Candidates& sets, const Grounds& grounds, const DecideSummary& decided, const Rules& rules) {
  if (decided.alike_sets.empty()) return std::nullopt;
  std::vector<const Fit*> all = grounds.rivals;
  all.insert(all.begin(), grounds.winner);
  std::vector<double> evidence;
  for (const Fit* f : all) evidence.push_back(sets.bic(*f));
  return next_experiment(sets.fitter(), all, evidence, sets.dispersion(), rules.decide.tie, rules.next);
}

DescribeSummary describe_all(const Candidates& sets, const DecideSummary& decided, const DescribeOptions& options) {
  const auto of = [&](const Fit& f) { return describe(sets.fitter().model(), f, sets.fitter().noise(), options); };
  DescribeSummary out{of(sets.base()), {}};
  if (decided.verdict == "unknown") out.shape = out.baseline;
  else if (decided.partial) out.shape = of(decided.after);
  return out;
}

Result reconcile_moved(const Dataset& d, const RigModel& model, const Options& run) {
  const Rules& rules = run.rules;
  Result r;
  r.rules = rules;
  say(run, "lint", 0.0);
  r.lint = lint(model, model.all_forms(), rules.lint);
  r.forms = nameable(model.all_forms(), r.lint);
  say(run, "baseline", 0.05);
  Fitter fitter(model, {});
  r.noise = measure_noise(fitter, rules.noise);
  r.baseline = fit_baseline(fitter, r.noise, rules.baseline, run);
  say(run, "one effect", 0.15);
  Candidates sets(std::move(fitter), r.baseline.fit, r.forms, rules.compare, rules.line);
  r.screen = screen(sets, rules.screen);
  r.fit = fit_sets(sets, r.screen, rules.fit, rules.screen, run);
  r.screen.effects = screened(sets, rules.screen, rules.detect.p);
  r.baseline.alone = baseline_estimates(sets.fitter(), sets.base(), std::max(1.0, sets.structure(sets.base()).dispersion));
  say(run, "challenge", 0.85);
  r.detect = detect(sets, rules.detect);
  const Fit* winner = choose(sets, rules.detect.p, *r.detect);
  r.challenge = challenge(sets, winner, rules.challenge, run);
  const auto rivals = all_rivals(sets, winner, r.lint, r.challenge, rules, run);
  r.confirm = confirm(sets, winner, rules.confirm, run);
  const Grounds grounds{winner, rivals, r.challenge, r.confirm};
  r.decide = decide(sets, grounds, rules, run);
  if (r.decide.missing()) r.localise = localise(model, sets.base(), r.fit.noise, rules.localise);
  r.describe = describe_all(sets, r.decide, rules.describe);
  r.next = next_of(sets, grounds, r.decide, rules);
  if (r.next) r.decide.sentence += what_would(*r.next, rules.next);
  if (r.decide.verdict == "unknown") r.decide.sentence += what_it_is_like(r.localise, r.describe.shape, d.outputs.size() > 1, rules);
  return r;
}

}  // namespace

Result reconcile(const Dataset& d, const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto model = make_model(d);
  Result r = d.rig == Rig::tip_hold ? reconcile_hold(d, *model, options) : reconcile_moved(d, *model, options);
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return r;
}

}  // namespace filum::reconcile
