#pragma once
// The step of a scene with a brain: blades follow their hands, tissue follows the blades, pressure is measured.

#include <memory>
#include <optional>

#include "collision/surface_tree.h"
#include "world/brain_model.h"
#include "world/brain_section.h"
#include "world/falx.h"
#include "world/inputs.h"
#include "world/observation.h"

namespace filum {

class BrainScene {
 public:
  explicit BrainScene(std::shared_ptr<const BrainModel> model);

  BrainState start() const;
  void size_observation(Observation& o) const;

  /// Reports events into o; allocates nothing.
  void step(const Inputs& inputs, BrainState& s, std::array<std::int32_t, 3>& valid, Observation& o) noexcept;
  void observe(const BrainState& s, const std::array<std::int32_t, 3>& valid, Observation& o) noexcept;
  /// After a state was restored.
  void match(const BrainState& s);

 private:
  void move_blades(const Inputs& inputs, BrainState& s, std::array<std::int32_t, 3>& valid, Observation& o) noexcept;
  void change_form(std::size_t i, BrainState& s, Observation& o) noexcept;
  bool clear_of_tissue(const BrainState& s, std::size_t i, const RigidSurface& form) const noexcept;
  const RigidSurface& surface_of(std::size_t i, const BladeState& blade) const noexcept { return surfaces_[i][static_cast<std::size_t>(blade.form)]; }
  void find_candidates(const BrainState& s) noexcept;
  void pull_veins(BrainState& s, Observation& o) noexcept;
  void push_tissue(BrainState& s) noexcept;
  void measure(const BrainState& s, Observation& o) noexcept;
  void feel(const BrainState& s, std::uint64_t step) noexcept;
  void report(BrainState& s, Observation& o) noexcept;
  void observe_section(const BrainState& s, BrainObservation& b) noexcept;
  double exposed_share(const BrainState& s) noexcept;
  Vec3 place(const BrainState& s, int node) const noexcept { return model_->cortex.mesh.nodes.col(node) + s.fem.u.col(node); }

  std::shared_ptr<const BrainModel> model_;
  LinearFem fem_;
  std::optional<ElementLaw> law_;
  std::optional<PoreFlow> pores_;
  std::vector<char> open_;          // nodes of the surface that no blade covers: fluid leaves there
  Points push_;                     // [N], of law and fluid on all nodes
  SpatulaContact contact_;
  SurfaceTree tree_;
  BrainSection section_;
  FalxContact falx_;
  std::vector<Columns4> response_;  // of the tissue to a unit translation of each blade along each axis, found last
  std::vector<Mat3> stiffness_;     // [N/m], of each blade: a column a step
  std::vector<MovedNode> probes_;
  std::vector<std::vector<RigidSurface>> surfaces_;  // of each blade, of each of its forms
  std::vector<MovingBlade> blades_;
  std::vector<int> vertex_of_;   // node -> vertex of the surface, -1 inside
  std::vector<double> area_;     // [m2], of each vertex
  std::vector<int> hits_, candidates_;
  std::vector<char> marked_;     // nodes among the candidates
  Points positions_, loads_;     // [m], [N], of all nodes
  FemSummary summary_;
};

/// Hashes of the arrays of a brain's state, by name.
std::array<std::pair<const char*, std::uint64_t>, 8> brain_hashes(const BrainState& s) noexcept;

}  // namespace filum
