#include "reconcile/choose.h"

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

/// Where the smaller set is silent, its form cannot be to blame for what is left: the share of the larger set's gain that comes from those
/// samples. 0 where there are too few of them, or the gain there could be chance.
double where_silent(const Candidates& sets, const Fit& smaller, const Fit& larger) {
  const Fitter& fitter = sets.fitter();
  const CompareOptions& rules = sets.rules();
  Fit without = larger;
  for (std::size_t k = without.forms.size(); k-- > 0;)
    if (const auto mine = effects_in(smaller); std::find(mine.begin(), mine.end(), without.forms[k]->effect) != mine.end()) {
      without.forms.erase(without.forms.begin() + static_cast<std::ptrdiff_t>(k));
      without.params.erase(without.params.begin() + static_cast<std::ptrdiff_t>(k));
    }
  if (without.forms.size() + smaller.forms.size() != larger.forms.size()) return 0.0;
  double gain = 0.0;
  int silent = 0, all = 0;
  for (std::size_t i = 0; i < larger.predicted.size(); ++i) {
    if (larger.predicted[i].empty()) continue;
    std::vector<Eigen::VectorXd> plain;
    fitter.residual(static_cast<int>(i), fitter.setting(without, static_cast<int>(i)), nullptr, &plain);
    Eigen::Index row = 0;  // of the whitened residual, which has no entry for a sample that is left out
    for (std::size_t c = 0; c < plain.size(); ++c) {
      const double least = rules.materiality * fitter.noise().output[c].full_scale;
      for (Eigen::Index n = 0; n < plain[c].size(); ++n) {
        if (!std::isfinite(larger.residual[i][c][n])) continue;
        const auto at = row++;
        ++all;
        if (std::abs(plain[c][n] - larger.predicted[i][c][n]) > least) continue;
        gain += (std::pow(smaller.white[i][at], 2) - std::pow(larger.white[i][at], 2)) / sets.dispersion();
        ++silent;
      }
    }
  }
  if (silent < rules.silent_least * all || gain < rules.fall) return 0.0;
  return gain * sets.dispersion() / std::max(smaller.chi2 - larger.chi2, 1e-300);
}

/// Chance that in a set where nothing is missing some effect does as well as this one: its score test (and no more than its fit bore out) among the
/// best ones of the repetitions, so that the number of effects, forms and starting points looked at is paid for.
double chance(const Candidates& sets, const Fit& single, const DetectSummary& detection, const std::vector<Score>& scores) {
  if (single.forms[0]->line) return sets.line_chance(*single.forms[0], sets.base());
  double gain = 0.0;
  for (const Score& s : scores)
    if (s.form->effect == single.forms[0]->effect) gain = std::max(gain, s.gain);
  gain = std::min(gain, sets.base().chi2 - single.chi2) / sets.dispersion();
  const auto& null = detection.null_scores;
  const auto above = null.end() - std::lower_bound(null.begin(), null.end(), gain);
  return (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(null.size()));
}

/// Whether the share of the gap that the larger set explains beyond the smaller one is more than the smaller one's form could err by.
bool takes_a_part(const Candidates& sets, const Fit& smaller, const Fit& larger) {
  const CompareOptions& rules = sets.rules();
  const double already = sets.explained(smaller), share = sets.explained(larger) - already, material = sets.material(larger, smaller);
  return share >= rules.pair_share || (share >= rules.pair_least && material >= rules.pair_material) ||
         (share >= rules.pair_clean && material >= 2.0 * rules.pair_material && share >= rules.pair_rest * (1.0 - already)) ||
         (material >= rules.pair_material && where_silent(sets, smaller, larger) >= rules.silent_share);
}

}  // namespace

std::vector<Effect> effects_in(const Fit& f) {
  std::vector<Effect> out;
  for (const Form* form : f.forms) out.push_back(form->effect);
  return out;
}

bool earns_its_place(const Candidates& sets, const Fit& smaller, const Fit& larger) {
  return sets.bic(smaller) - sets.bic(larger) >= sets.rules().pair_evidence && sets.material(larger, smaller) >= 1.0 && takes_a_part(sets, smaller, larger);
}

const Fit* choose(const Candidates& sets, double detect_p, DetectSummary& detection) {
  const CompareOptions& rules = sets.rules();
  const Fit* first = sets.best(1);
  if (first != nullptr) detection.chance = chance(sets, *first, detection, ScoreTests(sets.fitter(), sets.base()).all(sets.forms()));
  const Fit* now = nullptr;
  for (std::size_t size = 1; size <= static_cast<std::size_t>(rules.most_effects); ++size) {
    const Fit* next = sets.best(size);
    if (next == nullptr) break;
    const Fit& before = now == nullptr ? sets.base() : *now;
    const double fall = sets.bic(before) - sets.bic(*next);
    const double needed = now == nullptr ? rules.accept_evidence : rules.pair_evidence;
    bool enough = fall >= needed && (now != nullptr || (before.chi2 - next->chi2) / sets.dispersion() >= rules.fall);
    // an instant read off the record is chosen among all: repetitions with the same instants do not know that
    if (size == 1 && next->forms[0]->instants == 0 && !next->at_bound) enough = enough || (detection.chance <= rules.accept_p && (fall > 0.0 || next->forms[0]->line));
    if (!enough || sets.material(*next, before) < 1.0 || (now != nullptr && !takes_a_part(sets, before, *next))) {
      if (now == nullptr) continue;  // two effects may cancel in the test of singles
      break;
    }
    now = next;
  }
  // a line leaves no window's sum behind: it was tested in the spectrum
  const bool line = now != nullptr && std::any_of(now->forms.begin(), now->forms.end(), [](const Form* f) { return f->line; });
  return now != nullptr && !line && detection.p > detect_p ? nullptr : now;
}

}  // namespace filum::reconcile
