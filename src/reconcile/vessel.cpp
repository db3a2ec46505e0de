// vessel-inflation: incompressible tube, wall from a to b, ends held or at a given stretch; r^2 = b^2 + ... by volume.
// Linear elastic (Lame): u = C/r, P = 2 mu C (1/a^2 - 1/b^2), mu = E/3, outer diameter 2 b (1 - (lz-1)/2) + 2 C/b.
// Further terms add pressure as a function of C, by Gauss quadrature over the wall, local stretch l = r'/R of the finite motion
// r'^2 = R^2/lz + 2 C (which agrees with u = C/r to first order), lr = 1/(l lz) across it, P = int (s_theta - s_r) dr'/r':
//   fibres      W = k1/(2 k2)(exp(k2 E^2)-1), E = cos^2(b)(l^2-1)/2 + sin^2(b)(lz^2-1)/2, in tension (Holzapfel, Gasser & Ogden 2000)
//   stiffening  4 c20 (I1-3)(l^2 - lr^2), c10 = E/6                (Yeoh 1993)
//   tone        s_act (1 - ((lm-l)/(lm-1))^2), or a bell that vanishes at l = 1   (Rachev & Hayashi 1999)
//   tethering   pressure k u(b) from outside                        residual stress: neo-Hookean sector (Chuong & Fung 1986)
// Axial force: what a transducer at a closed end shows, the wall's less pi r_i^2 P. Linear: E (lz-1) pi (b^2-a^2), since Lame's wall held in plane strain has
// 2 nu pi a^2 P, nu = 1/2. Further terms add pi int (2 (s_z - s_r) - (s_theta - s_r)) r' dr' at r'^2 = R^2/lz + 2 C (Holzapfel, Gasser & Ogden 2000, reduced axial force), a
// pressure from outside takes pi b^2 of itself.
// Valid: thick or thin wall, quasi-static. Memory acts on the pressure that the wall's motion asks for, and on the axial force.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reconcile/hereditary.h"
#include "reconcile/model.h"

namespace filum::reconcile {
namespace {

constexpr int kPoints = 5;
constexpr double kNode[kPoints] = {0.046910077, 0.230765345, 0.5, 0.769234655, 0.953089923};
constexpr double kWeight[kPoints] = {0.118463443, 0.239314335, 0.284444444, 0.239314335, 0.118463443};

/// Gauss's points of the wall cut in `mesh` rings.
double place(int i, int mesh) { return (i / kPoints + kNode[i % kPoints]) / mesh; }
double share(int i, int mesh) { return kWeight[i % kPoints] / mesh; }

struct Wall {
  double a, b, lame, mu;  // lame = 1/a^2 - 1/b^2
};

/// Active stress at a stretch around; the diameter without pressure is the one measured: tone has no part in it.
double tone_stress(const double* p, int form, double l) {
  const double x = (p[1] - l) / (p[1] - 1.0);
  if (form == 0) return p[0] * std::max(0.0, 1.0 - x * x);
  return p[0] * std::max(0.0, std::exp(-std::pow((l - p[1]) / 0.15, 2)) - std::exp(-std::pow((1.0 - p[1]) / 0.15, 2)));
}

class Vessel final : public RigModel {
 public:
  explicit Vessel(const Dataset& d) : RigModel(d) {
    std::vector<double> spans;
    for (const Trial& t : d.trials) {
      spans.push_back(t.time[t.samples() - 1] - t.time[0]);
      largest_ = std::max(largest_, t.at("pressure").cwiseAbs().maxCoeff());
      const Eigen::VectorXd& D = t.at("outer_diameter");
      for (const double v : D)
        if (std::isfinite(v) && !t.hold_out) strain_ = std::max(strain_, std::abs(v / t.size("outer_diameter") - 1.0));
      b_ = 0.5 * t.size("outer_diameter");
      a_ = b_ - t.size("wall_thickness");
    }
    span_ = median(spans);
  }
  bool has_gain() const override { return true; }
  std::vector<double> guess() const override;
  std::vector<Form> forms() const override;
  void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const override;
  double wall_pressure(const Trial& t, const Setting& s, double C, double stretch) const override { return extra(C, stretch, wall_of(t, s), s); }
  double wall_axial_force(const Trial& t, const Setting& s, double C, double stretch) const override { return axial_force(C, stretch, wall_of(t, s), s); }

