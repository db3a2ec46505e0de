// tip-hold has no input, so nothing is simulated against it: a still tip leaves white noise on a slow polynomial, and effects are
// told apart where they stand in the spectrum. Power in a band is judged by Whittle's likelihood (Whittle 1953): for N periodogram
// values of mean q times the white level, 2 log L rises by 2 N (q - 1 - log q). A line has all of it in one bin, tremor has a band.

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/rng.h"
#include "reconcile/hold_spectrum.h"
#include "reconcile/search.h"

namespace filum::reconcile {
namespace {

constexpr HoldRules kRules;

/// The band between 7.5 and 12.5 Hz that stands out most.
Band tremor_band(const std::vector<Spectrum>& all) {
  Band best;
  const double around = std::max(0.5, 0.5 * (level(all, 3.5, 6.5) + level(all, 13.5, 18.0)));
  for (const double half : {0.2, 0.4, 0.8, 1.4, 2.0})
    for (double f = 7.8; f <= 12.2; f += 0.1) {
      const Band b = band(all, f - half, f + half, around);
      if (b.evidence > best.evidence) best = b;
    }
  return best;
}

struct Found {
  Effect effect;
  const Form* form = nullptr;
  double low, high, frequency, power, evidence;  // power: squared rms [m2] of one record and output
  int bins;
};

void add_line(const Fitter& fitter, const Fit& base, const Form& form, double low, double high, const std::vector<Spectrum>& all, std::vector<Found>& found) {
  const Line line = strongest_line(fitter, base, low, high);
  if (line.gain < line.columns + kRules.line_spread * std::sqrt(2.0 * line.columns) + kRules.line_gain) return;
  // at the edge of its band it is the skirt of what lies beyond
  if (form.effect == Effect::pulsation && std::min(line.frequency - low, high - line.frequency) < all[0].step) return;
  const double w = 2.5 * all[0].step;
  const double rate = all[0].rate;
  double at = std::fmod(line.frequency, rate);  // where it appears when folded
  if (at > 0.5 * rate) at = rate - at;
  const double around = level(all, std::max(0.05, at - 12 * w), at + 12 * w);
  const Band narrow = band(all, at - w, at + w, around), wide = band(all, std::max(0.0, at - 10 * w), at + 10 * w, around);
  if (narrow.excess < kRules.line_share * wide.excess) return;  // a band, not a line
  found.push_back({form.effect, &form, at - w, at + w, line.frequency, squared_rms(all, at - w, at + w, around), line.gain, narrow.bins});
}

/// What least squares leaves of a record when sine and cosine of these frequencies are free.
double left_without(const Eigen::VectorXd& time, const std::vector<double>& frequencies, Eigen::VectorXd& r) {
  const auto m = 2 * static_cast<Eigen::Index>(frequencies.size());
  Eigen::MatrixXd B(r.size(), m);
  Eigen::VectorXd y = r;
  for (Eigen::Index n = 0; n < r.size(); ++n) {
    const bool there = std::isfinite(r[n]);
    if (!there) y[n] = 0.0;
    for (Eigen::Index k = 0; k < m; k += 2) {
      const double phase = 6.283185307179586 * frequencies[static_cast<std::size_t>(k / 2)] * (time[n] - time[0]);
      B(n, k) = there ? std::cos(phase) : 0.0;
      B(n, k + 1) = there ? std::sin(phase) : 0.0;
    }
  }
  const Eigen::MatrixXd A = B.transpose() * B;
  r -= B * (A + 1e-9 * A.trace() * Eigen::MatrixXd::Identity(m, m)).ldlt().solve(B.transpose() * y);
  double sum = 0.0;
  for (const double v : r)
    if (std::isfinite(v)) sum += v * v;
  return sum;
}

/// The records without the lines that were found, so that what leaks from a strong line is not taken for something left over. A beat is no
/// pure sine: its second and third harmonic belong to it.
Fit without_lines(const Dataset& d, const Fit& base, const std::vector<Found>& found) {
  Fit out = base;
  for (std::size_t i = 0; i < out.residual.size(); ++i)
    for (Eigen::VectorXd& r : out.residual[i])
      for (const Found& f : found) {
        if (f.form == nullptr) continue;
        const double span = d.trials[i].time[d.trials[i].samples() - 1] - d.trials[i].time[0];
        Eigen::VectorXd best = r;
        double least = 1e300;
        for (int k = -4; k <= 4; ++k) {  // the line was found on a grid of 0.3/span
          const double at = f.frequency + 0.05 * k / span;
          Eigen::VectorXd trial = r;
          const double sum = left_without(d.trials[i].time, f.effect == Effect::pulsation ? std::vector<double>{at, 2 * at, 3 * at} : std::vector<double>{at}, trial);
          if (sum < least) least = sum, best = trial;
        }
        r = best;
      }
  return out;
}

/// Hum at 50 or 60 Hz. Sampled at nearly that rate it is folded to where heart and breath are: then it must stand in what they leave, or it is the skirt of theirs.
void add_hum(const Fitter& fitter, const Fit& base, const Form& form, const std::vector<Spectrum>& all, std::vector<Found>& found) {
  std::vector<Found> both;
  const auto look = [&](const Fit& in) {
    both.clear();
    for (const double f : {50.0, 60.0}) add_line(fitter, in, form, f - 0.2, f + 0.2, all, both);
    std::stable_sort(both.begin(), both.end(), [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
  };
  look(base);
  std::vector<Found> stronger;
  for (const Found& f : found)
    if (!both.empty() && f.evidence > both[0].evidence && std::abs(std::abs(std::remainder(both[0].frequency, all[0].rate)) - f.frequency) < 8.0 * all[0].step) stronger.push_back(f);
  if (!stronger.empty()) look(without_lines(fitter.model().data(), base, stronger));
  if (!both.empty()) found.push_back(both[0]);
}

/// Power beside what was named, in octaves: what nobody explains.
Band leftover(const std::vector<Spectrum>& all, const std::vector<Found>& found) {
  Band worst;
  std::vector<Spectrum> rest = all;
  for (Spectrum& s : rest)
    for (const Found& f : found)
      for (std::size_t k = s.power.size(); k-- > 0;)
        if (s.frequency[k] >= f.low - 2 * s.step && s.frequency[k] <= f.high + 2 * s.step)
          s.power.erase(s.power.begin() + static_cast<std::ptrdiff_t>(k)), s.frequency.erase(s.frequency.begin() + static_cast<std::ptrdiff_t>(k));
  const double top = all[0].frequency.back();
  for (double f = std::max(0.12, 4.0 * all[0].step); f < top; f *= 1.6) {
    const Band b = band(rest, f, std::min(top, 1.6 * f), 1.0);
    if (b.evidence > worst.evidence) worst = b;
  }
  return worst;
}

std::vector<Spectrum> spectra(const RigModel& model, const Fit& base, const std::vector<double>& sigma, bool held) {
  std::vector<Spectrum> all;
  const Dataset& d = model.data();
  for (std::size_t i = 0; i < base.residual.size(); ++i)
    if (!base.residual[i].empty() && d.trials[i].hold_out == held)
      for (std::size_t c = 0; c < base.residual[i].size(); ++c) all.push_back(spectrum(base.residual[i][c], d.trials[i].time, sigma[c]));
  return all;
}

Gap gap_in(const std::vector<Spectrum>& all, const std::vector<Found>& found) {
  double before = 0.0, after = 0.0;
  for (const Spectrum& s : all)
    for (std::size_t k = 0; k < s.power.size(); ++k) {
      const bool named = std::any_of(found.begin(), found.end(), [&](const Found& f) { return s.frequency[k] >= f.low && s.frequency[k] <= f.high; });
      before += s.power[k];
      after += named ? std::min(1.0, s.power[k]) : s.power[k];
    }
  double n = 0;
  for (const Spectrum& s : all) n += static_cast<double>(s.power.size());
  return n > 0 ? Gap{std::sqrt(before / n), std::sqrt(after / n)} : Gap{};
}

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
    return first.second >= kRules.clipped_least && first.second > kRules.clipped_share * static_cast<double>(y.size()) && first.second > kRules.clipped_times * std::max(1, second.second);
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
  std::vector<double> stated;
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
    stated[c] = noise.output[c].sigma;
  }
  fitter.set_noise(noise);
  const auto all = spectra(model, base, stated, false), held = spectra(model, base, stated, true);
  Fit fitted = base;
  for (std::size_t i = 0; i < d.trials.size(); ++i)
    if (d.trials[i].hold_out) fitted.residual[i].clear();
  std::vector<Found> found;
  say("lines and bands", 0.1);
  const bool fast = all[0].frequency.back() > 12.0;
  const Band t = tremor_band(all);
  for (const Form& f : r.forms)
    if (f.line && f.effect != Effect::mains_hum) add_line(fitter, fitted, f, f.params[0].low, f.params[0].high, all, found);
  for (const Form& f : r.forms)
    if (f.effect == Effect::mains_hum) add_hum(fitter, fitted, f, all, found);
  // heart and breath are one effect: the stronger gives the numbers
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
  const bool alias = std::any_of(found.begin(), found.end(), [&](const Found& f) { return f.effect == Effect::mains_hum && f.low < t.high && f.high > t.low; });
  if (fast && !alias && t.evidence > kRules.tremor_gain && t.mean > kRules.tremor_power * t.background && t.top_share < kRules.tremor_top && t.centre > kRules.tremor_low && t.centre < kRules.tremor_high)
    found.push_back({Effect::physiological_tremor, nullptr, t.low - 0.6, t.high + 0.6, closing_frequency(all, t), tremor_power(spectra(model, without_lines(d, fitted, found), stated, false), t), t.evidence, t.bins});
  for (const std::string& output : d.outputs)
    for (const Trial& trial : d.trials)
      if (const auto limit = trial.hold_out || !r.effects.empty() ? std::nullopt : clipped_at(trial.at(output))) r.effects.push_back({Effect::saturation, "clipped", {*limit}});
  say("amplitudes", 0.5);
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
  say("what is left", 0.8);
  const Band left = leftover(spectra(model, without_lines(d, base, found), stated, false), found);
  const double detrended = std::sqrt(squared_rms(all, left.low, left.high, 1.0));
  const bool unexplained = left.evidence > kRules.left_gain && left.mean > kRules.left_power && detrended > r.rules.materiality * model.full_scale(d.outputs[0]);
  r.fit = gap_in(all, found);
  r.held_out = held.empty() ? r.fit : gap_in(held, found);
  r.held_out_how = held.empty() ? "no trial is held out: the same bands on the fitted ones" : "trials marked hold_out";
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
  if (!r.effects.empty() && (share > kRules.named_share || found.empty())) {
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
                  left.low, left.high, left.mean, 100 * kRules.named_share);
    r.sentence = text;
  } else {
    r.verdict = "agree";
    char text[240];
    std::snprintf(text, sizeof text, "A still tip, a slow drift and white noise explain the records. A band or a line with %.1f times the noise's power over an octave, in these or in longer records, would change this.", kRules.left_power);
    r.sentence = text;
  }
  if (r.verdict == "effect")
    for (const Found& f : found) add_cells(d, all, f.low, f.high, level(all, std::max(0.05, f.low - 3.0), f.high + 3.0), r.where);
  if (r.verdict == "unknown") {
    add_cells(d, all, left.low, left.high, 1.0, r.where);
    char text[60];
    std::snprintf(text, sizeof text, "%.3g Hz <= f <= %.3g Hz", left.low, left.high);
    r.shape.push_back({text, left.mean, stability(spectra(model, without_lines(d, base, found), stated, false), found, left, d.outputs.size())});
  }
  share_out(r.where);
  if (r.verdict != "agree") r.where_by = localise_by(model, fitted, noise);
  return r;
}

}  // namespace filum::reconcile
