// From fits to a verdict. The rules stand in rules.h; every set that was tried is kept with the reason why it was not taken.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "reconcile/challenge.h"
#include "reconcile/choose.h"
#include "reconcile/confirm.h"
#include "reconcile/rivals.h"
#include "reconcile/rules.h"

namespace filum::reconcile {
namespace {

std::string names(const std::vector<Effect>& effects) {
  std::string out;
  for (const Effect e : effects) out += (out.empty() ? "" : " + ") + info(e).name;
  return out;
}

std::string form_text(const Fit& f) {
  std::string out;
  for (const Form* form : f.forms) out += (out.empty() ? "" : "; ") + form->text;
  return out;
}

/// Whether the baseline with the model file's own values misfits although the refitted one does not.
bool refit_matters(const Search& search, const Rules& rules) {
  const Fitter& fitter = search.fitter();
  const Dataset& d = fitter.model().data();
  bool with_prior = false;
  for (const int i : fitter.free_baseline()) with_prior = with_prior || d.prior.count(fitter.model().baseline()[static_cast<std::size_t>(i)].name) > 0;
  if (!with_prior) return false;
  Fit nominal = search.base();
  for (const int i : fitter.free_baseline()) nominal.base[static_cast<std::size_t>(i)] = d.nominal.at(fitter.model().baseline()[static_cast<std::size_t>(i)].name);
  const Fit there = fitter.transfer(nominal, fitter.use);
  return there.chi2 - search.base().chi2 > rules.refit * static_cast<double>(fitter.free_baseline().size()) && search.material(there, search.base()) > 1.0;
}

void list_tried(const Search& search, Result& r, const Fit* best) {
  const Fit* taken = r.verdict == "effect" ? best : nullptr;
  for (const Fit& f : search.candidates()) {
    Tried t{effects_in(f), form_text(f), search.bic(f) - search.bic(search.base()), search.explained(f), &f == taken, ""};
    char text[200];
    const bool rival = r.verdict == "ambiguous" && std::any_of(r.rivals.begin(), r.rivals.end(), [&](const Tried& other) { return other.effects == t.effects; });
    if (t.taken) t.why = "taken";
    else if (rival) t.why = "a rival: not told apart";
    else if (t.evidence > -r.rules.accept_evidence) t.why = "no evidence beyond the baseline";
    else if (t.explained < r.rules.explained) std::snprintf(text, sizeof text, "explains %.0f %% of what is missing", 100 * t.explained), t.why = text;
    else if (best != nullptr && search.bic(f) > search.bic(*best)) std::snprintf(text, sizeof text, "worse than the best by %.1f", search.bic(f) - search.bic(*best)), t.why = text;
    else t.why = "further effect does not earn its place";
    if (f.at_bound) t.why += "; a parameter stands at its bound";
    r.tried.push_back(std::move(t));
  }
}

/// Median size of the gain errors that a fit asks of the records: what no instrument does is not explained.
double gain_asked(const Fitter& fitter, const Fit& f) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < fitter.use.size(); ++i)
    for (std::size_t c = 0; fitter.use[i] && c < f.instrument.size(); ++c) sizes.push_back(std::abs(f.log_gain[i] + std::log(f.instrument[c])));
  return median(std::move(sizes));
}

/// The fit with steps of its differences at which they agree with those of twice the step, where the usual ones do not.
Fit with_checked_steps(const Fitter& fitter, const Fit& f) {
  Fitter stepped(fitter);
  bool usual = true;
  const auto checked = check_sensitivities(fitter, f);
  if (checked.size() != fitter.globals(f.forms).size()) return f;  // one that is held
  for (const Sensitivity& s : checked) {
    stepped.steps.push_back(s.step);
    usual = usual && s.step == 1.0;
  }
  return usual ? f : stepped.fit(f.forms, f.base, f.params, {3, 1e-5}, &f);
}

void note(const Challenge& c, Result& r) {
  r.held_out = c.gap;
  r.held_out_how = c.how;
  r.folds = c.folds;
  r.held_before = c.before, r.held_after = c.after;
}

/// As it stands in the list of rivals.
Tried as_rival(const Search& search, const Fit& f) { return {effects_in(f), form_text(f), search.bic(f) - search.bic(search.base()), search.explained(f), false, ""}; }

