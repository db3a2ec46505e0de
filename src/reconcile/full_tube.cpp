// vessel-inflation by the trainer's wall elements (physics/tube_slice): Hooke's law at vanishing strain for the linear part; for fibres, stiffening, tone
// and the opening angle, alone or together, the pressure (and, where it was measured, the axial force) of a rubber wall that has them less that of one that has
// not, at equal motion and axial stretch, as the reduced model adds them. Softening element by element (tube_softening). What acts equally on the whole wall
// (relaxation) or from outside (tethering: a pressure on an incompressible wall moves it alike on either side) changes nothing in a slice but its load and stays
// the reduced model's.

#include <algorithm>
#include <cmath>
#include <map>

#include "physics/tube_slice.h"
#include "base/numbers.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace {

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

TubeSlice slice_of(const TubeWall& w, const WallLaw& law, double opening, double stretch, int around) {
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
  if (stretch != 1.0) {  // starts as thin as it will be
    s.shape.stretch = stretch;
    s.shape.first_inner_radius = w.inner / std::sqrt(stretch);
  }
  s.layers = {{"wall", s.shape.thickness, law}};
  return s;
}

struct Motion {
  double C = 0.0, axial = 0.0;  // [m2], of the outer face; [N], the wall's axial force less that of the pressure on a closed end
};

/// Without pressure and at each pressure; C from where an unloaded wall of constant volume has its outer face at this stretch. Empty where an equilibrium was
/// not found. A wall of flat elements carries its axial force over the cross-section of a polygon: given for the round one.
std::vector<Motion> motions(const TubeSlice& s, std::vector<double> pressures) {
  pressures.insert(pressures.begin(), 0.0);
  const std::vector<SliceState> states = inflate(s, pressures);
  double first = states[0].outer, stretch = s.shape.stretch;
  if (stretch != 1.0) {
    TubeSlice free = s;
    free.shape.stretch = 1.0;
    free.shape.first_inner_radius *= std::sqrt(stretch);
    const SliceState rest = inflate(free, {0.0})[0];
    if (!rest.converged) return {};
    first = rest.outer;
  }
  const double polygon = std::sin(kTurn / s.around) / (kTurn / s.around);
  std::vector<Motion> out;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SliceState& at = states[i];
    if (!at.converged || !std::isfinite(at.outer)) return {};
    out.push_back({0.5 * (at.outer * at.outer - first * first / stretch), (at.axial_force - pressures[i] * at.lumen) / polygon});
  }
  return out;
}

/// Pressure of a rubber tube at motion c: int mu (l^2 - 1/(l lz)^2) dr/r, midpoint rule.
double rubber_pressure(const TubeWall& w, double mu, double c, double stretch) {
  constexpr int kPoints = 400;
  const double ri = std::sqrt(w.inner * w.inner / stretch + 2.0 * c), ro = std::sqrt(w.outer * w.outer / stretch + 2.0 * c);
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double r = ri + (ro - ri) * (i + 0.5) / kPoints, l2 = r * r / ((r * r - 2.0 * c) * stretch);
    sum += mu * (l2 - 1.0 / (l2 * stretch * stretch)) / r;
  }
  return sum * (ro - ri) / kPoints;
}

/// Reduced axial force of a rubber tube at motion c: pi int mu (2 (lz^2 - lr^2) - (l^2 - lr^2)) r dr, midpoint rule.
double rubber_axial(const TubeWall& w, double mu, double c, double stretch) {
  constexpr int kPoints = 400;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double R = w.inner + (w.outer - w.inner) * (i + 0.5) / kPoints, l2 = 1.0 / stretch + 2.0 * c / (R * R), radial = 1.0 / (l2 * stretch * stretch);
    sum += mu * (2.0 * (stretch * stretch - radial) - (l2 - radial)) * R / stretch;
  }
  return sum * 0.5 * kTurn * (w.outer - w.inner) / kPoints;
}

/// Values of the states at motion c, straight between them.
double between(const std::vector<double>& C, const std::vector<double>& values, double c) {
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(std::upper_bound(C.begin(), C.end(), c) - C.begin(), 1, static_cast<std::ptrdiff_t>(C.size()) - 1));
  const double w = (c - C[i - 1]) / (C[i] - C[i - 1]);
  return (1.0 - w) * values[i - 1] + w * values[i];
}

}  // namespace

double tube_linear_factor(const TubeWall& w, int around) {
  constexpr double kPoisson = 0.4999, kSmall = 1e-5;  // modulus 1 Pa times a strain of 1e-5
  const double lame = 1.0 / (w.inner * w.inner) - 1.0 / (w.outer * w.outer), mu = 1e5;
  const double P = kSmall * 2.0 * mu * lame * w.inner * w.inner;
  const auto C = motions(slice_of(w, WallLaw::hooke(2.0 * mu * (1.0 + kPoisson), kPoisson), 0.0, 1.0, around), {P});
  return C.empty() ? NAN : P / (2.0 * mu * lame * C[1].C);
}

