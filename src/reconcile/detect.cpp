// Detection by parametric bootstrap (Davison & Hinkley 1997, ch. 4): repetitions in which the baseline is true, with the noise as it was
// estimated, scales of the records drawn anew and every parameter fitted again (linearly). Two statistics, each against its own maximum in
// the repetitions, so that the number of places and effects looked at costs nothing: the largest sum of the residual over a window, and the
// best score test of the whole catalogue. p is twice the smaller of the two (Bonferroni).

#include "reconcile/detect.h"

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

double best_score(const std::vector<ScoreTests::Direction>& directions, const std::vector<Eigen::VectorXd>& y) {
  double best = 0.0;
  for (const ScoreTests::Direction& d : directions) {
    double along = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) along += d.q[i].dot(y[i]);
    if (along < 0.0 || d.either_sign) best = std::max(best, along * along / d.seen);  // the residual falls as the effect grows
  }
  return best;
}

std::vector<ScoreTests::Direction> directions_of(const ScoreTests& tests, const std::vector<Form>& forms) {
  std::vector<ScoreTests::Direction> out;
  for (const Form& f : forms) {
    if (f.line) continue;
    for (const auto& start : f.starts) {
      out.push_back(tests.direction(f, start));
      if (out.back().seen <= 0.0) out.pop_back();
    }
  }
  return out;
}

double excess_of(const Candidates& sets) {
  double sum = 0.0;
  int n = 0;
  for (const auto& trial : sets.base().residual)
    for (std::size_t c = 0; c < trial.size(); ++c)
      for (const double r : trial[c]) {
        const OutputNoise& o = sets.fitter().noise().output[c];
        if (std::isfinite(r)) sum += (r * r - o.sigma * o.sigma) / (o.full_scale * o.full_scale), ++n;
      }
  return std::sqrt(std::max(0.0, n > 0 ? sum / n : 0.0));
}

}  // namespace

DetectSummary detect(const Candidates& sets, const DetectOptions& options) {
  const ScoreTests tests(sets.fitter(), sets.base());
  const std::vector<ScoreTests::Direction> directions = directions_of(tests, sets.forms());
  DetectSummary out;
  const Window seen = strongest_window(tests.residuals());
  const auto scores = tests.all(sets.forms());
  // what replicates differ by beyond the noise's own model counts as noise
  out.statistic = seen.value / std::sqrt(sets.dispersion());
  out.score = scores.empty() ? 0.0 : scores[0].gain / sets.dispersion();
  out.repetitions = options.repetitions;
  out.excess = excess_of(sets);
  Rng rng(20261121);
  int windows = 0, effects = 0;
  for (int i = 0; i < options.repetitions; ++i) {
    auto y = tests.repetition(rng);
    out.null_scores.push_back(best_score(directions, y));
    effects += out.null_scores.back() >= out.score ? 1 : 0;
    tests.refit(y);
    windows += strongest_window(y).value >= out.statistic ? 1 : 0;
  }
  out.p = std::min(1.0, 2.0 * (1.0 + std::min(windows, effects)) / (1.0 + options.repetitions));
  std::sort(out.null_scores.begin(), out.null_scores.end());
  if (tests.residuals().empty()) return out;
  const Trial& t = sets.fitter().model().data().trials[static_cast<std::size_t>(tests.trials()[seen.trial])];
  const auto at = [&](Eigen::Index k) { return t.time[k % t.time.size()]; };  // outputs stand one behind the other
  out.trial = t.file;
  out.from = at(seen.from);
  out.to = at(seen.from + seen.length);
  return out;
}

}  // namespace filum::reconcile
