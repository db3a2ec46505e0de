// tip-hold has no input, so nothing is simulated against it: a still tip leaves white noise on a slow polynomial, and effects are
// told apart where they stand in the spectrum. Power in a band is judged by Whittle's likelihood (Whittle 1953): for N periodogram
// values of mean q times the white level, 2 log L rises by 2 N (q - 1 - log q). A line has all of it in one bin, tremor has a band.

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/rng.h"
#include "reconcile/hold_bands.h"
#include "reconcile/hold_check.h"
#include "reconcile/search.h"

namespace filum::reconcile {
namespace {


/// What a sine of this frequency takes off chi-squared beside the slow polynomial, and its amplitude: mean over records and outputs with weight; folded
/// to nearly nothing, or near half the sampling rate, it is hardly seen, and the weight says so.
struct LineFit {
  double gain = 0.0, amplitude = 0.0, half = INFINITY;  // half: of the interval [m]
};
LineFit line_fit(const Dataset& d, const Fit& base, const Noise& noise, double frequency) {
  LineFit out;
  double sum = 0.0, weight = 0.0, spread = 0.0;
  std::vector<std::pair<double, double>> all;
  for (std::size_t i = 0; i < base.residual.size(); ++i)
    for (std::size_t c = 0; c < base.residual[i].size(); ++c) {
      Eigen::Matrix<double, 6, 6> N = Eigen::Matrix<double, 6, 6>::Zero();
      Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero(), v;
      const Eigen::VectorXd &r = base.residual[i][c], &time = d.trials[i].time;
      for (Eigen::Index n = 0; n < r.size(); ++n) {
        if (!std::isfinite(r[n])) continue;
        const double since = time[n] - time[0], phase = 6.283185307179586 * frequency * since, u = 2.0 * since / (time[time.size() - 1] - time[0]) - 1.0;
        v << std::cos(phase), std::sin(phase), 1.0, u, 1.5 * u * u - 0.5, (2.5 * u * u - 1.5) * u;
        N += v * v.transpose();
        right += v * r[n];
      }
      const Eigen::Matrix<double, 4, 2> slow = N.bottomRightCorner<4, 4>().ldlt().solve(N.bottomLeftCorner<4, 2>());
      const Eigen::Matrix2d A = N.topLeftCorner<2, 2>() - N.topRightCorner<2, 4>() * slow;
      const Eigen::Vector2d b = right.head<2>() - slow.transpose() * right.tail<4>();
      const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(A).eigenvalues()[0], variance = std::pow(noise.output[c].sigma, 2);
      if (!(least > 1e-6 * N.trace())) continue;
      const Eigen::Vector2d x = A.ldlt().solve(b);
      out.gain += x.dot(b) / variance;
      all.emplace_back(x.norm(), least / variance);
      sum += all.back().first * all.back().second;
      weight += all.back().second;
    }
  if (weight <= 0.0) return out;
  out.amplitude = sum / weight;
  for (const auto& [a, w] : all) spread += w * (a - out.amplitude) * (a - out.amplitude) / weight;
  out.half = 1.4 * 1.96 * std::sqrt(1.0 / weight + spread / static_cast<double>(all.size())) + 0.02 * out.amplitude;
  return out;
}

/// Amplitude at the frequency that takes most off; the interval holds those of all frequencies that do nearly as well. `frequency` was found on a grid of
/// 0.3/span, between whose points a sine loses up to 4 % of its amplitude (sin x/x), and is brought to the best; folded to a few cycles a record it is sought wider.
Estimate line_amplitude(const Dataset& d, const Fit& base, const Noise& noise, double& frequency) {
  double span = 1e-300, rate = 1.0;
  for (const Trial& t : d.trials) span = std::max(span, t.time[t.samples() - 1] - t.time[0]), rate = (t.samples() - 1) / (t.time[t.samples() - 1] - t.time[0]);
  const double folded = std::abs(std::remainder(frequency, 0.5 * rate)) * span;  // from nothing or half the rate [1/span]
  const double step = folded < 5.0 ? 0.05 : 0.02;
  const int reach = folded < 5.0 ? 60 : 20;
  std::vector<std::pair<double, LineFit>> near;
  for (int k = -reach; k <= reach; ++k) near.emplace_back(frequency + step * k / span, line_fit(d, base, noise, frequency + step * k / span));
  const auto best = std::max_element(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.second.gain < b.second.gain; });
  const LineFit& top = best->second;
  if (!std::isfinite(top.half)) return {"amplitude", "m", 0.0, 0.0, INFINITY};
  Estimate e{"amplitude", "m", top.amplitude, top.amplitude - top.half, top.amplitude + top.half};
  for (const auto& [f, fit] : near)
    if (fit.gain > top.gain - 3.84 && std::isfinite(fit.half)) e.low = std::min(e.low, fit.amplitude - fit.half), e.high = std::max(e.high, fit.amplitude + fit.half);
  e.low = std::max(0.0, e.low);
  frequency = best->first;
  return e;
}

/// Squared rms [m2] of tremor: all power from 2 to 20 Hz above the white noise beyond. Tremor is mechanical resonance driven by muscle noise (Lakie et al.,
/// J. Physiol. 593:4411, 2015), whose skirts reach far beyond the band that shows it, below the peak as far as rest.
double tremor_power(const std::vector<Spectrum>& all, const Band& t) {
  const double top = all[0].frequency.back();
  if (top < 26.0) return squared_rms(all, t.low - 1.5, t.high + 1.5, t.background);
  return squared_rms(all, 2.0, 20.0, level(all, 20.0, top));
}

NamedEffect named(const Found& f, const Estimate& line) {
  const double rms = std::sqrt(f.power), share = 1.96 / std::sqrt(std::max(2.0, 2.0 * f.bins));
  const double width = 0.5 * (f.high - f.low) / std::sqrt(std::max(1.0, 0.5 * f.bins));
  NamedEffect out{f.effect, "", {{"frequency", "Hz", f.frequency, f.frequency - 1.96 * width, f.frequency + 1.96 * width}}};
  if (f.effect == Effect::physiological_tremor) {
    out.form = "narrow band of random phase";
    const double few = std::max(1.6 * share, 0.06);  // neighbouring bins of a narrow band are not independent
    out.parameters.push_back({"rms", "m", rms, rms * (1.0 - few), rms * (1.0 + few)});
  } else {
    out.form = f.form->text;
    out.parameters.push_back(line);
  }
  return out;
}

std::vector<NotTestable> hold_lint(const Dataset& d) {
  std::vector<NotTestable> out = {
      {Effect::sensor_lag, "nothing is prescribed, so nothing can lag", "a tip moved by a known stage"},
      {Effect::sensor_drift, "a slow drift is part of the still hand and of the baseline", "a sensor on a fixed tip"}};
  double rate = 1e300, span = 0.0;
  for (const Trial& t : d.trials) {
    const double length = t.time[t.samples() - 1] - t.time[0];
    rate = std::min(rate, (t.samples() - 1) / length);
    span = std::max(span, length);
  }
  if (rate < 24.0) out.push_back({Effect::physiological_tremor, "sampled more slowly than twice 12 Hz", info(Effect::physiological_tremor).shows});
  if (span < 5.0) out.push_back({Effect::pulsation, "records shorter than 5 s", info(Effect::pulsation).shows});
  return out;
}

/// The limit of a record whose top or bottom many samples share, within half the step to the next value.
std::optional<Estimate> clipped_at(const Eigen::VectorXd& y) {
  std::map<double, int> counts;
  for (const double v : y)
    if (std::isfinite(v)) ++counts[v];
  if (counts.size() < 12) return std::nullopt;
  const auto edge = [&](const auto& first, const auto& second) {
    return first.second >= kHoldRules.clipped_least && first.second > kHoldRules.clipped_share * static_cast<double>(y.size()) && first.second > kHoldRules.clipped_times * std::max(1, second.second);
  };
  const auto limit = [](const auto& first, const auto& second) {
    const double half = 0.5 * std::abs(first.first - second.first);
    return Estimate{"limit", "m", first.first, first.first - half, first.first + half};
  };
  if (edge(*counts.rbegin(), *std::next(counts.rbegin()))) return limit(*counts.rbegin(), *std::next(counts.rbegin()));
  if (edge(*counts.begin(), *std::next(counts.begin()))) return limit(*counts.begin(), *std::next(counts.begin()));
  return std::nullopt;
}

/// Share of 30 resamplings of the records (with their outputs together) in which the same octave has most power left.
double stability(const std::vector<Spectrum>& all, const std::vector<Found>& found, const Band& left, std::size_t outputs) {
  constexpr int kRounds = 30;
  Rng rng(20261123);
  int same = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Spectrum> drawn;
    for (std::size_t i = 0; i < all.size() / outputs; ++i) {
      const auto from = all.begin() + static_cast<std::ptrdiff_t>(outputs * rng.below(all.size() / outputs));
      drawn.insert(drawn.end(), from, from + static_cast<std::ptrdiff_t>(outputs));
    }
    const Band again = leftover(drawn, found);
    same += again.low < left.high && again.high > left.low && std::abs(std::log(again.low / left.low)) < 0.1 ? 1 : 0;
  }
  return same / static_cast<double>(kRounds);
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

double closing_frequency(const std::vector<Spectrum>& all, const Band& b) {
  double sum = 0.0, weight = 0.0;
  for (const Spectrum& s : all)
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= b.low && s.frequency[k] <= b.high) sum += s.frequency[k] * (s.power[k] - b.background), weight += s.power[k] - b.background;
  return weight > 0 ? std::clamp(sum / weight, b.low, b.high) : b.centre;
}

}  // namespace

