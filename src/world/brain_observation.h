#pragma once
// What may be seen of a brain and its retractors. Empty in scenes without one.

#include <array>
#include <string>
#include <vector>

#include "base/pose.h"

namespace filum {

inline constexpr int kProfileBins = 16;
inline constexpr double kProfileBin = 4e-3;  // [m]

struct BladeObservation {
  Vec3 force_W = Vec3::Zero();   // [N], of the tissue on the blade
  Vec3 torque_W = Vec3::Zero();  // [N m], about its tip
  Vec3 push_W = Vec3::Zero();    // [N], what a device of three forces shows: along the handle
  Vec3 turn_W = Vec3::Zero();    // [N], and across it
  double area = 0.0;             // [m2], in contact
  double peak = 0.0;             // [Pa], largest pressure of a vertex
  double mean = 0.0;             // [Pa], normal force over area
  double tip = 0.0;              // [Pa], largest within 5 mm of the tip
  std::array<double, kProfileBins> profile{};  // [Pa], largest pressure by distance from the tip, kProfileBin each
  Mat3 stiffness_W = Mat3::Zero();  // [N/m], of the tissue touched, against a further translation of the blade
  int contacts = 0;
  bool parked = false;           // held by its arm
  bool keeps_force = false;      // the arm keeps its force, not its pose
};

struct BrainObservation {
  int n = 0;                     // vertices of the surface; 0: no brain
  Points positions;              // [m], 3 x n, frame W
  std::vector<double> pressure;  // [Pa], of each vertex: normal force over tributary area
  int n_blades = 0;
  std::array<BladeObservation, 2> blades;
  double exposed = 0.0;          // share of the target that can be seen from above
  int veins_torn = 0;
  std::vector<int> vein_torn;    // of each vein, 0 or 1
  Points section;                // [m], 3 x m, vertices of the cross-section
  std::vector<double> section_stress;  // [Pa], von Mises, of each of its triangles
  int iterations = 0;            // of the solver
  double residual = 0.0;         // [N]
};

struct VeinShape {
  int vertex = 0;                // of the surface
  Vec3 dura_W = Vec3::Zero();    // [m]
};

struct BladeDescription {
  std::string name;
  Points vertices;               // [m], 3 x n, frame T of the tool
  std::vector<std::array<int, 3>> triangles;
  double width = 0.0, grip = 0.0;  // [m]
};

/// Constant part, for those who look.
struct BrainDescription {
  std::string name;
  std::vector<std::array<int, 3>> triangles;  // of the surface's vertices
  Points rest;                                // [m], 3 x n
  std::vector<BladeDescription> blades;       // blade i is tool i
  std::vector<VeinShape> veins;
  std::vector<std::array<int, 3>> section_triangles;  // of the cross-section's vertices
  Points section_rest;                        // [m], 3 x m
  Vec3 target_W = Vec3::Zero();               // [m]
  double target_radius = 0.0;                 // [m]
  double bone_y = 0.0;                        // [m], bone fills what lies below this y; 0: none
  double time_compression = 1.0;
};

}  // namespace filum
