#pragma once
// What may be seen of a needle, and of the tissue that is stitched with it. Empty in scenes without them.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/pose.h"

namespace filum {

struct NeedleObservation {
  bool present = false;
  Pose X_WN;                              // origin at the centre of mass, arc in z = 0, its middle on +x, the point on the side of +y
  Vec3 point_W = Vec3::Zero();            // [m], the sharp end
  Vec3 point_direction_W = Vec3::UnitX(); // unit
  Vec3 swage_W = Vec3::Zero();            // [m]
  std::array<bool, 3> held{};             // by each tool
  std::array<double, 3> grip_share{};     // where: 0 at the swage, 1 at the point
  std::array<double, 3> grip_angle{};     // [rad], between the wire there and the handle of the tool
  int sutures_left = 0;                   // that may still be asked for
  double thread_pull = 0.0;               // [N], of the thread on the swage
};

/// Constant part of a needle.
struct NeedleDescription {
  bool present = false;
  std::string name;
  double wire_radius = 0.0, bend_radius = 0.0, angle = 0.0, taper = 0.0;  // [m], [m], [rad], [m]
};

/// One way of needle and thread through the tissue.
struct PassObservation {
  enum class State : std::int32_t { open, needle, thread, pulled_out, torn };  // open: the point is still inside
  State state = State::open;
  Vec3 entry_W = Vec3::Zero(), exit_W = Vec3::Zero();        // [m], where they are now
  Vec3 entry_rest = Vec3::Zero(), exit_rest = Vec3::Zero();  // [m], in the tissue at rest
  bool out = false;                       // the point has come out again
  double entry_depth = 0.0, exit_depth = 0.0;  // share of the wall from outside: 0 outer surface, 1 inner
  double entry_angle = 0.0, exit_angle = 0.0;  // [rad], of the needle against the surface
  double bite_entry = 0.0, bite_exit = 0.0;    // [m], distance from the nearest cut edge at rest
  double depth_share = 0.0;               // greatest depth over the thickness there
  double shallow = 1.0, deep = 0.0;       // least and greatest depth, shares of the wall from outside
  double arc = -1.0;                      // [m], thread between its short end and the entry; -1 while the needle is in it
  double tension = 0.0;                   // [N], pull of the thread in it on the tissue
  double peak_force = 0.0;                // [N], largest pull on the tissue so far
  double hole = 0.0;                      // [m], radius, grown by sawing
  double torn = 0.0;                      // [m], length of the tear towards the edge
  int side = 0;                           // of the cut, 0 or 1
};
inline constexpr int kMaxPasses = 40;

inline constexpr int kLeakSectors = 8;

/// Clamps and blood of a vessel.
struct BloodObservation {
  bool present = false;                   // two stumps in clamps that can be taken off
  int n_clamps = 2;
  std::array<Pose, 3> clamp_W;            // upstream, downstream, one that stays on: at the held end, z towards the cut, y up the clamp's arms
  std::array<bool, 3> off{};
  bool wrong_order = false;               // the downstream one came off first
  std::array<double, 2> pressure{};       // [Pa], in each stump
  std::array<double, kLeakSectors> leak{};  // [m3/s], out of the join, from where the vessel's angle is zero
  std::array<Vec3, kLeakSectors> place{};   // [m], of the widest gap of each sector
  double leaks = 0.0, through = 0.0;      // [m3/s], out of the join; on into what lies behind it
  double lost = 0.0;                      // [m3], so far
  double least_area = 0.0;                // [m2], of the lumen
  int milking = 0;                        // 0 nothing, 1 two forceps hold it shut and strip, 2 the first has let go, 3 over
  double empty_from = 0.0, empty_to = 0.0;  // [m], of the emptied stretch, along the lumen from the upstream clamp
  double lumen_length = 0.0;              // [m]
};

/// What a tool holds of the tissue.
struct GripObservation {
  bool held = false;
  bool through = false;                   // the wall through its thickness, not its adventitia alone
  double pull = 0.0;                      // [N], of the tissue on the tool
  int side = -1;                          // of the cut, 0 or 1; -1: nothing is held
};

struct TissueObservation {
  int n = 0;                              // vertices of the surface; 0: no tissue
  Points positions;                       // [m], 3 x n, frame W
  int n_passes = 0;
  std::array<PassObservation, kMaxPasses> passes;
  double point_force = 0.0;               // [N], of the tissue on the needle's point
  double soundness = 1.0;                 // of the weakest element: 1 whole, 0 gone
  std::array<GripObservation, 3> grips;   // of each tool
  BloodObservation blood;
};

/// One side of a cut, at rest.
struct CutEdge {
  std::vector<Vec3> rim;                  // [m], the inner rim in turn
  Vec3 axis = Vec3::UnitY(), origin = Vec3::Zero();  // unit, [m], of its own vessel
};

/// A layer of the wall between two depths, shares of its thickness from outside.
struct TissueLayer {
  std::string name;
  double from = 0.0, to = 1.0;
};

struct TissueDescription {
  std::string name, kind;                 // "card" | "vessel"
  double thickness = 0.0;                 // [m]
  std::vector<TissueLayer> layers;        // outermost first
  Vec3 cut_along = Vec3::UnitY();         // unit, direction of the cut at rest; of a vessel: where its angle is zero
  bool lumen = false;                     // two vessels: the cut runs round an axis or, where they are given, along the edges
  int second = 0;                         // end to side: the first vertex of the vessel that is sewn to the other's side; else 0
  std::array<CutEdge, 2> edges;           // of a cut that runs round no one axis (end to side), the same way round from their heels
  Vec3 axis = Vec3::UnitY(), middle = Vec3::Zero();  // unit; [m], between the cut edges, at rest
  double radius = 0.0;                    // [m], of the outer surface at rest
  double clamp_reach = 0.0;               // [m], of a clamp's arms to both sides, from the vessel's axis; 0: no clamps
  std::vector<std::array<int, 3>> triangles;
  Points rest;                            // [m], 3 x n
};

}  // namespace filum
