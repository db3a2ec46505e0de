#include "reconcile/choose.h"

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

/// Where the smaller set is silent, its form cannot be to blame for what is left: the share of the larger set's gain that comes from those
/// samples. 0 where there are too few of them, or the gain there could be chance.
double where_silent(const Search& search, const Fit& smaller, const Fit& larger, const Rules& rules) {
  const Fitter& fitter = search.fitter();
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
        gain += (std::pow(smaller.white[i][at], 2) - std::pow(larger.white[i][at], 2)) / search.dispersion();
        ++silent;
      }
    }
  }
  if (silent < rules.silent_least * all || gain < rules.detect) return 0.0;
  return gain * search.dispersion() / std::max(smaller.chi2 - larger.chi2, 1e-300);
}

/// Chance that in a set where nothing is missing some effect does as well as this one: its score test (and no more than its fit bore out) among the
/// best ones of the repetitions, so that the number of effects, forms and starting points looked at is paid for.
double chance(const Search& search, const Fit& single, const Detection& detection, const std::vector<Score>& scores) {
  if (single.forms[0]->line) return search.line_p(*single.forms[0], search.base());
  double gain = 0.0;
  for (const Score& s : scores)
    if (s.form->effect == single.forms[0]->effect) gain = std::max(gain, s.gain);
  gain = std::min(gain, search.base().chi2 - single.chi2) / search.dispersion();
  const auto& null = detection.null_scores;
  const auto above = null.end() - std::lower_bound(null.begin(), null.end(), gain);
  return (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(null.size()));
}

/// Whether the share of the gap that the larger set explains beyond the smaller one is more than the smaller one's form could err by.
bool takes_a_part(const Search& search, const Fit& smaller, const Fit& larger, const Rules& rules) {
  const double already = search.explained(smaller), share = search.explained(larger) - already, material = search.material(larger, smaller);
  return share >= rules.pair_share || (share >= rules.pair_least && material >= rules.pair_material) ||
         (share >= rules.pair_clean && material >= 2.0 * rules.pair_material && share >= rules.pair_rest * (1.0 - already)) ||
         (material >= rules.pair_material && where_silent(search, smaller, larger, rules) >= rules.silent_share);
}

}  // namespace

std::vector<Effect> effects_in(const Fit& f) {
  std::vector<Effect> out;
  for (const Form* form : f.forms) out.push_back(form->effect);
  return out;
}

bool earns_its_place(const Search& search, const Fit& smaller, const Fit& larger, const Rules& rules) {
  return search.bic(smaller) - search.bic(larger) >= rules.pair_evidence && search.material(larger, smaller) >= 1.0 && takes_a_part(search, smaller, larger, rules);
}

const Fit* choose(const Search& search, const Rules& rules, Detection& detection) {
  const Fit* first = search.best(1);
  if (first != nullptr) detection.chance = chance(search, *first, detection, Screen(search.fitter(), search.base()).all(search.forms()));
  const Fit* now = nullptr;
  for (std::size_t size = 1; size <= static_cast<std::size_t>(rules.most_effects); ++size) {
    const Fit* next = search.best(size);
    if (next == nullptr) break;
    const Fit& before = now == nullptr ? search.base() : *now;
    const double fall = search.bic(before) - search.bic(*next);
    const double needed = now == nullptr ? rules.accept_evidence : rules.pair_evidence;
    bool enough = fall >= needed && (now != nullptr || (before.chi2 - next->chi2) / search.dispersion() >= rules.detect);
    // an instant read off the record is chosen among all: repetitions with the same instants do not know that
    if (size == 1 && next->forms[0]->instants == 0 && !next->at_bound) enough = enough || (detection.chance <= rules.accept_p && (fall > 0.0 || next->forms[0]->line));
    if (!enough || search.material(*next, before) < 1.0 || (now != nullptr && !takes_a_part(search, before, *next, rules))) {
      if (now == nullptr) continue;  // two effects may cancel in the test of singles
      break;
    }
    now = next;
  }
  return now;
}

}  // namespace filum::reconcile
