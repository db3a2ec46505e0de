// tissue-block and spatula-press: homogeneous (or, under the blade, effective) strain e = u/h, so the force is a chain of scalar
// laws: play -> load train -> permanent set -> elastic law -> softening -> relaxation, drainage -> contact.
//   linear      F = E K e (shear: E/(2(1+nu)) K e), K = A (contract: small-strain stiffness E A / h)
//   Ogden       P = 2E/(3 alpha) (l^(alpha-1) - l^(-alpha/2-1))                 (Ogden 1972; Budday et al. 2017)
//   stiffening  P = 2 (l - l^-2)(c10 + 2 c20 (I1-3)), c10 = E/6                 (Yeoh 1993); also E e exp(2 r (I1-3)) (Demiray 1972)
//               under a blade E* e (1 + 2 r (I1-3)) or exp, I1 of the stretch 1 - depth/height
//   softening   factor 1 - d (1 - exp(-(Wmax - W)/W0)); also erf (Ogden & Roxburgh 1999) and x/(1 + x), x = (Wmax - W)/W0
//   platen      1 + mu S/3, (e^(mu S) - 1)/(mu S), 1 + mu S^2, S = width/height
// The blade: e = depth/height, K = E* stiffness of a rectangular punch on a bonded layer, F = depth (2 sqrt(A/pi) + A/h)/(1-nu^2) E.
// Valid: quasi-static, uniform strain. The blade's factor is an estimate: its error is a free scale of each blade size.

#include <algorithm>
#include <cmath>
#include <set>

#include "physics/tissue_law.h"
#include "reconcile/hereditary.h"
#include "reconcile/model.h"

namespace filum::reconcile {
namespace {

enum class Mode { compression, tension, shear, press, press_small };  // press_small: small strains, as physics/tissue_law has them

struct Geometry {
  Mode mode;
  double height, area, aspect, radius;  // [m], [m2], width/height, half of the lateral size [m]
  double factor;                        // force = factor * E * e (nu apart)
};

Geometry geometry_of(const Dataset& d, const Trial& t) {
  Geometry g{};
  g.height = t.size("height");
  if (d.rig == Rig::spatula_press) {
    g.mode = Mode::press;
    g.area = t.size("blade_length") * t.size("blade_width");
    g.radius = 0.5 * t.size("blade_width");
    g.aspect = t.size("blade_width") / g.height;
    g.factor = (2.0 * std::sqrt(g.area / 3.14159265358979) * g.height + g.area);
    return g;
  }
  const std::string mode = t.word("mode");
  g.mode = mode == "shear" ? Mode::shear : mode == "tension" ? Mode::tension : Mode::compression;
  const bool round = t.shape == "cylinder";
  g.area = round ? 0.25 * 3.14159265358979 * t.size("diameter") * t.size("diameter") : t.size("length") * t.size("width");
  g.radius = round ? 0.5 * t.size("diameter") : 0.5 * std::min(t.size("length"), t.size("width"));
  g.aspect = round ? t.size("diameter") / g.height : std::sqrt(g.area) / g.height;
  g.factor = g.area;
  return g;
}

/// First invariant minus 3 of uniaxial stretch or simple shear; a press counts depth/height positive, its stretch is 1 - depth/height.
double invariant(double e, Mode mode) {
  if (mode == Mode::shear) return e * e;
  const double l = std::max(mode == Mode::press ? 1.0 - e : 1.0 + e, 0.05);
  return l * l + 2.0 / l - 3.0;
}

/// Stress of simple shear over G by Ogden's one-term law.
double sheared_ogden(double e, double alpha) {
  const double root = std::sqrt(1.0 + 0.25 * e * e), l = 0.5 * e + root;
  return (std::pow(l, alpha) - std::pow(l, -alpha)) / (alpha * 2.0 * root);
}

/// The difference of the stiffening law from the linear one, over the modulus.
double stiffening(double e, double r, int kind, Mode mode) {
  const double i1 = mode == Mode::press_small ? 3.0 * e * e : invariant(e, mode);
  const double l = std::max(1.0 + e, 0.05);
  const bool shear = mode == Mode::shear;
  const bool pressed = mode == Mode::press || mode == Mode::press_small;  // a blade's linear law is the tissue's: what stiffens is its secant, as in the elements
  const double neo = shear || pressed ? e : (l - 1.0 / (l * l)) / 3.0;
  switch (kind) {
    case 0: return shear ? 2.0 * r * e * e * e : 2.0 * r * neo * i1;
    case 1: return neo * (1.0 + 2.0 * r * i1) - e;
    case 4: return 2.0 * r * e * i1;
    case 2: return e * std::expm1(std::min(2.0 * r * i1, 50.0));
    default: return neo * std::exp(std::min(2.0 * r * i1, 50.0)) - e;
  }
}

}  // namespace

double PressTable::at(double strain, double most) const {
  if (load.empty() || peak <= 0.0 || strain <= 0.0) return load.empty() || strain > 0.0 ? 0.0 : most >= peak * (1.0 - 1e-9) ? unload[0] : 0.0;
  const auto between = [](const std::vector<double>& v, double x) {
    const double at = std::clamp(x, 0.0, 1.0) * kPoints;
    const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kPoints - 1));
    return v[i] + (at - static_cast<double>(i)) * (v[i + 1] - v[i]);
  };
  if (strain >= most) return between(load, strain / peak);
  return most / peak * between(unload, strain / most);
}

