#include "reconcile/measure_noise.h"

namespace filum::reconcile {
namespace {

Noise assumed_noise(const RigModel& model, const NoiseOptions& options) {
  Noise noise;
  for (const std::string& name : model.data().outputs) {
    const double fs = model.full_scale(name), stated = model.data().channel(name).noise;
    noise.output.push_back({stated > 0 ? stated : options.first * fs, 0.0, fs, stated > 0 ? "stated" : "fast part"});
  }
  noise.scatter = options.first_scatter;
  return noise;
}

}  // namespace

NoiseSummary measure_noise(Fitter& fitter, const NoiseOptions& options) {
  fitter.set_noise(assumed_noise(fitter.model(), options));
  NoiseSummary out;
  out.loose = fitter.fit({}, fitter.model().guess(), {});
  out.noise = estimate_noise(fitter, out.loose);
  fitter.set_noise(out.noise);
  return out;
}

}  // namespace filum::reconcile