double tube_axial_factor(const TubeWall& w, int around) {
  constexpr double kPoisson = 0.4999, kSmall = 1e-4, kYoung = 3e5;  // [Pa]
  TubeSlice slice = slice_of(w, WallLaw::hooke(kYoung, kPoisson), 0.0, 1.0 + kSmall, around);
  const auto at = motions(slice, {0.0});
  return at.empty() ? NAN : at[0].axial / (kYoung * kSmall * 0.5 * kTurn * (w.outer * w.outer - w.inner * w.inner));
}

namespace {

bool is_rubber(const WallLaw& law) { return law.kind == WallLaw::Kind::neo_hookean && law.c20 == 0.0 && law.growth == 0.0 && law.tone.stress == 0.0; }

using Reduced = std::function<double(double, double)>;

/// One slice of the table; without points where an equilibrium was not found.
WallTable::Slice table_slice(const TubeWall& w, const WallLaw& law, double opening, double stretch, double most, const Reduced& reduced, const Reduced& reduced_axial, int around) {
  WallLaw rubber;
  rubber.kind = WallLaw::Kind::neo_hookean;
  rubber.mu = law.mu, rubber.lambda = law.lambda;
  std::vector<double> bare, full, at, ratios, beside;
  for (int i = 1; i <= kStates; ++i) {
    const double c = 1.05 * most * i / kStates;
    bare.push_back(rubber_pressure(w, law.mu, c, stretch));
    full.push_back(bare.back() + reduced(c, stretch));
  }
  const auto with = motions(slice_of(w, law, opening, stretch, around), full), without = motions(slice_of(w, rubber, 0.0, stretch, around), bare);
  if (with.empty() || without.empty()) return {};
  for (std::size_t i = 1; i < without.size(); ++i) {  // what the mesh makes of rubber: pressure over quadrature's, axial force beside quadrature's
    at.push_back(without[i].C);
    ratios.push_back(bare[i - 1] / rubber_pressure(w, law.mu, without[i].C, stretch));
    beside.push_back(without[i].axial - rubber_axial(w, law.mu, without[i].C, stretch));
  }
  WallTable::Slice out;
  out.stretch = stretch;
  full.insert(full.begin(), 0.0);
  for (std::size_t i = 0; i < with.size(); ++i) {
    const double C = with[i].C;
    if (i > 0 && C <= with[i - 1].C) return {};
    out.C.push_back(C);
    out.beyond.push_back(full[i] - between(at, ratios, C) * rubber_pressure(w, law.mu, C, stretch) - reduced(C, stretch));
    if (reduced_axial) out.axial.push_back(with[i].axial - rubber_axial(w, law.mu, C, stretch) - between(at, beside, C) - reduced_axial(C, stretch));
  }
  return out;
}

}  // namespace

WallTable tube_table(const TubeWall& w, const WallLaw& law, double opening, const std::vector<double>& stretches, double most,
                     const Reduced& reduced, int around, const Reduced& reduced_axial) {
  WallTable out;
  out.linear = tube_linear_factor(w, around);
  if (reduced_axial) out.axial = tube_axial_factor(w, around);
  if (!std::isfinite(out.axial)) out.linear = NAN;
  if ((is_rubber(law) && opening <= 0.0) || !std::isfinite(out.linear)) return out;
  for (const double stretch : stretches) {
    out.slices.push_back(table_slice(w, law, opening, stretch, most, reduced, reduced_axial, around));
    if (out.slices.back().C.empty()) return out.linear = NAN, out;
  }
  return out;
}

