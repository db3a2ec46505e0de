// vessel-inflation by the trainer's wall elements (physics/tube_slice): Hooke's law at vanishing strain for the linear part; for fibres, Yeoh's
// stiffening and the opening angle the pressure of a rubber wall that has them less that of one that has not, at equal motion, as the reduced model adds them. What acts
// equally on the whole wall (relaxation, softening) or from outside (tethering: a pressure on an incompressible wall moves it alike on either side)
// changes nothing in a slice but its load and stays the reduced model's, as do tone and the exponential form of stiffening, which the trainer's wall
// has no law for, stiffening beside fibres, and both in a tube that is stretched along its axis.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/tube_slice.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kStates = 6;  // pressures at which the finite elements are asked

/// Inner radius [m] of the open sector that closes to a tube from a to b without load: neo-Hookean, midpoint rule.
double open_radius(double a, double b, double angle) {
  const double k = kTurn / (kTurn - angle);
  const auto pressure = [&](double inner) {
    constexpr int kPoints = 200;
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double r = a + (b - a) * (i + 0.5) / kPoints, l = r * k / std::sqrt(inner * inner + k * (r * r - a * a));
      sum += (l * l - 1.0 / (l * l)) / r;
    }
    return sum;
  };
  double low = 0.2 * a, high = 6.0 * a * k;
  for (int i = 0; i < 50; ++i) {
    const double mid = 0.5 * (low + high);
    (pressure(mid) > 0.0 ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

TubeSlice slice_of(const TubeWall& w, const WallLaw& law, double opening, int around) {
  TubeSlice s;
  s.around = around;
  s.through = std::max(2, around / 4);
  s.shape.inner_radius = w.inner;
  s.shape.thickness = w.outer - w.inner;
  s.shape.length = w.outer * kTurn / around;
  if (opening > 0.0) {
    const double k = kTurn / (kTurn - opening), R = open_radius(w.inner, w.outer, opening);
    s.shape.inner_radius = R;
    s.shape.thickness = std::sqrt(R * R + k * (w.outer * w.outer - w.inner * w.inner)) - R;
    s.shape.opening_angle = opening;
    s.shape.first_inner_radius = w.inner;
  }
  s.layers = {{"wall", s.shape.thickness, law}};
  return s;
}

/// Motion C [m2] of the outer face at each pressure, from where it is without; empty where an equilibrium was not found.
std::vector<double> motions(const TubeSlice& s, std::vector<double> pressures) {
  pressures.insert(pressures.begin(), 0.0);
  std::vector<double> out;
  const std::vector<SliceState> states = inflate(s, pressures);
  for (const SliceState& at : states) {
    if (!at.converged || !std::isfinite(at.outer)) return {};
    out.push_back(0.5 * (at.outer * at.outer - states[0].outer * states[0].outer));
  }
  out.erase(out.begin());
  return out;
}

/// Pressure of a rubber tube at motion c: int mu (l^2 - l^-2) dr/r, midpoint rule.
double rubber_pressure(const TubeWall& w, double mu, double c) {
  constexpr int kPoints = 400;
  const double ri = std::sqrt(w.inner * w.inner + 2.0 * c), ro = std::sqrt(w.outer * w.outer + 2.0 * c);
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double r = ri + (ro - ri) * (i + 0.5) / kPoints, l2 = r * r / (r * r - 2.0 * c);
    sum += mu * (l2 - 1.0 / l2) / r;
  }
  return sum * (ro - ri) / kPoints;
}

/// Finite elements over quadrature for rubber at motion c, straight between the states.
double ratio(const std::vector<double>& C, const std::vector<double>& ratios, double c) {
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(std::upper_bound(C.begin(), C.end(), c) - C.begin(), 1, static_cast<std::ptrdiff_t>(C.size()) - 1));
  const double w = (c - C[i - 1]) / (C[i] - C[i - 1]);
  return (1.0 - w) * ratios[i - 1] + w * ratios[i];
}

}  // namespace

double tube_linear_factor(const TubeWall& w, int around) {
  constexpr double kPoisson = 0.4999, kSmall = 1e-5;  // modulus 1 Pa times a strain of 1e-5
  const double lame = 1.0 / (w.inner * w.inner) - 1.0 / (w.outer * w.outer), mu = 1e5;
  const double P = kSmall * 2.0 * mu * lame * w.inner * w.inner;
  const auto C = motions(slice_of(w, WallLaw::hooke(2.0 * mu * (1.0 + kPoisson), kPoisson), 0.0, around), {P});
  return C.empty() ? NAN : P / (2.0 * mu * lame * C[0]);
}