/// The best candidates but one (null: none left out).
void list_rivals(const Search& search, const Fit* but, std::size_t most, Result& r) {
  for (const Fit& f : search.candidates())
    if (&f != but && r.rivals.size() < most) r.rivals.push_back(as_rival(search, f));
}

void estimate(const Search& search, const Fit& winner, Result& r) {
  const Fitter& fitter = search.fitter();
  const Fit sure = with_checked_steps(fitter, winner);
  r.effects = effect_estimates(fitter, sure, search.dispersion());
  for (const Fit& other : search.other_forms(winner, r.rules.tie)) widen_by_forms(r.effects, effect_estimates(fitter, other, search.dispersion()));
  r.baseline = baseline_estimates(fitter, sure, search.dispersion());
}

/// Why the best set is not named, in words; empty if it may be.
std::string objection(const Search& search, const Fit& winner, const Challenge& c, bool confirmed, const Result& r) {
  if (!confirmed) return "Something is missing. The reduced model would name " + names(effects_in(winner)) + ", but " + r.confirmation->solver + " does not bear it out.";
  const bool holds = !c.done || c.explained >= r.rules.held_out;
  const double explained = search.explained(winner);
  if (explained >= r.rules.explained && holds) return "";
  char text[300];
  std::snprintf(text, sizeof text, "Something is missing that no candidate explains: the best, %s, covers %.0f %% of it%s.", names(effects_in(winner)).c_str(), 100 * explained,
                holds ? "" : " and fails on protocols it was not fitted to");
  return text;
}

bool leaves_a_part(const Search& search, const Fit& winner, const Rules& rules) {
  const Structure left = search.structure(winner);
  if (left.z > rules.partial_structure && left.excess > rules.partial_share * (search.base().chi2 - winner.chi2 + left.excess)) return true;
  // a law whose value stands at the end of its range is not believed to be the whole of what acts (discovery.md 4.3: inside bounds)
  return winner.at_bound || gain_asked(search.fitter(), winner) > rules.gain_most;
}

std::string what_would(const NextExperiment& next) {
  char text[60];
  std::snprintf(text, sizeof text, ", which decides in %.0f of 50 simulated repetitions", 50 * next.chance);
  return (next.chance >= assumed::kLikely ? " What would: " : " No protocol on the list of this rig is likely to; nearest comes ") + next.protocol + text + ".";
}

/// The winner and its rivals, how alike they are, and the experiment that would part them.
void compare(const Search& search, const Fit& winner, const std::vector<const Fit*>& rivals, Result& r) {
  std::vector<const Fit*> all = rivals;
  all.insert(all.begin(), &winner);
  std::vector<double> evidence;
  for (const Fit* f : all) {
    r.alike_sets.push_back(effects_in(*f));
    evidence.push_back(search.bic(*f));
  }
  r.alike = Screen(search.fitter(), search.base()).likeness(all);
  r.next = next_experiment(search.fitter(), all, evidence, search.dispersion(), r.rules.tie);
}

void leave_open(const Search& search, const Fit& winner, const std::vector<const Fit*>& rivals, Result& r) {
  r.verdict = "ambiguous";
  r.effects.clear();
  r.rivals = {as_rival(search, winner)};
  std::string others;
  for (const Fit* f : rivals) others += (others.empty() ? "" : " or ") + names(effects_in(*f)), r.rivals.push_back(as_rival(search, *f));
  r.sentence = "These trials cannot tell " + names(effects_in(winner)) + " from " + others + ".";
  compare(search, winner, rivals, r);
  if (r.next) r.sentence += what_would(*r.next);
}

/// What several sets share is named; what they do not share stays open.
void name_common(const Search& search, const Fit& winner, const std::vector<const Fit*>& rivals, const std::set<Effect>& shared, Result& r) {
  r.verdict = "effect";
  r.partial = true;
  std::erase_if(r.effects, [&](const NamedEffect& e) { return shared.count(e.effect) == 0; });
  compare(search, winner, rivals, r);
  std::string beside;
  for (const auto& set : r.alike_sets) {
    std::vector<Effect> rest;
    std::copy_if(set.begin(), set.end(), std::back_inserter(rest), [&](Effect e) { return shared.count(e) == 0; });
    beside += (beside.empty() ? "" : " or ") + (rest.empty() ? "nothing" : names(rest));
  }
  r.sentence = "All sets that explain the measurements share " + names({shared.begin(), shared.end()}) + "; what acts beside it is not decided: " + beside + "." + (r.next ? what_would(*r.next) : "");
}

