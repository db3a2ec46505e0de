#pragma once
// Retraction pressure against editable limits: bands with hysteresis and debouncing, dose over time, timers, perfusion.
// The limits are a training heuristic, fitted to few animals; their file says so, carries a version and a source, and both
// go into every result.
//   dose      D' = max(0, P - above) while loaded;  D' = -D / recovery_time while P < recovers_below
//   risk      1 / (1 + exp(-slope (D - red)))       D in mmHg min
//   perfusion rCPP = arterial - P
// P is the largest pressure of a vertex under the blades. Times are those of the patient: scene time times compression.
// Test: pressure_test.

#include <array>
#include <string>
#include <vector>

#include "base/yaml_file.h"

namespace filum {

inline constexpr double kMmHg = 133.322387415;  // [Pa]

enum class PressureBand { green, yellow, orange, red };
const char* name_of(PressureBand band);

struct PressureLimits {
  std::string title, version, label, source;
  std::array<double, 3> bands{};       // [Pa], from which yellow, orange, red
  double alarm = 0.0;                  // [Pa]
  double hysteresis = 0.0;             // [Pa]
  double debounce = 0.0;               // [s] of the scene
  double dose_above = 0.0, recovers_below = 0.0;  // [Pa]
  bool recovery = true;
  double recovery_time = 0.0;          // [s]
  std::array<double, 3> dose_bands{};  // [Pa s]
  double slope = 0.0;                  // [1/(mmHg min)]
  std::array<double, 3> timers{};      // [s], of uninterrupted load: reminder, orange, red
  bool perfusion = false;
  double arterial = 0.0;               // [Pa]
  std::array<double, 3> perfusion_bands{};  // [Pa], below which yellow, orange, red
  double red_after = 0.0, injury_after = 0.0;  // [s]
};

/// Format filum-pressure/1. Throws InputError.
PressureLimits load_pressure_limits(const std::string& path);
PressureLimits parse_pressure_limits(const YamlNode& file);

class PressureWatch {
 public:
  PressureWatch(PressureLimits limits, double time_compression);

  /// `peak` [Pa], `dt` [s] of the scene.
  void observe(double peak, double dt) noexcept;

  PressureBand band() const { return band_; }
  PressureBand dose_band() const;
  bool alarm() const { return peak_now_ >= limits_.alarm; }
  double pressure() const { return peak_now_; }    // [Pa], now
  double dose() const { return dose_; }            // [Pa s]
  double dose_largest() const { return dose_largest_; }
  double risk() const;                             // of the largest dose
  double loaded() const { return loaded_; }        // [s], uninterrupted until now
  double loaded_longest() const { return loaded_longest_; }
  int releases() const { return releases_; }       // loads ended by falling below recovers_below
  double peak() const { return peak_; }            // [Pa]
  const std::array<double, 4>& time_in_band() const { return time_in_band_; }  // [s], of loaded time
  double perfusion() const { return limits_.arterial - peak_now_; }  // [Pa]
  PressureBand perfusion_band() const;
  bool injured() const { return injured_; }        // perfusion mode: too low for too long, stays
  const PressureLimits& limits() const { return limits_; }
  /// What to tell the trainee now: level ("info", "warn", "danger"), code, text.
  std::vector<std::array<std::string, 3>> messages() const;

 private:
  void take_band(double peak, double dt) noexcept;

  PressureLimits limits_;
  double compression_;
  PressureBand band_ = PressureBand::green, wanted_ = PressureBand::green;
  double wanted_for_ = 0.0;  // [s]
  double peak_now_ = 0.0, peak_ = 0.0, dose_ = 0.0, dose_largest_ = 0.0, loaded_ = 0.0, loaded_longest_ = 0.0, starved_ = 0.0;
  bool under_load_ = false, injured_ = false;
  int releases_ = 0;
  std::array<double, 4> time_in_band_{};
};

}  // namespace filum
