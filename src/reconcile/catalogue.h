#pragma once
// The rigs and effects of the contract (experiments.md): names, channels, protocol and specimen keys, baseline parameters.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace filum::reconcile {

enum class Rig { tissue_block, spatula_press, vessel_inflation, suture_cantilever, suture_pull, needle_insertion, forceps_bridge, tip_hold };
constexpr int kRigs = 8;

enum class Effect {
  viscoelastic_relaxation, strain_stiffening, tension_compression_asymmetry, first_cycle_softening, permanent_set,
  poroelastic_drainage, contact_adhesion, platen_friction, rig_compliance, pulsation, fibre_stiffening, residual_stress,
  smooth_muscle_tone, perivascular_tethering, rest_curvature, bending_creep, speed_dependent_friction, bending_stiffness_loss,
  layer_rupture, shaft_friction, viscous_drag, temperature_drift, bridge_nonlinearity, hysteresis, cross_talk, sensor_lag,
  sensor_drift, saturation, physiological_tremor, mains_hum
};
constexpr int kEffects = 30;
constexpr int index_of(Effect e) { return static_cast<int>(e); }

struct ChannelInfo {
  std::string name;
  std::string unit;       // an example with the right dimension
  bool input = false;
  bool required = false;  // of several outputs at least one is needed
};

struct ParameterInfo {
  std::string name;
  std::string unit;
  double low = 0.0, high = 0.0, nominal = 0.0;  // [SI]; nominal where the model file says nothing
  bool logarithmic = true;
};

struct KeyInfo {
  std::string name;
  std::string unit;                  // "" for a word
  std::vector<std::string> words;    // allowed words; empty: any
  bool required = false;
  double low = 0.0, high = 0.0;      // [SI], what is possible: a factor of 1000 apart at most (plausible.h); 0: anything
};

struct RigInfo {
  Rig rig;
  std::string name;
  std::string model;  // name of the model under test
  std::vector<ChannelInfo> channels;
  std::vector<KeyInfo> specimen;
  std::vector<KeyInfo> protocol;
  std::vector<ParameterInfo> baseline;
};

struct EffectInfo {
  Effect effect;
  std::string name;
  std::string law;
  std::string shows;  // the protocol that would show it
  std::vector<Rig> rigs;
  int stage;          // 0 instrument, 1 boundary, 2 rate and time, 3 constitutive, 4 biology: cheaper explanations first
};

const std::vector<RigInfo>& rigs();
const RigInfo& info(Rig rig);
const std::vector<EffectInfo>& effects();
const EffectInfo& info(Effect effect);
std::vector<Effect> effects_of(Rig rig);
std::optional<Rig> rig_named(std::string_view name);

}  // namespace filum::reconcile
