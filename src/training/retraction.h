#pragma once
// Tasks of brain retraction: goals in turn, pressure and dose against the limits, what went wrong, and how it is reported.
//   press    the largest pressure stays within [low, high] for `seconds`
//   release  it stays below `high` for `seconds`
//   expose   at least `share` of the target is seen for `seconds`
//   hold     the exposure (pressure from `low` up, or `share` of the target) is kept, `seconds` in all; pauses are allowed
// Seconds are those of the patient: scene time times the scene's compression. Test: retraction_test.

#include <string>
#include <vector>

#include "training/retraction_task.h"
#include "training/step_recogniser.h"
#include "training/task.h"
#include "world/observation.h"

namespace filum {

/// Pressure at the end of a run. SI units, times of the patient.
struct PressureReport {
  double peak = 0.0, tip = 0.0, mean = 0.0;   // [Pa]; mean: largest of normal force over area
  double force = 0.0;                         // [N], largest on a blade
  double dose = 0.0, risk = 0.0;              // [Pa s], largest; share
  std::array<double, 4> time_in_band{};       // [s]
  double loaded_longest = 0.0;                // [s]
  int releases = 0, slips = 0, edge_cuts = 0, veins_torn = 0;
  double exposed = 0.0;                       // largest share of the target seen
  double press_error = 0.0;                   // [Pa], mean distance from the middle of the band asked for while pressing; NaN without
  double perfusion_least = 0.0;               // [Pa]
  double hold_peak = 0.0;                     // [Pa], largest while an exposure was being held
  bool injured = false;
  PressureLimits limits;
  std::vector<double> time, pressure, dose_curve, exposed_curve;  // [s] of the scene, [Pa], [Pa s], share; ten a second
  std::array<std::vector<double>, 2> profiles;   // [Pa], of each blade: kProfileBins from the tip on at each of these times
  std::vector<double> place_peak, place_dose;    // [Pa], [Pa s], of each vertex of the surface
  std::vector<std::string> blade_names;          // these three of the scene
  Points rest;                                   // [m]
  std::vector<std::array<int, 3>> triangles;
};

/// What a rubric line looks at; NaN for measures of other tasks.
double retraction_value(Measure measure, const PressureReport& report);

class RetractionWatch {
 public:
  RetractionWatch(const RetractionTask& task, double time_compression);

  /// What is borne counts; goals are met only while `scored`.
  void observe(const Observation& o, double dt, bool scored, std::vector<TaskEvent>& events);
  int step() const { return step_; }
  bool blind() const { return !done() && task_.goals[static_cast<std::size_t>(step_)].blind; }
  bool done() const { return step_ == static_cast<int>(task_.goals.size()); }
  const PressureWatch& pressure() const { return pressure_; }
  PressureReport report() const;

 private:
  bool met(const RetractionGoal& goal, const Observation& o, double peak) const;
  void sample(const Observation& o, double peak);
  void map_pressure(const Observation& o, double dt);

  RetractionTask task_;
  PressureWatch pressure_;
  PressureReport report_;
  double compression_;
  int step_ = 0;
  double kept_ = 0.0;            // [s], of the goal's time
  double error_ = 0.0, pressing_ = 0.0;
};

}  // namespace filum