namespace {

class Tissue final : public RigModel {
 public:
  explicit Tissue(const Dataset& d) : RigModel(d) {
    input_ = d.rig == Rig::tissue_block ? "displacement" : "depth";
    for (const Trial& t : d.trials) {
      const Geometry g = geometry_of(d, t);
      for (const double u : t.at(input_)) largest_ = std::max(largest_, std::abs(u) / g.height);
      sizes_.insert({std::lround(1e7 * g.radius), std::lround(1e7 * g.height)});
      radius_ = std::max(radius_, g.radius);
      height_ = std::max(height_, g.height);
      spans_.push_back(t.time[t.samples() - 1] - t.time[0]);
      sheared_ = sheared_ || g.mode == Mode::shear;
      area_ = std::max(area_, g.area);
      travel_ = std::max(travel_, largest_ * g.height);
    }
    force_ = full_scale(d.outputs[0]) * (d.outputs[0] == "pressure" ? area_ : 1.0);
    span_ = median(spans_);
  }

  std::vector<double> guess() const override;
  std::vector<Form> forms() const override;
  void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const override;
  double press_law(const Trial& t, const Setting& s, double strain, double most) const override;
  double largest_strain() const override { return largest_; }
  double punch_stiffness(const Trial& t, double nu) const override {
    const Geometry g = geometry_of(data(), t);
    return g.factor / g.height / (1.0 - nu * nu);
  }

 private:
  double modulus(const Geometry& g, const Setting& s) const;
  double elastic(double e, const Geometry& g, const Setting& s) const;
  double chain(double e, double most, double top, const Geometry& g, const Setting& s) const;
  void elastic_history(const Trial& t, const Geometry& g, const Setting& s, Eigen::VectorXd& f) const;
  void drain(const Trial& t, const Geometry& g, const Setting& s, Eigen::VectorXd& f) const;
  void part(const Trial& t, const Geometry& g, const Setting& s, Eigen::VectorXd& f) const;
  double widening(const Geometry& g, const Setting& s) const;

