#pragma once
// The brain of a scene: constant part, state, and what may be seen of it. Scenes without a brain have none of it.

#include <memory>
#include <string>
#include <vector>

#include "physics/linear_fem.h"
#include "physics/spatula_contact.h"
#include "world/brain_observation.h"
#include "world/cortex.h"

namespace filum {

/// A vein from the cortex to the dura: pulls once it is taut, tears at its strength.
struct BridgingVein {
  int node = 0;                  // of the mesh
  Vec3 dura_W = Vec3::Zero();    // [m]
  double slack = 0.0;            // [m], length at which it begins to pull
  double stiffness = 0.0;        // [N/m]
  double strength = 0.0;         // [N]
};

struct BrainModel {
  std::string name;
  Cortex cortex;
  std::vector<FemMaterial> regions;
  FemOptions fem;
  SpatulaParameters contact;
  std::vector<BladeShape> blades;
  std::vector<Pose> blade_start;
  std::vector<BridgingVein> veins;
  Vec3 target_W = Vec3::Zero();  // [m], centre of the disc to be shown
  double target_radius = 0.0;    // [m], 0: no target
  double time_compression = 1.0; // scene seconds that count as one second of scene time in timers, dose and relaxation
  double fastest = 0.3;          // [m/s], and 3 rad/s: a blade follows its hand no faster
  double strongest = 10.0;       // [N], force given to a device at most
  double slip_distance = 2e-3;   // [m], sliding that counts as a slip
  double edge_pressure = 8e3;    // [Pa], at the blade's edge: cuts (60 mmHg)
};

struct BladeState {
  Pose X_W;                      // of the blade, frame T of a tool
  Pose X_WD;                     // as last commanded
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // [N], [N m], of the tissue on the blade about its tip
  double slid = 0.0;             // [m], largest sliding of a contact since the last slip
  std::int32_t parked = 0;       // held by its arm
  std::int32_t cutting = 0;      // edge pressure above the limit
};

struct BrainState {
  FemState fem;
  Points seen;                          // [m], 3 x n, displacement when contacts were last looked for
  std::vector<BladeContact> contacts;
  std::vector<BladeState> blades;
  std::vector<std::int32_t> torn;       // of each vein
  double exposed = 0.0;                 // share of the target that can be seen
};

}  // namespace filum
