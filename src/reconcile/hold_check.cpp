#include "reconcile/hold_check.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "reconcile/structure.h"

namespace filum::reconcile {
namespace {

/// Residuals of one record's outputs over their noise, with the clock; NaN where a sample is missing.
struct Record {
  const Trial* trial = nullptr;
  std::vector<Eigen::VectorXd> white;
  std::vector<Eigen::MatrixXd> slow;  // orthonormal columns of the polynomial over the samples that are there
  std::vector<Spectrum> seen;         // over the noise as it was found
  std::vector<double> left;           // of white noise in the lowest bins, when the polynomial has taken its part
};

constexpr int kLowest = 6;  // bins of which the polynomial takes a part worth counting

Eigen::MatrixXd slow_columns(const Eigen::VectorXd& time, const Eigen::VectorXd& there) {
  Eigen::MatrixXd B(time.size(), 4);
  for (Eigen::Index n = 0; n < time.size(); ++n) {
    const double u = 2.0 * (time[n] - time[0]) / (time[time.size() - 1] - time[0]) - 1.0;
    B.row(n) << 1.0, u, 1.5 * u * u - 0.5, (2.5 * u * u - 1.5) * u;
    if (!std::isfinite(there[n])) B.row(n).setZero();
  }
  return Eigen::HouseholderQR<Eigen::MatrixXd>(B).householderQ() * Eigen::MatrixXd::Identity(time.size(), 4);
}

/// Shares of a sine's power at the lowest frequencies that the polynomial leaves.
std::vector<double> left_by(const Eigen::MatrixXd& slow) {
  std::vector<double> out;
  const Eigen::Index n = slow.rows();
  for (int k = 1; k <= kLowest; ++k) {
    Eigen::MatrixXd waves(n, 2);
    for (Eigen::Index i = 0; i < n; ++i) waves.row(i) << std::cos(6.283185307179586 * k * static_cast<double>(i) / static_cast<double>(n)), std::sin(6.283185307179586 * k * static_cast<double>(i) / static_cast<double>(n));
    out.push_back(1.0 - (slow.transpose() * waves).squaredNorm() / waves.squaredNorm());
  }
  return out;
}

std::vector<Record> records_of(const Dataset& d, const Fit& fitted, const Noise& noise) {
  std::vector<Record> out;
  for (std::size_t i = 0; i < fitted.residual.size(); ++i) {
    if (fitted.residual[i].empty()) continue;
    out.push_back({&d.trials[i], {}, {}, {}, {}});
    for (std::size_t c = 0; c < fitted.residual[i].size(); ++c) {
      out.back().white.push_back(fitted.residual[i][c] / noise.output[c].sigma);
      out.back().slow.push_back(slow_columns(d.trials[i].time, fitted.residual[i][c]));
      out.back().seen.push_back(spectrum(out.back().white[c], d.trials[i].time, 1.0));
    }
    out.back().left = left_by(out.back().slow[0]);
  }
  return out;
}

/// Residuals as a still tip would have left them: white noise less the polynomial.
std::vector<Record> repetition(const std::vector<Record>& seen, Rng& rng) {
  std::vector<Record> out;
  for (const Record& s : seen) {
    out.push_back({s.trial, s.white, {}, {}, {}});
    for (std::size_t c = 0; c < s.white.size(); ++c) {
      Eigen::VectorXd& y = out.back().white[c];
      Eigen::VectorXd whole(y.size());
      for (Eigen::Index n = 0; n < y.size(); ++n) whole[n] = std::isfinite(y[n]) ? rng.normal() : 0.0;
      whole -= s.slow[c] * (s.slow[c].transpose() * whole);
      for (Eigen::Index n = 0; n < y.size(); ++n)
        if (std::isfinite(y[n])) y[n] = whole[n];
    }
  }
  return out;
}

/// Their spectra: bins of white noise are independent and exponential (Brillinger 1981), the lowest less what the polynomial takes.
std::vector<Spectrum> drawn(const std::vector<Record>& seen, Rng& rng) {
  std::vector<Spectrum> out;
  for (const Record& s : seen)
    for (const Spectrum& like : s.seen) {
      out.push_back(like);
      for (std::size_t k = 0; k < like.power.size(); ++k) out.back().power[k] = -std::log(1.0 - rng.uniform()) * (k < s.left.size() ? s.left[k] : 1.0);
    }
  return out;
}

Window window_of(const std::vector<Record>& records) {
  std::vector<Eigen::VectorXd> all;
  for (const Record& r : records)
    for (const Eigen::VectorXd& y : r.white) all.push_back(y.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }));
  return strongest_window(all);
}

