#pragma once
// A model as `filum reconcile` writes it (filum-model/1: a rig's baseline with the effects its measurements showed) put into a scene.
//   tissue-block, spatula-press -> a scene with a brain: youngs_modulus of the grey matter, white keeping its ratio to grey,
//     poissons_ratio of both, as far as the scene's elements bear it (0.45; 0.49 with averaged pressure: beyond, E/(1 - nu^2) is kept instead); viscoelastic-relaxation as a Prony series in place of the scene's own relaxation, with the modulus that of
//     a sudden load (g(0) = 1), as in the rig;
//     strain-stiffening, first-cycle-softening (of a press with the number `local_strain_square`, by which depth over height becomes the tissue's own
//     strain), tension-compression-asymmetry of a block, permanent-set in each element (physics/tissue_law); poroelastic-drainage through the surface that no blade covers (physics/pore_flow).
//   suture-cantilever, suture-pull -> a scene with a thread: youngs_modulus scales EA, EI and GJ by E pi d^4/64 over the scene's EI;
//     friction_coefficient is thread on thread; rest-curvature is the thread's, in the plane of the sheet.
// Whatever the scene cannot show is refused, all of it at once, with what it would take; `on: false` at an effect, or at the top for the whole file, leaves it out, and what is
// left out takes no part: the scene's states are then bit for bit those without the file. Test: measured_model_test.

#include <optional>
#include <string>
#include <vector>

#include "physics/elastic_rod.h"
#include "physics/linear_fem.h"
#include "physics/tissue_law.h"

namespace filum {

class YamlNode;
struct BrainModel;
struct Model;

class MeasuredModel {
 public:
  /// Throws InputError where the file is not of this form or asks for an effect that no scene shows.
  static MeasuredModel load(const std::string& path);
  /// Whether a file says that it is one; false for anything that cannot be read.
  static bool is_one(const std::string& path);

  /// `dt` [s] of the scene, in scene seconds of which `compression` make a second. Relaxation within ten steps is taken as done at once.
  void apply(BrainModel& brain, double dt, double compression) const;
  void apply_to_thread(Model& scene) const;

 private:
  void read_effects(const YamlNode& file);
  bool read_effect(const YamlNode& effect);
  bool read_tissue(const std::string& name, const YamlNode& effect, const YamlNode& parameters);
  void apply_tissue(BrainModel& brain) const;
  [[noreturn]] void refuse_rig(const std::string& scene, const std::string& rigs) const;

  std::string file_, rig_;
  bool on_ = true;
  std::optional<double> young_, poisson_, friction_, curvature_;  // [Pa], [-], [-], [1/m]
  std::vector<RelaxationTerm> relaxation_;
  TissueLaw law_;
  double softening_energy_ = 0.0;            // [Pa]
  double diffusivity_ = 0.0, share_ = 0.0;   // [m2/s], [-] of the stiffness that drains away
};

/// Gives a thread a natural curvature [1/m] in the horizontal plane, towards the left of its direction.
void curl(RodState& thread, double curvature);

}  // namespace filum
