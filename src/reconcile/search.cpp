#include "reconcile/search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "reconcile/in_step.h"
#include "reconcile/rules.h"

namespace filum::reconcile {
namespace {

std::set<Effect> set_of(const Fit& f) {
  std::set<Effect> s;
  for (const Form* form : f.forms) s.insert(form->effect);
  return s;
}

Noise first_noise(const RigModel& model) {
  Noise noise;
  for (const std::string& name : model.data().outputs) {
    const double fs = model.full_scale(name), stated = model.data().channel(name).noise;
    noise.output.push_back({stated > 0 ? stated : assumed::kFirstNoise * fs, 0.0, fs, stated > 0 ? "stated" : "fast part"});
  }
  noise.scatter = assumed::kFirstScatter;
  return noise;
}

}  // namespace

void stop_if_cancelled(const Options& options) {
  if (options.cancelled && options.cancelled()) throw Cancelled();
}

void parallel(int threads, std::size_t n, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  std::mutex guard;
  const auto loop = [&] {
    for (std::size_t i = next++; i < n && !failed; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(guard);
        failure = std::current_exception();
        failed = true;
      }
    }
  };
  std::vector<std::thread> pool;
  for (int i = 1; i < threads; ++i) pool.emplace_back(loop);
  loop();
  for (std::thread& t : pool) t.join();
  if (failure) std::rethrow_exception(failure);
}

/// Tells how far a stretch has come after each of its fits, whichever thread made it.
class Search::Steps {
 public:
  Steps(const Options& options, const Stretch& stretch, std::size_t all) : options_(options), stretch_(stretch), all_(all) {}
  void done() {
    const std::lock_guard lock(guard_);
    ++done_;
    if (options_.progress) options_.progress(stretch_.stage, stretch_.from + (stretch_.to - stretch_.from) * static_cast<double>(done_) / static_cast<double>(all_));
  }

 private:
  const Options& options_;
  const Stretch& stretch_;
  const std::size_t all_;
  std::size_t done_ = 0;
  std::mutex guard_;
};

Search::Search(const RigModel& model, const std::vector<Form>& forms, const Options& options)
    : model_(model), forms_(forms), options_(options), fitter_(model, first_noise(model)) {}

void Search::start_baseline() {
  const auto start = model_.guess();
  Fit loose = fitter_.fit({}, start, {});
  Noise noise = estimate_noise(fitter_, loose);
  fitter_.set_noise(noise);
  loose = fit_baseline(fitter_, start, &loose, options_.threads, {options_.rules.start_factor, options_.rules.start_same, options_.rules.start_share}, baseline_);
  noise = estimate_noise(fitter_, loose);
  noise.scatter = model_.data().rig == Rig::forceps_bridge ? assumed::kScatterLow : replicate_scatter(model_.data(), loose);
  fitter_.set_noise(noise);
  // the geometric factor of a blade is an estimate: where two blades are compared it is free within reason
  std::set<double> blades;
  for (const Trial& t : model_.data().trials) blades.insert(t.size("blade_width") * t.size("blade_length"));
  if (blades.size() > 1) noise.scatter = std::max(noise.scatter, assumed::kBladeScatter);
  fitter_.set_noise(noise);
  base_ = fitter_.fit({}, loose.base, {}, {}, &loose);
}

/// Takes out the records in which slow sampling folds this line onto what is slow anyway, or onto a harmonic of the motion where its phase is the same in
/// every repetition: a line must be seen in the others. Whether there were any.
bool Search::separate(Fit& from, const Line& line) const {
  const Dataset& d = model_.data();
  std::vector<bool> out(d.trials.size()), harmonic(d.trials.size());
  for (std::size_t i = 0; i < d.trials.size() && i < from.residual.size(); ++i) {
    const Trial& t = d.trials[i];
    if (from.residual[i].empty()) continue;
    out[i] = folded(t, line.frequency) * (t.time[t.samples() - 1] - t.time[0]) < options_.rules.line_folded;
    harmonic[i] = !out[i] && on_harmonic(d, t, line.frequency, static_cast<int>(options_.rules.line_harmonics));
  }
  const Shared shared = shared_line(fitter_, from, line.frequency, harmonic);
  const bool in_step = shared.saved == 0 || chi2_tail(shared.lost / line.background, shared.saved) > options_.rules.line_in_step;
  bool any = false;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i] || (harmonic[i] && in_step)) from.residual[i].clear(), any = true;
  return any;
}