/// Rise of twice the log likelihood when all spectra have a line at one of their bins between two frequencies.
double best_line(const std::vector<Spectrum>& all, double low, double high) {
  double best = 0.0;
  for (double f = low; f <= high; f += all[0].step) {
    double power = 0.0;
    int bins = 0;
    for (const Spectrum& s : all) {
      const auto k = static_cast<std::ptrdiff_t>(std::lround(f / s.step)) - 1;  // the first bin is one step
      if (k >= 0 && k < static_cast<std::ptrdiff_t>(s.power.size())) power += s.power[static_cast<std::size_t>(k)], ++bins;
    }
    const double q = bins > 0 ? power / bins : 0.0;
    if (q > 1.0) best = std::max(best, 2.0 * bins * (q - 1.0 - std::log(q)));
  }
  return best;
}

/// The white level of one spectrum, from where neither tremor nor heart is.
double white_level(const Spectrum& s) {
  std::vector<double> quiet;
  for (std::size_t k = 0; k < s.power.size(); ++k)
    if (s.frequency[k] > 1.5 && (s.frequency[k] < 6.0 || s.frequency[k] > 14.0)) quiet.push_back(s.power[k]);
  return median(quiet.size() < 8 ? s.power : quiet) / std::log(2.0);
}

/// `all`: record after record, output after output, over the noise as found.
double best_band(std::vector<Spectrum> all, const std::vector<double>& stated) {
  for (std::size_t c = 0; c < stated.size(); ++c) {  // as the noise itself was found
    std::vector<double> own;
    for (std::size_t i = c; i < all.size(); i += stated.size()) own.push_back(std::sqrt(white_level(all[i])));
    const double level = stated[c] > 0.0 ? std::max(1.0, median(own)) : median(own);
    for (std::size_t i = c; i < all.size(); i += stated.size())
      for (double& p : all[i].power) p /= level * level;
  }
  double best = leftover(all, {}).evidence;
  const double rate = all[0].rate;
  for (const auto& [low, high] : {std::pair{0.15, 0.4}, {0.8, 2.0}}) best = std::max(best, best_line(all, low, high));
  for (const double mains : {50.0, 60.0})
    if (const double at = std::abs(std::remainder(mains, rate)); at > all[0].step) best = std::max(best, best_line(all, std::max(at - 0.2, all[0].step), at + 0.2));
  for (Spectrum& s : all) {  // the rest of the spectrum says nothing of the tremor's band
    const auto last = std::upper_bound(s.frequency.begin(), s.frequency.end(), 18.0) - s.frequency.begin(), first = std::lower_bound(s.frequency.begin(), s.frequency.end(), 3.5) - s.frequency.begin();
    s.frequency = {s.frequency.begin() + first, s.frequency.begin() + last};
    s.power = {s.power.begin() + first, s.power.begin() + last};
  }
  return rate > 24.0 ? std::max(best, tremor_band(all).evidence) : best;
}

/// One half of every record.
Dataset half_of(const Dataset& d, bool second) {
  Dataset out = d;
  for (Trial& t : out.trials) {
    const Eigen::Index n = t.time.size() / 2, from = second ? t.time.size() - n : 0;
    t.time = Eigen::VectorXd(t.time.segment(from, n));
    for (auto& [name, v] : t.data) v = Eigen::VectorXd(v.segment(from, n));
  }
  return out;
}

struct Half {
  explicit Half(const Dataset& d, bool second, const Noise& noise) : data(half_of(d, second)), model(make_model(data)), fitter(*model, noise) {
    for (const OutputNoise& o : noise.output) sigma.push_back(o.sigma);
    base = fitter.fit({}, {}, {});
    all = spectra(data, base, sigma, false);
  }
  Dataset data;
  std::unique_ptr<RigModel> model;
  Fitter fitter;
  Fit base;
  std::vector<double> sigma;
  std::vector<Spectrum> all;
};

/// Where a half alone puts what was found.
std::vector<Found> placed(const Half& half, const std::vector<Found>& found) {
  std::vector<Found> out;
  for (Found f : found) {
    const double width = f.high - f.low;
    double centre = 0.0;
    if (f.form == nullptr) {
      centre = tremor_band(half.all).centre;
    } else if (f.effect == Effect::mains_hum) {
      centre = strongest_line(half.fitter, half.base, f.frequency - 0.2, f.frequency + 0.2).frequency;
      centre = std::abs(std::remainder(centre, half.all[0].rate));
    } else {
      centre = strongest_line(half.fitter, half.base, f.form->params[0].low, f.form->params[0].high).frequency;
    }
    // half a record resolves half as well
    const double half_width = f.form == nullptr ? 0.5 * width : width;
    f.low = centre - half_width, f.high = centre + half_width;
    out.push_back(f);
  }
  return out;
}

}  // namespace

