// suture-cantilever: heavy elastica, clamped level, EI (theta' - kappa0) = M, M' = -V cos(theta), V = rho g A (L - s), theta(0) = 0,
// M(L) = 0 (Love 1927, art. 270; Bickley 1934). With lengths in L and G = rho g A L^3/(E I) = 16 rho g L^3/(E d^2):
//   theta'' = -(1 - s) G cos(theta) (theta downward positive), theta(0) = 0, theta'(1) = kappa0 L.
// Integrated by the midpoint rule from the free end, shot on the angle there. kappa0 changes sign with the orientation.
// Creep: E -> E / J(t) at the overhang of the moment; set: rest curvature = fraction of the largest past curvature at the same
// distance from the tip, or of the largest anywhere. Tested against the trainer's rod and the small-deflection limit G/8 (cantilever_test).

#include <algorithm>
#include <cmath>

#include "reconcile/model.h"

namespace filum::reconcile {
namespace {

constexpr int kSteps = 40, kFinest = 2;
constexpr double kGravity = 9.81;

using Stations = std::array<double, kFinest * kSteps + 1>;  // of which steps + 1 count

struct Shape {
  double drop = 0.0, reach = 1.0;  // over L
  Stations curvature{};            // times L, from the tip
};

/// The shape from tip angle `tip`; returns theta at the clamp. Arc length x runs from the tip.
double shoot(double G, const Stations& rest, int steps, double tip, Shape& shape) {
  const double h = 1.0 / steps;
  double theta = tip, bend = 0.0, drop = 0.0, reach = 0.0;  // bend = theta' - rest, along s towards the clamp
  for (int i = 0; i < steps; ++i) {
    const double x = i * h, mid = x + 0.5 * h, rest_mid = 0.5 * (rest[static_cast<std::size_t>(i)] + rest[static_cast<std::size_t>(i) + 1]);
    shape.curvature[static_cast<std::size_t>(i)] = bend + rest[static_cast<std::size_t>(i)];
    const double theta_mid = theta - 0.5 * h * (bend + rest[static_cast<std::size_t>(i)]);
    const double bend_mid = bend + 0.5 * h * G * x * std::cos(theta);
    drop += h * std::sin(theta_mid);
    reach += h * std::cos(theta_mid);
    theta -= h * (bend_mid + rest_mid);
    bend += h * G * mid * std::cos(theta_mid);
  }
  shape.curvature[static_cast<std::size_t>(steps)] = bend + rest[static_cast<std::size_t>(steps)];
  shape.drop = drop;
  shape.reach = reach;
  return theta;
}

Shape elastica(double G, const Stations& rest, int steps, double& tip) {
  Shape shape;
  for (int i = 0; i < 30; ++i) {
    const double f = shoot(G, rest, steps, tip, shape);
    if (std::abs(f) < 1e-9) break;
    Shape other;
    const double slope = (shoot(G, rest, steps, tip + 1e-6, other) - f) / 1e-6;
    tip -= std::clamp(f / (std::abs(slope) > 0.05 ? slope : 0.05), -0.4, 0.4);
  }
  return shape;
}

class Cantilever final : public RigModel {
 public:
  explicit Cantilever(const Dataset& d) : RigModel(d) {
    std::vector<double> spans;
    for (const Trial& t : d.trials) {
      spans.push_back(t.time[t.samples() - 1] - t.time[0]);
      if (t.has("overhang")) longest_ = std::max(longest_, t.at("overhang").maxCoeff());
      else longest_ = std::max(longest_, length_at(t, 0));
    }
    span_ = median(spans);
  }
  bool has_gain() const override { return true; }
  std::vector<double> guess() const override;
  std::vector<Form> forms() const override;
  void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const override;
  BentThread bent_thread(const Trial& t, const Setting& s, Eigen::Index sample) const override;

