#include "reconcile/decide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "reconcile/choose.h"

namespace filum::reconcile {
namespace {

std::string names_of(const std::vector<Effect>& effects) {
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
bool refit_matters(const Candidates& sets, double refit) {
  const Fitter& fitter = sets.fitter();
  const Dataset& d = fitter.model().data();
  bool with_prior = false;
  for (const int i : fitter.free_baseline()) with_prior = with_prior || d.prior.count(fitter.model().baseline()[static_cast<std::size_t>(i)].name) > 0;
  if (!with_prior) return false;
  Fit nominal = sets.base();
  for (const int i : fitter.free_baseline()) nominal.base[static_cast<std::size_t>(i)] = d.nominal.at(fitter.model().baseline()[static_cast<std::size_t>(i)].name);
  const Fit there = fitter.transfer(nominal, fitter.use);
  return there.chi2 - sets.base().chi2 > refit * static_cast<double>(fitter.free_baseline().size()) && sets.material(there, sets.base()) > 1.0;
}

void list_tried(const Candidates& sets, const Fit* best, DecideSummary& r) {
  const Fit* taken = r.verdict == "effect" ? best : nullptr;
  for (const Fit& f : sets.fitted()) {
    Tried t{effects_in(f), form_text(f), sets.bic(f) - sets.bic(sets.base()), sets.explained(f), &f == taken, ""};
    char text[200];
    const bool rival = r.verdict == "ambiguous" && std::any_of(r.rivals.begin(), r.rivals.end(), [&](const Tried& other) { return other.effects == t.effects; });
    if (t.taken) t.why = "taken";
    else if (rival) t.why = "a rival: not told apart";
    else if (t.evidence > -sets.rules().accept_evidence) t.why = "no evidence beyond the baseline";
    else if (t.explained < sets.rules().explained) std::snprintf(text, sizeof text, "explains %.0f %% of what is missing", 100 * t.explained), t.why = text;
    else if (best != nullptr && sets.bic(f) > sets.bic(*best)) std::snprintf(text, sizeof text, "worse than the best by %.1f", sets.bic(f) - sets.bic(*best)), t.why = text;
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

/// As it stands in the list of rivals.
Tried as_rival(const Candidates& sets, const Fit& f) { return {effects_in(f), form_text(f), sets.bic(f) - sets.bic(sets.base()), sets.explained(f), false, ""}; }

/// The best candidates but one (null: none left out).
void list_rivals(const Candidates& sets, const Fit* but, std::size_t most, DecideSummary& r) {
  for (const Fit& f : sets.fitted())
    if (&f != but && r.rivals.size() < most) r.rivals.push_back(as_rival(sets, f));
}

void add_estimates(const Candidates& sets, const Fit& winner, double tie, const Run& run, DecideSummary& r) {
  const Fitter& fitter = sets.fitter();
  const Fit sure = with_checked_steps(fitter, winner);
  r.effects = effect_estimates(fitter, sure, sets.dispersion());
  for (const Fit& other : other_forms(sets, winner, tie, run)) widen_by_forms(r.effects, effect_estimates(fitter, other, sets.dispersion()));
  r.baseline = baseline_estimates(fitter, sure, sets.dispersion());
}

/// Why the best set is not named, in words; empty if it may be.
std::string objection(const Candidates& sets, const Fit& winner, const ChallengeSummary& c, const std::optional<ConfirmSummary>& confirmed, double held_out) {
  if (confirmed && confirmed->refutes()) return "Something is missing. The reduced model would name " + names_of(effects_in(winner)) + ", but " + confirmed->solver + " does not bear it out.";
  const bool holds = !c.done || c.explained >= held_out;
  const double explained = sets.explained(winner);
  if (explained >= sets.rules().explained && holds) return "";
  char text[300];
  std::snprintf(text, sizeof text, "Something is missing that no candidate explains: the best, %s, covers %.0f %% of it%s.", names_of(effects_in(winner)).c_str(), 100 * explained,
                holds ? "" : " and fails on protocols it was not fitted to");
  return text;
}

bool leaves_a_part(const Candidates& sets, const Fit& winner, const DecideOptions& options) {
  const Structure left = sets.structure(winner);
  if (left.z > options.partial_structure && left.excess > options.partial_share * (sets.base().chi2 - winner.chi2 + left.excess)) return true;
  // a law whose value stands at the end of its range is not believed to be the whole of what acts (discovery.md 4.3: inside bounds)
  return winner.at_bound || gain_asked(sets.fitter(), winner) > options.gain_most;
}

/// The winner and its rivals, and how alike they are.
void compare(const Candidates& sets, const Fit& winner, const std::vector<const Fit*>& rivals, DecideSummary& r) {
  std::vector<const Fit*> all = rivals;
  all.insert(all.begin(), &winner);
  for (const Fit* f : all) r.alike_sets.push_back(effects_in(*f));
  r.alike = ScoreTests(sets.fitter(), sets.base()).likeness(all);
}

void leave_open(const Candidates& sets, const Fit& winner, const std::vector<const Fit*>& rivals, DecideSummary& r) {
  r.verdict = "ambiguous";
  r.effects.clear();
  r.rivals = {as_rival(sets, winner)};
  std::string others;
  for (const Fit* f : rivals) others += (others.empty() ? "" : " or ") + names_of(effects_in(*f)), r.rivals.push_back(as_rival(sets, *f));
  r.sentence = "These trials cannot tell " + names_of(effects_in(winner)) + " from " + others + ".";
  compare(sets, winner, rivals, r);
}

/// What several sets share is named; what they do not share stays open.
void name_common(const Candidates& sets, const Fit& winner, const std::vector<const Fit*>& rivals, const std::set<Effect>& shared, DecideSummary& r) {
  r.verdict = "effect";
  r.partial = true;
  std::erase_if(r.effects, [&](const NamedEffect& e) { return shared.count(e.effect) == 0; });
  compare(sets, winner, rivals, r);
  std::string beside;
  for (const auto& set : r.alike_sets) {
    std::vector<Effect> rest;
    std::copy_if(set.begin(), set.end(), std::back_inserter(rest), [&](Effect e) { return shared.count(e) == 0; });
    beside += (beside.empty() ? "" : " or ") + (rest.empty() ? "nothing" : names_of(rest));
  }
  r.sentence = "All sets that explain the measurements share " + names_of({shared.begin(), shared.end()}) + "; what acts beside it is not decided: " + beside + ".";
}

/// What would make a name that leaves a part whole.
std::string completed_by(const CompareOptions& rules) {
  char text[200];
  std::snprintf(text, sizeof text, "; a further effect that lowers BIC by %.3g and takes away %.2g %% of the gap, beside values inside their range, would make it whole", rules.pair_evidence, 100 * rules.pair_share);
  return text;
}

void name(const Candidates& sets, const Grounds& grounds, const DecideOptions& options, const Run& run, DecideSummary& r) {
  const Fit& winner = *grounds.winner;
  add_estimates(sets, winner, options.tie, run, r);
  list_rivals(sets, &winner, 6, r);
  if (const std::string why = objection(sets, winner, grounds.challenged, grounds.confirmed, options.held_out); !why.empty()) {
    r.verdict = "unknown";
    r.effects.clear();
    r.sentence = why;
    return;
  }
  r.partial = leaves_a_part(sets, winner, options);
  const auto shared = common(winner, grounds.rivals);
  if (grounds.rivals.empty()) {
    r.verdict = "effect";
    r.sentence = "The measurements behave as if " + names_of(effects_in(winner)) + (r.partial ? " acted, among something else that remains unnamed." : " acted, under these protocols.") +
                 " A rival that came within " + std::to_string(static_cast<int>(options.tie)) + " units of BIC would make it ambiguous" + (r.partial ? completed_by(sets.rules()) : "") + ".";
  } else if (!shared.empty() && winner.forms.size() > 1) {
    name_common(sets, winner, grounds.rivals, shared, r);
  } else {
    leave_open(sets, winner, grounds.rivals, r);
  }
}

/// How near the best candidate came where nothing is named.
std::string nearest(const Candidates& sets) {
  char text[400];
  const Fit* best = sets.fitted().empty() ? nullptr : &sets.fitted()[0];
  std::snprintf(text, sizeof text, " An effect that lowers BIC by %.3g and changes a record by %.2g %% of full scale would change this", sets.rules().accept_evidence, 100 * std::max(sets.rules().materiality, solver_error(sets.fitter(), sets.base()).solver()));
  std::string out = text;
  if (best == nullptr) return out + "; none of the catalogue promises enough to be fitted.";
  std::snprintf(text, sizeof text, "; nearest comes %s (%.3g, and %.2g %%).", names_of(effects_in(*best)).c_str(), sets.bic(sets.base()) - sets.bic(*best), 100 * sets.rules().materiality * sets.material(*best, sets.base()));
  return out + text;
}

/// Whether what the baseline leaves has a material shape: averaged over the block length where it stands out and freed of the noise's own share, in parts of
/// full scale.
bool shape_is_seen(const Candidates& sets, double least) {
  const Structure s = sets.structure(sets.base());
  double sum = 0.0;
  int n = 0;
  for (const auto& trial : sets.base().residual)
    for (std::size_t c = 0; c < trial.size(); ++c)
      for (Eigen::Index k = 0; k + s.length <= trial[c].size(); k += s.length) {
        const double mean = trial[c].segment(k, s.length).mean();
        if (std::isfinite(mean)) sum += std::pow(mean / sets.fitter().noise().output[c].full_scale, 2), ++n;
      }
  return s.z > least && n > 0 && std::sqrt(sum / n * (1.0 - 1.0 / s.dispersion)) > sets.rules().materiality;
}

void name_nothing(const Candidates& sets, const DecideOptions& options, DecideSummary& r) {
  r.baseline = baseline_estimates(sets.fitter(), sets.base(), std::max(1.0, sets.structure(sets.base()).dispersion));
  list_rivals(sets, nullptr, 4, r);
  if (shape_is_seen(sets, options.structure)) {
    r.verdict = "unknown";
    r.sentence = "The residual has a shape that noise does not have, and no candidate explains it.";
  } else if (refit_matters(sets, options.refit)) {
    r.verdict = "parameter";
    r.sentence = "The model's form is right; its parameters are not those of the model file, but lie within their stated range." + nearest(sets);
  } else {
    r.verdict = "agree";
    char text[100];
    std::snprintf(text, sizeof text, "Nothing is missing beyond the noise and %.2g %% of full scale.", 100 * sets.rules().materiality);
    r.sentence = text + nearest(sets);
  }
}

/// The fits that the verdict rests on, and what their numbers are worth.
void rest_on(const Candidates& sets, const Fit* winner, DecideSummary& r) {
  const Fitter& fitter = sets.fitter();
  r.before = sets.base();
  r.after = winner != nullptr ? *winner : sets.base();
  r.numerics = solver_error(fitter, r.after);
  r.numerics.sensitivities = check_sensitivities(fitter, r.after);
  r.gap = gap_of(fitter.noise(), r.before, r.after);
  r.structure_before = sets.structure(r.before).z;
  r.structure_after = sets.structure(r.after).z;
}

}  // namespace

DecideSummary decide(const Candidates& sets, const Grounds& grounds, const Rules& rules, const Run& run) {
  DecideSummary r;
  if (grounds.winner != nullptr) name(sets, grounds, rules.decide, run, r);
  else name_nothing(sets, rules.decide, r);
  rest_on(sets, grounds.winner, r);
  r.units = check_units(sets.data(), r.baseline);
  list_tried(sets, grounds.winner, r);
  return r;
}

std::string what_would(const NextSummary& next, const NextOptions& options) {
  char text[60];
  std::snprintf(text, sizeof text, ", which decides in %.0f of %d simulated repetitions", options.records * next.chance, options.records);
  return (next.chance >= options.likely ? " What would: " : " No protocol on the list of this rig is likely to; nearest comes ") + next.protocol + text + ".";
}

std::string what_it_is_like(const LocaliseSummary& where, const std::vector<Term>& shape, bool several_outputs, const Rules& rules) {
  std::map<std::string, double> phases;
  for (const Cell& c : where.cells) phases[c.phase] += c.share;
  const auto most = std::max_element(phases.begin(), phases.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  char text[240] = "";
  std::string out;
  if (most != phases.end()) std::snprintf(text, sizeof text, " %.0f %% of it sits where the trials are in %s", 100 * most->second, most->first.c_str());
  out += text;
  if (!shape.empty()) std::snprintf(text, sizeof text, "; %sit follows %s (in %.0f %% of resamplings)", several_outputs ? (shape[0].output + ": ").c_str() : "", shape[0].name.c_str(), 100 * shape[0].stability), out += text;
  std::snprintf(text, sizeof text, ". A candidate that takes away %.0f %% of it, and %.0f %% in protocols it was not fitted to, would change this.", 100 * rules.compare.explained, 100 * rules.decide.held_out);
  return out + (out.empty() ? text + 1 : text);
}

}  // namespace filum::reconcile
