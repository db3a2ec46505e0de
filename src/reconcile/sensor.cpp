// Effects of the sensor, common to all rigs, in the order of a measuring chain: lag, drift, saturation; lines (pulsation, hum)
// and the slow polynomial of a hand are linear columns whose amplitudes every record has for itself.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reconcile/model.h"

namespace filum::reconcile {
namespace {

double interpolate(const Eigen::VectorXd& time, const Eigen::VectorXd& v, double t, Eigen::Index& at) {
  while (at + 1 < time.size() - 1 && time[at + 1] < t) ++at;
  if (t <= time[0]) return v[0];
  const double w = (t - time[at]) / (time[at + 1] - time[at]);
  return v[at] + std::min(w, 1.0) * (v[at + 1] - v[at]);
}

/// First-order low pass, exact for an input linear between samples: tau y' + y = x.
void low_pass(const Eigen::VectorXd& time, double tau, Eigen::Ref<Eigen::VectorXd> x) {
  double y = x[0], before = x[0];
  for (Eigen::Index n = 1; n < x.size(); ++n) {
    const double dt = time[n] - time[n - 1];
    const double q = dt / tau, decay = std::exp(-q);
    const double slope = (x[n] - before) / dt;
    // y = x - tau slope + C exp(-t/tau)
    y = x[n] - tau * slope + (y - before + tau * slope) * decay;
    before = x[n];
    x[n] = y;
  }
}

void apply_lag(const Trial& t, const Setting& s, Eigen::MatrixXd& out) {
  const double* p = s.on(Effect::sensor_lag);
  if (p == nullptr) return;
  const int kind = s.form(Effect::sensor_lag), only = kind / 3 - 1;  // -1: all outputs alike
  for (Eigen::Index c = 0; c < out.cols(); ++c) {
    if (only >= 0 && c != only) continue;
    if (kind % 3 != 1) {
      Eigen::VectorXd v = out.col(c);
      low_pass(t.time, kind % 3 == 0 ? p[0] : 0.5 * p[0], v);
      if (kind % 3 == 2) low_pass(t.time, 0.5 * p[0], v);
      out.col(c) = v;
    } else {
      const Eigen::VectorXd v = out.col(c);
      Eigen::Index at = 0;
      for (Eigen::Index n = 0; n < v.size(); ++n) out(n, c) = interpolate(t.time, v, t.time[n] - p[0], at);
    }
  }
}

void apply_drift(const Trial& t, const Setting& s, double start, Eigen::MatrixXd& out) {
  const double* p = s.on(Effect::sensor_drift);
  if (p == nullptr) return;
  const int channel = s.form(Effect::sensor_drift) / 2;
  for (Eigen::Index n = 0; n < out.rows(); ++n) {
    const double since = t.time[n] - start;
    out(n, channel) += s.form(Effect::sensor_drift) % 2 == 0 ? p[0] * since : p[0] * std::log1p(since / p[1]);
  }
}

void apply_saturation(const Setting& s, Eigen::MatrixXd& out) {
  const double* p = s.on(Effect::saturation);
  if (p == nullptr) return;
  auto v = out.col(s.form(Effect::saturation) / 3);
  switch (s.form(Effect::saturation) % 3) {
    case 0: v = v.array().min(std::abs(p[0])).max(-std::abs(p[0])); break;
    case 1: v = v.array().min(p[0]); break;
    default: v = v.array().max(p[0]); break;
  }
}

}  // namespace

double WallTable::Slice::at(double c, const std::vector<double>& of) const {
  if (of.size() < 2) return 0.0;
  if (c >= C.back()) return of.back() * c / C.back();
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, std::upper_bound(C.begin(), C.end(), c) - C.begin()));
  const double w = (c - C[i - 1]) / (C[i] - C[i - 1]);
  return (1.0 - w) * of[i - 1] + w * of[i];
}

double WallTable::at(double c, double stretch, std::vector<double> Slice::*of) const {
  if (slices.size() < 3) return slices.empty() ? 0.0 : slices[0].at(c, slices[0].*of);
  double sum = 0.0;
  for (const Slice& one : slices) {
    double weight = 1.0;
    for (const Slice& other : slices)
      if (&other != &one) weight *= (stretch - other.stretch) / (one.stretch - other.stretch);
    sum += weight * one.at(c, one.*of);
  }
  return sum;
}

