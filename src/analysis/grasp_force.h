#pragma once
// Grasps in a force record: one grasp is a stretch above a threshold. After SmartForceps (Sugiyama et al., JAMA Surg.
// 153 (2018); Baghdadi et al., Sci. Rep. 13 (2023) 9591): peak and variability of each grasp, and errors against bands of
// experts: high force (peak above P95), low force (peak below P5 and what was held slipped), variable force (coefficient
// of variation above P95). No band, no errors: they are not guessed. Test: grasp_force_test.

#include <functional>
#include <optional>
#include <vector>

namespace filum {

struct GraspOptions {
  double threshold = 20e-3;  // [N], above which something is held
  double shortest = 0.1;     // [s]
  double cut_off = 20.0;     // [Hz], low-pass before rates are taken
};

/// Something the world said of a grasp: what was held, and when it slipped.
struct HeldObject {
  double from = 0.0, to = 0.0;  // [s]
  double slip_limit = 0.0;      // [N], least squeeze that holds it
  bool slipped = false;
};

struct Grasp {
  double from = 0.0, to = 0.0;  // [s]
  double peak = 0.0;            // [N]
  double plateau = 0.0;         // [N], median of the middle half
  double rise = 0.0;            // [N/s], fastest increase
  double overshoot = 0.0;       // [N], peak less plateau
  double variation = 0.0;       // standard deviation over mean, middle half
  std::optional<double> excess; // [N], plateau less the slip limit of what was held
  bool slipped = false;
};

/// Force [N] sampled evenly at fs [Hz] from time t0 [s]. `scene_time`: where the force has another clock than what was held,
/// to the latter's; grasps are then told by it.
std::vector<Grasp> find_grasps(const std::vector<double>& force, double fs, double t0,
                               const std::vector<HeldObject>& held, const GraspOptions& options = {},
                               const std::function<double(double)>& scene_time = {});

/// 5th and 95th percentile of experts' grasps.
struct GraspBands {
  double peak_low = 0.0, peak_high = 0.0;  // [N]
  double variation_high = 0.0;
  int n = 0;                               // grasps they come from
};
GraspBands bands_of(const std::vector<Grasp>& experts);

struct GraspErrors {
  int high = 0, low = 0, variable = 0;
};
GraspErrors errors_of(const std::vector<Grasp>& grasps, const GraspBands& bands);

}  // namespace filum
