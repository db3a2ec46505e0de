#include "reconcile/hold_screen.h"
#include "reconcile/thin.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace filum::reconcile {
namespace {

/// The limit of a record whose top or bottom many samples share, within half the step to the next value.
std::optional<Estimate> clipped_at(const Eigen::VectorXd& y, const HoldScreenOptions& options) {
  std::map<double, int> counts;
  for (const double v : y)
    if (std::isfinite(v)) ++counts[v];
  if (counts.size() < 12) return std::nullopt;
  const auto edge = [&](const auto& first, const auto& second) {
    return first.second >= options.clipped_least && first.second > options.clipped_share * static_cast<double>(y.size()) && first.second > options.clipped_times * std::max(1, second.second);
  };
  const auto limit = [](const auto& first, const auto& second) {
    const double half = 0.5 * std::abs(first.first - second.first);
    return Estimate{"limit", "m", first.first, first.first - half, first.first + half};
  };
  if (edge(*counts.rbegin(), *std::next(counts.rbegin()))) return limit(*counts.rbegin(), *std::next(counts.rbegin()));
  if (edge(*counts.begin(), *std::next(counts.begin()))) return limit(*counts.begin(), *std::next(counts.begin()));
  return std::nullopt;
}

std::optional<NamedEffect> clipped_record(const Dataset& d, const HoldScreenOptions& options) {
  for (const std::string& output : d.outputs)
    for (const Trial& trial : d.trials)
      if (const auto limit = trial.hold_out ? std::nullopt : clipped_at(trial.at(output), options)) return NamedEffect{Effect::saturation, "clipped", {*limit}};
  return std::nullopt;
}

/// Squared rms [m2] of tremor: all power from 2 to 20 Hz above the white noise beyond. Tremor is mechanical resonance driven by muscle noise (Lakie et al.,
/// J. Physiol. 593:4411, 2015), whose skirts reach far beyond the band that shows it, below the peak as far as rest.
double tremor_power(const std::vector<Spectrum>& all, const Band& t) {
  const double top = all[0].frequency.back();
  if (top < 26.0) return squared_rms(all, t.low - 1.5, t.high + 1.5, t.background);
  return squared_rms(all, 2.0, 20.0, level(all, 20.0, top));
}

double closing_frequency(const std::vector<Spectrum>& all, const Band& b) {
  double sum = 0.0, weight = 0.0;
  for (const Spectrum& s : all)
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= b.low && s.frequency[k] <= b.high) sum += s.frequency[k] * (s.power[k] - b.background), weight += s.power[k] - b.background;
  return weight > 0 ? std::clamp(sum / weight, b.low, b.high) : b.centre;
}

bool is_tremor(const Band& t, const HoldScreenOptions& options) {
  return t.evidence > options.tremor_gain && t.mean > options.tremor_power * t.background && t.top_share < options.tremor_top && t.centre > options.tremor_low && t.centre < options.tremor_high;
}

/// The tremor's band beside the lines, which may be hum folded to where it would be.
void add_tremor(const HoldRecords& records, const HoldScreenOptions& options, HoldScreenSummary& out) {
  const Band& t = out.tremor;
  if (records.all[0].frequency.back() <= 12.0) return;
  const Dataset& d = records.fitter.model().data();
  const auto say_tremor = [&](const char* what) { out.looked.push_back({Effect::physiological_tremor, "narrow band of random phase", t.evidence, NAN, what}); };
  const bool alias = std::any_of(out.found.begin(), out.found.end(), [&](const Found& f) { return f.effect == Effect::mains_hum && f.low < t.high && f.high > t.low; });
  if (alias) return say_tremor("not fitted: the hum is folded to where its band would be");
  if (!is_tremor(t, options)) return say_tremor("not fitted: no band of random phase between 8 and 12 Hz stands out enough");
  const auto without = spectra(d, without_lines(d, records.fitted, out.found), records.sigma, false);
  out.found.push_back({Effect::physiological_tremor, nullptr, t.low - 0.6, t.high + 0.6, closing_frequency(records.all, t), tremor_power(without, t), t.evidence, t.bins});
  say_tremor("fitted");
}

}  // namespace

HoldScreenSummary screen_hold(const HoldRecords& records, const std::vector<Form>& forms, const HoldScreenOptions& options) {
  HoldScreenSummary out;
  out.tremor = tremor_band(records.all);
  for (const Form& f : forms)
    if (f.line && f.effect != Effect::mains_hum) add_line(records.fitter, records.fitted, f, f.params[0].low, f.params[0].high, records.all, options, out.found, &out.looked);
  for (const Form& f : forms)
    if (f.effect == Effect::mains_hum && !hum_is_gone(records.fitter.model().data())) add_hum(records.fitter, records.fitted, f, records.all, options, out.found, &out.looked);
  // heart and breath are one effect: the stronger gives the numbers
  std::stable_sort(out.found.begin(), out.found.end(), [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
  add_tremor(records, options, out);
  out.clipped = clipped_record(records.fitter.model().data(), options);
  out.looked.push_back({Effect::saturation, "clipped", NAN, NAN, out.clipped ? "fitted" : "not fitted: no top or bottom is shared by many samples"});
  return out;
}

}  // namespace filum::reconcile
