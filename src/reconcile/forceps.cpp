// forceps-bridge: the straight lines of a calibration, counts = offset + gain * value (devices/bridge_line.h, which the handle's counts are read with),
// and what bends them: temperature, a bridge's quadratic and cubic terms, play, cross-talk of grip force into the strain gauge.
// The play operator is that of Brokate & Sprekels 1996. Reference temperature: the mean of the record (the offset takes the rest).
#include <algorithm>
#include <cmath>

#include "devices/bridge_line.h"
#include "reconcile/model.h"

namespace filum::reconcile {
namespace {

class Forceps final : public RigModel {
 public:
  explicit Forceps(const Dataset& d) : RigModel(d) {
    double low = 1e9, high = -1e9, sum = 0.0;
    int n = 0;
    std::vector<double> spans;
    for (const Trial& t : d.trials) {
      angle_ = std::max(angle_, t.at("angle").cwiseAbs().maxCoeff());
      force_ = std::max(force_, t.at("grip_force").cwiseAbs().maxCoeff());
      spans.push_back(t.time[t.samples() - 1] - t.time[0]);
      if (!t.has("temperature")) continue;
      for (const double T : t.at("temperature")) low = std::min(low, T), high = std::max(high, T), sum += T, ++n;
    }
    span_ = median(spans);
    if (n > 0) mean_ = sum / n, spread_ = high - low;
  }

  std::vector<double> guess() const override {
    std::vector<double> g = {1.0, 0.0, 1.0, 0.0};
    line("angle", "strain_counts", g[0], g[1]);
    line("grip_force", "pressure_counts", g[2], g[3]);
    return g;
  }

  void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const override {
    out.resize(t.samples(), static_cast<Eigen::Index>(data().outputs.size()));
    for (std::size_t c = 0; c < data().outputs.size(); ++c) {
      const bool strain = data().outputs[c] == "strain_counts";
      Eigen::VectorXd x = t.at(strain ? "angle" : "grip_force");
      const double* play = s.on(Effect::hysteresis);
      if (play != nullptr && (s.form(Effect::hysteresis) != 1) == strain) {
        if (s.form(Effect::hysteresis) == 2) behind(x, play[0]);
        else follow(x, play[0]);
      }
      const double gain = s.scale * s.base[strain ? 0 : 2], offset = s.base[strain ? 1 : 3];
      const BridgeLine bridge{offset, 1.0 / gain};
      Eigen::VectorXd y = x.unaryExpr([&](double v) { return bridge.count(v); });
      if (const double* p = s.on(Effect::bridge_nonlinearity); p != nullptr && (s.form(Effect::bridge_nonlinearity) < 2) == strain) {
        y.array() += p[0] * x.array().square();
        if (s.form(Effect::bridge_nonlinearity) % 2 == 0) y.array() += p[1] * x.array().cube();
      }
      if (const double* p = s.on(Effect::cross_talk); p != nullptr && strain) y += p[0] * t.at("grip_force");
      warm(t, s, strain, gain, x, y);
      out.col(static_cast<Eigen::Index>(c)) = y;
    }
  }

  std::vector<Form> forms() const override {
    std::vector<Form> f;
    const bool has_strain = has("strain_counts"), has_pressure = has("pressure_counts");
    if (spread_ > 0.0) thermal(f, has_strain, has_pressure);
    bool clocked = true;
    for (const Trial& t : data().trials) clocked = clocked && t.clocked;
    if (clocked && spread_ <= 0.0) {
      const double fs = full_scale(has_strain ? "strain_counts" : "pressure_counts");
      f.push_back({Effect::temperature_drift, has_strain ? 4 : 5, "warm-up exponential in time", {{"warm_up_offset", "count", -fs, fs, false}, {"warm_up_time", "s", 0.02 * span_, 20 * span_, true}},
                   grid({{0.03 * fs}, {0.2 * span_, span_}}), false});
    }
    if (has_strain) {
      const double fs = full_scale("strain_counts"), q = fs / (angle_ * angle_), c = q / angle_, k = fs / std::max(force_, 1e-9);
      f.push_back({Effect::bridge_nonlinearity, 1, "quadratic", {{"quadratic", "count/rad2", -2 * q, 2 * q, false}}, {{0.05 * q}}, false});
      f.push_back({Effect::bridge_nonlinearity, 0, "quadratic and cubic", {{"quadratic", "count/rad2", -2 * q, 2 * q, false}, {"cubic", "count/rad3", -2 * c, 2 * c, false}}, {{0.05 * q, 0.02 * c}}, false});
      f.push_back({Effect::hysteresis, 0, "play of the angle", {{"width", "rad", 1e-4 * angle_, 0.5 * angle_, true}}, {{0.02 * angle_}, {0.1 * angle_}}, false});
      if (one_way()) f.push_back({Effect::hysteresis, 2, "closing and opening apart by the width", {{"width", "rad", 1e-4 * angle_, 0.5 * angle_, true}}, {{0.02 * angle_}, {0.1 * angle_}}, false});
      f.push_back({Effect::cross_talk, 0, "proportional to grip force", {{"gain", "count/N", -k, k, false}}, {{0.03 * k}}, false});
    }
    if (has_pressure) {
      const double q = full_scale("pressure_counts") / (force_ * force_), c = q / force_;
      f.push_back({Effect::bridge_nonlinearity, 2, "pressure channel, quadratic and cubic", {{"quadratic", "count/N2", -2 * q, 2 * q, false}, {"cubic", "count/N3", -2 * c, 2 * c, false}}, {{0.05 * q, 0.02 * c}}, false});
      f.push_back({Effect::hysteresis, 1, "play of the grip force", {{"width", "N", 1e-4 * force_, 0.5 * force_, true}}, {{0.02 * force_}, {0.1 * force_}}, false});
    }
    return f;
  }

