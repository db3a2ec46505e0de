#include "analysis/grasp_force.h"

#include <algorithm>
#include <cmath>

#include "training/metrics.h"

namespace filum {
namespace {

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

void measure_middle(const std::vector<double>& force, std::size_t first, std::size_t last, Grasp& grasp) {
  const std::size_t quarter = (last - first) / 4;
  const std::vector<double> middle(force.begin() + static_cast<std::ptrdiff_t>(first + quarter),
                                   force.begin() + static_cast<std::ptrdiff_t>(last - quarter));
  grasp.plateau = quantile(middle, 0.5);
  double mean = 0.0, square = 0.0;
  for (double f : middle) mean += f / static_cast<double>(middle.size());
  for (double f : middle) square += (f - mean) * (f - mean);
  grasp.variation = mean > 0.0 ? std::sqrt(square / static_cast<double>(middle.size())) / mean : 0.0;
}

void match_object(const std::vector<HeldObject>& held, Grasp& grasp) {
  for (const HeldObject& object : held) {
    if (object.from > grasp.to || object.to < grasp.from) continue;
    grasp.excess = grasp.plateau - object.slip_limit;
    grasp.slipped = grasp.slipped || object.slipped;
  }
}

}  // namespace

std::vector<Grasp> find_grasps(const std::vector<double>& force, double fs, double t0,
                               const std::vector<HeldObject>& held, const GraspOptions& o,
                               const std::function<double(double)>& scene_time) {
  const auto time = [&](std::size_t k) {
    const double t = t0 + static_cast<double>(k) / fs;
    return scene_time ? scene_time(t) : t;
  };
  std::vector<Grasp> grasps;
  const std::vector<double> smooth = low_pass(force, fs, o.cut_off);
  const auto shortest = static_cast<std::size_t>(std::max(4.0, o.shortest * fs));
  for (std::size_t k = 0; k < force.size(); ++k) {
    if (!(force[k] > o.threshold)) continue;
    const std::size_t first = k;
    while (k < force.size() && force[k] > o.threshold) ++k;
    if (k - first < shortest) continue;
    Grasp grasp;
    grasp.from = time(first);
    grasp.to = time(k);
    grasp.peak = *std::max_element(force.begin() + static_cast<std::ptrdiff_t>(first),
                                   force.begin() + static_cast<std::ptrdiff_t>(k));
    for (std::size_t i = std::max<std::size_t>(first, 1); i < k; ++i)
      grasp.rise = std::max(grasp.rise, (smooth[i] - smooth[i - 1]) * fs);
    measure_middle(force, first, k, grasp);
    grasp.overshoot = grasp.peak - grasp.plateau;
    match_object(held, grasp);
    grasps.push_back(grasp);
  }
  return grasps;
}

GraspBands bands_of(const std::vector<Grasp>& experts) {
  GraspBands bands;
  bands.n = static_cast<int>(experts.size());
  if (experts.empty()) return bands;
  std::vector<double> peaks, variations;
  for (const Grasp& grasp : experts) {
    peaks.push_back(grasp.peak);
    variations.push_back(grasp.variation);
  }
  bands.peak_low = quantile(peaks, 0.05);
  bands.peak_high = quantile(peaks, 0.95);
  bands.variation_high = quantile(variations, 0.95);
  return bands;
}

GraspErrors errors_of(const std::vector<Grasp>& grasps, const GraspBands& bands) {
  GraspErrors errors;
  for (const Grasp& grasp : grasps) {
    errors.high += grasp.peak > bands.peak_high ? 1 : 0;
    errors.low += grasp.peak < bands.peak_low && grasp.slipped ? 1 : 0;
    errors.variable += grasp.variation > bands.variation_high ? 1 : 0;
  }
  return errors;
}

}  // namespace filum