WallTable tube_table(const TubeWall& w, const WallLaw& law, double opening, double most, const std::function<double(double)>& reduced, int around) {
  WallTable out;
  out.linear = tube_linear_factor(w, around);
  const bool plain = law.kind == WallLaw::Kind::neo_hookean && opening <= 0.0;
  if (plain || !std::isfinite(out.linear)) return out;
  WallLaw rubber = law;
  rubber.kind = WallLaw::Kind::neo_hookean;
  std::vector<double> bare, full, ratios;
  for (int i = 1; i <= kStates; ++i) {
    const double c = 1.05 * most * i / kStates;
    bare.push_back(rubber_pressure(w, law.mu, c));
    full.push_back(bare.back() + reduced(c));
  }
  const auto with = motions(slice_of(w, law, opening, around), full), without = motions(slice_of(w, rubber, 0.0, around), bare);
  if (with.empty() || without.empty()) return out.linear = NAN, out;
  for (std::size_t i = 0; i < without.size(); ++i) ratios.push_back(bare[i] / rubber_pressure(w, law.mu, without[i]));
  out.C = {0.0}, out.beyond = {0.0};
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (with[i] <= out.C.back()) return out.linear = NAN, out;
    out.C.push_back(with[i]);
    out.beyond.push_back(full[i] - ratio(without, ratios, with[i]) * rubber_pressure(w, law.mu, with[i]) - reduced(with[i]));
  }
  return out;
}

namespace {

class TubeSolver final : public FullSolver {
 public:
  explicit TubeSolver(const RigModel& model) : model_(model) {}
  std::string name() const override { return "the trainer's wall (physics/vessel_wall_element)"; }

  bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const override {
    model_.rig(t, s, out);
    Setting with = s;
    with.wall = &table(t, s, fine);
    if (!std::isfinite(with.wall->linear)) return false;
    model_.rig(t, with, out);
    return true;
  }

 private:
  /// At the batch's stiffness: a few per cent more or less of one specimen change a correction of a per cent by little.
  const WallTable& table(const Trial& t, const Setting& s, bool fine) const {
    TubeWall w;
    w.outer = 0.5 * t.size("outer_diameter");
    w.inner = w.outer - t.size("wall_thickness");
    Setting own;
    own.base = s.base;
    own.mesh = 4;
    WallLaw law;
    law.kind = WallLaw::Kind::neo_hookean;
    law.mu = s.base[0] / 3.0;
    law.lambda = 1e3 * law.mu;
    double opening = 0.0;
    std::vector<double> key = {w.inner, w.outer, law.mu, fine ? 1.0 : 0.0};
    const bool level = !t.has("axial_stretch") || (t.at("axial_stretch").array() - 1.0).abs().maxCoeff() < 1e-3;
    if (const double* p = s.on(Effect::fibre_stiffening); p != nullptr && level) {
      const int form = s.form(Effect::fibre_stiffening);
      law.kind = WallLaw::Kind::fibres;  // I - 1 = 2 E, two families
      law.k1 = 0.25 * p[0] * (form == 1 ? 0.5 : 1.0);
      law.k2 = 0.25 * p[1];
      law.beta = p[2];
      own.p[static_cast<std::size_t>(index_of(Effect::fibre_stiffening))] = p;
      own.kind[static_cast<std::size_t>(index_of(Effect::fibre_stiffening))] = form;
      key.insert(key.end(), {law.k1, law.k2, law.beta});
    }
    if (const double* p = s.on(Effect::strain_stiffening); p != nullptr && level && law.kind == WallLaw::Kind::neo_hookean && s.form(Effect::strain_stiffening) == 0) {
      law.kind = WallLaw::Kind::yeoh;
      law.c20 = 0.5 * law.mu * p[0];
      own.p[static_cast<std::size_t>(index_of(Effect::strain_stiffening))] = p;
      key.push_back(-law.c20);
    }
    if (const double* p = s.on(Effect::residual_stress); p != nullptr && level) {
      opening = p[0];
      own.p[static_cast<std::size_t>(index_of(Effect::residual_stress))] = p;
      key.push_back(opening);
    }
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    double most = 0.0;  // the widest that any record gets, whichever comes first
    for (const Trial& other : model_.data().trials)
      for (const double D : other.at("outer_diameter"))
        if (std::isfinite(D)) most = std::max(most, 0.5 * w.outer * (D - 2.0 * w.outer));
    return known_.emplace(std::move(key), tube_table(w, law, opening, std::max(most, 1e-3 * w.inner * w.inner),
                                                     [&](double C) { return model_.wall_pressure(t, own, C); }, fine ? 32 : 16)).first->second;
  }

  const RigModel& model_;
  mutable std::map<std::vector<double>, WallTable> known_;
};

}  // namespace

std::unique_ptr<FullSolver> make_tube_solver(const RigModel& model) { return std::make_unique<TubeSolver>(model); }

}  // namespace filum::reconcile
