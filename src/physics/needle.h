#pragma once
// A needle as a rigid body of six coordinates: backward Euler, solved by Newton's method with line search.
//
// The step is the minimiser over the pose (p, q) of
//   m/(2 dt^2) |p - p^|^2 + 1/(2 dt^2) phi^T I phi - m g.p + U_grip + U_roll + U_sheet + U_jaws + U_tethers,
// p^ = p_n + dt v_n, phi the turn from the pose that the last velocity leads to. A needle weighs a few micronewtons, so its motion is
// quasi-static wherever it is touched; inertia only bounds the step.
// Grip. The wire lies between two flat pads that press with N each over the stretch w inside. Three points at 0 and +-3w/8 each bear up
// to 2 mu N/3 along the pads and 2N/3 across (friction.h), elastic before that. Chosen so that the limits
// of a line contact are met exactly: pull 2 mu N; turn about the pads' normal mu N w/2 (integral of |s| 2 mu N/w); tilt out of
// the pads N w/2 (all pressure at one end). Turn about the wire's own axis: a round wire bears 2 mu N r, a body flattened to b
// another N b/2 before it stands on its edge. Beyond its limits the needle slips and turns.
// Sheet and jaws: k o^2/2 for the overlap o of points of the wire; on the sheet with Coulomb friction.
// Neglects: gyroscopic moments, bending of the wire. Tests: needle_test.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "physics/instrument_contact.h"
#include "physics/needle_shape.h"
#include "physics/rod_tether.h"

namespace filum {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

inline constexpr int kNeedleTools = 3;
inline constexpr int kNeedleSamples = 13;  // points of the wire that touch sheet and jaws

/// A stretch of the needle between the pads of one tool.
struct NeedleGrip {
  std::int32_t held = 0;
  double arc = 0.0;                    // [m], its middle
  double half = 0.0;                   // [m], half its length, w/2
  std::array<Vec3, 3> anchor_T{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // [m], where the pads hold the points, frame of the tool
  double roll = 0.0;                   // [rad], elastic turn of the wire between the pads
};

/// Part of the state.
struct NeedleState {
  Pose X_WN;
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();  // [m/s], [rad/s], frame W
  Vec3 pull = Vec3::Zero();                 // [N], of the thread on the swage in the last step
  std::array<NeedleGrip, kNeedleTools> grips;
  bool in_hand() const noexcept {
    return std::any_of(grips.begin(), grips.end(), [](const NeedleGrip& g) { return g.held != 0; });
  }
  Eigen::Matrix<double, 3, kNeedleSamples> sheet_bristle = Eigen::Matrix<double, 3, kNeedleSamples>::Zero();  // [m]
};

/// What the needle feels of a tool in this step.
struct NeedleTool {
  Pads pads;
  Pose X_start, X_end;
  double grip_force = 0.0;             // [N], each pad
  InstrumentBars bars;
  bool bars_touch = true;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // [N], [N m], of the needle on the tool, about its tip
};

struct NeedleOptions {
  double dt = 2e-3;
  Vec3 gravity = Vec3(0, 0, -9.81);
  double sheet = -1e3;                 // [m], height of the background sheet
  double contact_stiffness = 500.0;    // [N/m], of a point of the wire on sheet or jaws
  double bar_stiffness = 5000.0;       // [N/m], of a point of the wire on a bar: what a grip bears does not press it through
  double presliding = 1e-6;            // [m]
  int max_iterations = 30;
  double force_tolerance = 1e-9;       // [N]
};

struct NeedleSummary {
  int iterations = 0;
  double residual = 0.0;               // [N]
  bool sound = true;
};

class NeedleBody {
 public:
  explicit NeedleBody(NeedleShape shape, int n_tools);

  std::vector<NeedleTool> tools;
  std::vector<RoundBar> bars;          // that stand in the scene, slowly moved: without friction, not passed by a point that goes through the axis in a step
  std::vector<RodTether> tethers;      // what holds the wire at an arc: thread, tissue; on the needle `along` points to its tip

  const NeedleShape& shape() const noexcept { return shape_; }

  /// Moves the pose to the end of the step; forces of tethers and tools are those there.
  NeedleSummary step(NeedleState& s, const NeedleOptions& o) noexcept;
  /// The same without accepting it: the point at `arc` is held as by a spring of the stiffness returned whose rest is at `point`. It is that
  /// of the body turned to where `load` [N] there brings it: with the pull of the last step, what is left to linearise is small.
  Mat3 look_ahead(const NeedleState& s, const NeedleOptions& o, double arc, Vec3& point, const Vec3& load = Vec3::Zero()) noexcept;

  /// Takes hold of what lies between the pads within `reach` of their middle plane. False if nothing does.
  bool take(int tool, double reach, NeedleState& s) const noexcept;
  /// True if part of the wire lies between the pads of the tool at X_end.
  bool between(int tool, double reach, const NeedleState& s) const noexcept;

 private:
  struct Trial {
    Pose X;
    Vec6 gradient;
    Mat6 stiffness;
    double energy = 0.0;
  };
  struct Stretch {
    double first = -1.0, last = -1.0;
  };
  void begin(const NeedleState& s, const NeedleOptions& o) noexcept;
  enum class Turn { about_middle, about_swage };  // of a move: which point of the needle goes straight on
  NeedleSummary minimise(const NeedleState& s, const NeedleOptions& o) noexcept;
  NeedleSummary descend(const NeedleState& s, const NeedleOptions& o, Turn turn) noexcept;
  bool advance(const NeedleState& s, const NeedleOptions& o, Turn turn) noexcept;
  void evaluate(const NeedleState& s, const NeedleOptions& o, Trial& t) noexcept;
  void add_inertia(const NeedleState& s, const NeedleOptions& o, Trial& t) const noexcept;
  void add_grips(const NeedleState& s, Trial& t) noexcept;
  void add_sheet(const NeedleState& s, const NeedleOptions& o, Trial& t) noexcept;
  void add_jaws(const NeedleOptions& o, Trial& t) noexcept;
  void add_bars(const NeedleState& s, const NeedleOptions& o, Trial& t) const noexcept;
  void add_tethers(const NeedleOptions& o, Trial& t) noexcept;
  static void add_surface(RodTether& c, const Vec3& d, const Vec3& r, Trial& t) noexcept;
  void fix_loads(const NeedleOptions& o) noexcept;
  void finish_grips(NeedleState& s) const noexcept;
  double roll_limit(const NeedleTool& tool) const noexcept;
  Stretch stretch_between(int tool, double reach, const NeedleState& s) const noexcept;

  NeedleShape shape_;
  Vec3 inertia_N_;
  std::array<double, kNeedleSamples> sample_arc_;
  std::array<double, kNeedleSamples> load_{};                 // [N], by which friction on the sheet goes
  std::array<std::array<FrictionPoint, 3>, kNeedleTools> held_;
  std::array<std::array<Vec3, 3>, kNeedleTools> slid_;        // [m], frame W, of grip points in this step
  std::array<double, kNeedleTools> roll_{};                   // [rad], after the step
  std::array<FrictionPoint, kNeedleSamples> on_sheet_;
  Pose predicted_;
  Vec3 dead_load_ = Vec3::Zero();                             // [N], of look_ahead(), at an arc
  double dead_arc_ = 0.0;
  Mat3 inertia_W_;
  Trial now_, trial_;
};

}  // namespace filum