 private:
  double extra(double C, double lz, const Wall& w, const Setting& s) const;
  double axial_force(double C, double lz, const Wall& w, const Setting& s) const;
  double sector_axial_force(double C, double angle, int mesh, const Wall& w) const;
  Wall wall_of(const Trial& t, const Setting& s) const;
  double sector(double C, double angle, int mesh, const Wall& w) const;
  /// extra() at one axial stretch, tabulated: cubic (Catmull-Rom) between 400 points.
  struct Table {
    double low = 0.0, step = 1.0;
    std::vector<double> value;
    double operator()(double C) const;
  };
  Table tabulate(double lz, double least, double most, const Wall& w, const Setting& s) const;
  template <class Left, class Extra>
  double solve(double P, double start, const Left& left, const Wall& w, const Extra& extra) const;

  double largest_ = 1e-9, strain_ = 1e-3, a_ = 1.0, b_ = 1.0, span_ = 1.0;
};

/// int f(l, r) dr/r over a wall at motion c whose open sector has the inner radius R_in and its angle over a whole turn 1/K; l the stretch around.
template <class F>
double over_sector(double K, double c, double R_in, int mesh, const Wall& w, const F& f) {
  double sum = 0.0;
  const double ri = std::sqrt(w.a * w.a + 2.0 * c), ro = std::sqrt(w.b * w.b + 2.0 * c);
  for (int i = 0; i < mesh * kPoints; ++i) {
    const double r = ri + (ro - ri) * place(i, mesh);
    const double R = std::sqrt(std::max(R_in * R_in + K * (r * r - ri * ri), 1e-30));
    sum += share(i, mesh) * (ro - ri) * f(r * K / R, r) / r;
  }
  return sum;
}

/// Open inner radius such that the unloaded tube is the one measured.
double open_radius(double K, int mesh, const Wall& w) {
  double low = 0.2 * w.a, high = 6.0 * w.a * K;
  for (int i = 0; i < 40; ++i) {
    const double mid = 0.5 * (low + high);
    (over_sector(K, 0.0, mid, mesh, w, [&](double l, double) { return w.mu * (l * l - 1.0 / (l * l)); }) > 0.0 ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

/// Pressure that a neo-Hookean tube closed from a sector of this opening angle bears, less that of the one without.
double Vessel::sector(double C, double angle, int mesh, const Wall& w) const {
  const double K = 1.0 / (1.0 - angle / (2.0 * std::numbers::pi));  // r'^2 = r0^2 + (R^2 - R0^2)/K
  const auto stress = [&](double l, double) { return w.mu * (l * l - 1.0 / (l * l)); };
  return over_sector(K, C, open_radius(K, mesh, w), mesh, w, stress) - over_sector(1.0, C, w.a, mesh, w, stress);
}

double Vessel::sector_axial_force(double C, double angle, int mesh, const Wall& w) const {
  const double K = 1.0 / (1.0 - angle / (2.0 * std::numbers::pi));
  const auto stress = [&](double l, double r) { return std::numbers::pi * r * r * w.mu * (2.0 * (1.0 - 1.0 / (l * l)) - (l * l - 1.0 / (l * l))); };
  return over_sector(K, C, open_radius(K, mesh, w), mesh, w, stress) - over_sector(1.0, C, w.a, mesh, w, stress);
}

/// Beyond the linear law, reduced.
double Vessel::axial_force(double C, double lz, const Wall& w, const Setting& s) const {
  const double *fibre = s.on(Effect::fibre_stiffening), *stiff = s.on(Effect::strain_stiffening), *tone = s.on(Effect::smooth_muscle_tone);
  double F = 0.0;
  for (int i = 0; (fibre != nullptr || stiff != nullptr || tone != nullptr) && i < s.mesh * kPoints; ++i) {
    const double R = w.a + (w.b - w.a) * place(i, s.mesh), l2 = std::max(1.0 / lz + 2.0 * C / (R * R), 1e-4), z2 = lz * lz, r2 = 1.0 / (l2 * z2);
    double around = 0.0, along = 0.0;  // s_theta - s_r, s_z - s_r
    if (fibre != nullptr) {
      const double c2 = std::pow(std::cos(fibre[2]), 2), e = c2 * 0.5 * (l2 - 1.0) + (1.0 - c2) * 0.5 * (z2 - 1.0);
      const double tension = e > 0.0 ? (s.form(Effect::fibre_stiffening) == 1 ? 1.0 : 2.0) * fibre[0] * e * std::exp(std::min(fibre[1] * e * e, 60.0)) : 0.0;
      around += tension * c2 * l2, along += tension * (1.0 - c2) * z2;
    }
    if (stiff != nullptr) {
      const double i1 = l2 + z2 + r2 - 3.0;
      const double slope = w.mu * (s.form(Effect::strain_stiffening) == 0 ? 2.0 * stiff[0] * i1 : std::expm1(std::min(2.0 * stiff[0] * i1, 50.0)));
      around += slope * (l2 - r2), along += slope * (z2 - r2);
    }
    if (tone != nullptr) around += tone_stress(tone, s.form(Effect::smooth_muscle_tone), std::sqrt(l2));
    F += share(i, s.mesh) * (w.b - w.a) * std::numbers::pi * (2.0 * along - around) * R / lz;
  }
  if (const double* p = s.on(Effect::perivascular_tethering)) F -= p[0] * C / w.b * std::numbers::pi * w.b * w.b;
  if (const double* p = s.on(Effect::residual_stress)) F += sector_axial_force(C, p[0], s.mesh, w);
  return F + (s.wall != nullptr ? s.wall->at(C, lz, &WallTable::Slice::axial) : 0.0);
}

double Vessel::extra(double C, double lz, const Wall& w, const Setting& s) const {
  const double *fibre = s.on(Effect::fibre_stiffening), *stiff = s.on(Effect::strain_stiffening), *tone = s.on(Effect::smooth_muscle_tone);
  double P = 0.0;
  if (fibre != nullptr || stiff != nullptr || tone != nullptr) {
    const double ri = std::sqrt(std::max(w.a * w.a / lz + 2.0 * C, 1e-4 * w.a * w.a)), ro = std::sqrt(std::max(w.b * w.b / lz + 2.0 * C, 1.1e-4 * w.b * w.b));
    for (int i = 0; i < s.mesh * kPoints; ++i) {
      const double r = ri + (ro - ri) * place(i, s.mesh);
      const double l = r / std::sqrt(std::max((r * r - 2.0 * C) * lz, 1e-4 * w.a * w.a)), lr = 1.0 / (l * lz);
      double stress = 0.0;
      if (fibre != nullptr) {
        const double c2 = std::pow(std::cos(fibre[2]), 2), e = c2 * 0.5 * (l * l - 1.0) + (1.0 - c2) * 0.5 * (lz * lz - 1.0);
        const double turn = s.form(Effect::fibre_stiffening) == 1 ? 1.0 : 2.0;  // one or two families
        if (e > 0.0) stress += turn * fibre[0] * e * std::exp(std::min(fibre[1] * e * e, 60.0)) * c2 * l * l;
      }
      if (stiff != nullptr) {
        const double i1 = l * l + lr * lr + lz * lz - 3.0, c10 = 0.5 * w.mu;
        if (s.form(Effect::strain_stiffening) == 0) stress += 4.0 * stiff[0] * c10 * i1 * (l * l - lr * lr);
        else stress += w.mu * std::expm1(std::min(2.0 * stiff[0] * i1, 50.0)) * (l * l - lr * lr);
      }
      if (tone != nullptr) stress += tone_stress(tone, s.form(Effect::smooth_muscle_tone), l);
      P += share(i, s.mesh) * (ro - ri) * stress / r;
    }
  }
  if (const double* p = s.on(Effect::perivascular_tethering)) P += p[0] * C / w.b;
  if (const double* p = s.on(Effect::residual_stress)) P += sector(C, p[0], s.mesh, w);
  return P + (s.wall != nullptr ? s.wall->at(C, lz) : 0.0);
}

double Vessel::Table::operator()(double C) const {
  const double x = std::clamp((C - low) / step, 1.0, static_cast<double>(value.size()) - 3.001);
  const auto i = static_cast<std::size_t>(x);
  const double t = x - static_cast<double>(i), a = value[i - 1], b = value[i], c = value[i + 1], d = value[i + 2];
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

Vessel::Table Vessel::tabulate(double lz, double least, double most, const Wall& w, const Setting& s) const {
  const int points = 400 * s.mesh;
  Table t;
  t.step = (most - least) / (points - 7);
  t.low = least - 3 * t.step;
  for (int i = 0; i < points; ++i) t.value.push_back(extra(t.low + i * t.step, lz, w, s));
  return t;
}

/// C that bears the pressure P; monotone (what has softened comes back firmer as the energy rises), so Newton steps guarded by bisection.
template <class Left, class Extra>
double Vessel::solve(double P, double start, const Left& left, const Wall& w, const Extra& extra) const {
  const auto miss = [&](double C) { return left(C) * (2.0 * w.mu * C * w.lame + extra(C)) - P; };
  double low = -0.49 * w.a * w.a, high = 40.0 * w.a * w.a, C = start;
  for (int i = 0; i < 60; ++i) {
    const double f = miss(C);
    (f > 0.0 ? high : low) = C;
    const double h = 1e-6 * w.a * w.a, slope = (miss(C + h) - f) / h;
    double next = slope > 0.0 ? C - f / slope : 0.5 * (low + high);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - C) < 1e-9 * w.a * w.a) return next;
    C = next;
  }
  return C;
}

Wall Vessel::wall_of(const Trial& t, const Setting& s) const {
  Wall w{};
  w.b = 0.5 * t.size("outer_diameter");
  w.a = w.b - t.size("wall_thickness");
  w.lame = (1.0 / (w.a * w.a) - 1.0 / (w.b * w.b)) * (s.wall != nullptr ? s.wall->linear : 1.0);
  w.mu = s.base[0] * s.scale / 3.0;
  return w;
}

Kernel memory(const Setting& s) {
  const double* p = s.on(Effect::viscoelastic_relaxation);
  const int kind = s.form(Effect::viscoelastic_relaxation);
  return kind == 0 ? prony(p[0], p[1]) : kind == 1 ? prony(p[0], p[1], p[2], p[3]) : fractional(p[0], p[1], p[2]);
}

void Vessel::rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const {
  const Wall w = wall_of(t, s);
  Eigen::VectorXd P = t.at("pressure");
  if (s.on(Effect::viscoelastic_relaxation) != nullptr) creep(memory(s), t.time, P);
  const double* soft = s.on(Effect::first_cycle_softening);
  const bool plain = soft == nullptr && s.on(Effect::fibre_stiffening) == nullptr && s.on(Effect::strain_stiffening) == nullptr &&
                     s.on(Effect::smooth_muscle_tone) == nullptr && s.on(Effect::perivascular_tethering) == nullptr && s.on(Effect::residual_stress) == nullptr && (s.wall == nullptr || s.wall->slices.empty());
  out.resize(t.samples(), static_cast<Eigen::Index>(data().outputs.size()));
  double C = 0.0, top = 0.0;
  // an elastic term bears pressure at every C > 0, so the linear wall alone bounds C from above (softening by its factor)
  const bool steady = !t.has("axial_stretch") || t.at("axial_stretch").maxCoeff() == t.at("axial_stretch").minCoeff();
  const double reach = std::max(P.maxCoeff(), -P.minCoeff()) / (2.0 * w.mu * w.lame) / (soft != nullptr ? 1.0 - soft[0] : 1.0);
  Table table;
  const double held = t.has("axial_stretch") ? t.at("axial_stretch")[0] : 1.0;
  const double least = held > 1.001 ? -0.45 * w.a * w.a : std::max(std::min(0.0, 1.3 * P.minCoeff() / (2.0 * w.mu * w.lame)), -0.45 * w.a * w.a);  // fibres that the axis stretches pull in
  if (!plain && steady) table = tabulate(held, least, 1.3 * reach, w, s);
  for (Eigen::Index n = 0; n < P.size(); ++n) {
    const double lz = t.has("axial_stretch") ? t.at("axial_stretch")[n] : 1.0;
    const auto left = [&](double c) {  // share of the stress, by the energy over the modulus that this motion has and the most so far
      if (soft == nullptr) return 1.0;
      const double e = c / (w.a * w.b), energy = 0.5 * e * e, most = std::max(top, energy);
      return 1.0 - soft[0] * softening_share((most - energy) / soft[1], s.form(Effect::first_cycle_softening)) +
             (s.wall != nullptr ? s.wall->softened.at(c, w.a * w.b * std::sqrt(2.0 * most)) : 0.0);
    };
    if (plain) {
      C = P[n] / (2.0 * w.mu * w.lame);
    } else {
      C = steady ? solve(P[n], C, left, w, table) : solve(P[n], C, left, w, [&](double c) { return extra(c, lz, w, s); });
      top = std::max(top, 0.5 * std::pow(C / (w.a * w.b), 2));
    }
    const double whole = left(C);
    for (std::size_t c = 0; c < data().outputs.size(); ++c) {
      double& y = out(n, static_cast<Eigen::Index>(c));
      if (data().outputs[c] == "outer_diameter") y = 2.0 * w.b * (1.0 - 0.5 * (lz - 1.0)) + 2.0 * C / w.b;
      else y = whole * (3.0 * w.mu * (lz - 1.0) * std::numbers::pi * (w.b * w.b - w.a * w.a) * (s.wall != nullptr ? s.wall->axial : 1.0) + (plain ? 0.0 : axial_force(C, lz, w, s)));
    }
  }
  if (s.on(Effect::viscoelastic_relaxation) != nullptr)
    for (std::size_t c = 0; c < data().outputs.size(); ++c)
      if (data().outputs[c] == "axial_force") relax(memory(s), t.time, out.col(static_cast<Eigen::Index>(c)));
}

std::vector<double> Vessel::guess() const {
  double pu = 0.0, pp = 0.0;
  for (const Trial& t : data().trials) {
    if (t.hold_out) continue;
    const double b = 0.5 * t.size("outer_diameter"), a = b - t.size("wall_thickness"), lame = 1.0 / (a * a) - 1.0 / (b * b);
    for (Eigen::Index n = 0; n < t.time.size(); ++n) {
      const double lz = t.has("axial_stretch") ? t.at("axial_stretch")[n] : 1.0;
      const double rise = t.at("outer_diameter")[n] - 2.0 * b * (1.0 - 0.5 * (lz - 1.0)), x = t.at("pressure")[n] * 3.0 / (b * lame);
      if (std::isfinite(rise)) pu += rise * x, pp += x * x;
    }
  }
  const double E = pp / std::max(pu, 1e-300);
  return {E > 1.0 && E < 1e10 ? E : data().nominal.at("youngs_modulus")};
}

std::vector<Form> Vessel::forms() const {
  const double T = span_, tiny = 1e-3 * T;
  const double inner = std::max(strain_, 0.01) * b_ / a_, green = inner + 0.5 * inner * inner;
  const double stress = largest_ * a_ / (b_ - a_);
  const double k1 = 0.2 * stress / green, deg = std::numbers::pi / 180.0;
  double shortest = INFINITY, longest = -INFINITY;
  for (const Trial& t : data().trials) {
    shortest = std::min(shortest, t.has("axial_stretch") ? t.at("axial_stretch").minCoeff() : 1.0);
    longest = std::max(longest, t.has("axial_stretch") ? t.at("axial_stretch").maxCoeff() : 1.0);
  }
  const bool axial = longest - shortest > 0.02;
  const ParamSpec k1s{"k1", "Pa", 1e-3 * k1, 50 * k1, true}, k2s{"k2", "-", 0.01 / (green * green), 40.0 / (green * green), true};
  // without an axial stretch the angle only scales k1 and k2: held near 40 degrees
  const ParamSpec angle{"fibre_angle", "rad", (axial ? 5 : 39.9) * deg, (axial ? 75 : 40.1) * deg, false};
  std::vector<Form> f;
  for (int k = 0; k < 2; ++k)
    f.push_back({Effect::fibre_stiffening, k, k == 0 ? "two symmetric families" : "one family", {k1s, k2s, angle},
                 grid({{k1}, {1.0 / (green * green), 8.0 / (green * green)}, {40 * deg}}), false});
  const double r0 = 0.1 / (inner * inner);
  for (int k = 0; k < 2; ++k)
    f.push_back({Effect::strain_stiffening, k, k == 0 ? "Yeoh" : "exponential", {{"c20_over_c10", "-", 1e-3 * r0, 300 * r0, true}}, {{r0}, {6 * r0}}, false});
  f.push_back({Effect::smooth_muscle_tone, 0, "parabola of the stretch", {{"active_stress", "Pa", 1e-3 * stress, 5 * stress, true}, {"stretch_of_most_tone", "-", 1.02, 1.8, false}},
               grid({{0.2 * stress}, {1.1, 1.3}}), false});
  f.push_back({Effect::smooth_muscle_tone, 1, "bell of the stretch", {{"active_stress", "Pa", 1e-3 * stress, 5 * stress, true}, {"stretch_of_most_tone", "-", 1.02, 1.8, false}},
               grid({{0.2 * stress}, {1.1, 1.25}}), false});
  f.push_back({Effect::residual_stress, 0, "neo-Hookean sector", {{"opening_angle", "rad", 2 * deg, 300 * deg, false}}, {{60 * deg}, {150 * deg}}, false});
  const double k = largest_ / (strain_ * b_);
  f.push_back({Effect::perivascular_tethering, 0, "elastic foundation", {{"foundation_stiffness", "Pa/m", 1e-3 * k, 3 * k, true}}, {{0.2 * k}}, false});
  const ParamSpec g1{"g1", "-", 0.005, 0.97, false}, tau{"tau1", "s", tiny, 10 * T, true};
  const auto visco = Effect::viscoelastic_relaxation;
  f.push_back({visco, 0, "one exponential", {g1, tau}, grid({{0.3}, {0.02 * T, 0.1 * T, 0.5 * T}}), false});
  f.push_back({visco, 2, "fractional Zener (Cole-Cole) relaxation", {g1, tau, {"order", "-", 0.15, 0.95, false}}, grid({{0.4}, {0.03 * T, 0.2 * T}, {0.6}}), false});
  f.push_back({visco, 1, "two exponentials", {{"g1", "-", 0.005, 0.6, false}, tau, {"g2", "-", 0.005, 0.39, false}, {"tau2", "s", tiny, 10 * T, true}},
               grid({{0.2}, {0.02 * T}, {0.2}, {0.2 * T}}), false});
  const double W = 0.5 * inner * inner;
  const char* softenings[] = {"exponential in the energy", "error function of the energy", "x/(1 + x) of the energy"};
  for (int kind = 0; kind < 3; ++kind)
    f.push_back({Effect::first_cycle_softening, kind, softenings[kind], {{"d", "-", 0.005, 0.9, false}, {"W0", "Pa", 0.01 * W, 5 * W, true, 0}}, grid({{0.2}, {0.1 * W, 0.5 * W}}), false});
  return f;
}

}  // namespace

std::unique_ptr<RigModel> make_vessel(const Dataset& d) { return std::make_unique<Vessel>(d); }

}  // namespace filum::reconcile
