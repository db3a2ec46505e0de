#include "reconcile/lines.h"

#include <algorithm>
#include <cmath>

#include "reconcile/in_step.h"

namespace filum::reconcile {
namespace {

/// Takes out the records in which slow sampling folds this line onto what is slow anyway, or onto a harmonic of the motion where its phase is the same in
/// every repetition: a line must be seen in the others. Whether there were any.
bool separate(const Fitter& fitter, Fit& from, const Line& line, const LineOptions& options) {
  const Dataset& d = fitter.model().data();
  std::vector<bool> out(d.trials.size()), harmonic(d.trials.size());
  for (std::size_t i = 0; i < d.trials.size() && i < from.residual.size(); ++i) {
    const Trial& t = d.trials[i];
    if (from.residual[i].empty()) continue;
    out[i] = folded(t, line.frequency) * (t.time[t.samples() - 1] - t.time[0]) < options.folded;
    harmonic[i] = !out[i] && on_harmonic(d, t, line.frequency, static_cast<int>(options.harmonics));
  }
  const Shared shared = shared_line(fitter, from, line.frequency, harmonic);
  const bool in_step = shared.saved == 0 || chi2_tail(shared.lost / line.background, shared.saved) > options.in_step;
  bool any = false;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i] || (harmonic[i] && in_step)) from.residual[i].clear(), any = true;
  return any;
}

/// Bands in which an effect's lines are looked for [Hz].
std::vector<std::pair<double, double>> bands_of(const Form& f, std::size_t line) {
  if (f.effect == Effect::mains_hum) return {{50.0 - assumed::kHumBand, 50.0 + assumed::kHumBand}, {60.0 - assumed::kHumBand, 60.0 + assumed::kHumBand}};
  return {{f.params[line].low, f.params[line].high}};
}

/// Strongest line of one of a form's frequencies that goes through two periods in the longest record: less is not told from what is slow.
Line line_of(const Fitter& fitter, const Form& f, std::size_t line, const Fit& from, const LineOptions& options) {
  Line best;
  double span = 0.0;
  for (const Trial& t : fitter.model().data().trials) span = std::max(span, t.time[t.samples() - 1] - t.time[0]);
  for (const auto& [lowest, high] : bands_of(f, line)) {
    const double low = std::max(lowest, assumed::kLinePeriods / span);
    if (low >= high) continue;
    Fit left = from;
    Line found = strongest_line(fitter, left, low, high);
    while (f.effect == Effect::mains_hum && found.gain > 0.0 && separate(fitter, left, found, options)) found = strongest_line(fitter, left, low, high);
    if (found.gain > best.gain) best = found;
  }
  return best;
}

/// Places in a band where a line may stand: two to each width of a record's own resolution.
double places(const Dataset& d, const Form& f, std::size_t line) {
  double span = 0.0, width = 0.0;
  for (const Trial& t : d.trials) span = std::max(span, t.time[t.samples() - 1] - t.time[0]);
  for (const auto& [low, high] : bands_of(f, line)) width += high - low;
  return 1.0 + 2.0 * width * span;
}

}  // namespace

double line_chance(const Fitter& fitter, const Fit& from, const Form& form, const LineOptions& options) {
  double gain = 0.0, looks = 1.0;
  int columns = 0;
  for (std::size_t k = 0; k < form.params.size(); ++k) {
    const Line line = line_of(fitter, form, k, from, options);
    if (places(fitter.model().data(), form, k) * chi2_tail(line.gain, line.columns) > options.seen) return 1.0;
    gain += line.gain;
    columns += line.columns;
    looks *= places(fitter.model().data(), form, k);
  }
  return std::min(1.0, looks * chi2_tail(gain, columns));
}

std::vector<Score> line_scores(const Fitter& fitter, const Fit& from, const std::vector<Form>& forms, double accept, const LineOptions& options) {
  std::vector<Score> out;
  for (const Form& f : forms) {
    if (!f.line || std::any_of(from.forms.begin(), from.forms.end(), [&](const Form* g) { return g->effect == f.effect; })) continue;
    if (line_chance(fitter, from, f, options) > accept) continue;
    Score s{&f, {}, 0.0, 1.0, 0.0, 0.0};
    for (std::size_t k = 0; k < f.params.size(); ++k) {
      const Line line = line_of(fitter, f, k, from, options);
      s.start.push_back(line.frequency);
      s.gain += line.gain;
    }
    s.seen = s.gain;
    out.push_back(std::move(s));
  }
  return out;
}

}  // namespace filum::reconcile
