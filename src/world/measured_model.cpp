#include "world/measured_model.h"

#include <cmath>
#include <map>
#include <numbers>

#include "base/error.h"
#include "base/yaml_file.h"
#include "world/brain_model.h"
#include "world/model.h"

namespace filum {
namespace {

constexpr const char* kFormat = "filum-model/1";
constexpr double kSteps = 10.0;  // of the scene, within which a relaxation is over at once

/// { value, low, high }: a value with its interval.
double estimate(const YamlNode& from, const std::string& key, const std::string& unit, const Range& range) {
  const YamlNode field = from.map(key);
  for (const char* end : {"low", "high"})
    if (field.has(end)) field.quantity(end, unit);
  return field.quantity("value", unit, range);
}

std::vector<RelaxationTerm> read_relaxation(const YamlNode& effect, const YamlNode& parameters) {
  std::vector<RelaxationTerm> terms;
  const Range share{0.0, 1.0, true}, time = Range::positive();
  for (const YamlNode& item : effect.items_or_none("prony")) terms.push_back({item.number("share", share), item.quantity("time", "s", time)});
  const bool series = !terms.empty();
  for (const std::string& name : parameters.keys()) {
    if (series) estimate(parameters, name, name.starts_with("tau") ? "s" : "-", {});
    else if (name == "g1" || name == "g2") terms.push_back({estimate(parameters, name, "-", share), estimate(parameters, "tau" + name.substr(1), "s", time)});
    else if (name != "tau1" && name != "tau2") effect.refuse("form", "exponentials (g1, tau1, g2, tau2), or the law as a list `prony` of { share, time }");
  }
  if (terms.empty()) effect.refuse("parameters", "g1 and tau1");
  double sum = 0.0;
  for (const RelaxationTerm& t : terms) sum += t.share;
  if (!(sum < 1.0)) effect.refuse("parameters", "shares that sum to less than 1");
  return terms;
}

double read_curvature(const YamlNode& effect, const YamlNode& parameters) {
  if (effect.text_or("form", "uniform") != "uniform") effect.refuse("form", "uniform: the scene's thread curls evenly");
  return estimate(parameters, "curvature", "1/m", {-2e4, 2e4});
}

}  // namespace

bool MeasuredModel::is_one(const std::string& path) {
  try {
    return YamlNode::load(path).text_or("format", "") == kFormat;
  } catch (const InputError&) {
    return false;
  }
}

/// What physics/tissue_law and physics/pore_flow show; false for another effect.
bool MeasuredModel::read_tissue(const std::string& name, const YamlNode& effect, const YamlNode& parameters) {
  const std::string form = effect.text_or("form", "");
  const Range share{0.0, 1.0, true};
  const bool block = rig_ == "tissue-block";
  // a press gives its laws by depth over height: the elements' own follow from what that strain is in the tissue (reconcile/full_press)
  const double local = block ? 1.0 : effect.number_or("local_strain_square", 0.0, Range::positive());
  const bool placed = local > 0.0 || (name != "strain-stiffening" && name != "first-cycle-softening");
  if (!placed) return false;
  if (name == "strain-stiffening") {
    law_.stiffening = estimate(parameters, "c20_over_c10", "-", Range::positive()) / local;
    law_.exponential = form.starts_with("exponential") || form == "Demiray" || form.find("exp(") != std::string::npos;
  } else if (name == "tension-compression-asymmetry" && block) {
    law_.asymmetry = estimate(parameters, "alpha", "-", {-200.0, -1e-3});
    law_.asymmetry_form = form.starts_with("quadratic") ? 1 : form.starts_with("two moduli") ? 2 : 0;
  } else if (name == "first-cycle-softening") {
    law_.softening = estimate(parameters, "d", "-", share);
    softening_energy_ = local * estimate(parameters, "W0", "Pa", Range::positive());
    law_.softening_form = form.starts_with("error") ? 1 : form.starts_with("x/(1 + x)") ? 2 : 0;
  } else if (name == "permanent-set") {
    if (form.starts_with("grows")) effect.refuse("form", "fraction of the largest past strain: of one that grows with its square the file does not say where it is itself");
    law_.set = estimate(parameters, "fraction", "-", share);
  } else if (name == "poroelastic-drainage") {
    diffusivity_ = estimate(parameters, "diffusivity", "m2/s", Range::positive());
    share_ = estimate(parameters, "drained_share", "-", {0.0, 0.95, true});
  } else {
    return false;
  }
  return true;
}

namespace {

/// Why no scene shows an effect, and what it would take.
std::string why_not(const std::string& rig, const std::string& name) {
  static const std::map<std::string, std::string> reasons = {
      {"sensor-lag", "is the sensor's, and no scene has that sensor; with `on: false` the rest runs"},
      {"sensor-drift", "is the sensor's, and no scene has that sensor; with `on: false` the rest runs"},
      {"saturation", "is the sensor's, and no scene has that sensor; with `on: false` the rest runs"},
      {"mains-hum", "is the sensor's, and no scene has that sensor; with `on: false` the rest runs"},
      {"rig-compliance", "is the testing machine's, not the specimen's; with `on: false` the rest runs"},
      {"hysteresis", "is the machine's play, not the specimen's; with `on: false` the rest runs"},
      {"platen-friction", "is between specimen and platens, of which a scene has none; with `on: false` the rest runs"},
      {"pulsation", "would take tissue that moves with heart and breath: the scene's rests"},
      {"contact-adhesion", "would take blade contacts that pull until they part: the scene's only push"},
      {"bending-creep", "would take a bending memory in the thread's state: the scene's thread has a plastic limit only"},
      {"permanent-set", "of a thread would take a set that grows with the largest curvature: the scene's sets beyond a sharp limit"},
      {"speed-dependent-friction", "would take contacts whose friction goes by their sliding speed: the scene's is Coulomb's"},
      {"bending-stiffness-loss", "is what the scene's thread does of itself: it bends over the bar with its own stiffness"},
      {"viscous-drag", "would take a drag on the thread in its medium: the scene has none"},
      {"strain-stiffening", "of a press would take the number local_strain_square beside it, by which depth over height becomes the tissue's own strain"},
      {"first-cycle-softening", "of a press would take the number local_strain_square beside it, by which depth over height becomes the tissue's own strain"}};
  const bool scene = rig == "tissue-block" || rig == "spatula-press" || rig == "suture-cantilever" || rig == "suture-pull";
  if (!scene) return "is of a rig that no scene stands on";
  const auto found = reasons.find(name);
  return found == reasons.end() ? "is known to no scene of " + rig : found->second;
}

}  // namespace

bool MeasuredModel::read_effect(const YamlNode& effect) {
  const std::string name = effect.text("name");
  const bool on = effect.flag_or("on", true) && on_;
  const YamlNode parameters = effect.map("parameters");
  for (const char* key : {"form", "prony", "note", "local_strain_square"}) effect.has(key);
  if (!on) {
    for (const std::string& key : parameters.keys()) parameters.has(key);
    return true;
  }
  const bool tissue = rig_ == "tissue-block" || rig_ == "spatula-press";
  if (tissue && read_tissue(name, effect, parameters)) return true;
  if (tissue && name == "viscoelastic-relaxation") return relaxation_ = read_relaxation(effect, parameters), true;
  if (rig_ == "suture-cantilever" && name == "rest-curvature") return curvature_ = read_curvature(effect, parameters), true;
  return false;
}

void MeasuredModel::read_effects(const YamlNode& file) {
  std::string refused;
  std::optional<YamlNode> first;
  for (const YamlNode& effect : file.items_or_none("effects")) {
    if (read_effect(effect)) continue;
    if (!first) first = effect;
    const std::string name = effect.text("name");
    refused += (refused.empty() ? "" : "; ") + name + " " + why_not(rig_, name);
  }
  if (!first) return;
  first->refuse("name", std::string(rig_ == "suture-cantilever" ? "rest-curvature" : rig_ == "suture-pull" ? "no effect of this rig" : "effects that a scene shows") + ", or `on: false` beside the name, which leaves an effect out: " + refused);
}

MeasuredModel MeasuredModel::load(const std::string& path) {
  const YamlNode file = YamlNode::load(path);
  if (file.text("format") != kFormat) file.refuse("format", kFormat);
  MeasuredModel m;
  m.file_ = path;
  m.rig_ = file.choice("rig", {"tissue-block", "spatula-press", "suture-cantilever", "suture-pull", "vessel-inflation", "needle-insertion", "forceps-bridge", "tip-hold"});
  m.on_ = file.flag_or("on", true);
  for (const char* key : {"title", "baseline_model", "partial", "valid_for", "source"}) file.has(key);
  const YamlNode baseline = file.map("baseline");
  for (const std::string& name : baseline.keys()) {
    if (name == "youngs_modulus") m.young_ = estimate(baseline, name, "Pa", Range::positive());
    else if (name == "poissons_ratio") m.poisson_ = estimate(baseline, name, "-", {-0.99, 0.4999, false});
    else if (name == "friction_coefficient") m.friction_ = estimate(baseline, name, "-", Range::between(0.0, 2.0));
    else baseline.has(name);  // of a rig that no scene stands on: refused by apply()
  }
  m.read_effects(file);
  file.finish();
  return m;
}

/// Linear tetrahedra lock where tissue is nearly incompressible (a blade met 30 times the force at 0.4999): beyond what the scene's elements bear, `most`, the modulus makes up
/// for it by E/(1 - nu^2), which is what a blade on a half space feels.
static void take_poisson(FemMaterial& tissue, double measured, double most) {
  tissue.poisson = std::min(measured, std::max(most, tissue.poisson));
  tissue.young *= (1.0 - tissue.poisson * tissue.poisson) / (1.0 - measured * measured);
}

void MeasuredModel::refuse_rig(const std::string& scene, const std::string& rigs) const { throw InputError(file_, "rig", rig_, rigs + ": the scene of " + scene + " shows nothing of another rig"); }

void MeasuredModel::apply(BrainModel& brain, double dt, double compression) const {
  if (rig_ != "tissue-block" && rig_ != "spatula-press") refuse_rig("a brain", "tissue-block or spatula-press");
  if (!on_) return;
  if (young_) {
    const double factor = *young_ / brain.regions.front().young;
    if (factor != 1.0)
      for (FemMaterial& tissue : brain.regions) tissue.young *= factor;
  }
  if (poisson_)
    for (FemMaterial& tissue : brain.regions) take_poisson(tissue, *poisson_, brain.fem.averaged_pressure ? 0.49 : 0.45);
  apply_tissue(brain);
  if (relaxation_.empty()) return;
  brain.fem.relaxation.clear();
  double at_once = 0.0;
  for (const RelaxationTerm& t : relaxation_)
    if (t.time < kSteps * dt * compression) at_once += t.share;
  for (FemMaterial& tissue : brain.regions) tissue.young *= 1.0 - at_once;
  for (const RelaxationTerm& t : relaxation_)
    if (t.time >= kSteps * dt * compression) brain.fem.relaxation.push_back({t.share / (1.0 - at_once), t.time});
}

void MeasuredModel::apply_tissue(BrainModel& brain) const {
  constexpr double kStiffest = 3.0;  // of the secant: the law is taken of the displacements before (tissue_law.h)
  const FemMaterial& grey = brain.regions.front();
  if (!law_.linear()) {
    brain.law = law_;
    brain.law.softening_energy = softening_energy_ > 0.0 ? softening_energy_ / grey.young : 1.0;
    brain.law.limit = kStiffest;
  }
  if (diffusivity_ > 0.0) brain.drainage = {diffusivity_, rig_ == "tissue-block" ? poisson_by_block(share_, grey.poisson) : poisson_by_punch(share_, grey.poisson)};
}

void MeasuredModel::apply_to_thread(Model& scene) const {
  if (rig_ != "suture-cantilever" && rig_ != "suture-pull") refuse_rig("a thread", "suture-cantilever or suture-pull");
  if (!on_) return;
  if (young_) {
    const double r = scene.thread.radius, factor = *young_ * 0.25 * std::numbers::pi * r * r * r * r / scene.thread.EI;
    for (double* stiffness : {&scene.thread.EA, &scene.thread.EI, &scene.thread.GJ}) *stiffness *= factor;
  }
  if (friction_) scene.thread.friction = scene.contact.friction = *friction_;
  if (curvature_) scene.rest_curvature = *curvature_;
}

void curl(RodState& thread, double curvature) {
  for (int i = 1; i + 1 < thread.n; ++i) {
    const double turn = 0.5 * curvature * (thread.rest_length[i - 1] + thread.rest_length[i]);
    for (int side = 0; side < 2; ++side) {
      const Eigen::Index j = i - 1 + side;
      const Vec3 t = (thread.x.col(j + 1) - thread.x.col(j)).normalized(), d1 = thread.d1.col(j), d2 = t.cross(d1);
      const Vec3 left = Vec3::UnitZ().cross(t).stableNormalized();
      const Vec3 m1 = std::cos(thread.theta[j]) * d1 + std::sin(thread.theta[j]) * d2;
      thread.rest_kappa.col(i).segment<2>(2 * side) += turn * Eigen::Vector2d(left.dot(m1), left.dot(t.cross(m1)));
    }
  }
}

}  // namespace filum