/// Bands in which an effect's lines are looked for [Hz].
static std::vector<std::pair<double, double>> bands_of(const Form& f, std::size_t line) {
  if (f.effect == Effect::mains_hum) return {{50.0 - assumed::kHumBand, 50.0 + assumed::kHumBand}, {60.0 - assumed::kHumBand, 60.0 + assumed::kHumBand}};
  return {{f.params[line].low, f.params[line].high}};
}

/// Strongest line of one of a form's frequencies that goes through two periods in the longest record: less is not told from what is slow.
Line Search::line_of(const Form& f, std::size_t line, const Fit& from) const {
  Line best;
  double span = 0.0;
  for (const Trial& t : model_.data().trials) span = std::max(span, t.time[t.samples() - 1] - t.time[0]);
  for (const auto& [lowest, high] : bands_of(f, line)) {
    const double low = std::max(lowest, assumed::kLinePeriods / span);
    if (low >= high) continue;
    Fit left = from;
    Line found = strongest_line(fitter_, left, low, high);
    while (f.effect == Effect::mains_hum && found.gain > 0.0 && separate(left, found)) found = strongest_line(fitter_, left, low, high);
    if (found.gain > best.gain) best = found;
  }
  return best;
}

/// Places in a band where a line may stand: two to each width of a record's own resolution.
double Search::places(const Form& f, std::size_t line) const {
  double span = 0.0, width = 0.0;
  for (const Trial& t : model_.data().trials) span = std::max(span, t.time[t.samples() - 1] - t.time[0]);
  for (const auto& [low, high] : bands_of(f, line)) width += high - low;
  return 1.0 + 2.0 * width * span;
}

double Search::line_p(const Form& form, const Fit& from) const {
  double gain = 0.0, looks = 1.0;
  int columns = 0;
  for (std::size_t k = 0; k < form.params.size(); ++k) {
    const Line line = line_of(form, k, from);
    if (places(form, k) * chi2_tail(line.gain, line.columns) > options_.rules.line_seen) return 1.0;
    gain += line.gain;
    columns += line.columns;
    looks *= places(form, k);
  }
  return std::min(1.0, looks * chi2_tail(gain, columns));
}

std::vector<Score> Search::lines(const Fit& from) const {
  std::vector<Score> out;
  for (const Form& f : forms_) {
    if (!f.line || std::any_of(from.forms.begin(), from.forms.end(), [&](const Form* g) { return g->effect == f.effect; })) continue;
    if (line_p(f, from) > options_.rules.accept_p) continue;
    Score s{&f, {}, 0.0, 1.0, 0.0, 0.0};
    for (std::size_t k = 0; k < f.params.size(); ++k) {
      const Line line = line_of(f, k, from);
      s.start.push_back(line.frequency);
      s.gain += line.gain;
    }
    s.seen = s.gain;
    out.push_back(std::move(s));
  }
  return out;
}