WallTable::Softened tube_softening(const TubeWall& w, WallSoftening law, double most, int around) {
  constexpr double kPoisson = 0.4999, kSmall = 1e-4, kYoung = 3e5;  // [Pa]: the law is linear in the motion, so that a small one stands for any
  const double ab = w.inner * w.outer, scale = kSmall * ab / most;
  // the reduced law counts E (C/(a b))^2/2; in plane strain the wall stores 4/3 of that where R^2 = a b
  WallSoftening own = law;
  own.W0 *= 4.0 / 3.0 * kYoung * scale * scale;
  const TubeSlice slice = slice_of(w, WallLaw::hooke(kYoung, kPoisson), 0.0, 1.0, around);
  WallTable::Softened out;
  out.share = {0.1, 0.3, 0.5, 0.7, 0.85, 1.0};
  out.top = {0.0};
  out.more.assign(out.share.size(), 0.0);
  for (const double level : {0.25, 0.5, 0.75, 1.0}) {
    const double top = level * most;
    std::vector<double> radii;
    for (auto share = out.share.rbegin(); share != out.share.rend(); ++share) radii.push_back(w.inner + *share * scale * top / w.inner);
    const std::vector<double> P = borne(slice, own, radii);
    out.top.push_back(top);
    for (std::size_t m = 0; m < out.share.size(); ++m) {
      const double firm = P[0] * out.share[m], e2 = std::pow(top / ab, 2), more = P[P.size() - 1 - m] / firm - law.left(0.5 * e2 * out.share[m] * out.share[m], 0.5 * e2);
      if (!std::isfinite(more)) return {};
      out.more.push_back(more);
    }
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
  /// What the wall's law is with these effects; `own`: the same effects for the reduced model, `key`: their values.
  static WallLaw law_of(const Setting& s, Setting& own, double& opening, std::vector<double>& key) {
    const auto take = [&](Effect e, int values) {
      const double* p = s.on(e);
      if (p == nullptr) return p;
      own.p[static_cast<std::size_t>(index_of(e))] = p;
      own.kind[static_cast<std::size_t>(index_of(e))] = s.form(e);
      key.push_back(1e3 * index_of(e) + s.form(e));
      key.insert(key.end(), p, p + values);
      return p;
    };
    WallLaw law;
    law.kind = WallLaw::Kind::neo_hookean;
    law.mu = s.base[0] / 3.0;
    law.lambda = 1e3 * law.mu;
    if (const double* p = take(Effect::fibre_stiffening, 3)) {
      law.kind = WallLaw::Kind::fibres;  // I - 1 = 2 E, two families
      law.k1 = 0.25 * p[0] * (s.form(Effect::fibre_stiffening) == 1 ? 0.5 : 1.0);
      law.k2 = 0.25 * p[1];
      law.beta = p[2];
    }
    if (const double* p = take(Effect::strain_stiffening, 1)) (s.form(Effect::strain_stiffening) == 0 ? law.c20 : law.growth) = p[0] * (s.form(Effect::strain_stiffening) == 0 ? 0.5 * law.mu : 2.0);
    if (const double* p = take(Effect::smooth_muscle_tone, 2))
      law.tone = {s.form(Effect::smooth_muscle_tone) == 0 ? MuscleTone::Shape::parabola : MuscleTone::Shape::bell, p[0], p[1]};
    if (const double* p = take(Effect::residual_stress, 1)) opening = p[0];
    if (const double* p = s.on(Effect::first_cycle_softening)) key.insert(key.end(), {-1.0 - s.form(Effect::first_cycle_softening), p[0], p[1]});
    return law;
  }

  /// Axial stretches at which the finite elements are asked: one, or both ends of what the records have and the middle.
  std::vector<double> stretches() const {
    double low = INFINITY, high = -INFINITY;
    for (const Trial& t : model_.data().trials) {
      low = std::min(low, t.has("axial_stretch") ? t.at("axial_stretch").minCoeff() : 1.0);
      high = std::max(high, t.has("axial_stretch") ? t.at("axial_stretch").maxCoeff() : 1.0);
    }
    if (high - low > 1e-3) return {low, 0.5 * (low + high), high};
    return {std::abs(low - 1.0) < 1e-3 ? 1.0 : 0.5 * (low + high)};
  }

  /// The largest motion C [m2] of any record.
  double widest(const TubeWall& w) const {
    double most = 1e-3 * w.inner * w.inner;
    for (const Trial& t : model_.data().trials) {
      const Eigen::VectorXd& D = t.at("outer_diameter");
      for (Eigen::Index n = 0; n < D.size(); ++n)
        if (std::isfinite(D[n])) most = std::max(most, 0.5 * w.outer * (D[n] - w.outer * (3.0 - (t.has("axial_stretch") ? t.at("axial_stretch")[n] : 1.0))));
    }
    return most;
  }

  /// At the batch's stiffness: a few per cent more or less of one specimen change a correction of a per cent by little.
  const WallTable& table(const Trial& t, const Setting& s, bool fine) const {
    TubeWall w;
    w.outer = 0.5 * t.size("outer_diameter");
    w.inner = w.outer - t.size("wall_thickness");
    Setting own;
    own.base = s.base;
    own.mesh = 4;
    double opening = 0.0;
    std::vector<double> key = {w.inner, w.outer, s.base[0], fine ? 1.0 : 0.0};
    const WallLaw law = law_of(s, own, opening, key);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    const int around = fine ? 32 : 16;
    const auto& outputs = model_.data().outputs;
    Reduced axial;
    if (std::find(outputs.begin(), outputs.end(), "axial_force") != outputs.end()) axial = [&](double C, double lz) { return model_.wall_axial_force(t, own, C, lz); };
    WallTable made = tube_table(w, law, opening, stretches(), widest(w), [&](double C, double lz) { return model_.wall_pressure(t, own, C, lz); }, around, axial);
    if (const double* p = s.on(Effect::first_cycle_softening)) {
      made.softened = tube_softening(w, {static_cast<WallSoftening::Shape>(s.form(Effect::first_cycle_softening)), p[0], p[1]}, widest(w), around);
      if (made.softened.top.empty()) made.linear = NAN;
    }
    return known_.emplace(std::move(key), std::move(made)).first->second;
  }

  const RigModel& model_;
  mutable std::map<std::vector<double>, WallTable> known_;
};

}  // namespace

std::unique_ptr<FullSolver> make_tube_solver(const RigModel& model) { return std::make_unique<TubeSolver>(model); }

}  // namespace filum::reconcile
