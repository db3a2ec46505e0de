#include "reconcile/catalogue.h"

#include <algorithm>

namespace filum::reconcile {
namespace {

using R = Rig;
using E = Effect;

const std::vector<R> kTissue = {R::tissue_block, R::spatula_press};
const std::vector<R> kTissueVessel = {R::tissue_block, R::spatula_press, R::vessel_inflation};
const std::vector<R> kAll = {R::tissue_block, R::spatula_press, R::vessel_inflation, R::suture_cantilever,
                             R::suture_pull,  R::needle_insertion, R::forceps_bridge, R::tip_hold};

ParameterInfo modulus(double low, double high, double nominal) { return {"youngs_modulus", "Pa", low, high, nominal, true}; }

std::vector<RigInfo> make_rigs() {
  const KeyInfo rate{"rate", "*", {}, false};
  return {
      {R::tissue_block, "tissue-block", "brain/linear",
       {{"time", "s", true, true}, {"displacement", "m", true, true}, {"force", "N", false, true}},
       {{"shape", "", {"cuboid", "cylinder"}, true}, {"length", "m", {}, false, 2e-4, 0.2}, {"width", "m", {}, false, 2e-4, 0.2},
        {"height", "m", {}, true, 1e-4, 0.1}, {"diameter", "m", {}, false, 2e-4, 0.2}},
       {{"mode", "", {"compression", "tension", "shear"}, true}, rate, {"hold", "s", {}, false}, {"cycle", "*", {}, false}},
       {modulus(1.0, 1e10, 1e3), {"poissons_ratio", "-", 0.0, 0.4999, 0.49, false}}},
      {R::spatula_press, "spatula-press", "brain/linear",
       {{"time", "s", true, true}, {"depth", "m", true, true}, {"force", "N", false, false}, {"pressure", "Pa", false, false}},
       {{"shape", "", {"box", "cuboid"}, false}, {"length", "m", {}, true, 1e-3, 1.0}, {"width", "m", {}, true, 1e-3, 1.0}, {"height", "m", {}, true, 5e-4, 0.5},
        {"blade_length", "m", {}, true, 3e-4, 0.3}, {"blade_width", "m", {}, true, 2e-4, 0.2}, {"markers", "*", {}, false}},
       {rate, {"hold", "s", {}, false}, {"cycle", "*", {}, false}},
       {modulus(1.0, 1e10, 1e3), {"poissons_ratio", "-", 0.0, 0.4999, 0.49, false}}},
      {R::vessel_inflation, "vessel-inflation", "vessel/linear",
       {{"time", "s", true, false}, {"pressure", "Pa", true, true}, {"axial_stretch", "-", true, false},
        {"outer_diameter", "m", false, true}, {"axial_force", "N", false, false}},
       {{"outer_diameter", "m", {}, true, 5e-5, 0.05}, {"wall_thickness", "m", {}, true, 5e-6, 5e-3}, {"length", "m", {}, false, 5e-4, 0.5},
        {"layer_split", "*", {}, false}},
       {rate, {"cycle", "*", {}, false}, {"hold", "s", {}, false}},
       {modulus(1e2, 1e10, 3e5)}},
      {R::suture_cantilever, "suture-cantilever", "suture/elastic",
       {{"time", "s", true, false}, {"overhang", "m", true, false}, {"tip_drop", "m", false, true}, {"tip_reach", "m", false, false}},
       {{"diameter", "m", {}, true, 3e-6, 3e-3}, {"density", "kg/m3", {}, true, 100.0, 3e4}, {"overhang", "m", {}, false, 5e-4, 0.5}},
       {{"orientation", "", {"up", "down"}, false}, {"overhang", "m", {}, false, 5e-4, 0.5}, {"hold", "s", {}, false}, rate, {"cycle", "*", {}, false}},
       {modulus(1e6, 1e12, 2.5e9)}},
      {R::suture_pull, "suture-pull", "suture/capstan",
       {{"time", "s", true, false}, {"speed", "m/s", true, true}, {"hold_force", "N", true, true}, {"wrap_angle", "rad", true, true},
        {"pull_force", "N", false, true}},
       {{"diameter", "m", {}, true, 3e-6, 3e-3}, {"cylinder_diameter", "m", {}, true, 1e-4, 0.1}},
       {{"medium", "", {"dry", "wet"}, false}, rate, {"hold", "s", {}, false}, {"cycle", "*", {}, false}},
       {{"friction_coefficient", "-", 0.001, 3.0, 0.2, true}}},
      {R::needle_insertion, "needle-insertion", "needle/linear",
       {{"time", "s", true, false}, {"depth", "m", true, true}, {"speed", "m/s", true, false}, {"force", "N", false, true}},
       {{"needle_diameter", "m", {}, true, 1e-5, 0.01}, {"wall_thickness", "m", {}, true, 2e-5, 0.02}},
       {{"layers", "*", {}, false}, rate, {"cycle", "*", {}, false}, {"hold", "s", {}, false}},
       {{"stiffness", "N/m", 1e-3, 1e7, 100.0, true}, {"puncture_force", "N", 1e-6, 1e3, 0.1, true}}},
      {R::forceps_bridge, "forceps-bridge", "forceps/linear",
       {{"time", "s", true, false}, {"angle", "rad", true, true}, {"grip_force", "N", true, true}, {"temperature", "K", true, false},
        {"strain_counts", "count", false, false}, {"pressure_counts", "count", false, false}},
       {{"bits", "#", {}, true}, {"reference", "V", {}, true, 0.5, 50.0}},
       {{"direction", "", {"closing", "opening"}, false}, rate, {"hold", "s", {}, false}, {"cycle", "*", {}, false}},
       {{"strain_gain", "count/rad", -1e9, 1e9, 5730.0, false}, {"strain_offset", "count", -1e8, 1e8, 1000.0, false},
        {"pressure_gain", "count/N", -1e9, 1e9, 667.0, false}, {"pressure_offset", "count", -1e8, 1e8, 100.0, false}}},
      {R::tip_hold, "tip-hold", "hand/still",
       {{"time", "s", true, true}, {"x", "m", false, false}, {"y", "m", false, false}, {"z", "m", false, false}},
       {{"sensor", "", {"optical", "magnetic", "camera"}, true}},
       {{"support", "", {"free", "wrist-rest"}, false}, {"hold", "s", {}, false}, {"cycle", "*", {}, false}},
       {}},
  };
}

std::vector<EffectInfo> make_effects() {
  return {
      {E::viscoelastic_relaxation, "viscoelastic-relaxation", "g(t) = g_inf + sum g_i exp(-t/tau_i), g_inf + sum g_i = 1",
       "ramps at two rates ten times apart and a hold of several relaxation times", kTissueVessel, 2},
      {E::strain_stiffening, "strain-stiffening", "W = c10 (I1-3) + c20 (I1-3)^2", "larger strain, in both directions", kTissueVessel, 3},
      {E::tension_compression_asymmetry, "tension-compression-asymmetry", "one-term Ogden, alpha < 0",
       "the same specimen in tension and in compression", {R::tissue_block}, 3},
      {E::first_cycle_softening, "first-cycle-softening", "stress scaled by 1 - d (1 - exp(-(Wmax - W)/W0))",
       "load, unload and load again to the same strain, then beyond it", kTissueVessel, 3},
      {E::permanent_set, "permanent-set", "rest length shifts by a fraction of the largest past strain",
       "unload fully and hold at zero after a large strain", {R::tissue_block, R::spatula_press, R::suture_cantilever}, 3},
      {E::poroelastic_drainage, "poroelastic-drainage", "consolidation, time constant ~ size^2/diffusivity",
       "a second specimen (or blade) size with long holds", kTissue, 2},
      {E::contact_adhesion, "contact-adhesion", "pull-off traction until separation", "retract until the platen leaves the specimen", kTissue, 1},
      {E::platen_friction, "platen-friction", "barrelling: apparent modulus rises with width/height",
       "specimens of a second width-to-height ratio", {R::tissue_block}, 1},
      {E::rig_compliance, "rig-compliance", "load train in series",
       "specimens of very different stiffness (another height or shear), or a rigid dummy",
       {R::tissue_block, R::spatula_press, R::needle_insertion}, 0},
      {E::pulsation, "pulsation", "sum of sinusoids at heart and breath rate", "ten seconds or more in contact, sampled at 10 Hz or more",
       {R::spatula_press, R::tissue_block, R::tip_hold}, 4},
      {E::fibre_stiffening, "fibre-stiffening", "W = k1/(2 k2) (exp(k2 E^2) - 1), fibres in tension only",
       "pressures that stretch the wall by more than a tenth", {R::vessel_inflation}, 3},
      {E::residual_stress, "residual-stress", "opening angle", "a cut ring, or a second wall thickness", {R::vessel_inflation}, 3},
      {E::smooth_muscle_tone, "smooth-muscle-tone", "active circumferential stress", "the same inflation relaxed by papaverine", {R::vessel_inflation}, 4},
      {E::perivascular_tethering, "perivascular-tethering", "elastic foundation outside", "the same segment freed of its surroundings", {R::vessel_inflation}, 1},
      {E::rest_curvature, "rest-curvature", "natural curvature kept from the packet", "both orientations, up and down", {R::suture_cantilever}, 1},
      {E::bending_creep, "bending-creep", "bending compliance J(t) = 1 + a ln(1 + t/t0)", "rest at one overhang for minutes", {R::suture_cantilever}, 2},
      {E::speed_dependent_friction, "speed-dependent-friction", "mu(v) = mu_k + (mu_s - mu_k) exp(-v/v_s) + c v",
       "speeds over two decades at two wrap angles and hold forces", {R::suture_pull}, 2},
      {E::bending_stiffness_loss, "bending-stiffness-loss", "force to bend over the cylinder added to the capstan",
       "small hold forces beside large ones", {R::suture_pull}, 1},
      {E::layer_rupture, "layer-rupture", "one puncture force per layer", "deeper insertion", {R::needle_insertion}, 3},
      {E::shaft_friction, "shaft-friction", "force per embedded length, both directions", "deep insertion and withdrawal", {R::needle_insertion}, 1},
      {E::viscous_drag, "viscous-drag", "force proportional to speed", "a second speed", {R::needle_insertion, R::suture_pull}, 2},
      {E::temperature_drift, "temperature-drift", "offset (and gain) per kelvin", "a change of temperature, or the warm-up in time", {R::forceps_bridge}, 0},
      {E::bridge_nonlinearity, "bridge-nonlinearity", "quadratic and cubic terms", "the whole range of angles", {R::forceps_bridge}, 0},
      {E::hysteresis, "hysteresis", "play (backlash) operator", "the same range closing and opening", {R::forceps_bridge, R::tissue_block}, 0},
      {E::cross_talk, "cross-talk", "strain channel reads grip force", "grip force that varies independently of the angle", {R::forceps_bridge}, 0},
      {E::sensor_lag, "sensor-lag", "first-order low pass or pure delay", "fast reversals or steps of the input", kAll, 0},
      {E::sensor_drift, "sensor-drift", "offset linear or logarithmic in time", "a long rest without load", kAll, 0},
      {E::saturation, "saturation", "output clipped", "loads beyond the sensor's range", kAll, 0},
      {E::physiological_tremor, "physiological-tremor", "narrow band at 8-12 Hz", "sampling at 25 Hz or more", {R::tip_hold}, 4},
      {E::mains_hum, "mains-hum", "line at 50 or 60 Hz (and its alias)", "a steady record of some seconds", kAll, 0},
  };
}

}  // namespace

const std::vector<RigInfo>& rigs() {
  static const std::vector<RigInfo> table = make_rigs();
  return table;
}

const RigInfo& info(Rig rig) { return rigs()[static_cast<std::size_t>(rig)]; }

const std::vector<EffectInfo>& effects() {
  static const std::vector<EffectInfo> table = make_effects();
  return table;
}

const EffectInfo& info(Effect effect) { return effects()[static_cast<std::size_t>(effect)]; }

std::vector<Effect> effects_of(Rig rig) {
  std::vector<Effect> found;
  for (const EffectInfo& e : effects())
    if (std::find(e.rigs.begin(), e.rigs.end(), rig) != e.rigs.end()) found.push_back(e.effect);
  return found;
}

std::optional<Rig> rig_named(std::string_view name) {
  for (const RigInfo& r : rigs())
    if (r.name == name) return r.rig;
  return std::nullopt;
}

}  // namespace filum::reconcile