/// What would make a name that leaves a part whole.
std::string completed_by(const Rules& rules) {
  char text[200];
  std::snprintf(text, sizeof text, "; a further effect that lowers BIC by %.3g and takes away %.2g %% of the gap, beside values inside their range, would make it whole", rules.pair_evidence, 100 * rules.pair_share);
  return text;
}

void name(const Search& search, const Fit& winner, Result& r, const Options& options) {
  auto rivals = rivals_of(search, winner, r.rules, r.not_testable);
  const Challenge c = challenge(search, search.base(), winner, options);
  for (const Fit* f : instruments_not_outdone(search, winner, c, options))
    if (std::find(rivals.begin(), rivals.end(), f) == rivals.end()) rivals.push_back(f);
  note(c, r);
  const bool confirmed = confirm(search, winner, options, r);
  estimate(search, winner, r);
  list_rivals(search, &winner, 6, r);
  if (const std::string why = objection(search, winner, c, confirmed, r); !why.empty()) {
    r.verdict = "unknown";
    r.effects.clear();
    r.sentence = why;
    return;
  }
  r.partial = leaves_a_part(search, winner, r.rules);
  const auto shared = common(winner, rivals);
  if (rivals.empty()) {
    r.verdict = "effect";
    r.sentence = "The measurements behave as if " + names(effects_in(winner)) + (r.partial ? " acted, among something else that remains unnamed." : " acted, under these protocols.") +
                 " A rival that came within " + std::to_string(static_cast<int>(r.rules.tie)) + " units of BIC would make it ambiguous" + (r.partial ? completed_by(r.rules) : "") + ".";
  } else if (!shared.empty() && winner.forms.size() > 1) {
    name_common(search, winner, rivals, shared, r);
  } else {
    leave_open(search, winner, rivals, r);
  }
}

/// How near the best candidate came where nothing is named.
std::string nearest(const Search& search, const Result& r) {
  char text[400];
  const Fit* best = search.candidates().empty() ? nullptr : &search.candidates()[0];
  std::snprintf(text, sizeof text, " An effect that lowers BIC by %.3g and changes a record by %.2g %% of full scale would change this", r.rules.accept_evidence, 100 * std::max(r.rules.materiality, solver_error(search.fitter(), search.base()).solver()));
  std::string out = text;
  if (best == nullptr) return out + "; none of the catalogue promises enough to be fitted.";
  std::snprintf(text, sizeof text, "; nearest comes %s (%.3g, and %.2g %%).", names(effects_in(*best)).c_str(), search.bic(search.base()) - search.bic(*best), 100 * r.rules.materiality * search.material(*best, search.base()));
  return out + text;
}

void name_nothing(const Search& search, Result& r, const Options& options) {
  const Structure s = search.structure(search.base());
  // what is left, averaged over the block length where it stands out and freed of the noise's own share, in parts of full scale
  double sum = 0.0;
  int n = 0;
  for (const auto& trial : search.base().residual)
    for (std::size_t c = 0; c < trial.size(); ++c)
      for (Eigen::Index k = 0; k + s.length <= trial[c].size(); k += s.length) {
        const double mean = trial[c].segment(k, s.length).mean();
        if (std::isfinite(mean)) sum += std::pow(mean / search.fitter().noise().output[c].full_scale, 2), ++n;
      }
  const bool seen = s.z > r.rules.structure && n > 0 && std::sqrt(sum / n * (1.0 - 1.0 / s.dispersion)) > r.rules.materiality;
  const Challenge c = challenge(search, search.base(), search.base(), options);
  note(c, r);
  r.baseline = r.baseline_alone;
  list_rivals(search, nullptr, 4, r);
  if (seen) {
    r.verdict = "unknown";
    r.sentence = "The residual has a shape that noise does not have, and no candidate explains it.";
  } else if (refit_matters(search, r.rules)) {
    r.verdict = "parameter";
    r.sentence = "The model's form is right; its parameters are not those of the model file, but lie within their stated range." + nearest(search, r);
  } else {
    r.verdict = "agree";
    char text[100];
    std::snprintf(text, sizeof text, "Nothing is missing beyond the noise and %.2g %% of full scale.", 100 * r.rules.materiality);
    r.sentence = text + nearest(search, r);
  }
}

