#include "reconcile/fit_sets.h"

#include <algorithm>

namespace filum::reconcile {
namespace {

/// `from` with one more effect, at each of these starts.
std::vector<Fit> extended(const Candidates& sets, const Fit& from, const std::vector<Score>& starts, const Run& run, const Stretch& stretch) {
  const Fitter& fitter = sets.fitter();
  std::vector<Fit> fits(starts.size());
  Steps steps(run, stretch, starts.size());
  parallel(run.threads, starts.size(), [&](std::size_t i) {
    stop_if_cancelled(run);
    auto forms = from.forms;
    auto params = from.params;
    forms.push_back(starts[i].form);
    params.push_back(starts[i].start);
    const Effort effort{from.forms.empty() ? 25 : 18, 1e-4};
    fits[i] = fitter.fit(forms, from.base, params, effort, &from);
    // a record that is clipped throughout may have been given a scale of its own for it, from which no slope leads back
    if (starts[i].form->effect == Effect::saturation)
      if (Fit anew = fitter.fit(forms, from.base, params, effort); anew.chi2 < fits[i].chi2) fits[i] = std::move(anew);
    steps.done();
  });
  return fits;
}

bool worth_more(const Candidates& sets, const Fit& f, const FitOptions& options) {
  if (sets.structure(f).z > options.look_further) return true;
  const auto scores = ScoreTests(sets.fitter(), f).all(sets.forms());
  if (!scores.empty() && scores[0].gain / sets.dispersion() > sets.rules().pair_evidence) return true;
  return !sets.lines(f).empty();
}

/// The best sets of a size, to which one more effect is added.
std::vector<Fit> parents_of(const Candidates& sets, std::size_t size, int most) {
  std::vector<Fit> out;
  for (const Fit& f : sets.fitted())
    if (f.forms.size() == size && out.size() < static_cast<std::size_t>(most)) out.push_back(f);
  return out;
}

/// Sets of `size` effects from those of one less.
void enlarge(Candidates& sets, std::size_t size, const FitOptions& options, ScreenOptions further, const Run& run, FitSummary& summary) {
  const bool pairs = size == 2;
  const char* stage = pairs ? "pairs" : "three effects";
  double at = 0.35 + 0.25 * static_cast<double>(size - 2);
  say(run, stage, at);
  further.most = pairs ? options.pair_effects : options.triple_effects;
  further.forms = options.further_forms;
  const std::vector<Fit> parents = parents_of(sets, size - 1, pairs ? options.pair_parents : options.triple_parents);
  const double each = 0.2 / static_cast<double>(parents.size());
  for (const Fit& p : parents) {
    std::vector<Fit> fits = extended(sets, p, promising(sets, p, further), run, {stage, at, at + each});
    summary.fits += static_cast<int>(fits.size());
    sets.keep(std::move(fits));
    at += each;
  }
  sets.refresh(options.kept_most, run, {stage, at, at + 0.05});
}

}  // namespace

FitSummary fit_sets(Candidates& sets, const ScreenSummary& screened, const FitOptions& options, const ScreenOptions& further, const Run& run) {
  const CompareOptions& rules = sets.rules();
  FitSummary out;
  out.fits = static_cast<int>(screened.chosen.size());
  sets.keep(extended(sets, sets.base(), screened.chosen, run, {"one effect", 0.15, 0.3}));
  sets.refresh(options.kept_most, run, {"one effect", 0.3, 0.35});
  for (std::size_t size = 1; size < static_cast<std::size_t>(rules.most_effects); ++size) {
    const Fit* top = sets.best(size);
    if (top == nullptr || !worth_more(sets, *top, options) || sets.bic(*top) > sets.bic(sets.base()) - rules.accept_evidence) break;
    enlarge(sets, size + 1, options, further, run, out);
    const Fit* next = sets.best(size + 1);
    top = sets.best(size);
    if (next == nullptr || top == nullptr || sets.bic(*next) > sets.bic(*top) - rules.pair_evidence) break;
  }
  out.sets = sets.fitted().size();
  for (const Fit& f : sets.fitted()) out.most = std::max(out.most, f.forms.size());
  out.noise = sets.fitter().noise();
  out.dispersion = sets.dispersion();
  return out;
}

std::vector<Fit> other_forms(const Candidates& sets, const Fit& winner, double tie, const Run& run) {
  std::vector<std::pair<std::size_t, const Form*>> swaps;
  for (std::size_t k = 0; k < winner.forms.size(); ++k)
    for (const Form& f : sets.forms())
      if (f.effect == winner.forms[k]->effect && f.kind != winner.forms[k]->kind && !f.line && !f.params.empty() && f.params[0].name == winner.forms[k]->params[0].name) swaps.emplace_back(k, &f);
  std::vector<Fit> fits(swaps.size());
  parallel(run.threads, swaps.size(), [&](std::size_t i) {
    stop_if_cancelled(run);
    const auto& [k, form] = swaps[i];
    auto forms = winner.forms;
    auto params = winner.params;
    params[k] = form->starts[0];
    for (std::size_t a = 0; a < form->params.size(); ++a)
      for (std::size_t b = 0; b < forms[k]->params.size(); ++b)
        if (form->params[a].name == forms[k]->params[b].name) params[k][a] = std::clamp(winner.params[k][b], form->params[a].low, form->params[a].high);
    forms[k] = form;
    fits[i] = sets.fitter().fit(forms, winner.base, params, {15, 1e-4}, &winner);
  });
  std::erase_if(fits, [&](const Fit& f) { return sets.bic(f) - sets.bic(winner) > tie; });
  return fits;
}

}  // namespace filum::reconcile
