#pragma once
// A block of tissue with a blade pressed on it, as the spatula paper's experiments are set up: what the brain's problems and
// benches are made of.

#include <vector>

#include "collision/surface_tree.h"
#include "physics/spatula_contact.h"

namespace filum {

class BrainBlock {
 public:
  /// Block of the mesh, held where z is lowest; blade flat, `side` x `side` [m], above the middle of the top at z = 0.
  BrainBlock(TetMesh mesh, const FemOptions& options, double side, const SpatulaParameters& parameters, int blade_cells = 10);

  /// The blade's middle comes to p [m]: contacts, then one step.
  void step(const Vec3& p);
  /// The same at rest: contacts, then equilibrium, until neither changes.
  void rest_at(const Vec3& p);
  double force() const { return blades_[0].force.z(); }  // [N], up, on the blade
  const std::vector<BladeContact>& contacts() const { return contacts_; }

  LinearFem fem;
  FemState state;
  FemSummary summary;
  double contact_ms = 0.0, solve_ms = 0.0;  // of the last step

 private:
  Pose at(const Vec3& p) const;
  void find_contacts(const Vec3& p);

  RigidSurface blade_;
  SpatulaContact contact_;
  SurfaceTree tree_;
  Points positions_, seen_;
  std::vector<BladeContact> contacts_;
  std::vector<int> hits_, candidates_;
  std::vector<char> marked_;
  std::array<MovingBlade, 1> blades_;
};

/// Block of nx x ny x nz nodes, `size` [m], its top at z = 0.
TetMesh block_of_nodes(int nx, int ny, int nz, const Vec3& size);

}  // namespace filum
