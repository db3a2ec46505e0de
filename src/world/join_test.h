#pragma once
// The join at the end of a task: clamps off, upstream first, and look what comes out.
//
// The scene goes on with its instruments as they are (no input); the transmural pressure rises in the first stump, then in the second,
// and is held. Leak, lumen and flow are those of vessel_leak.h on the walls as they then are.
//   Flow onwards: what goes on beyond the join in the circulation of the scene, with this lumen and these gaps (balance_join, is_patent: vessel_flow.h).
//   Thread in the lumen: its length inside the tube through the rings' middles, less what runs from one bite of a stitch to the other. A stitch is a pass out
//   of one stump and the next, of those that are still there, into the other, on one piece of thread; each pass belongs to one stitch at most.
//   Edges: how far they reach past each other, and how far each is rolled into the lumen (vessel_edge.h), as they lie before the pressure.
// Neglects: that an open end does not hold pressure (the leak of a join that is not closed is that of a vessel kept at this pressure, and its gaps are as wide for the
// flow onwards), drops, clotting. Deterministic. Test: join_test_test.

#include <array>
#include <vector>

#include "physics/vessel_leak.h"
#include "world/model.h"
#include "world/state.h"

namespace filum {

inline constexpr int kJoinSectors = 8;

struct JoinTestOptions {
  double pressure = 13332.0;   // [Pa], 100 mmHg
  double rise = 0.1;           // [s], in each stump
  double hold = 0.2;           // [s]
  double seal = 3e-6;          // [m], gaps that close by themselves
};

struct JoinTestReport {
  std::array<double, kJoinSectors> flow{};   // [m3/s], from the leak of each sector, from where the vessel's angle is zero
  std::array<double, kJoinSectors> gap{};    // [m], mean
  std::vector<EdgeGap> edge;   // at each node of the first cut edge
  double leak = 0.0;           // [m3/s]
  double area = 0.0;           // [m2], not sealed
  double narrowing = 0.0;      // [-], of the lumen near the join, 0 open to 1 closed
  double through = 0.0;        // [m3/s], on beyond the join; negative: back to it from collaterals
  bool patent = false;
  double thread_inside = 0.0;  // [m]
  double overlap = 0.0;        // [m], by which the cut edges reach past each other along the vessel, or one is rolled inward: the larger
  bool sound = true;           // all numbers finite and the walls stepped without trouble
};

JoinTestReport join_test(const Model& model, const State& state, const JoinTestOptions& options = {});

/// Largest length [m] by which a place of the first cut edge lies past the place of the second at the same angle; 0 where they stand apart.
double edge_overlap(const VesselModel& vessel, const Points& x);

/// Length of thread [m] within the lumens, less that between the two bites of each stitch and half a millimetre beside them.
double thread_in_lumen(const Model& model, const State& state);

}  // namespace filum
