#include "training/retraction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace filum {
namespace {

constexpr double kSamples = 10.0;         // [Hz] of the scene
constexpr std::size_t kMostSamples = 40000;

double peak_of(const Observation& o) {
  double peak = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(o.brain.n_blades); ++i) peak = std::max(peak, o.brain.blades[i].peak);
  return peak;
}

bool any_on_arm(const Observation& o) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(o.brain.n_blades); ++i)
    if (o.brain.blades[i].parked) return true;
  return false;
}

}  // namespace

RetractionWatch::RetractionWatch(const RetractionTask& task, double time_compression)
    : task_(task), pressure_(task.limits, time_compression), compression_(time_compression) {
  for (auto* curve : {&report_.time, &report_.pressure, &report_.dose_curve, &report_.exposed_curve}) curve->reserve(kMostSamples);
  report_.perfusion_least = task.limits.arterial;
}

bool RetractionWatch::met(const RetractionGoal& g, const Observation& o, double peak) const {
  switch (g.kind) {
    case RetractionGoal::Kind::press:
      return peak >= g.low && peak <= g.high;
    case RetractionGoal::Kind::release:
      return peak < g.high;
    case RetractionGoal::Kind::expose:
    case RetractionGoal::Kind::hold:
      return o.brain.exposed >= g.share && peak >= g.low && peak <= g.high && (!g.on_arm || any_on_arm(o));
  }
  return false;
}

void RetractionWatch::sample(const Observation& o, double peak) {
  const bool due = report_.time.empty() || o.time >= report_.time.back() + 1.0 / kSamples - 1e-9;
  if (!due || report_.time.size() >= kMostSamples) {  // each column of the map shows the largest until the next one
    for (std::size_t i = 0; i < static_cast<std::size_t>(o.brain.n_blades); ++i)
      std::transform(o.brain.blades[i].profile.begin(), o.brain.blades[i].profile.end(), report_.profiles[i].end() - kProfileBins,
                     report_.profiles[i].end() - kProfileBins, [](double now, double before) { return std::max(now, before); });
    return;
  }
  report_.time.push_back(o.time);
  report_.pressure.push_back(peak);
  report_.dose_curve.push_back(pressure_.dose());
  report_.exposed_curve.push_back(o.brain.exposed);
  for (std::size_t i = 0; i < static_cast<std::size_t>(o.brain.n_blades); ++i)
    report_.profiles[i].insert(report_.profiles[i].end(), o.brain.blades[i].profile.begin(), o.brain.blades[i].profile.end());
}

/// Per place of the cortex: the largest pressure it has borne, and the pressure above the dose's threshold over the patient's time.
void RetractionWatch::map_pressure(const Observation& o, double dt) {
  const std::size_t n = o.brain.pressure.size();
  if (report_.place_peak.size() != n) {
    report_.place_peak.assign(n, 0.0);
    report_.place_dose.assign(n, 0.0);
  }
  const double above = task_.limits.dose_above;
  for (std::size_t k = 0; k < n; ++k) {
    report_.place_peak[k] = std::max(report_.place_peak[k], o.brain.pressure[k]);
    report_.place_dose[k] += dt * compression_ * std::max(0.0, o.brain.pressure[k] - above);
  }
}

void RetractionWatch::observe(const Observation& o, double dt, bool scored, std::vector<TaskEvent>& events) {
  if (done()) return;
  const double peak = peak_of(o);
  pressure_.observe(peak, dt);
  for (std::size_t i = 0; i < static_cast<std::size_t>(o.brain.n_blades); ++i) {
    report_.tip = std::max(report_.tip, o.brain.blades[i].tip);
    report_.mean = std::max(report_.mean, o.brain.blades[i].mean);
    report_.force = std::max(report_.force, o.brain.blades[i].force_W.norm());
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(o.n_events); ++k) {
    const std::string_view name = o.events[k].name;
    report_.slips += name == "slip" ? 1 : 0;
    report_.edge_cuts += name == "edge-cut" ? 1 : 0;
  }
  map_pressure(o, dt);
  report_.veins_torn = o.brain.veins_torn;
  report_.exposed = std::max(report_.exposed, o.brain.exposed);
  report_.perfusion_least = std::min(report_.perfusion_least, pressure_.perfusion());
  sample(o, peak);
  if (!scored) return;
  const RetractionGoal& g = task_.goals[static_cast<std::size_t>(step_)];
  const bool now = met(g, o, peak);
  if (now && g.kind == RetractionGoal::Kind::hold) report_.hold_peak = std::max(report_.hold_peak, peak);
  if (now) kept_ += dt * compression_;
  else if (g.kind != RetractionGoal::Kind::hold) kept_ = 0.0;
  if (now && g.kind == RetractionGoal::Kind::press) {
    error_ += dt * std::abs(peak - 0.5 * (g.low + g.high));
    pressing_ += dt;
  }
  if (!now || kept_ < g.seconds) return;
  events.push_back({o.time, "goal-reached", -1, peak / kMmHg, "mmHg", {}});
  ++step_;
  kept_ = 0.0;
}

double retraction_value(Measure measure, const PressureReport& r) {
  switch (measure) {
    case Measure::pressure_peak: return r.peak;
    case Measure::pressure_tip: return r.tip;
    case Measure::pressure_dose: return r.dose;
    case Measure::time_in_red: return r.time_in_band[3];
    case Measure::time_over: return r.time_in_band[1] + r.time_in_band[2] + r.time_in_band[3];
    case Measure::hold_peak: return r.hold_peak;
    case Measure::releases: return r.releases;
    case Measure::press_error: return r.press_error;
    case Measure::loaded_longest: return r.loaded_longest;
    case Measure::exposed: return r.exposed;
    case Measure::slips: return r.slips;
    case Measure::edge_cuts: return r.edge_cuts;
    case Measure::veins_torn: return r.veins_torn;
    default: return std::numeric_limits<double>::quiet_NaN();
  }
}

PressureReport RetractionWatch::report() const {
  PressureReport r = report_;
  r.peak = pressure_.peak();
  r.dose = pressure_.dose_largest();
  r.risk = pressure_.risk();
  r.time_in_band = pressure_.time_in_band();
  r.loaded_longest = pressure_.loaded_longest();
  r.releases = pressure_.releases();
  r.injured = pressure_.injured();
  r.limits = pressure_.limits();
  r.press_error = pressing_ > 0.0 ? error_ / pressing_ : std::numeric_limits<double>::quiet_NaN();
  return r;
}

}  // namespace filum
