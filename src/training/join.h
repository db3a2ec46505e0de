#pragma once
// The test of a join with the clamps off, as whoever runs the world reports it.

#include <vector>

namespace filum {

struct JoinReport {
  double pressure = 0.0;             // [Pa], held
  double leak = 0.0;                 // [m3/s]
  double area = 0.0;                 // [m2], of gaps that are not sealed
  std::vector<double> sector_flow;   // [m3/s], from where the vessel's angle is zero
  std::vector<double> sector_gap;    // [m], mean
  double narrowing = 0.0;            // [-], 0 open to 1 closed
  double through = 0.0;              // [m3/s]
  bool patent = false;
  double thread_inside = 0.0;        // [m], in the lumen, beside the stitches
  double overlap = 0.0;              // of the cut edges past each other, wall thicknesses
  bool sound = true;                 // the solver had no trouble
};

}  // namespace filum