/// Fits `from` with one more effect, for the effects that the score test likes best.
std::vector<Fit> Search::extend(const Fit& from, int most_effects, int most_forms, const Stretch& stretch) const {
  const Rules& rules = options_.rules;
  std::vector<Score> scores = Screen(fitter_, from).all(forms_);
  for (Score& s : lines(from)) scores.push_back(std::move(s));
  std::stable_sort(scores.begin(), scores.end(), [](const Score& a, const Score& b) { return a.gain > b.gain; });
  if (scores.empty()) return {};
  const double top = scores[0].gain;
  // instruments first: as the cheapest explanation they are fitted whenever they promise anything, and take no place from the others
  const auto instrument = [&](const Score& s) { return from.forms.empty() && info(s.form->effect).stage == 0 && s.gain >= rules.screen_least; };
  std::stable_partition(scores.begin(), scores.end(), instrument);
  std::vector<Effect> order;
  std::map<Effect, std::map<int, int>> used;
  std::vector<Score> candidates;
  for (const Score& s : scores) {
    const Effect e = s.form->effect;
    const bool seen = std::find(order.begin(), order.end(), e) != order.end() || instrument(s);
    if (!seen) {
      if (static_cast<int>(order.size()) >= most_effects) continue;
      if (order.size() >= 3 && s.gain < rules.screen_share * top) continue;
      if (s.gain < rules.screen_least) continue;
      order.push_back(e);
    }
    auto& forms = used[e];
    const bool new_form = forms.count(s.form->kind) == 0;
    if (new_form && static_cast<int>(forms.size()) >= most_forms && s.form->kind != 0) continue;
    if (!new_form && forms[s.form->kind] >= (s.form->params.size() > 1 || e == Effect::saturation || e == Effect::mains_hum ? 2 : 1)) continue;  // 50 and 60 Hz may fold to the same line
    ++forms[s.form->kind];
    candidates.push_back(s);
  }
  std::vector<Fit> fits(candidates.size());
  Steps steps(options_, stretch, candidates.size());
  parallel(options_.threads, candidates.size(), [&](std::size_t i) {
    stop_if_cancelled(options_);
    auto forms = from.forms;
    auto params = from.params;
    forms.push_back(candidates[i].form);
    params.push_back(candidates[i].start);
    const FitOptions effort{from.forms.empty() ? 25 : 18, 1e-4};
    fits[i] = fitter_.fit(forms, from.base, params, effort, &from);
    // a record that is clipped throughout may have been given a scale of its own for it, from which no slope leads back
    if (candidates[i].form->effect == Effect::saturation)
      if (Fit anew = fitter_.fit(forms, from.base, params, effort); anew.chi2 < fits[i].chi2) fits[i] = std::move(anew);
    steps.done();
  });
  return fits;
}

/// The amplitudes of a line stand for one strength and a phase in each record. Integrated over the phase, a record in which the line's
/// signal to noise is S pays log(2 pi S^2), S^2 its fall of chi2; at the least that is named, 10 to 20 a record, that is 4 to 5 where BIC
/// would ask 2 log n, some 13 (half of log(2 pi S^2), with a margin, is the rule line_price).
double Search::bic(const Fit& f) const {
  int lines = 0;
  int instants = 0;  // a change point costs as a parameter does, though no slope leads to it (Zhang & Siegmund 2007)
  for (const Form* form : f.forms) {
    lines += !form->line ? 0 : form->effect == Effect::pulsation && form->kind >= 2 ? 2 : 1;
    instants += form->instants;
  }
  const auto records = std::count(fitter_.use.begin(), fitter_.use.end(), true);
  const double amplitudes = 2.0 * lines * static_cast<double>(records) * static_cast<double>(model_.data().outputs.size());
  const double each = std::log(static_cast<double>(f.samples));
  return f.chi2 / dispersion_ + (f.parameters + instants - amplitudes) * each + amplitudes * std::min(options_.rules.line_price, each);
}

double Search::preference(const Fit& f) const {
  double sum = 0.0;
  for (const Form* form : f.forms) {
    const auto first = std::find_if(forms_.begin(), forms_.end(), [&](const Form& g) { return g.effect == form->effect; });
    sum += form == &*first ? 0.0 : options_.rules.form_preference;
  }
  return sum;
}

/// Keeps the best fit of each set of effects.
void Search::keep(std::vector<Fit> fits) {
  for (Fit& f : fits) {
    const auto mine = set_of(f);
    if (mine.size() != f.forms.size()) continue;
    const auto at = std::find_if(candidates_.begin(), candidates_.end(), [&](const Fit& c) { return set_of(c) == mine; });
    if (at == candidates_.end()) candidates_.push_back(std::move(f));
    else if (bic(f) + preference(f) < bic(*at) + preference(*at)) *at = std::move(f);
  }
  std::stable_sort(candidates_.begin(), candidates_.end(), [&](const Fit& a, const Fit& b) { return bic(a) < bic(b); });
}

const Fit* Search::best(std::size_t effects) const {
  for (const Fit& f : candidates_)
    if (f.forms.size() == effects) return &f;
  return nullptr;
}