 private:
  /// Calls each(sample, length, weight, natural curvature from the tip, shape) in turn while it answers true.
  template <class Each>
  void trace(const Trial& t, const Setting& s, const Each& each) const;
  static double length_at(const Trial& t, Eigen::Index n) {
    if (t.has("overhang")) return t.at("overhang")[n];
    if (t.size("overhang") > 0.0) return t.size("overhang");
    // not given: a thread that hangs steeply is about as long as the chord to its tip
    const double drop = t.has("tip_drop") ? t.at("tip_drop")[0] : 0.0, reach = t.has("tip_reach") ? t.at("tip_reach")[0] : 0.0;
    return 1.05 * std::max(std::hypot(drop, reach), 1e-4);
  }
  double longest_ = 0.0, span_ = 1.0;
};

template <class Each>
void Cantilever::trace(const Trial& t, const Setting& s, const Each& each) const {
  const double d = t.size("diameter"), E = s.base[0] * s.scale;
  const double weight = 16.0 * t.size("density") * kGravity / (E * d * d);
  const double *curl = s.on(Effect::rest_curvature), *creep = s.on(Effect::bending_creep), *set = s.on(Effect::permanent_set);
  const double side = t.word("orientation") == "up" ? -1.0 : 1.0;
  const int steps = kSteps * std::min(s.mesh, kFinest);
  double sharpest = 0.0;  // [1/m], of the whole thread so far
  Stations most{};  // [1/m], at a distance from the tip in parts of the longest overhang
  double tip = 0.0, last_L = -1.0, last_G = -1.0;
  Stations rest{};
  Shape shape;
  for (Eigen::Index n = 0; n < t.time.size(); ++n) {
    const double L = std::max(length_at(t, n), 1e-9);
    double G = weight * L * L * L;
    if (creep != nullptr) {
      const double since = t.time[n] - t.time[0];
      G *= s.form(Effect::bending_creep) == 0 ? 1.0 + creep[0] * std::log1p(since / creep[1])
         : s.form(Effect::bending_creep) == 1 ? 1.0 + creep[0] * -std::expm1(-since / creep[1]) : 1.0 + creep[0] * std::pow(since / span_, creep[1]);
    }
    if (n == 0 || set != nullptr || std::abs(L - last_L) > 1e-12 * L || std::abs(G - last_G) > 1e-9 * G) {
      rest.fill(0.0);
      for (int i = 0; i <= steps; ++i) {
        if (curl != nullptr) {
          const double away = s.form(Effect::rest_curvature) == 0 ? 1.0 : 2.0 * static_cast<double>(i) / steps;
          rest[static_cast<std::size_t>(i)] += side * curl[0] * L * away;
        }
        if (set == nullptr) continue;
        if (s.form(Effect::permanent_set) == 1) {
          rest[static_cast<std::size_t>(i)] += set[0] * L * sharpest;
          continue;
        }
        const double at = std::min(i * L / longest_, steps - 1e-9);
        const auto k = static_cast<std::size_t>(at);
        rest[static_cast<std::size_t>(i)] += set[0] * L * (most[k] + (at - static_cast<double>(k)) * (most[k + 1] - most[k]));
      }
      if (n == 0) tip = std::min(1.2, G / 6.0);
      shape = elastica(G, rest, steps, tip);
      last_L = L;
      last_G = G;
      for (int i = 0; set != nullptr && i <= steps; ++i) {
        sharpest = std::max(sharpest, shape.curvature[static_cast<std::size_t>(i)] / L);
        const double at = static_cast<double>(i) * longest_ / L;
        if (at > steps - 1e-9) break;
        const auto k = static_cast<std::size_t>(at);
        const double kappa = (shape.curvature[k] + (at - static_cast<double>(k)) * (shape.curvature[k + 1] - shape.curvature[k])) / L;
        most[static_cast<std::size_t>(i)] = std::max(most[static_cast<std::size_t>(i)], kappa);
      }
    }
    if (!each(n, L, G, rest, shape)) return;
  }
}

void Cantilever::rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const {
  out.resize(t.samples(), static_cast<Eigen::Index>(data().outputs.size()));
  trace(t, s, [&](Eigen::Index n, double L, double, const Stations&, const Shape& shape) {
    for (std::size_t c = 0; c < data().outputs.size(); ++c)
      out(n, static_cast<Eigen::Index>(c)) = L * (data().outputs[c] == "tip_drop" ? shape.drop : shape.reach);
    return true;
  });
}

RigModel::BentThread Cantilever::bent_thread(const Trial& t, const Setting& s, Eigen::Index sample) const {
  BentThread out;
  trace(t, s, [&](Eigen::Index n, double L, double G, const Stations& rest, const Shape&) {
    if (n < sample) return true;
    const auto tip = rest.begin(), clamp = tip + kSteps * std::min(s.mesh, kFinest) + 1;
    out = {L, G, std::vector<double>(std::make_reverse_iterator(clamp), std::make_reverse_iterator(tip))};
    return false;
  });
  return out;
}

std::vector<double> Cantilever::guess() const {
  // the modulus whose curve comes nearest, on a logarithmic grid
  double best = 1e300, E_best = data().nominal.at("youngs_modulus");
  const auto fixed = data().nominal;
  for (double E = 1e7; E < 1e12; E *= 1.5) {
    Setting s;
    s.base = &E;
    double sum = 0.0;
    for (const Trial& t : data().trials) {
      if (t.hold_out) continue;
      Trial few = t;
      const Eigen::Index step = std::max<Eigen::Index>(1, t.samples() / 20);
      std::vector<Eigen::Index> keep;
      for (Eigen::Index n = 0; n < t.samples(); n += step) keep.push_back(n);
      few.time = Eigen::VectorXd(t.time(keep));
      for (auto& [name, v] : few.data) v = Eigen::VectorXd(v(keep));
      Eigen::MatrixXd out;
      rig(few, s, out);
      const Eigen::VectorXd& y = few.at(data().outputs[0]);
      for (Eigen::Index n = 0; n < y.size(); ++n)
        if (std::isfinite(y[n])) sum += std::pow(y[n] - out(n, 0), 2);
    }
    if (sum < best) best = sum, E_best = E;
  }
  return {E_best};
}

std::vector<Form> Cantilever::forms() const {
  std::vector<Form> f;
  const double k = 0.1 / longest_;
  for (int kind = 0; kind < 2; ++kind)
    f.push_back({Effect::rest_curvature, kind, kind == 0 ? "uniform" : "growing from the tip", {{"curvature", "1/m", -60 * k, 60 * k, false}}, {{k}, {-k}, {10 * k}}, false});
  bool clocked = true;
  for (const Trial& t : data().trials) clocked = clocked && t.clocked;
  if (clocked) {
    f.push_back({Effect::bending_creep, 0, "logarithm of time", {{"a", "-", 1e-4, 3.0, true}, {"t0", "s", 1e-4 * span_, 2 * span_, true}}, grid({{0.05}, {0.01 * span_, 0.2 * span_}}), false});
    f.push_back({Effect::bending_creep, 1, "one exponential", {{"a", "-", 1e-4, 3.0, true}, {"t0", "s", 1e-3 * span_, 5 * span_, true}}, grid({{0.1}, {0.2 * span_}}), false});
    f.push_back({Effect::bending_creep, 2, "power of time", {{"a", "-", 1e-4, 3.0, true}, {"exponent", "-", 0.05, 1.0, false}}, grid({{0.1}, {0.3}}), false});
  }
  f.push_back({Effect::permanent_set, 0, "fraction of the largest past curvature", {{"fraction", "-", 0.002, 0.9, false}}, {{0.1}}, false});
  f.push_back({Effect::permanent_set, 1, "one curvature for the whole length, a fraction of the largest past one", {{"fraction", "-", 0.002, 0.9, false}}, {{0.1}}, false});
  return f;
}

}  // namespace

std::unique_ptr<RigModel> make_cantilever(const Dataset& d) { return std::make_unique<Cantilever>(d); }

}  // namespace filum::reconcile