Result reconcile_hold(const Dataset& d, const RigModel& model, const Options& options) {
  const auto say = [&](const char* stage, double share) {
    stop_if_cancelled(options);
    if (options.progress) options.progress(stage, share);
  };
  Result r;
  say("baseline", 0.0);
  r.rules = options.rules;
  r.forms = model.all_forms();
  r.not_testable = hold_lint(d);
  Noise noise;
  std::vector<double> stated, given;
  std::vector<Screened> looked;
  for (const std::string& name : d.outputs) {
    stated.push_back(d.channel(name).noise);
    noise.output.push_back({stated.back() > 0 ? stated.back() : 0.02 * model.full_scale(name), 0.0, model.full_scale(name), stated.back() > 0 ? "stated" : "fast part"});
  }
  Fitter fitter(model, noise);
  fitter.use.assign(d.trials.size(), true);
  Fit base = fitter.fit({}, {}, {});
  for (std::size_t c = 0; c < stated.size(); ++c) {
    std::vector<double> levels;
    for (std::size_t i = 0; i < d.trials.size(); ++i)
      if (!d.trials[i].hold_out) levels.push_back(spectrum(base.residual[i][c], d.trials[i].time, 0.0).sigma);
    if (stated[c] <= 0 || median(levels) > stated[c]) noise.output[c].sigma = median(levels);
    given.push_back(std::max(0.0, stated[c]));
    stated[c] = noise.output[c].sigma;
  }
  fitter.set_noise(noise);
  const auto all = spectra(d, base, stated, false), held = spectra(d, base, stated, true);
  Fit fitted = base;
  for (std::size_t i = 0; i < d.trials.size(); ++i)
    if (d.trials[i].hold_out) fitted.residual[i].clear();
  std::vector<Found> found;
  say("lines and bands", 0.1);
  const bool fast = all[0].frequency.back() > 12.0;
  const Band t = tremor_band(all);
  for (const Form& f : r.forms)
    if (f.line && f.effect != Effect::mains_hum) add_line(fitter, fitted, f, f.params[0].low, f.params[0].high, all, found, &looked);
  for (const Form& f : r.forms)
    if (f.effect == Effect::mains_hum) add_hum(fitter, fitted, f, all, found, &looked);
  // heart and breath are one effect: the stronger gives the numbers
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
  const bool alias = std::any_of(found.begin(), found.end(), [&](const Found& f) { return f.effect == Effect::mains_hum && f.low < t.high && f.high > t.low; });
  const auto say_tremor = [&](const char* what) { looked.push_back({Effect::physiological_tremor, "narrow band of random phase", t.evidence, NAN, what}); };
  if (fast && !alias && t.evidence > kHoldRules.tremor_gain && t.mean > kHoldRules.tremor_power * t.background && t.top_share < kHoldRules.tremor_top && t.centre > kHoldRules.tremor_low && t.centre < kHoldRules.tremor_high) {
    found.push_back({Effect::physiological_tremor, nullptr, t.low - 0.6, t.high + 0.6, closing_frequency(all, t), tremor_power(spectra(d, without_lines(d, fitted, found), stated, false), t), t.evidence, t.bins});
    say_tremor("fitted");
  } else if (fast) {
    say_tremor(alias ? "not fitted: the hum is folded to where its band would be" : "not fitted: no band of random phase between 8 and 12 Hz stands out enough");
  }
  for (const std::string& output : d.outputs)
    for (const Trial& trial : d.trials)
      if (const auto limit = trial.hold_out || !r.effects.empty() ? std::nullopt : clipped_at(trial.at(output))) r.effects.push_back({Effect::saturation, "clipped", {*limit}});
  looked.push_back({Effect::saturation, "clipped", NAN, NAN, r.effects.empty() ? "not fitted: no top or bottom is shared by many samples" : "fitted"});
  say("amplitudes", 0.4);
  for (Found& f : found) {
    Tried tried{{f.effect}, "", -f.evidence, 1.0, true, "taken"};
    if (std::none_of(r.effects.begin(), r.effects.end(), [&](const NamedEffect& e) { return e.effect == f.effect; })) {
      std::vector<Found> others;
      for (const Found& o : found)
        if (o.effect != f.effect) others.push_back(o);
      const Estimate line = f.form == nullptr ? Estimate{} : line_amplitude(d, without_lines(d, fitted, others), noise, f.frequency);
      r.effects.push_back(named(f, line));
    }
    r.tried.push_back(tried);
  }
  if (t.evidence > 4.0 && std::none_of(found.begin(), found.end(), [](const Found& f) { return f.effect == Effect::physiological_tremor; }))
    r.tried.push_back({{Effect::physiological_tremor}, "", -t.evidence, 0.0, false, "no band of random phase between 8 and 12 Hz stands out enough"});
  say("what is left", 0.6);
  const Band left = leftover(spectra(d, without_lines(d, base, found), stated, false), found);
  const double detrended = std::sqrt(squared_rms(all, left.low, left.high, 1.0));
  const bool unexplained = left.evidence > kHoldRules.left_gain && left.mean > kHoldRules.left_power && detrended > r.rules.materiality * model.full_scale(d.outputs[0]);
  r.fit = gap_in(all, found);
  const auto halves = held.empty() ? gap_of_halves(d, noise, found) : std::nullopt;
  r.held_out = !held.empty() ? gap_in(held, found) : halves ? *halves : r.fit;
  r.held_out_how = !held.empty() ? "trials marked hold_out" : halves ? "no trial is held out: the places of what is named are taken from one half of every record and judged in the other, both ways (the names are from the whole)"
                                                                    : "no trial is held out, and half a record is too short: the same bands on the fitted ones";
  say("repetitions", 0.7);
  r.detection = detect_hold(d, fitted, noise, given, options);
  stop_if_cancelled(options);
  r.screened = screened_hold(r, looked);
  r.noise = noise;
  r.before = base;
  r.after = without_lines(d, base, found);  // a band of random phase has no curve: it stays in what is left
  r.partial = !r.effects.empty() && unexplained;
  r.structure_before = left.evidence;
  const double share = [&] {
    double named_power = 0.0;
    for (const Found& f : found) named_power += f.power;
    return named_power / std::max(1e-300, named_power + (unexplained ? detrended * detrended : 0.0));
  }();
  if (!r.effects.empty() && (share > kHoldRules.named_share || found.empty())) {
    r.verdict = "effect";
    std::string list;
    for (const NamedEffect& e : r.effects) list += (list.empty() ? "" : " + ") + info(e.effect).name;
    r.sentence = "The tip moves as if " + list + " acted. A record with the forearm supported, or the sensor on a fixed tip, would confirm it.";
  } else if (unexplained) {
    r.effects.clear();
    r.partial = false;
    r.verdict = "unknown";
    char text[300];
    std::snprintf(text, sizeof text, "Between %.2g and %.2g Hz there is %.1f times the noise's power that no effect of the catalogue explains. A line or a band of the catalogue with %.0f %% of all power named would change this.",
                  left.low, left.high, left.mean, 100 * kHoldRules.named_share);
    r.sentence = text;
  } else {
    r.verdict = "agree";
    char text[240];
    std::snprintf(text, sizeof text, "A still tip, a slow drift and white noise explain the records. A band or a line with %.1f times the noise's power over an octave, in these or in longer records, would change this.", kHoldRules.left_power);
    r.sentence = text;
  }
  if (r.verdict == "effect")
    for (const Found& f : found) add_cells(d, all, f.low, f.high, level(all, std::max(0.05, f.low - 3.0), f.high + 3.0), r.where);
  if (r.verdict == "unknown") {
    add_cells(d, all, left.low, left.high, 1.0, r.where);
    char text[60];
    std::snprintf(text, sizeof text, "%.3g Hz <= f <= %.3g Hz", left.low, left.high);
    r.shape.push_back({text, left.mean, stability(spectra(d, without_lines(d, base, found), stated, false), found, left, d.outputs.size())});
  }
  share_out(r.where);
  if (r.verdict != "agree") r.where_by = localise_by(model, fitted, noise);
  return r;
}

}  // namespace filum::reconcile