/// Noise and overdispersion from the best fit so far, and all fits again under them.
void Search::refresh(const Stretch& stretch) {
  const Fit& top = candidates_.empty() || bic(candidates_[0]) > bic(base_) ? base_ : candidates_[0];
  Noise noise = estimate_noise(fitter_, top);
  noise.scatter = fitter_.noise().scatter;
  if (!top.forms.empty() && model_.data().rig != Rig::forceps_bridge && model_.data().rig != Rig::spatula_press) {
    // an effect that was missing may have looked like scatter, never the other way round
    noise.scatter = std::min(noise.scatter, std::max(assumed::kScatterLow, replicate_scatter(model_.data(), top)));
  }
  fitter_.set_noise(noise);
  base_ = fitter_.fit({}, base_.base, {}, {12, 1e-5}, &base_);
  int kept = 0;  // an instrument alone stays in the comparison
  std::erase_if(candidates_, [&](const Fit& f) { return ++kept > options_.rules.kept_most && (f.forms.size() > 1 || info(f.forms[0]->effect).stage != 0); });
  Steps steps(options_, stretch, candidates_.size());
  parallel(options_.threads, candidates_.size(), [&](std::size_t i) {
    stop_if_cancelled(options_);
    const Fit old = candidates_[i];
    candidates_[i] = fitter_.fit(old.forms, old.base, old.params, {6, 1e-4}, &old);
    steps.done();
  });
  dispersion_ = 1.0;
  const Fit* least = &base_;
  for (const Fit& f : candidates_)
    if (f.chi2 < least->chi2) least = &f;
  dispersion_ = structure(*least).z > options_.rules.overdispersed ? structure(*least).dispersion : 1.0;
  dispersion_ = std::max(dispersion_, replicate_dispersion(fitter_, *least));
  keep({});
}

bool Search::worth_more(const Fit& f) const {
  const Structure s = structure(f);
  if (s.z > options_.rules.look_further) return true;
  const auto scores = Screen(fitter_, f).all(forms_);
  if (!scores.empty() && scores[0].gain / dispersion_ > options_.rules.pair_evidence) return true;
  return !lines(f).empty();
}

void Search::run() {
  const auto say = [&](const char* stage, double share) {
    stop_if_cancelled(options_);
    if (options_.progress) options_.progress(stage, share);
  };
  say("baseline", 0.05);
  start_baseline();
  say("one effect", 0.15);
  keep(extend(base_, options_.rules.screen_most, assumed::kFirstForms, {"one effect", 0.15, 0.3}));
  refresh({"one effect", 0.3, 0.35});
  for (std::size_t size = 1; size < static_cast<std::size_t>(options_.rules.most_effects); ++size) {
    const Fit* top = best(size);
    if (top == nullptr || !worth_more(*top)) break;
    if (bic(*top) > bic(base_) - options_.rules.accept_evidence) break;
    const char* stage = size == 1 ? "pairs" : "three effects";
    double at = 0.35 + 0.25 * static_cast<double>(size - 1);
    say(stage, at);
    std::vector<Fit> parents;
    for (const Fit& f : candidates_)
      if (f.forms.size() == size && parents.size() < static_cast<std::size_t>(size == 1 ? assumed::kPairParents : assumed::kTripleParents)) parents.push_back(f);
    const double each = 0.2 / static_cast<double>(parents.size());
    for (const Fit& p : parents) keep(extend(p, size == 1 ? assumed::kPairEffects : assumed::kTripleEffects, assumed::kFurtherForms, {stage, at, at + each})), at += each;
    refresh({stage, at, at + 0.05});
    const Fit* next = best(size + 1);
    top = best(size);
    if (next == nullptr || top == nullptr || bic(*next) > bic(*top) - options_.rules.pair_evidence) break;
  }
}

Structure Search::structure(const Fit& f) const {
  Structure s = structure_of(f.white, f.parameters);
  if (s.dispersion <= 1.0) return s;
  const double own = replicate_dispersion(fitter_, f, s.length);
  const double common = std::clamp(1.0 - (own - 1.0) / (s.dispersion - 1.0), 0.0, 1.0);
  s.excess *= common;
  s.z *= common;
  return s;
}

