#include "reconcile/hold_decide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/rng.h"

namespace filum::reconcile {
namespace {

/// Share of resamplings of the records (with their outputs together) in which the same octave has most power left.
double octave_stability(const std::vector<Spectrum>& all, const std::vector<Found>& found, const Band& left, std::size_t outputs, int rounds) {
  Rng rng(20261123);
  int same = 0;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Spectrum> drawn;
    for (std::size_t i = 0; i < all.size() / outputs; ++i) {
      const auto from = all.begin() + static_cast<std::ptrdiff_t>(outputs * rng.below(all.size() / outputs));
      drawn.insert(drawn.end(), from, from + static_cast<std::ptrdiff_t>(outputs));
    }
    const Band again = leftover(drawn, found);
    same += again.low < left.high && again.high > left.low && std::abs(std::log(again.low / left.low)) < 0.1 ? 1 : 0;
  }
  return same / static_cast<double>(rounds);
}

/// Power [m2] above the background that each record has between two frequencies.
void add_cells(const Dataset& d, const std::vector<Spectrum>& all, double low, double high, double background, std::vector<Cell>& cells) {
  std::size_t next = 0;
  for (const Trial& t : d.trials) {
    if (t.hold_out) continue;
    const std::vector<Spectrum> own(all.begin() + static_cast<std::ptrdiff_t>(next), all.begin() + static_cast<std::ptrdiff_t>(next + d.outputs.size()));
    next += d.outputs.size();
    char text[60];
    std::snprintf(text, sizeof text, "%.3g Hz <= f <= %.3g Hz", low, high);
    cells.push_back({t.file, "hold", text, squared_rms(own, low, high, background)});
  }
}

/// Powers into shares of their sum, the largest first.
void share_out(std::vector<Cell>& cells) {
  double sum = 1e-300;
  for (const Cell& c : cells) sum += c.share;
  for (Cell& c : cells) c.share /= sum;
  std::erase_if(cells, [](const Cell& c) { return c.share <= 0.0; });
  std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.share > b.share; });
}

std::string octave_text(const Band& b) {
  char text[60];
  std::snprintf(text, sizeof text, "%.3g Hz <= f <= %.3g Hz", b.low, b.high);
  return text;
}

std::vector<Spectrum> beside(const HoldRecords& records, const std::vector<Found>& found) {
  const Dataset& d = records.fitter.model().data();
  return spectra(d, without_lines(d, records.base, found), records.sigma, false);
}

/// The verdict in words.
void say_verdict(const HoldLeft& left, double named, const HoldDecideOptions& options, DecideSummary& r) {
  char text[300];
  if (!r.effects.empty() && named > options.named_share) {
    r.verdict = "effect";
    std::string list;
    for (const NamedEffect& e : r.effects) list += (list.empty() ? "" : " + ") + info(e.effect).name;
    r.sentence = "The tip moves as if " + list + " acted. A record with the forearm supported, or the sensor on a fixed tip, would confirm it.";
    return;
  }
  if (left.unexplained) {
    r.effects.clear();
    r.partial = false;
    r.verdict = "unknown";
    std::snprintf(text, sizeof text, "Between %.2g and %.2g Hz there is %.1f times the noise's power that no effect of the catalogue explains. A line or a band of the catalogue with %.0f %% of all power named would change this.",
                  left.band.low, left.band.high, left.band.mean, 100 * options.named_share);
  } else {
    r.verdict = "agree";
    std::snprintf(text, sizeof text, "A still tip, a slow drift and white noise explain the records. A band or a line with %.1f times the noise's power over an octave, in these or in longer records, would change this.", options.left_power);
  }
  r.sentence = text;
}

}  // namespace

HoldLeft left_beside(const HoldRecords& records, const std::vector<Found>& found, double materiality, const HoldDecideOptions& options) {
  const RigModel& model = records.fitter.model();
  HoldLeft out{leftover(beside(records, found), found), 0.0, false};
  out.rms = std::sqrt(squared_rms(records.all, out.band.low, out.band.high, 1.0));
  out.unexplained = out.band.evidence > options.left_gain && out.band.mean > options.left_power && out.rms > materiality * model.full_scale(model.data().outputs[0]);
  return out;
}

DecideSummary decide_hold(const HoldRecords& records, const std::vector<Found>& found, HoldFitSummary fitted, const HoldLeft& left, const HoldDecideOptions& options) {
  const Dataset& d = records.fitter.model().data();
  DecideSummary r;
  r.effects = std::move(fitted.effects);
  r.tried = std::move(fitted.tried);
  r.before = records.base;
  r.after = without_lines(d, records.base, found);  // a band of random phase has no curve: it stays in what is left
  r.gap = gap_in(records.all, found);
  r.structure_before = left.band.evidence;
  r.partial = !r.effects.empty() && left.unexplained;
  double named = 0.0;
  for (const Found& f : found) named += f.power;
  named /= std::max(1e-300, named + (left.unexplained ? left.rms * left.rms : 0.0));
  say_verdict(left, found.empty() ? 1.0 : named, options, r);
  r.units = check_units(d, r.baseline);
  return r;
}

LocaliseSummary localise_hold(const HoldRecords& records, const std::vector<Found>& found, const HoldLeft& left, const std::string& verdict, const LocaliseOptions& options) {
  const RigModel& model = records.fitter.model();
  LocaliseSummary out;
  if (verdict == "agree") return out;
  if (verdict == "effect")
    for (const Found& f : found) add_cells(model.data(), records.all, f.low, f.high, level(records.all, std::max(0.05, f.low - 3.0), f.high + 3.0), out.cells);
  else
    add_cells(model.data(), records.all, left.band.low, left.band.high, 1.0, out.cells);
  share_out(out.cells);
  out.by = shares_of(model, records.fitted, records.fitter.noise(), options);
  return out;
}

std::vector<Term> describe_hold(const HoldRecords& records, const std::vector<Found>& found, const HoldLeft& left, int resamplings) {
  const double stable = octave_stability(beside(records, found), found, left.band, records.fitter.model().data().outputs.size(), resamplings);
  return {{octave_text(left.band), left.band.mean, stable}};
}

}  // namespace filum::reconcile
