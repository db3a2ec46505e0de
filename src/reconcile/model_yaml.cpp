// model.yaml (filum-model/1): the baseline with what was named, ready to be named in a scene (world/measured_model).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "reconcile/full_solver.h"
#include "reconcile/hereditary.h"
#include "reconcile/report.h"

namespace filum::reconcile {
namespace {

using Json = nlohmann::ordered_json;

std::string hash_text(const Dataset& d) {
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(d.hash));
  return hash;
}

bool by_strain(Effect e) { return e == Effect::strain_stiffening || e == Effect::first_cycle_softening; }

/// The effect with the values that a scene runs it with, those of the mesh: a diffusivity is that of Biot's theory, not of the series; under a blade stiffening
/// and softening are those of its elements.
const NamedEffect& as_run(const NamedEffect& e, const Dataset& d, const Result& r) {
  const bool meshed = e.effect == Effect::poroelastic_drainage || (d.rig == Rig::spatula_press && by_strain(e.effect));
  if (!meshed || !r.confirm || !r.confirm->holds) return e;
  const auto at = std::find_if(r.confirm->values.begin(), r.confirm->values.end(), [&](const NamedEffect& v) { return v.effect == e.effect; });
  return at == r.confirm->values.end() ? e : *at;
}

/// A relaxation that is not made of exponentials, as the sum of them that a scene can run.
std::string spectrum_text(const NamedEffect& e) {
  const auto of = [&](const char* name) {
    const auto at = std::find_if(e.parameters.begin(), e.parameters.end(), [&](const Estimate& p) { return p.name == name; });
    return at == e.parameters.end() ? 0.0 : at->value;
  };
  if (e.effect != Effect::viscoelastic_relaxation || of("order") <= 0.0) return "";
  const Kernel k = fractional(of("g1"), of("tau1"), of("order"));
  std::string out = "    prony:\n";
  for (std::size_t i = 0; i < k.tau.size(); ++i) {
    char text[100];
    std::snprintf(text, sizeof text, "      - { share: \"%.6g\", time: \"%.6g s\" }\n", k.weight[i], k.tau[i]);
    out += text;
  }
  return out;
}

/// Why a scene leaves an effect out; empty where it is the specimen's own.
std::string of_the_laboratory(Effect e) {
  switch (e) {
    case Effect::sensor_lag:
    case Effect::sensor_drift:
    case Effect::saturation:
    case Effect::mains_hum: return "off: this is what the sensor adds to what happened, and no scene has that sensor";
    case Effect::rig_compliance:
    case Effect::hysteresis: return "off: this is the testing machine's, not the specimen's";
    case Effect::platen_friction: return "off: this is between specimen and platens, of which a scene has none";
    default: return "";
  }
}

/// Under a blade the law goes by depth over height; what that strain is in the tissue, squared, by the elements (full_press.cpp).
std::string local_strain(const Dataset& d, const Result& r, Effect e) {
  if (d.rig != Rig::spatula_press || !by_strain(e)) return "";
  double nu = d.nominal.count("poissons_ratio") > 0 ? d.nominal.at("poissons_ratio") : 0.49;
  for (const Estimate& p : r.decide.baseline)
    if (p.name == "poissons_ratio") nu = p.value;
  const Trial& t = d.trials[0];
  const Vec3 box(t.size("length"), t.size("width"), t.size("height"));
  const PressedBox pressed = pressed_box(box, std::min(t.size("blade_length"), 0.98 * box.x()), std::min(t.size("blade_width"), 0.98 * box.y()), 2);
  const double square = local_strain_square(pressed, box.z(), std::min(nu, 0.49));
  if (!std::isfinite(square) || square <= 0.0) return "";
  char text[60];
  std::snprintf(text, sizeof text, "    local_strain_square: \"%.6g\"\n", square);
  return text;
}

/// A text of the dataset's in double quotes that YAML and JSON both read.
std::string quoted(const std::string& text) { return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string model_yaml(const Dataset& d, const Result& r, const std::string& program) {
  std::ostringstream s;
  const auto value = [&](const Estimate& e, const std::string& indent) {
    const std::string unit = e.unit == "-" ? "" : " " + e.unit;
    char text[240];
    std::snprintf(text, sizeof text, "{ value: \"%.6g%s\", low: \"%.6g%s\", high: \"%.6g%s\" }", e.value, unit.c_str(), e.low, unit.c_str(), e.high, unit.c_str());
    s << indent << e.name << ": " << text << "\n";
  };
  s << "# Baseline with what the measurements showed to be missing. Values with their 95 % intervals.\n"
    << "format: filum-model/1\ntitle: " << quoted(d.name) << "\nrig: " << info(d.rig).name << "\nbaseline_model: " << d.model << "\nbaseline:\n";
  for (const Estimate& e : r.decide.baseline) value(e, "  ");
  if (r.decide.baseline.empty()) s << "  {}\n";
  s << "effects:\n";
  for (const NamedEffect& named : r.decide.effects) {
    const NamedEffect& e = as_run(named, d, r);
    const std::string off = d.rig == Rig::forceps_bridge || d.rig == Rig::tip_hold ? "" : of_the_laboratory(e.effect);
    s << "  - name: " << info(e.effect).name << "\n    on: " << (off.empty() ? "true" : "false") << "\n" << (off.empty() ? "" : "    note: \"" + off + "\"\n") << "    form: \"" << e.form << "\"\n"
      << local_strain(d, r, e.effect) << "    parameters:\n";
    for (const Estimate& p : e.parameters) value(p, "      ");
    s << spectrum_text(e);
  }
  s << "partial: " << (r.decide.partial ? "true" : "false") << "\nvalid_for:\n";
  for (const Channel& c : d.channels) {
    if (!c.input) continue;
    double low = INFINITY, high = -INFINITY;
    for (const Trial& t : d.trials) {
      const Eigen::VectorXd& v = c.name == "time" ? t.time : t.at(c.name);
      low = std::min(low, v.minCoeff());
      high = std::max(high, v.maxCoeff());
    }
    std::string unit;
    for (const ChannelInfo& k : info(d.rig).channels)
      if (k.name == c.name && k.unit != "-") unit = " " + k.unit;
    char text[160];
    std::snprintf(text, sizeof text, "  %s: [\"%.6g%s\", \"%.6g%s\"]\n", c.name.c_str(), low, unit.c_str(), high, unit.c_str());
    s << text;
  }
  s << "source: { dataset: " << quoted(d.name) << ", hash: \"" << hash_text(d) << "\", program: \"" << program << "\" }\n";
  return s.str();
}

}  // namespace filum::reconcile
