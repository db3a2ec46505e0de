#pragma once
// The brain of a scene: constant part, state, and what may be seen of it. Scenes without a brain have none of it.

#include <memory>
#include <string>
#include <vector>

#include "physics/linear_fem.h"
#include "physics/pore_flow.h"
#include "physics/spatula_contact.h"
#include "physics/tissue_law.h"
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

/// The falx, a stiff sheet in the plane y = `y`, between two heights; empty where `top` is not above `bottom`.
struct FalxSheet {
  double y = 0.0, bottom = 0.0, top = 0.0;  // [m]
  bool present() const noexcept { return top > bottom; }
};

/// Where somebody else has put a blade on its arm before the trainee takes over: it goes from key to key, then stays.
struct PlacedKey {
  double t = 0.0;  // [s]
  Pose X_W;
};

struct BrainModel {
  std::string name;
  std::string mesh_name, mesh_file;  // as the model file says, and where that is; empty: made from a shape
  Cortex cortex;
  std::vector<FemMaterial> regions;
  FemOptions fem;
  TissueLaw law;       // of the elements; linear: none of it takes part
  Drainage drainage;   // diffusivity 0: none
  SpatulaParameters contact;
  std::vector<std::vector<BladeShape>> blades;  // of each blade the forms it can be given, as many of each, the first to start with
  std::vector<std::string> blade_names;
  std::vector<Pose> blade_start;
  std::vector<std::vector<PlacedKey>> placed;  // of each blade; none: it is in the hand from the start
  std::vector<char> arm_keeps_force;           // of each blade: what its arm keeps once locked, force or pose
  std::vector<BridgingVein> veins;
  Vec3 target_W = Vec3::Zero();  // [m], centre of the disc to be shown
  double target_radius = 0.0;    // [m], 0: no target
  double time_compression = 1.0; // scene seconds that count as one second of scene time in timers, dose and relaxation
  double bone_y = 0.0;           // [m], see Cortex
  FalxSheet falx;
  double section_x = 0.0;        // [m], of the plane of the cross-section
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
  std::int32_t parked = 0;       // held by its arm: 1 while the clutch is pressed, 2 until it is freed
  std::int32_t toggling = 0;     // the button that locks and frees is down
  Pose X_DB;                     // of the blade in the hand's frame, as it was taken
  Vec3 kept_force = Vec3::Zero();  // [N], of the tissue on the blade when the arm was locked
  std::int32_t cutting = 0;      // edge pressure above the limit
  std::int32_t form = 0;         // which of its forms it has
  std::int32_t choosing = 0;     // the button that changes the form is down
  Vec3 stop_force = Vec3::Zero();  // [N], of the falx on the blade, for the hand
};

struct BrainState {
  FemState fem;
  TissueMemory memory;                  // of the elements; empty where the law is linear
  Eigen::VectorXd content;              // fluid gained per volume, of each node; empty where nothing drains
  Points relaxed_push;                  // [N], 3 x (n terms): what relaxation has taken of the pushes of law and fluid, as fem.w of the elastic force
  Points seen;                          // [m], 3 x n, displacement when contacts were last looked for
  std::vector<BladeContact> contacts;
  std::vector<BladeState> blades;
  std::vector<std::int32_t> torn;       // of each vein
  double exposed = 0.0;                 // share of the target that can be seen
};

}  // namespace filum
