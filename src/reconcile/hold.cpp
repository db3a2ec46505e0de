// tip-hold has no input, so nothing is simulated against it: a still tip leaves white noise on a slow polynomial, and effects are
// told apart where they stand in the spectrum. Power in a band is judged by Whittle's likelihood (Whittle 1953): for N periodogram
// values of mean q times the white level, 2 log L rises by 2 N (q - 1 - log q). A line has all of it in one bin, tremor has a band.

#include <Eigen/Dense>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <map>

#include "reconcile/search.h"

namespace filum::reconcile {
namespace {

struct Spectrum {
  std::vector<double> frequency, power;  // [Hz], periodogram over the white level: mean 1
  double sigma = 1.0;                    // [m]
  double step = 1.0;
  int n = 0;
  double rate = 1.0;                     // [Hz], of the samples
};

/// Of one record and output, residual of the polynomial. sigma <= 0: taken from the median of the bins above 1.5 Hz outside the tremor band.
Spectrum spectrum(const Eigen::VectorXd& residual, const Eigen::VectorXd& time, double sigma) {
  Spectrum s;
  std::vector<double> x;
  for (const double v : residual) x.push_back(std::isfinite(v) ? v : 0.0);
  const auto n = x.size();
  s.n = static_cast<int>(n);
  const double span = (time[time.size() - 1] - time[0]) * static_cast<double>(n) / static_cast<double>(n - 1);
  s.step = 1.0 / span;
  s.rate = static_cast<double>(n) / span;
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> out;
  fft.fwd(out, x);
  std::vector<double> quiet;
  for (std::size_t k = 1; k < n / 2; ++k) {
    s.frequency.push_back(static_cast<double>(k) / span);
    s.power.push_back(std::norm(out[k]) / static_cast<double>(n));
    const double f = s.frequency.back();
    if (f > 1.5 && (f < 6.0 || f > 14.0)) quiet.push_back(s.power.back());
  }
  if (quiet.size() < 8) quiet = s.power;
  const double median_level = median(quiet) / std::log(2.0);
  s.sigma = sigma > 0 ? sigma : std::sqrt(median_level);
  for (double& p : s.power) p /= s.sigma * s.sigma;
  return s;
}

struct Band {
  double low = 0, high = 0, mean = 1, background = 1, evidence = 0, centre = 0, top_share = 0, excess = 0;
  int bins = 0;
};

/// Power between two frequencies over all spectra, against `background`.
Band band(const std::vector<Spectrum>& all, double low, double high, double background) {
  Band b{low, high, 0, background, 0, 0, 0, 0, 0};
  double weighted = 0.0, top = 0.0;
  for (const Spectrum& s : all) {
    double most = 0.0;
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= low && s.frequency[k] <= high) {
        b.mean += s.power[k];
        weighted += s.power[k] * s.frequency[k];
        most = std::max(most, s.power[k]);
        ++b.bins;
      }
    top += most;
  }
  if (b.bins == 0) return b;
  b.centre = weighted / b.mean;
  b.top_share = top / b.mean;
  b.mean /= b.bins;
  const double q = b.mean / background;
  b.excess = (b.mean - background) * b.bins;
  b.evidence = q > 1.0 ? 2.0 * b.bins * (q - 1.0 - std::log(q)) : 0.0;
  return b;
}

double level(const std::vector<Spectrum>& all, double low, double high) {
  std::vector<double> p;
  for (const Spectrum& s : all)
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= low && s.frequency[k] <= high) p.push_back(s.power[k]);
  return p.empty() ? 1.0 : median(p) / std::log(2.0);
}

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

/// Squared rms in [m2] that a band holds above its background.
double squared_rms(const std::vector<Spectrum>& all, double low, double high, double background) {
  double sum = 0.0;
  for (const Spectrum& s : all) {
    double p = 0.0;
    for (std::size_t k = 0; k < s.power.size(); ++k)
      if (s.frequency[k] >= low && s.frequency[k] <= high) p += (s.power[k] - background) * s.sigma * s.sigma;
    sum += 2.0 * p / s.n;
  }
  return std::max(0.0, sum / static_cast<double>(all.size()));
}