double WallTable::Softened::at(double c, double most) const {
  if (top.size() < 2 || !(most > 0.0)) return 0.0;
  const auto place = [](const std::vector<double>& x, double v) {
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(std::upper_bound(x.begin(), x.end(), v) - x.begin(), 1, static_cast<std::ptrdiff_t>(x.size()) - 1));
    return std::pair(i, std::clamp((v - x[i - 1]) / (x[i] - x[i - 1]), 0.0, 1.0));
  };
  const auto [k, u] = place(top, most);
  const auto [m, v] = place(share, std::abs(c) / most);
  const auto line = [this, column = m, v = v](std::size_t row) { return (1.0 - v) * more[row * share.size() + column - 1] + v * more[row * share.size() + column]; };
  return (1.0 - u) * line(k - 1) + u * line(k);
}

void RigModel::simulate(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const {
  rig(t, s, out);
  sense(t, s, out);
}

void RigModel::sense(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const {
  apply_lag(t, s, out);
  if (has_gain()) out *= s.gain;
  for (Eigen::Index c = 0; s.instrument != nullptr && c < out.cols(); ++c) out.col(c) *= s.instrument[c];
  apply_drift(t, s, session_start(), out);
  apply_saturation(s, out);
}

Eigen::MatrixXd RigModel::free_columns(const Trial& t, const Setting& s) const {
  std::vector<double> lines;
  const auto add = [&](Effect e, int n) {
    const double* p = s.on(e);
    for (int i = 0; p != nullptr && i < n; ++i) lines.push_back(p[i]);
  };
  add(Effect::pulsation, s.form(Effect::pulsation) == 2 ? 2 : 1);
  if (const double* p = s.on(Effect::pulsation); p != nullptr && s.form(Effect::pulsation) == 3) lines.push_back(2.0 * p[0]);
  add(Effect::mains_hum, 1);
  const int order = free_polynomial();
  const Eigen::Index n = t.time.size();
  const double* lag = s.on(Effect::sensor_lag);
  const std::vector<int> tails = lag != nullptr && s.form(Effect::sensor_lag) % 3 == 0 ? drops(t) : std::vector<int>{};
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, order + 1 + 2 * static_cast<Eigen::Index>(lines.size()) + static_cast<Eigen::Index>(tails.size()));
  for (std::size_t i = 0; i < tails.size(); ++i)
    for (Eigen::Index k = tails[i]; k < n; ++k) columns(k, columns.cols() - 1 - static_cast<Eigen::Index>(i)) = std::exp((t.time[tails[i]] - t.time[k]) / lag[0]);
  const double half = 0.5 * (t.time[n - 1] - t.time[0]);
  const Eigen::ArrayXd x = (t.time.array() - t.time[0]) / half - 1.0;
  for (int k = 0; k <= order; ++k) columns.col(k) = x.pow(k);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Eigen::ArrayXd phase = 2.0 * std::numbers::pi * lines[i] * (t.time.array() - t.time[0]);
    columns.col(order + 1 + 2 * static_cast<Eigen::Index>(i)) = phase.cos();
    columns.col(order + 2 + 2 * static_cast<Eigen::Index>(i)) = phase.sin();
  }
  return columns;
}

double RigModel::full_scale(const std::string& output) const {
  std::vector<double> all;
  for (const Trial& t : data_.trials) {
    if (t.hold_out) continue;
    for (const double v : t.at(output))
      if (std::isfinite(v)) all.push_back(v);
  }
  std::sort(all.begin(), all.end());
  // quantiles, so that noise and single spikes do not set the scale
  const auto at = [&](double q) { return all[static_cast<std::size_t>(q * static_cast<double>(all.size() - 1))]; };
  return std::max(at(0.998) - at(0.002), 1e-300);
}

double RigModel::session_start() const {
  double start = data_.trials[0].time[0];
  for (const Trial& t : data_.trials) start = std::min(start, t.time[0]);
  return start;
}