  std::string input_;
  std::vector<double> spans_;
  std::set<std::pair<long, long>> sizes_;  // lateral and height [0.1 um]
  bool sheared_ = false;
  double largest_ = 1e-9, radius_ = 0.0, height_ = 0.0, span_ = 1.0, force_ = 1.0, area_ = 0.0, travel_ = 0.0;
};

double Tissue::modulus(const Geometry& g, const Setting& s) const {
  const double E = s.base[0] * s.scale, nu = s.base[1];
  if (g.mode == Mode::shear) return E / (2.0 * (1.0 + nu));
  return g.mode == Mode::press ? E / (1.0 - nu * nu) : E;
}

/// Stress over the modulus.
double Tissue::elastic(double e, const Geometry& g, const Setting& s) const {
  double stress = e;
  if (const double* p = s.on(Effect::strain_stiffening)) stress += stiffening(e, p[0], s.form(Effect::strain_stiffening), g.mode);
  if (const double* p = s.on(Effect::tension_compression_asymmetry)) {
    const int form = s.form(Effect::tension_compression_asymmetry);
    if (g.mode != Mode::shear) stress += asymmetric_stress(e, p[0], form);
    else if (form == 0) stress += sheared_ogden(e, p[0]) - e;
  }
  return stress;
}

double Tissue::widening(const Geometry& g, const Setting& s) const {
  const double* p = s.on(Effect::platen_friction);
  if (p == nullptr || g.mode == Mode::shear) return 1.0;
  const double x = p[0] * g.aspect;
  switch (s.form(Effect::platen_friction)) {
    case 0: return 1.0 + x / 3.0;
    case 1: return x < 1e-6 ? 1.0 + 0.5 * x : std::expm1(x) / x;
    default: return 1.0 + p[0] * g.aspect * g.aspect;
  }
}

/// Stress over the modulus, of the strain less what has set; `top`: largest past energy over the modulus.
double Tissue::chain(double e, double most, double top, const Geometry& g, const Setting& s) const {
  if (const double* set = s.on(Effect::permanent_set)) {
    const double peak = std::abs(e) > std::abs(most) ? e : most;
    e -= set[0] * (s.form(Effect::permanent_set) == 0 ? peak : peak * std::abs(peak) / largest_);
  }
  double stress = elastic(e, g, s);
  if (const double* soft = s.on(Effect::first_cycle_softening)) {
    const double w = 0.5 * e * e, deficit = std::max(top - w, 0.0) / soft[1];
    stress *= 1.0 - soft[0] * softening_share(deficit, s.form(Effect::first_cycle_softening));
  }
  return stress;
}

double Tissue::press_law(const Trial& t, const Setting& s, double strain, double most) const {
  const double* set = s.on(Effect::permanent_set);
  const double held = most - (set == nullptr ? 0.0 : set[0] * (s.form(Effect::permanent_set) == 0 ? most : most * most / largest_));
  Geometry g = geometry_of(data(), t);
  g.mode = Mode::press_small;
  return chain(strain, most, 0.5 * held * held, g, s);
}

void Tissue::elastic_history(const Trial& t, const Geometry& g, const Setting& s, Eigen::VectorXd& f) const {
  const Eigen::VectorXd& u = t.at(input_);
  const double* play = s.on(Effect::hysteresis);
  const double* set = s.on(Effect::permanent_set);
  const double* train = s.on(Effect::rig_compliance);
  const double stiff = modulus(g, s) * g.factor * widening(g, s);  // [N] per strain
  double held = u[0], most = 0.0, top = 0.0, force = 0.0;
  for (Eigen::Index n = 0; n < u.size(); ++n) {
    double x = u[n];
    if (play != nullptr) held = x = std::clamp(held, x - 0.5 * play[0], x + 0.5 * play[0]);
    const auto law = [&](double travel) {
      const double e = travel / g.height;
      return stiff * (chain(e, most, top, g, s) + (s.press != nullptr ? s.press->at(e, std::max(most, e)) : 0.0));
    };
    if (train != nullptr) {  // force = law(x - C force), by the secant rule
      double a = force, fa = law(x - train[0] * a) - a;
      double b = a + fa / (1.0 + train[0] * stiff / g.height);
      for (int i = 0; i < 12 && std::abs(b - a) > 1e-10 * force_; ++i) {
        const double fb = law(x - train[0] * b) - b;
        const double c = std::abs(fb - fa) > 0.0 ? b - fb * (b - a) / (fb - fa) : b;
        a = b;
        fa = fb;
        b = c;
      }
      force = b;
      x -= train[0] * force;
    } else {
      force = law(x);
    }
    f[n] = force;
    const double e = x / g.height;
    if (std::abs(e) > std::abs(most)) most = e;
    const double shifted = set != nullptr ? e - set[0] * most : e;
    top = std::max(top, 0.5 * shifted * shifted);
  }
}

void Tissue::drain(const Trial& t, const Geometry& g, const Setting& s, Eigen::VectorXd& f) const {
  if (const double* p = s.on(Effect::viscoelastic_relaxation)) {
    const int kind = s.form(Effect::viscoelastic_relaxation);
    relax(kind == 0 ? prony(p[0], p[1]) : kind == 1 ? prony(p[0], p[1], p[2], p[3]) : fractional(p[0], p[1], p[2], s.mesh), t.time, f);
  }
  const double* p = s.on(Effect::poroelastic_drainage);
  if (p == nullptr || g.mode == Mode::shear) return;  // shear keeps the volume: nothing drains
  if (s.drained != nullptr) return relax(*s.drained, t.time, f);
  switch (s.form(Effect::poroelastic_drainage)) {
    case 0: relax(radial_drainage(p[1], p[0], g.radius, 12 * s.mesh), t.time, f); break;
    case 1: relax(slab_drainage(p[1], p[0], g.height, 12 * s.mesh), t.time, f); break;
    // the slowest mode alone: a_1 = 2.405 of the cylinder, pi of the slab drained on both faces
    case 2: relax(prony(p[1], g.radius * g.radius / (5.783 * p[0])), t.time, f); break;
    default: relax(prony(p[1], g.height * g.height / (9.870 * p[0])), t.time, f); break;
  }
}

/// Contact is lost where a compressed specimen is left behind; adhesion holds on until a traction (or a gap) is passed.
void Tissue::part(const Trial& t, const Geometry& g, const Setting& s, Eigen::VectorXd& f) const {
  const Eigen::VectorXd& u = t.at(input_);
  const double away = g.mode == Mode::press ? -1.0 : 1.0;
  const double eps = 1e-3 * largest_ * g.height;
  const bool loose = g.mode == Mode::press || (g.mode == Mode::compression && (u[0] > eps || u[u.size() - 1] > eps));
  if (!loose) return;
  const double* p = s.on(Effect::contact_adhesion);
  const int kind = s.form(Effect::contact_adhesion);
  const double stiff = modulus(g, s) * g.factor / g.height;
  bool attached = away * u[0] <= eps;
  for (Eigen::Index n = 0; n < u.size(); ++n) {
    const double gap = away * u[n];
    if (gap <= 0.0) {
      attached = true;
      continue;
    }
    f[n] = 0.0;
    if (p == nullptr || !attached) continue;
    const double limit = p[0] * g.area;
    if (kind == 0) {
      attached = stiff * gap <= limit;
      if (attached) f[n] = away * stiff * gap;
    } else if (kind == 1) {
      f[n] = away * limit * gap / p[1] * std::exp(1.0 - gap / p[1]);
    } else {
      attached = gap <= p[1];
      if (attached) f[n] = away * limit * std::min(1.0, 20.0 * gap / p[1]);
    }
  }
}

void Tissue::rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const {
  const Geometry g = geometry_of(data(), t);
  Eigen::VectorXd f(t.samples());
  elastic_history(t, g, s, f);
  drain(t, g, s, f);
  part(t, g, s, f);
  out.resize(t.samples(), static_cast<Eigen::Index>(data().outputs.size()));
  for (std::size_t c = 0; c < data().outputs.size(); ++c) {
    const std::string& name = data().outputs[c];
    auto column = out.col(static_cast<Eigen::Index>(c));
    if (name == "force") column = f;
    else if (name == "pressure") column = f / g.area;
    else column = t.at(input_);  // a marker moves in proportion to the depth, with a free factor (see free gain)
  }
}

std::vector<double> Tissue::guess() const {
  double fe = 0.0, ee = 0.0;
  const Dataset& d = data();
  for (const Trial& t : d.trials) {
    const Geometry g = geometry_of(d, t);
    if (g.mode == Mode::shear || t.hold_out) continue;
    const double nu = d.nominal.at("poissons_ratio"), share = g.mode == Mode::press ? 1.0 / (1.0 - nu * nu) : 1.0;
    const Eigen::VectorXd &u = t.at(input_), &f = t.at(d.outputs[0]);
    for (Eigen::Index n = 0; n < u.size(); ++n) {
      const double model = u[n] / g.height * g.factor * share / (d.outputs[0] == "pressure" ? g.area : 1.0);
      if (std::isfinite(f[n])) fe += f[n] * model, ee += model * model;
    }
  }
  const double E = ee > 0.0 ? fe / ee : d.nominal.at("youngs_modulus");
  return {E > 1.0 ? E : d.nominal.at("youngs_modulus"), d.nominal.at("poissons_ratio")};
}

std::vector<Form> Tissue::forms() const {
  const double T = span_, tiny = 1e-3 * T;
  const double c = travel_ / force_;           // [m/N]
  const double w = 0.5 * largest_ * largest_;  // of the strain energy over E
  const double Dr = radius_ * radius_ / T, Dh = height_ * height_ / T;
  const double r0 = 0.1 / (largest_ * largest_);
  const auto own = effects_of(data().rig);
  std::vector<Form> f;
  const auto visco = Effect::viscoelastic_relaxation;
  const ParamSpec g1{"g1", "-", 0.005, 0.97, false}, tau{"tau1", "s", tiny, 10 * T, true};
  f.push_back({visco, 0, "one exponential", {g1, tau}, grid({{0.3}, {0.02 * T, 0.1 * T, 0.5 * T}}), false});
  f.push_back({visco, 2, "fractional Zener (Cole-Cole) relaxation", {g1, tau, {"order", "-", 0.15, 0.95, false}}, grid({{0.4}, {0.03 * T, 0.2 * T}, {0.6}}), false});
  f.push_back({visco, 1, "two exponentials", {{"g1", "-", 0.005, 0.6, false}, tau, {"g2", "-", 0.005, 0.39, false}, {"tau2", "s", tiny, 10 * T, true}},
               grid({{0.2}, {0.02 * T}, {0.2}, {0.2 * T}}), false});
  const ParamSpec ratio{"c20_over_c10", "-", 1e-3 * r0, 300 * r0, true};
  const char* names[] = {"Yeoh term added to the linear law", "Yeoh", "exponential", "Demiray", "linear law times 1 + 2 r (I1 - 3)"};
  for (int k = 0; k < (data().rig == Rig::tissue_block ? 5 : 3); k += data().rig == Rig::tissue_block ? 1 : 2)
    f.push_back({Effect::strain_stiffening, k, names[k], {ratio}, {{r0}, {8 * r0}}, false});
  const ParamSpec alpha{"alpha", "-", -120.0, -0.05, false};
  f.push_back({Effect::tension_compression_asymmetry, 0, "Ogden", {alpha}, {{-5.0}, {-20.0}}, false});
  f.push_back({Effect::tension_compression_asymmetry, 1, "quadratic term", {alpha}, {{-5.0}, {-20.0}}, false});
  f.push_back({Effect::tension_compression_asymmetry, 2, "two moduli, ratio as Ogden's at a strain of 0.1", {alpha}, {{-5.0}, {-20.0}}, false});
  const ParamSpec W0{"W0", "Pa", 0.01 * w, 5.0 * w, true, 0};
  f.push_back({Effect::first_cycle_softening, 0, "exponential in the energy", {{"d", "-", 0.005, 0.9, false}, W0}, grid({{0.2}, {0.1 * w, 0.5 * w}}), false});
  f.push_back({Effect::first_cycle_softening, 1, "error function of the energy", {{"d", "-", 0.005, 0.9, false}, W0}, grid({{0.2}, {0.3 * w}}), false});
  f.push_back({Effect::first_cycle_softening, 2, "x/(1 + x) of the energy", {{"d", "-", 0.005, 0.9, false}, W0}, grid({{0.3}, {0.2 * w}}), false});
  f.push_back({Effect::permanent_set, 0, "fraction of the largest past strain", {{"fraction", "-", 0.002, 0.6, false}}, {{0.05}}, false});
  f.push_back({Effect::permanent_set, 1, "grows with the square of the largest past strain", {{"fraction", "-", 0.002, 0.6, false}}, {{0.05}}, false});
  // where the size that counts is the same in all trials, and none is shear, drainage is the relaxation of a solid under another name
  std::set<long> across, along;
  for (const auto& [radius, height] : sizes_) across.insert(radius), along.insert(height);
  const auto drain = [&](int kind, const char* text, double D, double x = 1.0) {
    f.push_back({Effect::poroelastic_drainage, kind, text, {{"diffusivity", "m2/s", 1e-3 * D, 100 * D, true}, {"drained_share", "-", 0.01, 0.9, false}},
                 grid({{0.05 * x * D, 0.5 * x * D, 3 * x * D}, {0.3}}), false, !sheared_ && (kind % 2 == 0 ? across : along).size() == 1});
  };
  drain(0, "radial drainage", Dr);
  drain(1, "drainage through the height", Dh);
  // of one size alone these are the relaxation of a solid under another name
  if (sheared_ || across.size() > 1) drain(2, "slowest mode alone, lateral size", Dr, 1.0 / 5.783);
  if (sheared_ || along.size() > 1) drain(3, "slowest mode alone, height", Dh, 1.0 / 9.870);
  const double pull = 0.05 * force_ / area_;
  const ParamSpec traction{"pull_off", "Pa", 1e-2 * pull, 30 * pull, true}, gap{"gap", "m", 1e-3 * travel_, travel_, true};
  f.push_back({Effect::contact_adhesion, 0, "elastic until the traction is passed", {traction}, {{pull}, {3 * pull}}, false});
  f.push_back({Effect::contact_adhesion, 1, "cohesive law", {traction, gap}, grid({{pull}, {0.03 * travel_, 0.15 * travel_}}), false});
  f.push_back({Effect::contact_adhesion, 2, "constant traction over a gap", {traction, gap}, grid({{pull}, {0.05 * travel_, 0.2 * travel_}}), false});
  const ParamSpec mu{"friction_coefficient", "-", 0.005, 3.0, true};
  f.push_back({Effect::platen_friction, 0, "1 + mu S/3", {mu}, {{0.3}}, false});
  f.push_back({Effect::platen_friction, 1, "(exp(mu S) - 1)/(mu S)", {mu}, {{0.3}}, false});
  f.push_back({Effect::platen_friction, 2, "1 + mu S^2", {mu}, {{0.1}}, false});
  f.push_back({Effect::rig_compliance, 0, "spring in series", {{"compliance", "m/N", 1e-4 * c, 30 * c, true}}, {{0.1 * c}, {0.5 * c}}, false});
  f.push_back({Effect::hysteresis, 0, "play of the input", {{"width", "m", 1e-4 * travel_, 0.5 * travel_, true}}, {{0.02 * travel_}, {0.1 * travel_}}, false});
  const ParamSpec heart{"frequency", "Hz", 0.7, 2.2, false}, breath{"frequency", "Hz", 0.12, 0.45, false};
  f.push_back({Effect::pulsation, 0, "heart", {heart}, {}, true});
  f.push_back({Effect::pulsation, 1, "breath", {breath}, {}, true});
  f.push_back({Effect::pulsation, 2, "heart and breath", {heart, {"breath_frequency", "Hz", 0.12, 0.45, false}}, {}, true});
  f.push_back({Effect::pulsation, 3, "heart and its first harmonic", {heart}, {}, true});
  std::erase_if(f, [&](const Form& form) { return std::find(own.begin(), own.end(), form.effect) == own.end(); });
  return f;
}

}  // namespace

std::unique_ptr<RigModel> make_tissue(const Dataset& d) { return std::make_unique<Tissue>(d); }

}  // namespace filum::reconcile
