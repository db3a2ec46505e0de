#pragma once
// What the world shows of itself after a step. Training, session, server and viewer see this and nothing else of the
// simulation. Sized at load: copying one Observation into another of the same scene allocates nothing.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/pose.h"
#include "world/brain_observation.h"
#include "world/needle_observation.h"

namespace filum {

/// One tool as simulated (not as commanded: the commanded pose is in `X_WD`).
struct ToolObservation {
  Pose X_WT;                      // simulated pose; origin at the jaw tip, +z from the tip towards the handle, jaws open in x
  Pose X_WD;                      // commanded pose of the same frame
  Vec3 v_W = Vec3::Zero();        // [m/s], velocity of the tip
  Vec3 f_T_W = Vec3::Zero();      // [N], force of the scene on the tool, in W
  double grip_angle = 0.0;        // [rad], simulated opening between the jaws
  double grip_force = 0.0;        // [N], squeeze at the pads
  double thread_force = 0.0;      // [N], magnitude of the thread's pull on the jaws
  int grasped_edge = -1;          // index of a rod edge between the jaws, -1 none
  bool input_valid = false;       // false: the device is silent; scoring pauses
};

/// Something that happened in a step. `name` is one of the constants in kEventNames (static storage).
struct WorldEvent {
  const char* name = "";          // "grasp", "release", "drop", "cut", "thread-break", "thread-overload", "overrun", "solver-trouble", "input-lost", "input-back", "object-taken" (value: least squeeze that holds), "object-released", "object-slipped", "object-broken" (value: squeeze), "needle-taken" (value: share of its length from the swage), "needle-released", "needle-dropped", "puncture", "tear", "clamp-off" (value: 0 upstream, 1 downstream), "clamps-wrong-order", "milking-let-go" (value: ul emptied), "milking-refilled" (value: s), "milking-stayed-empty" (value: s), "milking-spoiled", "suture-fresh" (value: how many are left); asked for in vain: "suture-none-left", "suture-held", "suture-in-tissue", "suture-no-room", "suture-in-the-way"
  int tool = -1;                  // tool index or -1
  double value = 0.0;             // what the event measured, unit below
  const char* unit = "-";
};

/// A small object to be picked up.
struct PelletObservation {
  Vec3 p_W = Vec3::Zero();        // [m], centre
  int holder = -1;                // tool that holds it, -1 none
  bool broken = false;
};
inline constexpr int kMaxPellets = 8;

inline constexpr int kMaxParted = 24;

struct Observation {
  std::uint64_t step = 0;
  double time = 0.0;              // [s], scene time
  int n_nodes = 0;                // nodes of the thread in use now (resolution is adaptive; arrays are of capacity size)
  Points positions;               // [m], 3 x capacity, frame W; first n_nodes columns valid
  std::vector<double> arc;        // [m], capacity; material coordinate of each node from the short end
  std::vector<double> tension;    // [N], capacity; edge tension, first n_nodes-1 valid
  std::vector<double> contact;    // [N], capacity; summed normal self-contact force at each node
  double radius = 0.0;            // [m], of the thread
  bool broken = false;            // thread has parted
  int break_edge = -1;            // edge that parted, -1 none (nodes up to it and after it are two strands)
  int cut_edge_low = -1;          // cuts made with scissors: edge index near the short end, -1 none
  int cut_edge_high = -1;         // and near the long end
  int n_parted = 0;               // edges that hold nothing any more, cut or broken, from the short end on: pieces of thread lie between them
  std::array<int, kMaxParted> parted{};  // of more than these the last ones are not told
  int n_tools = 0;
  std::array<ToolObservation, 3> tools;
  int n_pellets = 0;
  std::array<PelletObservation, kMaxPellets> pellets;
  BrainObservation brain;
  NeedleObservation needle;
  TissueObservation tissue;
  int n_contacts = 0;             // self-contacts
  double min_gap = std::numeric_limits<double>::infinity();  // [m], smallest surface distance between strands (negative: compressed)
  int newton_iterations = 0;
  double residual = 0.0;          // [N], largest unbalanced nodal force
  std::uint64_t overruns = 0;     // steps that took longer than dt so far
  double real_time_factor = 1.0;  // 1 = keeps up
  std::uint64_t state_hash = 0;
  int n_events = 0;
  std::array<WorldEvent, 16> events;  // of this step, first n_events valid
};

/// The practice post: a horizontal round bar the thread is passed round.
struct PostShape {
  Vec3 p_W = Vec3::Zero();        // [m], a point on the axis
  Vec3 axis_W = Vec3::UnitY();    // unit
  double radius = 0.5e-3;         // [m]
  double half_length = 5e-3;      // [m]
};

/// Tool geometry the viewer and the contact code share.
struct ToolShape {
  std::string name;               // "forceps-left", "needle-holder"
  std::string kind;               // "forceps" | "needle-holder" | "scissors"
  double jaw_length = 8e-3;       // [m], hinge to tip
  double tip_radius = 0.15e-3;    // [m]
  double base_radius = 0.6e-3;    // [m], of a jaw at the hinge
  double pad_length = 1.5e-3;     // [m], gripping part behind the tip
  double max_angle = 0.5;         // [rad]
};

/// Constant part of a small object.
struct PelletShape {
  std::string name;
  double radius = 0.0;            // [m]
  double slip_limit = 0.0;        // [N], least squeeze that picks it up
  double strength = 0.0;          // [N], squeeze that breaks it
};

/// Constant description of the scene for those who only look.
struct SceneDescription {
  std::string task;
  std::string title;
  std::string suture;             // model name, e.g. "10-0-nylon"
  double thread_radius = 0.0;     // [m]
  double thread_strength = 0.0;   // [N]
  double dt = 2e-3;               // [s]
  PostShape post;                 // the bar the knot goes round
  PostShape base;                 // the bar below it; the thread lies in the slit between the two
  bool has_post = false;
  std::vector<PostShape> notch;   // two thin bars in a V: the short end is pulled in between them and stays while the hands are busy
  std::vector<PostShape> frame;   // round bars along the border of a sheet that is stretched over them
  double floor_height = 0.0;      // [m], z of the background sheet
  int n_tools = 0;
  std::array<ToolShape, 3> tools;
  int n_pellets = 0;
  std::array<PelletShape, kMaxPellets> pellets;
  bool has_field = false;         // the microscope starts above field_W rather than above the post
  Vec3 field_W = Vec3::Zero();    // [m]
  BrainDescription brain;
  NeedleDescription needle;
  TissueDescription tissue;
  int capacity = 0;               // nodes
};

}  // namespace filum