/// The largest set whose further effects each bring what a further effect must: what others take beyond it is as likely noise.
const Fit& Search::fullest() const {
  const Fit* now = &base_;
  for (std::size_t size = 1; size <= static_cast<std::size_t>(options_.rules.most_effects); ++size)
    if (const Fit* next = best(size); next != nullptr && (size == 1 ? next->chi2 < now->chi2 : bic(*next) < bic(*now) - options_.rules.pair_evidence)) now = next;
  return *now;
}

double Search::explained(const Fit& f) const {
  const Fit* least = &fullest();
  const Structure left = structure(*least);
  const double rest = left.z > options_.rules.overdispersed ? left.excess : 0.0;
  const double all = base_.chi2 - least->chi2 + rest;
  return all > 0.0 ? std::min(1.0, (base_.chi2 - f.chi2) / all) : 0.0;
}

std::vector<Fit> Search::other_forms(const Fit& winner, double tie) const {
  std::vector<std::pair<std::size_t, const Form*>> swaps;
  for (std::size_t k = 0; k < winner.forms.size(); ++k)
    for (const Form& f : forms_)
      if (f.effect == winner.forms[k]->effect && f.kind != winner.forms[k]->kind && !f.line && !f.params.empty() && f.params[0].name == winner.forms[k]->params[0].name) swaps.emplace_back(k, &f);
  std::vector<Fit> fits(swaps.size());
  parallel(options_.threads, swaps.size(), [&](std::size_t i) {
    stop_if_cancelled(options_);
    const auto& [k, form] = swaps[i];
    auto forms = winner.forms;
    auto params = winner.params;
    params[k] = form->starts[0];
    for (std::size_t a = 0; a < form->params.size(); ++a)
      for (std::size_t b = 0; b < forms[k]->params.size(); ++b)
        if (form->params[a].name == forms[k]->params[b].name) params[k][a] = std::clamp(winner.params[k][b], form->params[a].low, form->params[a].high);
    forms[k] = form;
    fits[i] = fitter_.fit(forms, winner.base, params, {15, 1e-4}, &winner);
  });
  std::erase_if(fits, [&](const Fit& f) { return bic(f) - bic(winner) > tie; });
  return fits;
}

double Search::material(const Fit& f, const Fit& against) const {
  double most = 0.0;
  const double error = std::max(solver_error(fitter_, f).solver(), solver_error(fitter_, against).solver());
  const double least = std::max(options_.rules.materiality, error), in_window = std::max(options_.rules.window_materiality, error);
  double common = 0.0;
  int used = 0;
  for (std::size_t i = 0; i < f.predicted.size(); ++i)
    if (!f.predicted[i].empty()) common += f.log_scale[i] - against.log_scale[i], ++used;
  for (std::size_t i = 0; i < f.predicted.size(); ++i)
    for (std::size_t c = 0; c < f.predicted[i].size(); ++c) {
      const Eigen::VectorXd change = (f.predicted[i][c] - against.predicted[i][c]) / fitter_.noise().output[c].full_scale;
      if (!change.allFinite()) continue;
      most = std::max(most, std::sqrt(change.squaredNorm() / static_cast<double>(change.size())) / least);
      // what one fit hides in the stiffness of single records counts as change, too
      const double hidden = std::abs(f.log_scale[i] - against.log_scale[i] - common / used), spread = (f.predicted[i][c].array() - f.predicted[i][c].mean()).matrix().norm();
      const double signal = std::max(spread, model_.data().rig == Rig::suture_pull ? f.predicted[i][c].norm() : 0.0) / std::sqrt(static_cast<double>(change.size()));
      const double gain = std::abs(f.log_gain[i] - against.log_gain[i] + std::log(f.instrument[c] / against.instrument[c])) * f.predicted[i][c].norm() / std::sqrt(static_cast<double>(change.size()));
      most = std::max(most, (hidden * signal + gain) / fitter_.noise().output[c].full_scale / least);
      const Eigen::Index w = std::max<Eigen::Index>(2, change.size() / 8);
      for (Eigen::Index k = 0; k + w <= change.size(); k += w)
        most = std::max(most, std::sqrt(change.segment(k, w).squaredNorm() / static_cast<double>(w)) / in_window);
    }
  return most;
}

}  // namespace filum::reconcile