/// Of what is not named: where most of it sits, the term it follows, what would change the verdict.
std::string described(const Result& r) {
  std::map<std::string, double> phases;
  for (const Cell& c : r.where) phases[c.phase] += c.share;
  const auto most = std::max_element(phases.begin(), phases.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  char text[240] = "";
  std::string out;
  const bool several = r.noise.output.size() > 1;
  if (most != phases.end()) std::snprintf(text, sizeof text, " %.0f %% of it sits where the trials are in %s", 100 * most->second, most->first.c_str());
  out += text;
  if (!r.shape.empty()) std::snprintf(text, sizeof text, "; %sit follows %s (in %.0f %% of resamplings)", several ? (r.shape[0].output + ": ").c_str() : "", r.shape[0].name.c_str(), 100 * r.shape[0].stability), out += text;
  std::snprintf(text, sizeof text, ". A candidate that takes away %.0f %% of it, and %.0f %% in protocols it was not fitted to, would change this.", 100 * r.rules.explained, 100 * r.rules.held_out);
  return out + (out.empty() ? text + 1 : text);
}

void finish(const Search& search, const Fit* winner, Result& r) {
  const Fitter& fitter = search.fitter();
  r.screened = screened(search, r);
  r.numerics = solver_error(fitter, winner != nullptr ? *winner : search.base());
  r.numerics.sensitivities = check_sensitivities(fitter, winner != nullptr ? *winner : search.base());
  r.noise = fitter.noise();
  r.starts = search.baseline();
  r.dispersion = search.dispersion();
  r.before = search.base();
  r.after = winner != nullptr ? *winner : search.base();
  r.fit = gap_of(r.noise, r.before, r.after);
  r.structure_before = search.structure(search.base()).z;
  r.structure_after = search.structure(r.after).z;
  if (r.verdict != "agree" && r.verdict != "parameter") r.where = localise(fitter.model(), r.before, r.noise), r.where_by = localise_by(fitter.model(), r.before, r.noise);
  r.residual_terms = describe(fitter.model(), r.before, r.noise);
  if (r.verdict == "unknown" || r.partial) r.shape = describe(fitter.model(), r.verdict == "unknown" ? r.before : r.after, r.noise);
  if (r.verdict == "unknown") r.sentence += described(r);
  list_tried(search, r, winner);
}

}  // namespace

Gap gap_of(const Noise& noise, const Fit& before, const Fit& after) {
  double sb = 0, sa = 0;
  int n = 0, m = 0;
  add_squares(noise, before, sb, n);
  add_squares(noise, after, sa, m);
  return {n > 0 ? std::sqrt(sb / n) : 0.0, m > 0 ? std::sqrt(sa / m) : 0.0};
}

Result reconcile(const Dataset& d, const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto model = make_model(d);
  Result r;
  if (d.rig == Rig::tip_hold) {
    r = reconcile_hold(d, *model, options);
  } else {
    r.rules = options.rules;
    r.forms = model->all_forms();
    if (options.progress) options.progress("lint", 0.0);
    r.not_testable = lint(*model, r.forms, options.rules.masked, options.rules.testable);
    // what the inputs hide altogether cannot be named; what lacks a condition stays as a rival
    std::erase_if(r.forms, [&](const Form& f) {
      return std::any_of(r.not_testable.begin(), r.not_testable.end(), [&](const NotTestable& n) { return n.effect == f.effect && n.hidden; });
    });
    Search search(*model, r.forms, options);
    search.run();
    if (options.progress) options.progress("challenge", 0.85);
    r.baseline_alone = baseline_estimates(search.fitter(), search.base(), std::max(1.0, search.structure(search.base()).dispersion));
    r.detection = detect(search, r.forms);
    const Fit* winner = choose(search, r.rules, *r.detection);
    // a line leaves no window's sum behind: it was tested in the spectrum
    const bool line = winner != nullptr && std::any_of(winner->forms.begin(), winner->forms.end(), [](const Form* f) { return f->line; });
    if (winner != nullptr && !line && r.detection->p > r.rules.detect_p) winner = nullptr;
    if (winner != nullptr) name(search, *winner, r, options);
    else name_nothing(search, r, options);
    finish(search, winner, r);
  }
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return r;
}

}  // namespace filum::reconcile
