#pragma once
// Hand-held instruments as rigid bodies (ODE): a handle and two jaws on a hinge each, drawn after a device pose by a virtual
// coupling (spring and damper, Colgate, Stanley & Brown, IROS 1995) and pushed back by the thread. The handle body stands for
// tool and fingers together, with its mass at the tip. ODE is scratch: pose and velocity are written from the state
// before each step and read back after it.
//
// Tool frame T: origin where the closed jaws' tips meet, +z from the tip towards the handle, jaws open along x about the
// hinge at z = jaw_length.
// Coupling force, integrated implicitly (m the mass, h the step, F the force of the scene, v' = v + h F/m):
//   f = (k (p_D - p - h v') + c (v_D - v')) / (1 + h c/m + h^2 k/m), likewise for rotation. At rest k (p_D - p) = -F.
// Grip: N is the measured force where the device has one, else the squeeze of the command beyond closure,
//   N = k_grip (theta - theta_command) / jaw_length, 0 <= N <= N_max.
// They touch each other and what stands in the scene (physics/instrument_contact.h), and rub on it (friction [P]).
// Neglects: bending of the jaws, play in the hinge, weight (the hand carries it). Test: instrument_test.

#include <memory>
#include <string>
#include <vector>

#include "base/pose.h"
#include "physics/thread_grasp.h"

namespace filum {

struct InstrumentParameters {
  std::string name = "forceps-left";
  std::string kind = "forceps";       // forceps | needle-holder | scissors
  double jaw_length = 8e-3;           // [m], hinge to tip
  double tip_radius = 0.15e-3;        // [m], of a jaw at its tip
  double base_radius = 0.5e-3;        // [m], of a jaw at the hinge
  double shaft_length = 30e-3;        // [m], behind the hinge
  double max_angle = 0.4;             // [rad], full opening
  double mass = 0.03;                 // [kg], tool and fingers, apparent at the tip
  double inertia = 3e-6;              // [kg m2], about any axis through the tip
  double coupling_stiffness = 500.0;  // [N/m]
  double coupling_damping = 7.7;      // [N s/m]
  double turning_stiffness = 0.05;    // [N m/rad]
  double turning_damping = 7.7e-4;    // [N m s/rad]
  double grip_stiffness = 0.1;        // [N m/rad]
  double max_grip_force = 3.0;        // [N]
  Pads pads;
};

/// Part of the state.
struct InstrumentState {
  Pose X_WT;
  Vec3 v = Vec3::Zero();      // [m/s], of the tip
  Vec3 w = Vec3::Zero();      // [rad/s]
  double angle = 0.3;         // [rad], between the jaws
  double angle_rate = 0.0;    // [rad/s]
  double grip_force = 0.0;    // [N], each pad
  Pose X_WD;                  // the device pose followed last
  double grip_command = 0.3;  // [rad], the grip followed last
};

struct InstrumentCommand {
  Pose X_WD;
  double grip_angle = 0.3;    // [rad], below zero: squeeze
  double grip_force = 0.0;    // [N], measured
  bool has_grip_force = false;
  bool follow = true;         // false: keep the last device pose and grip
};

struct RoundBar;      // physics/instrument_contact.h
struct Surroundings;
class InstrumentContact;

class Instruments {
 public:
  explicit Instruments(std::vector<InstrumentParameters> parameters);  // that pass through each other and all else
  Instruments(std::vector<InstrumentParameters> parameters, Surroundings surroundings);
  ~Instruments();
  Instruments(Instruments&&) noexcept;

  const std::vector<InstrumentParameters>& parameters() const noexcept { return parameters_; }

  /// The bars that stand in the scene from now on, instead of those before; for instruments that touch.
  void surround(const std::vector<RoundBar>& bars) noexcept;

  /// Advances all instruments by dt [s] in steps of at most 1 ms. force [N] and torque [N m] of the scene on each tool,
  /// about its tip, frame W. Arrays have one entry an instrument.
  void step(std::vector<InstrumentState>& states, const std::vector<InstrumentCommand>& commands, const std::vector<Vec3>& force,
            const std::vector<Vec3>& torque, double dt) noexcept;

 private:
  struct Ode;
  std::vector<InstrumentParameters> parameters_;
  std::unique_ptr<InstrumentContact> contact_;
  std::unique_ptr<Ode> ode_;
};

/// Axes of the three round bars of an instrument in its frame: jaw at +x, jaw at -x, shaft; opened by `angle` [rad]. The
/// closed jaws leave `clearance` [m] between them.
struct InstrumentBars {
  Vec3 a_T[3], b_T[3];  // [m], tip end, handle end
  double r_a[3], r_b[3];
};
InstrumentBars instrument_bars(const InstrumentParameters& p, double angle, double clearance) noexcept;

}  // namespace filum