void add_line(const Fitter& fitter, const Fit& base, const Form& form, double low, double high, const std::vector<Spectrum>& all, std::vector<Found>& found) {
  const Line line = strongest_line(fitter, base, low, high);
  if (line.gain < line.columns + 4.5 * std::sqrt(2.0 * line.columns) + 14.0) return;
  // at the edge of its band it is the skirt of what lies beyond
  if (form.effect == Effect::pulsation && std::min(line.frequency - low, high - line.frequency) < all[0].step) return;
  const double w = 2.5 * all[0].step;
  const double rate = all[0].rate;
  double at = std::fmod(line.frequency, rate);  // where it appears when folded
  if (at > 0.5 * rate) at = rate - at;
  const double around = level(all, std::max(0.05, at - 12 * w), at + 12 * w);
  const Band narrow = band(all, at - w, at + w, around), wide = band(all, std::max(0.0, at - 10 * w), at + 10 * w, around);
  if (narrow.excess < 0.6 * wide.excess) return;  // a band, not a line
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

/// Amplitude of a line by least squares at its own frequency, mean over records and outputs with weight; near half the sampling rate
/// one of sine and cosine is hardly seen, and the weight says so.
Estimate line_amplitude(const Dataset& d, const Fit& base, const Noise& noise, double frequency) {
  double sum = 0.0, weight = 0.0, spread = 0.0;
  std::vector<std::pair<double, double>> all;
  for (std::size_t i = 0; i < base.residual.size(); ++i)
    for (std::size_t c = 0; c < base.residual[i].size(); ++c) {
      Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
      Eigen::Vector2d b = Eigen::Vector2d::Zero();
      for (Eigen::Index n = 0; n < base.residual[i][c].size(); ++n) {
        if (!std::isfinite(base.residual[i][c][n])) continue;
        const double phase = 6.283185307179586 * frequency * (d.trials[i].time[n] - d.trials[i].time[0]);
        const Eigen::Vector2d v(std::cos(phase), std::sin(phase));
        A += v * v.transpose();
        b += v * base.residual[i][c][n];
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(A);
      const double least = eigen.eigenvalues()[0];
      if (least <= 1e-6 * A.trace()) continue;
      const double w = least / std::pow(noise.output[c].sigma, 2), a = A.ldlt().solve(b).norm();
      all.emplace_back(a, w);
      sum += w * a;
      weight += w;
    }
  if (weight <= 0.0) return {"amplitude", "m", 0.0, 0.0, INFINITY};
  const double mean = sum / weight;
  for (const auto& [a, w] : all) spread += w * (a - mean) * (a - mean) / weight;
  const double half = 1.4 * 1.96 * std::sqrt(1.0 / weight + spread / static_cast<double>(all.size())) + 0.02 * mean;
  return {"amplitude", "m", mean, std::max(0.0, mean - half), mean + half};
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

/// A top that many samples share is a clipped one.
bool clipped(const Eigen::VectorXd& y) {
  std::map<double, int> counts;
  for (const double v : y)
    if (std::isfinite(v)) ++counts[v];
  if (counts.size() < 12) return false;
  const auto edge = [&](int first, int second) { return first >= 6 && first > 0.01 * static_cast<double>(y.size()) && first > 4 * std::max(1, second); };
  return edge(counts.rbegin()->second, std::next(counts.rbegin())->second) || edge(counts.begin()->second, std::next(counts.begin())->second);
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
  Result r;
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
    for (std::size_t i = 0; i < d.trials.size(); ++i) levels.push_back(spectrum(base.residual[i][c], d.trials[i].time, 0.0).sigma);
    if (stated[c] <= 0 || median(levels) > stated[c]) noise.output[c].sigma = median(levels);
    stated[c] = noise.output[c].sigma;
  }
  fitter.set_noise(noise);
  const auto all = spectra(model, base, stated, false), held = spectra(model, base, stated, true);
  Fit fitted = base;
  for (std::size_t i = 0; i < d.trials.size(); ++i)
    if (d.trials[i].hold_out) fitted.residual[i].clear();
  std::vector<Found> found;
  const bool fast = all[0].frequency.back() > 12.0;
  const Band t = tremor_band(all);
  for (const Form& f : r.forms) {
    if (!f.line) continue;
    if (f.effect == Effect::mains_hum) {
      std::vector<Found> both;
      add_line(fitter, fitted, f, 49.8, 50.2, all, both);
      add_line(fitter, fitted, f, 59.8, 60.2, all, both);
      std::stable_sort(both.begin(), both.end(), [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
      if (!both.empty()) found.push_back(both[0]);
    } else {
      add_line(fitter, fitted, f, f.params[0].low, f.params[0].high, all, found);
    }
  }
  // heart and breath are one effect: the stronger gives the numbers
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.evidence > b.evidence; });
  const bool alias = std::any_of(found.begin(), found.end(), [&](const Found& f) { return f.effect == Effect::mains_hum && f.low < t.high && f.high > t.low; });
  if (fast && !alias && t.evidence > 25.0 && t.mean > 1.15 * t.background && t.top_share < 0.8 && t.centre > 7.6 && t.centre < 12.4)
    found.push_back({Effect::physiological_tremor, nullptr, t.low - 0.6, t.high + 0.6, closing_frequency(all, t), squared_rms(all, t.low - 1.5, t.high + 1.5, t.background), t.evidence, t.bins});
  for (std::size_t c = 0; c < d.outputs.size(); ++c)
    for (const Trial& trial : d.trials)
      if (clipped(trial.at(d.outputs[c])) && r.effects.empty())
        r.effects.push_back({Effect::saturation, "clipped", {{"limit", "m", trial.at(d.outputs[c]).maxCoeff(), trial.at(d.outputs[c]).maxCoeff(), trial.at(d.outputs[c]).maxCoeff()}}});
  for (const Found& f : found) {
    Tried tried{{f.effect}, "", -f.evidence, 1.0, true, "taken"};
    if (std::none_of(r.effects.begin(), r.effects.end(), [&](const NamedEffect& e) { return e.effect == f.effect; })) r.effects.push_back(named(f, line_amplitude(d, base, noise, f.frequency)));
    r.tried.push_back(tried);
  }
  if (t.evidence > 4.0 && std::none_of(found.begin(), found.end(), [](const Found& f) { return f.effect == Effect::physiological_tremor; }))
    r.tried.push_back({{Effect::physiological_tremor}, "", -t.evidence, 0.0, false, "no band of random phase between 8 and 12 Hz stands out enough"});
  const Band left = leftover(spectra(model, without_lines(d, base, found), stated, false), found);
  const double detrended = std::sqrt(squared_rms(all, left.low, left.high, 1.0));
  const bool unexplained = left.evidence > 45.0 && left.mean > 1.25 && detrended > r.rules.materiality * model.full_scale(d.outputs[0]);
  r.fit = gap_in(all, found);
  r.held_out = held.empty() ? r.fit : gap_in(held, found);
  r.held_out_how = held.empty() ? "no trial is held out: the same bands on the fitted ones" : "trials marked hold_out";
  r.noise = noise;
  r.before = r.after = base;
  r.partial = !r.effects.empty() && unexplained;
  r.structure_before = left.evidence;
  const double share = [&] {
    double named_power = 0.0;
    for (const Found& f : found) named_power += f.power;
    return named_power / std::max(1e-300, named_power + (unexplained ? detrended * detrended : 0.0));
  }();
  if (!r.effects.empty() && (share > 0.3 || found.empty())) {
    r.verdict = "effect";
    std::string list;
    for (const NamedEffect& e : r.effects) list += (list.empty() ? "" : " + ") + info(e.effect).name;
    r.sentence = "The tip moves as if " + list + " acted. A record with the forearm supported, or the sensor on a fixed tip, would confirm it.";
  } else if (unexplained) {
    r.effects.clear();
    r.partial = false;
    r.verdict = "unknown";
    char text[160];
    std::snprintf(text, sizeof text, "Between %.2g and %.2g Hz there is %.1f times the noise's power that no effect of the catalogue explains.", left.low, left.high, left.mean);
    r.sentence = text;
  } else {
    r.verdict = "agree";
    r.sentence = "A still tip, a slow drift and white noise explain the records.";
  }
  if (r.verdict != "agree")
    for (const Found& f : found) {
      char text[60];
      std::snprintf(text, sizeof text, "%.3g Hz <= f <= %.3g Hz", f.low, f.high);
      r.where.push_back({d.trials[0].file, "hold", text, 1.0 / static_cast<double>(found.size())});
    }
  if (r.verdict == "unknown") {
    char text[60];
    std::snprintf(text, sizeof text, "%.3g Hz <= f <= %.3g Hz", left.low, left.high);
    r.where.push_back({d.trials[0].file, "hold", text, 1.0});
    r.shape.push_back({text, left.mean, 1.0});
  }
  return r;
}

}  // namespace filum::reconcile
