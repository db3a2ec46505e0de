#include "training/pressure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace filum {
namespace {

constexpr double kTouch = 1.0 * kMmHg;  // [Pa], from which the tissue counts as loaded
constexpr double kMmHgMin = kMmHg * 60.0;

/// Number of thresholds that `value` has reached.
PressureBand reached(const std::array<double, 3>& thresholds, double value) {
  return static_cast<PressureBand>(std::count_if(thresholds.begin(), thresholds.end(), [&](double t) { return value >= t; }));
}

std::array<double, 3> growing(const YamlNode& node, std::array<const char*, 3> keys, const char* unit, bool falling = false) {
  std::array<double, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = node.quantity(keys[k], unit, Range::positive());
    if (k > 0 && (falling ? v[k] >= v[k - 1] : v[k] <= v[k - 1])) node.refuse(keys[k], std::string(falling ? "less" : "more") + " than " + keys[k - 1]);
  }
  return v;
}

std::string text(const char* format, double a, double b = 0.0) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

}  // namespace

const char* name_of(PressureBand band) {
  constexpr std::array kNames = {"green", "yellow", "orange", "red"};
  return kNames[static_cast<std::size_t>(band)];
}

PressureLimits parse_pressure_limits(const YamlNode& file) {
  file.choice("format", {"filum-pressure/1"});
  PressureLimits l;
  l.title = file.text("title");
  l.version = file.text("version");
  l.label = file.text("label");
  l.source = file.text("source");
  const YamlNode bands = file.map("bands");
  l.bands = growing(bands, {"yellow", "orange", "red"}, "mmHg");
  l.alarm = bands.quantity("alarm", "mmHg", Range::positive());
  l.hysteresis = bands.quantity("hysteresis", "mmHg", {0.0, l.bands[0], false});
  l.debounce = bands.quantity("debounce", "s", Range::between(0.0, 5.0));
  const YamlNode dose = file.map("dose");
  l.dose_above = dose.quantity("above", "mmHg", Range::not_negative());
  l.recovers_below = dose.quantity("recovers_below", "mmHg", {0.0, std::max(l.dose_above, 1e-9), false});
  l.recovery = dose.flag("recovery");
  l.recovery_time = dose.quantity("recovery_time", "s", Range::positive());
  l.dose_bands = growing(dose, {"yellow", "orange", "red"}, "mmHg.min");
  l.slope = dose.number("slope", Range::positive());
  l.timers = growing(file.map("timers"), {"remind", "orange", "red"}, "s");
  const YamlNode perfusion = file.map("perfusion");
  l.perfusion = perfusion.flag("on");
  l.arterial = perfusion.quantity("arterial", "mmHg", Range::positive());
  l.perfusion_bands = growing(perfusion, {"yellow", "orange", "red"}, "mmHg", true);
  l.red_after = perfusion.quantity("red_after", "s", Range::not_negative());
  l.injury_after = perfusion.quantity("injury_after", "s", Range::positive());
  file.finish();
  return l;
}

PressureLimits load_pressure_limits(const std::string& path) { return parse_pressure_limits(YamlNode::load(path)); }

PressureWatch::PressureWatch(PressureLimits limits, double time_compression) : limits_(std::move(limits)), compression_(time_compression) {}

/// Up when a threshold is reached, down when it is undershot by the hysteresis, each for the debounce time.
void PressureWatch::take_band(double peak, double dt) noexcept {
  PressureBand next = reached(limits_.bands, peak);
  if (next < band_) next = std::min(band_, reached(limits_.bands, peak + limits_.hysteresis));
  if (next != wanted_) wanted_for_ = 0.0;
  wanted_ = next;
  wanted_for_ += dt;
  if (wanted_for_ >= limits_.debounce) band_ = wanted_;
}

void PressureWatch::observe(double peak, double dt) noexcept {
  if (!std::isfinite(peak) || !(dt >= 0.0)) return;
  const double time = dt * compression_;
  peak_now_ = peak;
  peak_ = std::max(peak_, peak);
  take_band(peak, dt);
  if (peak > limits_.dose_above) dose_ += (peak - limits_.dose_above) * time;
  if (peak < limits_.recovers_below && limits_.recovery) dose_ *= std::exp(-time / limits_.recovery_time);
  dose_largest_ = std::max(dose_largest_, dose_);
  if (peak >= kTouch) time_in_band_[static_cast<std::size_t>(band_)] += time;
  if (peak >= limits_.recovers_below) {
    under_load_ = true;
    loaded_ += time;
    loaded_longest_ = std::max(loaded_longest_, loaded_);
  } else {
    releases_ += under_load_ ? 1 : 0;
    under_load_ = false;
    loaded_ = 0.0;
  }
  starved_ = perfusion() < limits_.perfusion_bands[2] ? starved_ + time : 0.0;
  injured_ = injured_ || (limits_.perfusion && starved_ >= limits_.injury_after);
}

PressureBand PressureWatch::dose_band() const { return reached(limits_.dose_bands, dose_); }

double PressureWatch::risk() const { return 1.0 / (1.0 + std::exp(-limits_.slope * (dose_largest_ - limits_.dose_bands[2]) / kMmHgMin)); }

PressureBand PressureWatch::perfusion_band() const {
  const double p = perfusion();
  if (p < limits_.perfusion_bands[2] && starved_ >= limits_.red_after) return PressureBand::red;
  if (p < limits_.perfusion_bands[1]) return PressureBand::orange;
  return p < limits_.perfusion_bands[0] ? PressureBand::yellow : PressureBand::green;
}

std::vector<std::array<std::string, 3>> PressureWatch::messages() const {
  std::vector<std::array<std::string, 3>> list;
  constexpr std::array kLevels = {"info", "info", "warn", "danger"};
  const auto level = [&](PressureBand b) { return std::string(kLevels[static_cast<std::size_t>(b)]); };
  if (alarm()) list.push_back({"danger", "pressure-alarm", text("%.0f mmHg: above the alarm at %.0f mmHg. Release now.", peak_now_ / kMmHg, limits_.alarm / kMmHg)});
  else if (band_ != PressureBand::green)
    list.push_back({level(band_), std::string("pressure-") + name_of(band_), text("%.0f mmHg under the blade.", peak_now_ / kMmHg)});
  if (const PressureBand d = dose_band(); d != PressureBand::green)
    list.push_back({level(d), std::string("dose-") + name_of(d), text("Dose %.0f mmHg min.", dose_ / kMmHgMin)});
  const PressureBand timer = reached(limits_.timers, loaded_);
  if (timer != PressureBand::green)
    list.push_back({level(timer), "release-reminder", text("Retracted for %.0f min without a pause: release for a while.", loaded_ / 60.0)});
  if (limits_.perfusion) {
    if (injured_) list.push_back({"danger", "perfusion-injury", "Perfusion was too low for too long: injury."});
    else if (const PressureBand p = perfusion_band(); p != PressureBand::green)
      list.push_back({level(p), std::string("perfusion-") + name_of(p), text("Regional perfusion pressure %.0f mmHg.", perfusion() / kMmHg)});
  }
  return list;
}

}  // namespace filum
