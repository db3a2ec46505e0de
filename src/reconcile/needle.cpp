// needle-insertion: F = k depth until the puncture, then zero. No model foretells the puncture to the sample, so its instant is
// read off each record as the first drop of the force during insertion (matched step filter), samples beside it are left out, and
// puncture_force is k depth there. Layers: further drops, each the end of a ramp of its own.
//   friction  f * embedded length * direction (Okamura, Simone & O'Leary 2004)     drag  b v while in the tissue
#include <algorithm>
#include <cmath>

#include "reconcile/model.h"

namespace filum::reconcile {
namespace {

struct Events {
  std::vector<int> drops;       // sample of each drop, first the puncture
  int beside = 2;               // samples left out on either side
  Eigen::VectorXd direction;    // +1 inwards, -1 outwards, kept through rest
};

class Needle final : public RigModel {
 public:
  explicit Needle(const Dataset& d) : RigModel(d) {
    std::vector<int> counts;
    for (const Trial& t : d.trials) {
      events_.push_back(find(t));
      if (!t.hold_out) counts.push_back(static_cast<int>(events_.back().drops.size()));
      deepest_ = std::max(deepest_, t.at("depth").maxCoeff());
      if (t.has("speed")) fastest_ = std::max(fastest_, t.at("speed").cwiseAbs().maxCoeff());
    }
    std::sort(counts.begin(), counts.end());
    layers_ = counts[counts.size() / 2];
    for (int j = 0; j < layers_; ++j) {
      std::vector<double> depths;
      for (std::size_t i = 0; i < d.trials.size(); ++i)
        if (!d.trials[i].hold_out && static_cast<int>(events_[i].drops.size()) > j) depths.push_back(d.trials[i].at("depth")[events_[i].drops[static_cast<std::size_t>(j)]]);
      depth_.push_back(median(depths));
    }
  }

  std::vector<double> guess() const override {
    double up = 0.0, down = 0.0;
    for (std::size_t i = 0; i < data().trials.size(); ++i) {
      const Trial& t = data().trials[i];
      for (int n = 0; n < t.samples() && !t.hold_out && !punctured(i, n); ++n) {
        const double x = t.at("depth")[n], y = t.at("force")[n];
        if (x > 0 && std::isfinite(y)) up += x * y, down += x * x;
      }
    }
    const double k = down > 0 && up > 0 ? up / down : data().nominal.at("stiffness");
    return {k, depth_.empty() ? 10.0 * k * deepest_ : k * depth_[0]};
  }
  bool steps_in_time() const override { return false; }
  bool fitted(int parameter) const override { return parameter == 0; }
  Measured measured(int, const std::vector<double>& base, const std::vector<double>& scale) const override {
    std::vector<double> forces;
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (!events_[i].drops.empty() && i < scale.size()) forces.push_back(base[0] * scale[i] * data().trials[i].at("depth")[events_[i].drops[0]]);
    if (forces.empty()) return {base[1], 0.0, INFINITY};
    double mean = 0.0, var = 0.0;
    for (const double f : forces) mean += f / static_cast<double>(forces.size());
    for (const double f : forces) var += (f - mean) * (f - mean) / std::max<double>(1.0, static_cast<double>(forces.size()) - 1.0);
    const double half = 2.2 * std::sqrt(var / static_cast<double>(forces.size())) + 0.01 * mean;
    return {mean, mean - half, mean + half};
  }
  std::vector<int> drops(const Trial& t) const override { return events_[static_cast<std::size_t>(&t - data().trials.data())].drops; }
  bool masked(const Trial& t, int sample, int) const override {
    const Events& e = events_[static_cast<std::size_t>(&t - data().trials.data())];
    return std::any_of(e.drops.begin(), e.drops.end(), [&](int d) { return std::abs(sample - d) <= e.beside; });
  }

  void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const override;
  std::vector<Form> forms() const override;