 private:
  bool has(const std::string& name) const { return std::find(data().outputs.begin(), data().outputs.end(), name) != data().outputs.end(); }

  static void follow(Eigen::VectorXd& x, double width) {
    double held = x[0];
    for (double& v : x) v = held = std::clamp(held, v - 0.5 * width, v + 0.5 * width);
  }

  /// Whether every record goes one way only, and records of both ways are there.
  bool one_way() const {
    bool up = false, down = false;
    for (const Trial& t : data().trials) {
      const Eigen::VectorXd& x = t.at("angle");
      double rise = 0.0, fall = 0.0;
      for (Eigen::Index n = 1; n < x.size(); ++n) (x[n] > x[n - 1] ? rise : fall) += std::abs(x[n] - x[n - 1]);
      if (std::min(rise, fall) > 0.1 * std::max(rise, fall)) return false;
      (rise > fall ? up : down) = true;
    }
    return up && down;
  }

  /// Half the width behind the motion from the first sample on: what a record of one direction shows of play that was taken up before.
  static void behind(Eigen::VectorXd& x, double width) {
    x.array() -= 0.5 * width * (x[x.size() - 1] >= x[0] ? 1.0 : -1.0);
  }

  void thermal(std::vector<Form>& f, bool has_strain, bool has_pressure) const {
    const auto offset = [&](const char* name, const char* channel) {
      const double r = full_scale(channel) / spread_;
      return ParamSpec{name, "count/K", -r, r, false};
    };
    const ParamSpec gain{"gain_per_kelvin", "1/K", -0.5 / spread_, 0.5 / spread_, false};
    const double r = has_strain ? full_scale("strain_counts") / spread_ : 0.0;
    const auto kind = Effect::temperature_drift;
    if (has_strain) {
      f.push_back({kind, 0, "strain offset per kelvin", {offset("offset_per_kelvin", "strain_counts")}, {{0.03 * r}}, false});
      f.push_back({kind, 1, "strain offset and gain per kelvin", {offset("offset_per_kelvin", "strain_counts"), gain}, {{0.03 * r, 0.01 / spread_}}, false});
    }
    if (has_pressure) {
      const double q = 0.03 * full_scale("pressure_counts") / spread_;
      f.push_back({kind, 2, "pressure offset per kelvin", {offset("offset_per_kelvin", "pressure_counts")}, {{q}}, false});
      if (has_strain)
        f.push_back({kind, 3, "offset per kelvin of both channels", {offset("offset_per_kelvin", "strain_counts"), offset("pressure_offset_per_kelvin", "pressure_counts")}, {{0.03 * r, q}}, false});
    }
  }

  void warm(const Trial& t, const Setting& s, bool strain, double gain, const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    const double* p = s.on(Effect::temperature_drift);
    if (p == nullptr) return;
    const int kind = s.form(Effect::temperature_drift);
    if (kind >= 4) {
      if ((kind == 4) == strain) y.array() += p[0] * (1.0 - ((t.time[0] - t.time.array()) / p[1]).exp());
      return;
    }
    const Eigen::ArrayXd dT = t.at("temperature").array() - mean_;
    if (strain && kind != 2) y.array() += p[0] * dT;
    if (strain && kind == 1) y.array() += gain * p[1] * dT * x.array();
    if (!strain && kind >= 2) y.array() += p[kind - 2] * dT;
  }

  void line(const std::string& input, const std::string& output, double& gain, double& offset) const {
    if (!has(output)) return;
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Trial& t : data().trials)
      for (Eigen::Index i = 0; i < t.time.size() && !t.hold_out; ++i) {
        const double x = t.at(input)[i], y = t.at(output)[i];
        if (std::isfinite(y)) n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
      }
    const double det = n * sxx - sx * sx;
    gain = det > 0 ? (n * sxy - sx * sy) / det : 0.0;
    offset = n > 0 ? (sy - gain * sx) / n : 0.0;
  }

  double angle_ = 1e-9, force_ = 1e-9, span_ = 1.0, mean_ = 293.0, spread_ = 0.0;
};

/// tip-hold: a still tip; an arbitrary origin and a drift at most cubic in time are free in every record.
class Hold final : public RigModel {
 public:
  using RigModel::RigModel;
  std::vector<double> guess() const override { return {}; }
  bool has_scale() const override { return false; }
  int free_polynomial() const override { return 3; }
  void rig(const Trial& t, const Setting&, Eigen::MatrixXd& out) const override {
    out = Eigen::MatrixXd::Zero(t.samples(), static_cast<Eigen::Index>(data().outputs.size()));
  }
  std::vector<Form> forms() const override {
    return {{Effect::pulsation, 0, "heart", {{"frequency", "Hz", 0.7, 2.2, false}}, {}, true},
            {Effect::pulsation, 1, "breath", {{"frequency", "Hz", 0.12, 0.45, false}}, {}, true}};
  }
};

}  // namespace

std::unique_ptr<RigModel> make_forceps(const Dataset& d) { return std::make_unique<Forceps>(d); }
std::unique_ptr<RigModel> make_hold(const Dataset& d) { return std::make_unique<Hold>(d); }

}  // namespace filum::reconcile
