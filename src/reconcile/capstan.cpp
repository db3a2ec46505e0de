// suture-pull: thread drawn over a cylinder, T1 = T2 exp(mu angle) in the direction of pulling (Euler-Eytelwein).
//   Stribeck   mu(v) = mu_k + (mu_s - mu_k) exp(-(|v|/v_s)^n) + c |v|, n = 1 or 2   (Armstrong-Helouvry 1994); also logarithmic in v
//   bending    + constant force (bend and straighten over the cylinder)      drag  + drag * v
#include <algorithm>
#include <cmath>

#include "reconcile/model.h"

namespace filum::reconcile {
namespace {

class Capstan final : public RigModel {
 public:
  explicit Capstan(const Dataset& d) : RigModel(d) {
    for (const Trial& t : d.trials) {
      fastest_ = std::max(fastest_, t.at("speed").cwiseAbs().maxCoeff());
      for (const double v : t.at("speed"))
        if (std::abs(v) > 0) slowest_ = std::min(slowest_, std::abs(v));
    }
    slowest_ = std::clamp(slowest_, 1e-4 * fastest_, fastest_);
  }
  bool has_gain() const override { return true; }

  std::vector<double> guess() const override {
    double up = 0.0, down = 0.0;
    for (const Trial& t : data().trials)
      for (Eigen::Index n = 0; n < t.time.size() && !t.hold_out; ++n) {
        const double y = t.at("pull_force")[n], h = t.at("hold_force")[n], a = t.at("wrap_angle")[n];
        if (std::isfinite(y) && y > 0.1 * h && h > 0) up += a * std::log(y / h), down += a * a;
      }
    return {down > 0 ? std::clamp(up / down, 0.01, 2.0) : data().nominal.at("friction_coefficient")};
  }

  bool steps_in_time() const override { return false; }

  Slide slide(const Trial& t, const Setting& s, Eigen::Index n) const override {
    const double v = t.at("speed")[n], wrap = t.at("wrap_angle")[n];
    double mu = s.base[0];
    if (const double* p = s.on(Effect::speed_dependent_friction)) mu = friction(mu, p, s.form(Effect::speed_dependent_friction), std::abs(v));
    return {mu * s.scale, v < 0 ? -wrap : wrap, t.at("hold_force")[n]};
  }

  void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const override {
    const double *bend = s.on(Effect::bending_stiffness_loss), *drag = s.on(Effect::viscous_drag);
    out.resize(t.samples(), static_cast<Eigen::Index>(data().outputs.size()));
    for (Eigen::Index n = 0; n < t.time.size(); ++n) {
      const Slide slid = slide(t, s, n);
      const double v = t.at("speed")[n], wrap = std::abs(slid.wrap);
      double y = slid.hold * std::exp(std::min(slid.mu * slid.wrap, 20.0));
      if (bend != nullptr) y += bend[0] * (s.form(Effect::bending_stiffness_loss) == 0 || wrap > 1e-6 ? (v < 0 ? -1.0 : 1.0) : 0.0);
      if (drag != nullptr && (s.form(Effect::viscous_drag) == 0 || t.word("medium") == "wet")) y += drag[0] * v;
      out(n, 0) = y;
    }
  }

  std::vector<Form> forms() const override {
    std::vector<Form> f;
    const double v = std::sqrt(slowest_ * fastest_);
    const ParamSpec mu_s{"mu_s", "-", 0.0, 2.0, false}, v_s{"v_s", "m/s", 0.05 * slowest_, 5 * fastest_, true};
    const ParamSpec c{"c", "s/m", -1.0 / fastest_, 1.0 / fastest_, false};
    const auto kind = Effect::speed_dependent_friction;
    f.push_back({kind, 0, "Stribeck without a viscous part; mu_k is the baseline's friction_coefficient", {mu_s, v_s}, grid({{0.3, 0.1}, {v, 0.3 * fastest_}}), false});
    f.push_back({kind, 1, "Stribeck", {mu_s, v_s, c}, grid({{0.3}, {v}, {0.05 / fastest_}}), false});
    f.push_back({kind, 2, "Stribeck with the square of the speed", {mu_s, v_s}, grid({{0.3}, {v, 0.4 * fastest_}}), false});
    f.push_back({kind, 3, "linear in the speed", {c}, {{0.05 / fastest_}}, false});
    f.push_back({kind, 4, "logarithm of the speed", {{"mu_per_e_fold", "-", -0.5, 0.5, false}, v_s}, grid({{-0.02}, {slowest_}}), false});
    const double fs = full_scale("pull_force");
    f.push_back({Effect::bending_stiffness_loss, 0, "constant force against the motion", {{"bending_force", "N", 1e-4 * fs, fs, true}}, {{0.05 * fs}}, false});
    const ParamSpec drag{"drag", "N.s/m", 1e-4 * fs / fastest_, 3.0 * fs / fastest_, true};
    f.push_back({Effect::viscous_drag, 0, "proportional to the speed", {drag}, {{0.1 * fs / fastest_}}, false});
    const bool both = std::any_of(data().trials.begin(), data().trials.end(), [](const Trial& t) { return t.word("medium") == "wet"; }) &&
                      std::any_of(data().trials.begin(), data().trials.end(), [](const Trial& t) { return t.word("medium") != "wet"; });
    if (both) f.push_back({Effect::viscous_drag, 1, "proportional to the speed, when wet", {drag}, {{0.1 * fs / fastest_}}, false});
    return f;
  }

 private:
  double friction(double mu_k, const double* p, int kind, double v) const {
    switch (kind) {
      case 0: return mu_k + (p[0] - mu_k) * std::exp(-v / p[1]);
      case 1: return mu_k + (p[0] - mu_k) * std::exp(-v / p[1]) + p[2] * v;
      case 2: return mu_k + (p[0] - mu_k) * std::exp(-v * v / (p[1] * p[1]));
      case 3: return mu_k + p[0] * v;
      default: return std::max(0.0, mu_k + p[0] * std::log1p(v / p[1]));
    }
  }
  double fastest_ = 1e-9, slowest_ = 1e9;
};

}  // namespace

std::unique_ptr<RigModel> make_capstan(const Dataset& d) { return std::make_unique<Capstan>(d); }

}  // namespace filum::reconcile