 private:
  static Events find(const Trial& t);
  bool punctured(std::size_t trial, int n) const { return !events_[trial].drops.empty() && n >= events_[trial].drops[0]; }

  std::vector<Events> events_;
  std::vector<double> depth_;  // [m], of each layer: median over the records
  int layers_ = 0;
  double deepest_ = 1e-9, fastest_ = 1e-9;
};

Events Needle::find(const Trial& t) {
  Events e;
  const Eigen::VectorXd &x = t.at("depth"), &y = t.at("force");
  const int n = t.samples();
  e.direction.resize(n);
  double sign = 1.0;
  for (int i = 0; i < n; ++i) {
    const double v = t.has("speed") ? t.at("speed")[i] : (i > 0 ? x[i] - x[i - 1] : 1.0);
    if (v != 0.0) sign = v > 0 ? 1.0 : -1.0;
    e.direction[i] = sign;
  }
  // a layer gives way under a needle that advances; what falls when it stops is no rupture
  const double travel = (x.maxCoeff() - x.minCoeff()) / n;  // [m], a sample
  const auto advancing = [&](int i) { return i > 0 && e.direction[i] > 0 && x[i] - x[i - 1] > 0.1 * travel; };
  std::vector<double> steps;
  double low = 1e300, high = -1e300;
  for (int i = 0; i < n; ++i)
    if (std::isfinite(y[i])) {
      low = std::min(low, y[i]);
      high = std::max(high, y[i]);
      if (i > 0 && std::isfinite(y[i - 1])) steps.push_back(std::abs(y[i] - y[i - 1]));
    }
  const double sigma = 1.05 * median(steps), span = high - low;
  const int w = std::clamp(n / 60, 2, 8);
  Eigen::VectorXd fall = Eigen::VectorXd::Zero(n);
  for (int i = w; i + w < n; ++i) {
    if (!advancing(i - w + 1) || !advancing(i + w)) continue;
    std::vector<double> before, after;
    for (int k = 1; k <= w; ++k) {
      if (std::isfinite(y[i - k])) before.push_back(y[i - k]);
      if (std::isfinite(y[i + k])) after.push_back(y[i + k]);
    }
    if (!before.empty() && !after.empty()) fall[i] = median(before) - median(after);
  }
  const double least = std::max(4.5 * sigma / std::sqrt(static_cast<double>(w)), 0.12 * span);
  for (int i = w; i + w < n; ++i) {
    if (fall[i] < least) continue;
    bool top = true;
    for (int k = -2 * w; k <= 2 * w; ++k) {
      const int j = i + k;
      if (j >= 0 && j < n && (fall[j] > fall[i] || (fall[j] == fall[i] && j < i))) top = false;
    }
    if (top) {
      int at = i;  // the sample behind the steepest step
      double steepest = 0.0;
      for (int j = i - w; j <= i + w; ++j)
        if (j > 0 && y[j - 1] - y[j] > steepest) steepest = y[j - 1] - y[j], at = j;
      e.drops.push_back(at);
    }
  }
  e.beside = std::max(2, n / 300);
  return e;
}

void Needle::rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const {
  const auto trial = static_cast<std::size_t>(&t - data().trials.data());
  const bool known = trial < events_.size();
  const double *compliance = s.on(Effect::rig_compliance), *layer = s.on(Effect::layer_rupture), *friction = s.on(Effect::shaft_friction), *drag = s.on(Effect::viscous_drag);
  double k = s.base[0] * s.scale;
  if (compliance != nullptr) k /= 1.0 + k * compliance[0];
  out.resize(t.samples(), 1);
  const Eigen::VectorXd& x = t.at("depth");
  bool through = false;
  double hole = 0.0;  // [m], depth of the puncture
  double sign = 1.0;
  for (int n = 0; n < t.samples(); ++n) {
    const double v = t.has("speed") ? t.at("speed")[n] : 0.0;
    sign = known ? events_[trial].direction[n] : (v != 0.0 ? (v > 0 ? 1.0 : -1.0) : sign);
    if (!through && (known && !events_[trial].drops.empty() ? punctured(trial, n) : k * x[n] > s.base[1])) through = true, hole = x[n];
    double y = through || x[n] < 0 ? 0.0 : k * x[n];
    if (layer != nullptr && through) {
      double before = hole;
      for (int j = 1; j < layers_; ++j) {
        const bool own = known && static_cast<int>(events_[trial].drops.size()) > j;
        const double force = layer[j - 1] * s.scale, at = own ? x[events_[trial].drops[static_cast<std::size_t>(j)]] : depth_[static_cast<std::size_t>(j)];
        const bool whole = own ? n < events_[trial].drops[static_cast<std::size_t>(j)] : x[n] < at;
        const double length = s.form(Effect::layer_rupture) == 0 ? std::min(force / k, at - before) : at - before;
        if (whole && sign > 0 && length > 0) y += force * std::clamp(1.0 - (at - x[n]) / length, 0.0, 1.0);
        before = at;
      }
    }
    const bool in = x[n] > 0;
    if (friction != nullptr && in) {
      const int kind = s.form(Effect::shaft_friction);
      if (through || kind == 2) y += friction[0] * sign * (kind == 1 ? std::max(0.0, x[n] - hole) : x[n]);
    }
    if (drag != nullptr && in && (through || s.form(Effect::viscous_drag) == 1))
      y += drag[0] * v * (s.form(Effect::viscous_drag) == 2 ? x[n] / deepest_ : 1.0);
    out(n, 0) = y;
  }
}

std::vector<Form> Needle::forms() const {
  std::vector<Form> f;
  const double fs = full_scale("force");
  if (layers_ > 1) {
    std::vector<ParamSpec> p;
    std::vector<double> start;
    for (int j = 1; j < layers_; ++j) p.push_back({"force_" + std::to_string(j + 1), "N", 0.01 * fs, 3 * fs, true}), start.push_back(0.5 * fs);
    for (int j = 1; j < layers_; ++j) {
      const double at = depth_[static_cast<std::size_t>(j)];
      p.push_back({"depth_" + std::to_string(j + 1), "m", 0.999 * at, 1.001 * at, false});
      start.push_back(at);
    }
    int instants = 0;
    for (const Events& e : events_) instants += std::clamp(static_cast<int>(e.drops.size()), 1, layers_) - 1;
    f.push_back({Effect::layer_rupture, 0, "ramp of the tissue's stiffness before each further drop", p, {start}, false, false, instants});
    f.push_back({Effect::layer_rupture, 1, "ramp from the drop before", p, {start}, false, false, instants});
  }
  const double per = fs / deepest_;
  const ParamSpec length{"friction_per_length", "N/m", 1e-4 * per, 5 * per, true};
  const char* names[] = {"of the depth, after the puncture", "of the depth beyond the puncture", "of the depth, from the surface on"};
  for (int k = 0; k < 3; ++k) f.push_back({Effect::shaft_friction, k, names[k], {length}, {{0.1 * per}}, false});
  if (fastest_ > 1e-9) {
    const ParamSpec drag{"drag", "N.s/m", 1e-4 * fs / fastest_, 3 * fs / fastest_, true};
    const char* drags[] = {"after the puncture", "from the surface on", "growing with the depth"};
    for (int k = 0; k < 3; ++k) f.push_back({Effect::viscous_drag, k, drags[k], {drag}, {{0.1 * fs / fastest_}}, false});
  }
  const double c = deepest_ / fs;
  f.push_back({Effect::rig_compliance, 0, "spring in series", {{"compliance", "m/N", 1e-4 * c, 30 * c, true}}, {{0.1 * c}}, false});
  return f;
}

}  // namespace

std::unique_ptr<RigModel> make_needle(const Dataset& d) { return std::make_unique<Needle>(d); }

}  // namespace filum::reconcile
