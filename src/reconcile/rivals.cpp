#include "reconcile/rivals.h"

#include <algorithm>

#include "reconcile/choose.h"

namespace filum::reconcile {
namespace {

bool instrument(const Form* f) { return info(f->effect).stage == 0; }

/// The instruments and what the winner has beside them, fitted together.
Fit together(const Candidates& sets, const Fit& instruments, const Fit& winner) {
  auto forms = instruments.forms;
  auto params = instruments.params;
  const auto mine = effects_in(instruments);
  for (std::size_t k = 0; k < winner.forms.size(); ++k) {
    if (std::find(mine.begin(), mine.end(), winner.forms[k]->effect) != mine.end()) continue;
    forms.push_back(winner.forms[k]);
    params.push_back(winner.params[k]);
  }
  return sets.fitter().fit(forms, winner.base, params, {18, 1e-4}, &winner);
}

/// Held-out misfit of both over the folds that count for both: whether the first is left with less.
bool predicts_better(const ChallengeSummary& a, const ChallengeSummary& b) {
  double first = 0.0, second = 0.0;
  bool any = false;
  for (std::size_t i = 0; i < a.folds.size() && i < b.folds.size(); ++i)
    if (a.folds[i].counts && b.folds[i].counts) first += a.folds[i].after, second += b.folds[i].after, any = true;
  return any && first < second;
}

}  // namespace

std::vector<const Fit*> rivals_of(const Candidates& sets, const Fit& winner, const DecideOptions& options, const std::vector<NotTestable>& hidden) {
  std::vector<const Fit*> out;
  const bool unsure = std::any_of(winner.forms.begin(), winner.forms.end(), [&](const Form* f) {
    return f->one_size || std::any_of(hidden.begin(), hidden.end(), [&](const NotTestable& n) { return n.effect == f->effect; });
  });
  const double tie = unsure ? options.untestable_tie : options.tie;
  for (const Fit& f : sets.fitted()) {
    if (&f == &winner || f.forms.size() > winner.forms.size()) continue;
    // a rival whose deciding protocol was not run is listed as not testable: it must come nearer to be a rival
    const bool aside = !unsure && std::any_of(f.forms.begin(), f.forms.end(), [&](const Form* g) {
      return std::any_of(hidden.begin(), hidden.end(), [&](const NotTestable& n) { return n.effect == g->effect; });
    });
    if (sets.bic(f) - sets.bic(winner) < (aside ? options.aside_tie : tie) && sets.explained(f) >= sets.rules().explained) out.push_back(&f);
  }
  return out;
}

std::set<Effect> common(const Fit& winner, const std::vector<const Fit*>& rivals) {
  const auto first = effects_in(winner);
  std::set<Effect> shared(first.begin(), first.end());
  for (const Fit* f : rivals) {
    const auto mine = effects_in(*f);
    std::erase_if(shared, [&](Effect e) { return std::find(mine.begin(), mine.end(), e) == mine.end(); });
  }
  return shared;
}

std::vector<const Fit*> instruments_not_outdone(const Candidates& sets, const Fit& winner, const ChallengeSummary& challenged, const ChallengeOptions& options, const Run& run) {
  std::vector<const Fit*> out;
  if (std::all_of(winner.forms.begin(), winner.forms.end(), instrument)) return out;
  for (const Fit& f : sets.fitted()) {
    if (f.forms.size() > winner.forms.size() || !std::all_of(f.forms.begin(), f.forms.end(), instrument) || sets.explained(f) < sets.rules().explained) continue;
    if (earns_its_place(sets, f, together(sets, f, winner))) continue;
    if (predicts_better(challenged, challenge(sets, &f, options, run))) continue;
    out.push_back(&f);
  }
  return out;
}

std::vector<const Fit*> all_rivals(const Candidates& sets, const Fit* winner, const LintSummary& lint, const ChallengeSummary& challenged, const Rules& rules, const Run& run) {
  if (winner == nullptr) return {};
  auto rivals = rivals_of(sets, *winner, rules.decide, lint.not_testable);
  for (const Fit* f : instruments_not_outdone(sets, *winner, challenged, rules.challenge, run))
    if (std::find(rivals.begin(), rivals.end(), f) == rivals.end()) rivals.push_back(f);
  return rivals;
}

}  // namespace filum::reconcile
