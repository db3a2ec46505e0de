#include "reconcile/screen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace filum::reconcile {
namespace {

std::string share_text(const char* format, double value) {
  char out[120];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

bool was_fitted(const Candidates& sets, Effect effect) {
  return std::any_of(sets.fitted().begin(), sets.fitted().end(),
                     [&](const Fit& f) { return std::any_of(f.forms.begin(), f.forms.end(), [&](const Form* g) { return g->effect == effect; }); });
}

/// Why a form was not fitted; `score`: its best, may be absent; `top`: the best promise of all.
std::string why_not(const Candidates& sets, const Form& form, const Score* score, double top, const ScreenOptions& options, double p_most) {
  if (form.line) {
    const double p = sets.line_chance(form, sets.base());
    return p > p_most ? share_text("not fitted: a line as strong comes by chance in %.2g of the cases", p) : "not fitted: it stands out, but others promise far more";
  }
  if (score == nullptr || score->gain < options.least) return share_text("not fitted: promises less than %.3g", options.least);
  if (score->gain < options.share * top) return share_text("not fitted: less than %.2g of the best promise", options.share);
  return "not fitted: promised too little before the noise was known";
}

/// Starts of one effect's form that are tried: more where several values matter, or two places are looked at (50 and 60 Hz may fold to the same line).
int starts_of(const Form& f) { return f.params.size() > 1 || f.effect == Effect::saturation || f.effect == Effect::mains_hum ? 2 : 1; }

}  // namespace

std::vector<Score> promising(const Candidates& sets, const Fit& from, const ScreenOptions& options) {
  std::vector<Score> scores = ScoreTests(sets.fitter(), from).all(sets.forms());
  for (Score& s : sets.lines(from)) scores.push_back(std::move(s));
  std::stable_sort(scores.begin(), scores.end(), [](const Score& a, const Score& b) { return a.gain > b.gain; });
  if (scores.empty()) return {};
  const double top = scores[0].gain;
  const auto instrument = [&](const Score& s) { return from.forms.empty() && info(s.form->effect).stage == 0 && s.gain >= options.least; };
  std::stable_partition(scores.begin(), scores.end(), instrument);
  std::vector<Effect> order;
  std::map<Effect, std::map<int, int>> used;
  std::vector<Score> chosen;
  for (const Score& s : scores) {
    const Effect e = s.form->effect;
    const bool seen = std::find(order.begin(), order.end(), e) != order.end() || instrument(s);
    if (!seen) {
      if (static_cast<int>(order.size()) >= options.most || s.gain < options.least) continue;
      if (order.size() >= 3 && s.gain < options.share * top) continue;
      order.push_back(e);
    }
    auto& forms = used[e];
    const bool new_form = forms.count(s.form->kind) == 0;
    if (new_form && static_cast<int>(forms.size()) >= options.forms && s.form->kind != 0) continue;
    if (!new_form && forms[s.form->kind] >= starts_of(*s.form)) continue;
    ++forms[s.form->kind];
    chosen.push_back(s);
  }
  return chosen;
}

ScreenSummary screen(const Candidates& sets, const ScreenOptions& options) { return {promising(sets, sets.base(), options), {}}; }

std::vector<Screened> screened(const Candidates& sets, const ScreenOptions& options, double p) {
  const auto scores = ScoreTests(sets.fitter(), sets.base()).all(sets.forms());
  const double top = scores.empty() ? 0.0 : scores[0].gain;
  std::vector<Screened> out;
  for (const Form& f : sets.fitter().model().all_forms()) {
    if (std::any_of(out.begin(), out.end(), [&](const Screened& s) { return s.effect == f.effect; })) continue;
    Screened s{f.effect, f.text, 0.0, 1.0, ""};
    const auto at = std::find_if(scores.begin(), scores.end(), [&](const Score& x) { return x.form->effect == f.effect; });
    if (at != scores.end()) s.form = at->form->text, s.gain = at->gain, s.masked = at->masked;
    if (f.line) s.gain = s.masked = NAN;  // of free phase: tested in the spectrum
    if (was_fitted(sets, f.effect)) s.what = "fitted";
    else if (std::none_of(sets.forms().begin(), sets.forms().end(), [&](const Form& g) { return g.effect == f.effect; })) s.what = "these trials could not show it";
    else s.what = why_not(sets, f, at == scores.end() ? nullptr : &*at, top, options, p);
    out.push_back(std::move(s));
  }
  std::stable_sort(out.begin(), out.end(), [](const Screened& a, const Screened& b) { return a.gain > b.gain || (!std::isnan(a.gain) && std::isnan(b.gain)); });
  return out;
}

}  // namespace filum::reconcile
