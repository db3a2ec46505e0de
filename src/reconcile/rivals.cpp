#include "reconcile/rivals.h"

#include <algorithm>

#include "reconcile/choose.h"

namespace filum::reconcile {
namespace {

bool instrument(const Form* f) { return info(f->effect).stage == 0; }

/// The instruments and what the winner has beside them, fitted together.
Fit together(const Search& search, const Fit& instruments, const Fit& winner) {
  auto forms = instruments.forms;
  auto params = instruments.params;
  const auto mine = effects_in(instruments);
  for (std::size_t k = 0; k < winner.forms.size(); ++k) {
    if (std::find(mine.begin(), mine.end(), winner.forms[k]->effect) != mine.end()) continue;
    forms.push_back(winner.forms[k]);
    params.push_back(winner.params[k]);
  }
  return search.fitter().fit(forms, winner.base, params, {18, 1e-4}, &winner);
}

/// Held-out misfit of both over the folds that count for both: whether the first is left with less.
bool predicts_better(const Challenge& a, const Challenge& b) {
  double first = 0.0, second = 0.0;
  bool any = false;
  for (std::size_t i = 0; i < a.folds.size() && i < b.folds.size(); ++i)
    if (a.folds[i].counts && b.folds[i].counts) first += a.folds[i].after, second += b.folds[i].after, any = true;
  return any && first < second;
}

}  // namespace

std::vector<const Fit*> rivals_of(const Search& search, const Fit& winner, const Rules& rules, const std::vector<NotTestable>& hidden) {
  std::vector<const Fit*> out;
  const bool unsure = std::any_of(winner.forms.begin(), winner.forms.end(), [&](const Form* f) {
    return f->one_size || std::any_of(hidden.begin(), hidden.end(), [&](const NotTestable& n) { return n.effect == f->effect; });
  });
  const double tie = unsure ? rules.untestable_tie : rules.tie;
  for (const Fit& f : search.candidates()) {
    if (&f == &winner || f.forms.size() > winner.forms.size()) continue;
    // a rival whose deciding protocol was not run is listed as not testable: it must come nearer to be a rival
    const bool aside = !unsure && std::any_of(f.forms.begin(), f.forms.end(), [&](const Form* g) {
      return std::any_of(hidden.begin(), hidden.end(), [&](const NotTestable& n) { return n.effect == g->effect; });
    });
    if (search.bic(f) - search.bic(winner) < (aside ? rules.aside_tie : tie) && search.explained(f) >= rules.explained) out.push_back(&f);
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

std::vector<const Fit*> instruments_not_outdone(const Search& search, const Fit& winner, const Challenge& challenged, const Options& options) {
  std::vector<const Fit*> out;
  if (std::all_of(winner.forms.begin(), winner.forms.end(), instrument)) return out;
  for (const Fit& f : search.candidates()) {
    if (f.forms.size() > winner.forms.size() || !std::all_of(f.forms.begin(), f.forms.end(), instrument) || search.explained(f) < options.rules.explained) continue;
    if (earns_its_place(search, f, together(search, f, winner), options.rules)) continue;
    if (predicts_better(challenged, challenge(search, search.base(), f, options))) continue;
    out.push_back(&f);
  }
  return out;
}

}  // namespace filum::reconcile
