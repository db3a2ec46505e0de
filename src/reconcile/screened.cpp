#include <algorithm>
#include <cmath>
#include <cstdio>

#include "reconcile/screen.h"
#include "reconcile/search.h"

namespace filum::reconcile {
namespace {

std::string text(const char* format, double value) {
  char out[120];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

bool fitted(const Search& search, Effect effect) {
  return std::any_of(search.candidates().begin(), search.candidates().end(),
                     [&](const Fit& f) { return std::any_of(f.forms.begin(), f.forms.end(), [&](const Form* g) { return g->effect == effect; }); });
}

/// Why a form was not fitted; `score`: its best, may be absent; `top`: the best promise of all.
std::string why_not(const Search& search, const Form& form, const Score* score, double top, const Rules& rules) {
  if (form.line) {
    const double p = search.line_p(form, search.base());
    return p > rules.detect_p ? text("not fitted: a line as strong comes by chance in %.2g of the cases", p) : "not fitted: it stands out, but others promise far more";
  }
  if (score == nullptr || score->gain < rules.screen_least) return text("not fitted: promises less than %.3g", rules.screen_least);
  if (score->gain < rules.screen_share * top) return text("not fitted: less than %.2g of the best promise", rules.screen_share);
  return "not fitted: promised too little before the noise was known";
}

}  // namespace

std::vector<Screened> screened(const Search& search, const Result& r) {
  const auto scores = Screen(search.fitter(), search.base()).all(r.forms);
  const double top = scores.empty() ? 0.0 : scores[0].gain;
  std::vector<Screened> out;
  for (const Form& f : search.fitter().model().all_forms()) {
    if (std::any_of(out.begin(), out.end(), [&](const Screened& s) { return s.effect == f.effect; })) continue;
    Screened s{f.effect, f.text, 0.0, 1.0, ""};
    const auto at = std::find_if(scores.begin(), scores.end(), [&](const Score& x) { return x.form->effect == f.effect; });
    if (at != scores.end()) s.form = at->form->text, s.gain = at->gain, s.masked = at->masked;
    if (f.line) s.gain = s.masked = NAN;  // of free phase: tested in the spectrum
    if (fitted(search, f.effect)) s.what = "fitted";
    else if (std::none_of(r.forms.begin(), r.forms.end(), [&](const Form& g) { return g.effect == f.effect; })) s.what = "these trials could not show it";
    else s.what = why_not(search, f, at == scores.end() ? nullptr : &*at, top, r.rules);
    out.push_back(std::move(s));
  }
  std::stable_sort(out.begin(), out.end(), [](const Screened& a, const Screened& b) { return a.gain > b.gain || (!std::isnan(a.gain) && std::isnan(b.gain)); });
  return out;
}

}  // namespace filum::reconcile
