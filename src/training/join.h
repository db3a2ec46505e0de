#pragma once
// What became of a join with the clamps off: as the trainee took them off, as forceps milked it, and as whoever runs the world tested it
// at the end.

#include <limits>
#include <vector>

#include "world/observation.h"

namespace filum {

/// A node of the cut edge.
struct EdgePlace {
  double share = 0.0;                // where on it: share of its length as first made, from where the vessel's angle is zero
  double gap = 0.0;                  // [m], to the other edge
};

struct JoinReport {
  double pressure = 0.0;             // [Pa], held
  double leak = 0.0;                 // [m3/s]
  double area = 0.0;                 // [m2], of gaps that are not sealed
  std::vector<double> sector_flow;   // [m3/s], from where the vessel's angle is zero
  std::vector<double> sector_gap;    // [m], mean
  std::vector<EdgePlace> edge;       // all its nodes, ascending
  double narrowing = 0.0;            // [-], 0 open to 1 closed
  double through = 0.0;              // [m3/s], on beyond the join, in the scene's circulation
  bool patent = false;
  double thread_inside = 0.0;        // [m], in the lumen, beside the stitches
  double overlap = 0.0;              // of the cut edges past each other, or how far one is rolled inward, wall thicknesses
  bool sound = true;                 // the solver had no trouble
};

/// Clamps that the trainee took off; what flowed is of the last moment. SI units, NaN where there was nothing.
struct ClampReport {
  double upstream = std::numeric_limits<double>::quiet_NaN(), downstream = std::numeric_limits<double>::quiet_NaN();  // [s], when
  bool wrong_order = false;
  double pressure[2] = {0, 0};       // [Pa], in the stumps
  double leak = 0.0, most_leak = 0.0, through = 0.0;  // [m3/s]
  double lost = 0.0;                 // [m3]
  double area_before = std::numeric_limits<double>::quiet_NaN(), area = std::numeric_limits<double>::quiet_NaN();  // [m2], least of the lumen
  bool any() const noexcept { return upstream == upstream || downstream == downstream; }
};

/// Milking (empty and refill) tests made with two forceps behind the join.
struct MilkingReport {
  int refilled = 0, stayed_empty = 0, spoiled = 0;
  double seconds = std::numeric_limits<double>::quiet_NaN();  // [s], of the last refill
  double volume = std::numeric_limits<double>::quiet_NaN();   // [m3], emptied in the last
  int tests() const noexcept { return refilled + stayed_empty; }
};

/// Follows both, observation by observation.
class BloodWatch {
 public:
  void observe(const Observation& o) noexcept;
  const ClampReport& clamps() const noexcept { return clamps_; }
  const MilkingReport& milking() const noexcept { return milking_; }

 private:
  ClampReport clamps_;
  MilkingReport milking_;
};

}  // namespace filum