DetectSummary detect_hold(const HoldRecords& records, const HoldDetectOptions& options, const Run& run) {
  const Dataset& d = records.fitter.model().data();
  const Noise& noise = records.fitter.noise();
  const auto repetitions = static_cast<std::size_t>(options.repetitions);
  DetectSummary out;
  const std::vector<Record> seen = records_of(d, records.fitted, noise);
  const Window window = window_of(seen);
  out.statistic = window.value;
  std::vector<Spectrum> own;
  for (const Record& r : seen) own.insert(own.end(), r.seen.begin(), r.seen.end());
  out.score = best_band(own, records.stated);
  out.score_is = "largest rise of twice the log likelihood over an octave, the tremor's band or a line of heart, breath or mains";
  out.repetitions = options.repetitions;
  out.null_scores.resize(repetitions);
  std::vector<double> windows(repetitions);
  parallel(run.threads, repetitions, [&](std::size_t k) {
    stop_if_cancelled(run);
    Rng rng(20261123 + k);
    out.null_scores[k] = best_band(drawn(seen, rng), records.stated);
    windows[k] = window_of(repetition(seen, rng)).value;
  });
  const auto above = [](const std::vector<double>& all, double v) { return std::count_if(all.begin(), all.end(), [&](double x) { return x >= v; }); };
  const auto scores = above(out.null_scores, out.score);
  out.p = std::min(1.0, 2.0 * (1.0 + static_cast<double>(std::min(above(windows, out.statistic), scores))) / (1.0 + options.repetitions));
  out.chance = (1.0 + static_cast<double>(scores)) / (1.0 + options.repetitions);
  std::sort(out.null_scores.begin(), out.null_scores.end());
  double sum = 0.0;
  int n = 0;
  for (const auto& trial : records.fitted.residual)
    for (std::size_t c = 0; c < trial.size(); ++c)
      for (const double r : trial[c])
        if (std::isfinite(r)) sum += (r * r - std::pow(noise.output[c].sigma, 2)) / std::pow(noise.output[c].full_scale, 2), ++n;
  out.excess = std::sqrt(std::max(0.0, n > 0 ? sum / n : 0.0));
  const Trial& t = *seen[window.trial / d.outputs.size()].trial;
  out.trial = t.file;
  out.from = t.time[window.from];
  out.to = t.time[std::min(window.from + window.length, t.time.size() - 1)];
  return out;
}

namespace {

/// nullopt where a half has too few samples.
std::optional<Gap> gap_of_halves(const Dataset& d, const Noise& noise, const std::vector<Found>& found, int least) {
  for (const Trial& t : d.trials)
    if (t.samples() < least) return std::nullopt;
  const Half first(d, false, noise), second(d, true, noise);
  const Gap a = gap_in(second.all, placed(first, found)), b = gap_in(first.all, placed(second, found));
  const auto mean = [](double x, double y) { return std::sqrt(0.5 * (x * x + y * y)); };
  return Gap{mean(a.before, b.before), mean(a.after, b.after)};
}

}  // namespace

ChallengeSummary challenge_hold(const HoldRecords& records, const std::vector<Found>& found, const HoldChallengeOptions& options) {
  const Dataset& d = records.fitter.model().data();
  ChallengeSummary out;
  if (!records.held.empty()) {
    out.gap = gap_in(records.held, found);
    out.how = "trials marked hold_out";
  } else if (const auto halves = gap_of_halves(d, records.fitter.noise(), found, options.samples)) {
    out.gap = *halves;
    out.how = "no trial is held out: the places of what is named are taken from one half of every record and judged in the other, both ways (the names are from the whole)";
  } else {
    out.gap = gap_in(records.all, found);
    out.how = "no trial is held out, and half a record is too short: the same bands on the fitted ones";
  }
  return out;
}

std::vector<Screened> screened_hold(const LintSummary& lint, const std::vector<Screened>& looked) {
  std::vector<Screened> out;
  for (const Effect effect : effects_of(Rig::tip_hold)) {
    Screened s{effect, "", NAN, NAN, ""};
    for (const Screened& x : looked)
      if (x.effect == effect && (std::isnan(s.gain) || x.what == "fitted" || (x.gain > s.gain && s.what != "fitted"))) s = x;
    const auto hidden = std::find_if(lint.not_testable.begin(), lint.not_testable.end(), [&](const NotTestable& n) { return n.effect == effect; });
    if (s.what.empty()) s.what = hidden != lint.not_testable.end() ? "these trials could not show it: " + hidden->why : "not looked for";
    out.push_back(std::move(s));
  }
  std::stable_sort(out.begin(), out.end(), [](const Screened& a, const Screened& b) { return a.gain > b.gain || (!std::isnan(a.gain) && std::isnan(b.gain)); });
  return out;
}

}  // namespace filum::reconcile