std::vector<Form> RigModel::sensor_forms() const {
  std::vector<Form> out;
  const Dataset& d = data_;
  std::vector<double> steps, spans;
  bool clocked = true;
  for (const Trial& t : d.trials) {
    clocked = clocked && t.clocked;
    spans.push_back(t.time[t.samples() - 1] - t.time[0]);
    steps.push_back(spans.back() / (t.samples() - 1));
  }
  const double dt = median(steps), span = median(spans);
  if (clocked && has_scale()) {
    const std::vector<std::vector<double>> starts = {{dt}, {5 * dt}, {0.03 * span}};
    for (int c = d.outputs.size() > 1 ? -1 : 0; c < static_cast<int>(d.outputs.size()); ++c) {
      const int kind = d.outputs.size() > 1 ? 3 * (c + 1) : 0;
      const std::string which = c < 0 || kind == 0 ? "all outputs" : d.outputs[static_cast<std::size_t>(c)];
      out.push_back({Effect::sensor_lag, kind, "first-order low pass, " + which, {{"time_constant", "s", 0.02 * dt, 0.3 * span, true}}, starts, false});
      out.push_back({Effect::sensor_lag, kind + 2, "two equal low passes, " + which, {{"time_constant", "s", 0.02 * dt, 0.3 * span, true}}, starts, false});
      out.push_back({Effect::sensor_lag, kind + 1, "pure delay, " + which, {{"delay", "s", 0.02 * dt, 0.3 * span, true}}, starts, false});
    }
  }
  for (std::size_t c = 0; c < d.outputs.size(); ++c) {
    const std::string& name = d.outputs[c];
    const double fs = full_scale(name);
    const int at = static_cast<int>(c);
    std::string si = "-";
    for (const ChannelInfo& k : info(d.rig).channels) if (k.name == name) si = k.unit;
    if (name[0] == 'u' && d.rig == Rig::spatula_press) si.assign(1, 'm');
    if (clocked && has_scale()) {
      const double r = 3.0 * fs / span;
      out.push_back({Effect::sensor_drift, 2 * at, name + ": offset linear in time", {{"rate", si + "/s", -r, r, false}}, {{0.02 * r}}, false});
      out.push_back({Effect::sensor_drift, 2 * at + 1, name + ": offset logarithmic in time",
                     {{"rate", si, -fs, fs, false}, {"start", "s", 0.03 * dt, 10 * span, true}}, {{0.02 * fs, 0.03 * span}}, false});
    }
    double low = 1e300, high = -1e300;
    for (const Trial& t : d.trials) {
      if (t.hold_out) continue;
      for (const double v : t.at(name))
        if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    }
    const double peak = std::max(std::abs(low), std::abs(high));
    if (low < 0) out.push_back({Effect::saturation, 3 * at, name + ": clipped on both sides", {{"limit", si, 0.2 * peak, 1.3 * peak, false}}, {{0.98 * peak}, {0.9 * peak}, {0.75 * peak}, {0.55 * peak}}, false});
    // a limit of nothing is no limit of a sensor
    const double above = low < 0 ? std::max(high - 0.9 * fs, 0.05 * fs) : high - 0.9 * fs, below = std::min(low + 0.9 * fs, -0.05 * fs);
    if (high > 0.05 * fs) out.push_back({Effect::saturation, 3 * at + 1, name + ": clipped above", {{"limit", si, above, high + 0.3 * fs, false}}, {{high - 0.02 * fs}, {high - 0.1 * fs}, {high - 0.25 * fs}, {high - 0.45 * fs}}, false});
    if (low < -0.06 * fs) out.push_back({Effect::saturation, 3 * at + 2, name + ": clipped below", {{"limit", si, low - 0.3 * fs, below, false}}, {{low + 0.02 * fs}, {low + 0.1 * fs}, {low + 0.25 * fs}, {low + 0.45 * fs}}, false});
  }
  if (clocked) out.push_back({Effect::mains_hum, 0, "line near 50 or 60 Hz, free phase in every record", {{"frequency", "Hz", 49.0, 61.0, false}}, {}, true});
  return out;
}

std::vector<Form> RigModel::all_forms() const {
  std::vector<Form> out = forms();
  const auto own = effects_of(data_.rig);
  for (Form& f : sensor_forms())
    if (std::find(own.begin(), own.end(), f.effect) != own.end()) out.push_back(std::move(f));
  return out;
}

std::unique_ptr<RigModel> make_model(const Dataset& d) {
  switch (d.rig) {
    case Rig::tissue_block:
    case Rig::spatula_press: return make_tissue(d);
    case Rig::vessel_inflation: return make_vessel(d);
    case Rig::suture_cantilever: return make_cantilever(d);
    case Rig::suture_pull: return make_capstan(d);
    case Rig::needle_insertion: return make_needle(d);
    case Rig::forceps_bridge: return make_forceps(d);
    default: return make_hold(d);
  }
}

std::vector<std::vector<double>> grid(const std::vector<std::vector<double>>& axes) {
  std::vector<std::vector<double>> out = {{}};
  for (const auto& axis : axes) {
    std::vector<std::vector<double>> next;
    for (const auto& head : out)
      for (const double v : axis) {
        next.push_back(head);
        next.back().push_back(v);
      }
    out = std::move(next);
  }
  return out;
}

double median(std::vector<double> v) {
  if (v.empty()) return 0.0;
  const auto mid = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), mid, v.end());
  return *mid;
}

}  // namespace filum::reconcile
