// Where the baseline misses: the residual's squares over the noise's variance, less one, summed over cells. What noise alone would make of a sum is known
// (variance 2 a sample, (1 + rho^2)/(1 - rho^2) times as much where neighbours are correlated), so each cell says how far it stands out.

#include "reconcile/localise.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>


#include "reconcile/transform.h"

namespace filum::reconcile {
namespace {

struct Sum {
  double excess = 0.0, variance = 0.0;
};

/// Cells of one axis, in the order of their bins.
using Axis = std::map<std::pair<int, std::string>, Sum>;

std::string first_input(const Dataset& d) {
  for (const Channel& c : d.channels)
    if (c.input && c.name != "time") return c.name;
  return "";
}

template <class... A>
std::string range_text(const char* format, A... values) {
  char out[80];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

/// What the trial does at each sample: rest, hold, load, unload.
std::vector<std::string> phases(const Trial& t, const Eigen::VectorXd& x) {
  const int n = t.samples();
  const double range = std::max(x.maxCoeff() - x.minCoeff(), 1e-300), span = t.time[n - 1] - t.time[0];
  std::vector<std::string> out;
  for (int k = 0; k < n; ++k) {
    const double rate = k > 0 ? (x[k] - x[k - 1]) / range / std::max((t.time[k] - t.time[k - 1]) / span, 1e-300) : 0.0;
    const double away = std::abs(x[k]) - (k > 0 ? std::abs(x[k - 1]) : 0.0);
    out.push_back(std::abs(rate) < 0.02 ? (std::abs(x[k]) < 0.05 * range ? "rest" : "hold") : away >= 0 ? "load" : "unload");
  }
  return out;
}

/// Rate of the input, over four samples to either side.
Eigen::VectorXd rates_of(const Trial& t, const Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  Eigen::VectorXd v(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index a = std::max<Eigen::Index>(0, k - 4), b = std::min(n - 1, k + 4);
    v[k] = std::abs(x[b] - x[a]) / (t.time[b] - t.time[a]);
  }
  return v;
}

/// Number of the cycle: a new one begins where the input leaves again after it had come back, by a tenth of its range.
std::vector<int> cycles(const Eigen::VectorXd& x) {
  const double least = 0.1 * (x.maxCoeff() - x.minCoeff());
  std::vector<int> out;
  double turn = std::abs(x[0]);
  bool back = false;
  int cycle = 1;
  for (const double v : x.cwiseAbs()) {
    if (back ? v > turn + least : v < turn - least) cycle += back ? 1 : 0, back = !back, turn = v;
    turn = back ? std::min(turn, v) : std::max(turn, v);
    out.push_back(cycle);
  }
  return out;
}

/// How the bins of an input and of its rate are cut, the same for all trials.
struct Bins {
  std::string name, unit;
  double low = INFINITY, high = -INFINITY, fastest = 0.0;  // in `unit`
  double scale = 1.0;                                      // SI of one unit
  bool strain = false;
  int parts = 4;                                           // of its range

  double of(const Trial& t, double x) const { return strain ? x / t.size("height", 1.0) : x / scale; }
  std::pair<int, std::string> value(double v) const {
    const int k = std::clamp(static_cast<int>(parts * (v - low) / (high - low)), 0, parts - 1);
    const double part = (high - low) / parts;
    return {k, range_text("%.3g to %.3g%s", low + k * part, low + (k + 1) * part, unit.c_str())};
  }
  std::pair<int, std::string> rate(double v) const {
    const double parts[] = {0.02, 0.1, 0.3, 1.0};
    for (int k = 0; k < 3; ++k)
      if (v < parts[k] * fastest) return {k, range_text("below %.2g%s/s", parts[k] * fastest, unit.c_str())};
    return {3, range_text("faster than %.2g%s/s", parts[2] * fastest, unit.c_str())};
  }
};

Bins bins_of(const Dataset& d, const std::string& input, int parts) {
  Bins b;
  b.parts = parts;
  const Channel& c = d.channel(input);
  b.strain = (d.rig == Rig::tissue_block || d.rig == Rig::spatula_press);
  b.name = b.strain ? "strain" : input;
  b.unit = b.strain || c.unit == "-" ? "" : " " + c.unit;
  b.scale = c.scale;
  std::vector<double> rates;
  for (const Trial& t : d.trials)
    for (Eigen::Index k = 0; k < t.time.size(); ++k) b.low = std::min(b.low, b.of(t, t.at(input)[k])), b.high = std::max(b.high, b.of(t, t.at(input)[k]));
  for (const Trial& t : d.trials)
    for (const double v : rates_of(t, t.at(input))) rates.push_back(b.of(t, v));
  const auto top = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() * 98 / 100);
  std::nth_element(rates.begin(), top, rates.end());
  b.fastest = *top;
  return b;
}

constexpr double kEdges[] = {0.1, 0.5, 3.0, 8.0, 12.0};  // [Hz], reference/discovery.md 2.5: breath, slow, heart, between, tremor, above

std::pair<int, std::string> band_of(double f) {
  int k = 0;
  while (k < 5 && f >= kEdges[k]) ++k;
  return {k, k == 0 ? "below 0.1 Hz" : k == 5 ? "above 12 Hz" : range_text("%.2g to %.2g Hz", kEdges[k - 1], kEdges[k])};
}

/// Periodogram of a residual over what the noise has there: mean 1, variance 1.
void add_bands(const Eigen::VectorXd& r, const OutputNoise& noise, double step, Axis& axis) {
  const auto out = transform(r / noise.sigma);
  const auto n = static_cast<double>(out.size());
  for (std::size_t k = 0; k < out.size() / 2; ++k) {
    const double f = static_cast<double>(k) / (n * step), colour = noise.spectrum(2.0 * std::numbers::pi * static_cast<double>(k) / n);
    Sum& s = axis[band_of(f)];
    s.excess += (k == 0 ? 1.0 : 2.0) * (std::norm(out[k]) / n - colour);
    s.variance += 4.0 * colour * colour;
  }
}

double sample_variance(const OutputNoise& o) {
  const double slow = (1.0 - o.white) * o.rho;  // twice the sum of the squared correlations over all lags
  return 2.0 + 4.0 * slow * slow / (1.0 - o.rho * o.rho);
}

void add_shares(const std::string& name, const Axis& axis, std::vector<Share>& out) {
  double all = 0.0;
  for (const auto& [bin, s] : axis) all += std::max(0.0, s.excess);
  if (axis.size() < 2 || all <= 0.0) return;  // one bin says nothing of where
  for (const auto& [bin, s] : axis) out.push_back({name, bin.second, std::max(0.0, s.excess) / all, s.excess / std::sqrt(s.variance)});
}

}  // namespace

std::vector<Share> shares_of(const RigModel& model, const Fit& base, const Noise& noise, const LocaliseOptions& options) {
  const Dataset& d = model.data();
  const std::string input = first_input(d);
  const Bins bins = input.empty() ? Bins{} : bins_of(d, input, options.parts);
  Axis trial, output, phase, value, rate, cycle, band;
  for (std::size_t i = 0; i < base.residual.size(); ++i) {
    if (base.residual[i].empty()) continue;
    const Trial& t = d.trials[i];
    const Eigen::VectorXd x = input.empty() ? Eigen::VectorXd::Zero(t.samples()) : t.at(input), v = rates_of(t, x);
    const auto what = phases(t, x);
    const auto turn = cycles(x);
    for (std::size_t c = 0; c < base.residual[i].size(); ++c) {
      const OutputNoise& o = noise.output[c];
      for (Eigen::Index k = 0; k < base.residual[i][c].size(); ++k) {
        const double r = base.residual[i][c][k], excess = r * r / (o.sigma * o.sigma) - 1.0;
        if (!std::isfinite(r)) continue;
        const auto put = [&](Axis& axis, const std::pair<int, std::string>& bin) {
          Sum& s = axis[bin];
          s.excess += excess;
          s.variance += sample_variance(o);
        };
        put(trial, {static_cast<int>(i), t.file});
        put(output, {static_cast<int>(c), d.outputs[c]});
        if (input.empty()) continue;
        const std::string& p = what[static_cast<std::size_t>(k)];
        put(phase, {p == "load" ? 0 : p == "hold" ? 1 : p == "unload" ? 2 : 3, p});
        if (bins.high > bins.low) put(value, bins.value(bins.of(t, x[k])));
        if (bins.fastest > 0.0 && t.clocked) put(rate, bins.rate(bins.of(t, v[k])));
        put(cycle, {turn[static_cast<std::size_t>(k)], std::to_string(turn[static_cast<std::size_t>(k)])});
      }
      if (t.clocked && t.samples() >= 16) add_bands(base.residual[i][c], o, (t.time[t.samples() - 1] - t.time[0]) / (t.samples() - 1), band);
    }
  }
  std::vector<Share> out;
  for (const auto& [name, axis] : {std::pair{std::string("trial"), &trial}, {"output", &output}, {"phase", &phase}, {bins.name, &value}, {"rate", &rate}, {"cycle", &cycle}, {"frequency", &band}}) add_shares(name, *axis, out);
  return out;
}

std::vector<Cell> cells_of(const RigModel& model, const Fit& base, const Noise& noise, const LocaliseOptions& options) {
  const Dataset& d = model.data();
  const std::string input = first_input(d);
  std::vector<Cell> cells;
  double total = 0.0;
  for (std::size_t i = 0; i < base.residual.size(); ++i) {
    if (base.residual[i].empty()) continue;
    const Trial& t = d.trials[i];
    const double t0 = t.time[0], span = t.time[t.samples() - 1] - t0, part = span / options.parts;
    const auto what = input.empty() ? std::vector<std::string>(static_cast<std::size_t>(t.samples()), "hold") : phases(t, t.at(input));
    std::map<std::pair<std::string, int>, double> excess;
    for (int k = 0; k < t.samples(); ++k)
      for (std::size_t c = 0; c < base.residual[i].size(); ++c) {
        const double r = base.residual[i][c][k];
        if (std::isfinite(r)) excess[{what[static_cast<std::size_t>(k)], std::min(options.parts - 1, static_cast<int>(options.parts * (t.time[k] - t0) / span))}] += std::pow(r / noise.output[c].sigma, 2) - 1.0;
      }
    for (const auto& [key, value] : excess) {
      if (value <= 0) continue;
      cells.push_back({t.file, key.first, range_text("%.4g s <= t <= %.4g s", t0 + key.second * part, t0 + (key.second + 1) * part), value});
      total += value;
    }
  }
  std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.share > b.share; });
  for (Cell& c : cells) c.share /= total;
  return cells;
}

LocaliseSummary localise(const RigModel& model, const Fit& base, const Noise& noise, const LocaliseOptions& options) {
  return {cells_of(model, base, noise, options), shares_of(model, base, noise, options)};
}

}  // namespace filum::reconcile
