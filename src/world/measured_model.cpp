#include "world/measured_model.h"

#include <cmath>
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
  if (name == "strain-stiffening" && block) {
    law_.stiffening = estimate(parameters, "c20_over_c10", "-", Range::positive());
    law_.exponential = form == "exponential" || form == "Demiray";
  } else if (name == "first-cycle-softening" && block) {
    law_.softening = estimate(parameters, "d", "-", share);
    softening_energy_ = estimate(parameters, "W0", "Pa", Range::positive());
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

void MeasuredModel::read_effect(const YamlNode& effect) {
  const std::string name = effect.text("name");
  const bool on = effect.flag_or("on", true) && on_;
  const YamlNode parameters = effect.map("parameters");
  for (const char* key : {"form", "prony"}) effect.has(key);
  if (!on) {
    for (const std::string& key : parameters.keys()) parameters.has(key);
    return;
  }
  const bool tissue = rig_ == "tissue-block" || rig_ == "spatula-press";
  if (tissue && read_tissue(name, effect, parameters)) return;
  if (tissue && name == "viscoelastic-relaxation") relaxation_ = read_relaxation(effect, parameters);
  else if (rig_ == "suture-cantilever" && name == "rest-curvature") curvature_ = read_curvature(effect, parameters);
  else
    effect.refuse("name", std::string(tissue ? "viscoelastic-relaxation" : rig_ == "suture-cantilever" ? "rest-curvature" : "no effect of this rig") +
                              ": no scene shows another one of " + rig_ + "; `on: false` beside its name leaves it out");
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
  for (const YamlNode& effect : file.items_or_none("effects")) m.read_effect(effect);
  file.finish();
  return m;
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
    for (FemMaterial& tissue : brain.regions) tissue.poisson = *poisson_;
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
