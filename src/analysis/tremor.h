#pragma once
// Tremor of a tool that is held still, from evenly sampled stretches of its tip's path.
//
// Drift and voluntary movement (98.9 % of their power lies below 2 Hz: Riviere) are taken away by a high-pass without
// phase shift, x minus its low-pass (what that takes from the density above its cut-off is given back); the densities of
// the three axes are added (Welch, spectrum.h). Bands: 4-6, 6-12, 8-12, 12-20 Hz. No standard for detecting tremor exists (Luft et al., Sensors 19 (2019) 4301); what is here is common
// practice, and every setting is reported.
//
// A value counts only where the device can resolve it: the same analysis of a recording with the tool clamped gives the
// noise floor; a band is resolved when the lower end of its interval is above the upper end of the floor's, and only
// then is rms = sqrt(P - P_floor) given. Without a clamped recording nothing is resolved. Test: tremor_test.

#include <optional>
#include <string>
#include <vector>

#include "analysis/spectrum.h"
#include "base/pose.h"

namespace filum {

/// A path sampled evenly, in stretches without gaps.
struct EvenPath {
  double fs = 0.0;                 // [Hz]
  std::vector<Points> stretches;   // [m], 3 x n each
  double jitter = 0.0;             // [s], rms deviation of the sampling times from even ones
  std::size_t gaps = 0;            // where samples are missing; nothing is filled in
  std::vector<double> starts = {}; // [s], of each stretch, on the clock of the readings
  double seconds() const;
};

struct TremorOptions {
  WelchOptions welch;
  double high_pass = 2.0;          // [Hz]
  double shortest = 10.0;          // [s], of stretches together; 30 s are advised
  double longest_jitter = 1e-3;    // [s]
};

struct TremorBand {
  double from = 0.0, to = 0.0;     // [Hz]
  Interval power;                  // [m^2], as measured
  double floor = 0.0;              // [m^2], of the clamped tool; NaN where not measured
  bool resolved = false;
  double rms = 0.0;                // [m], free of the floor; NaN where not resolved
  std::string why;                 // where not resolved
};

struct Tremor {
  bool measured = false;           // there is a spectrum
  std::string why;                 // where there is none, or none of the bands is resolved
  Spectrum spectrum;               // [m^2/Hz], three axes together
  std::vector<TremorBand> bands;
  SpectralPeak peak;               // between 4 and 20 Hz
  double rms = 0.0;                // [m], of the high-passed path, as measured
  double range = 0.0;              // [m], largest distance from the mean position
  double relative_power = 0.0;     // 8-12 Hz to 0.5-25 Hz, of the path before the high-pass
  bool resolved() const;
};

/// `clamped`: the same device with its tool held in a vice.
Tremor tremor_of(const EvenPath& path, const std::optional<EvenPath>& clamped, const TremorOptions& options = {});

/// From readings at uneven times t [s, growing] to stretches of even rate: a gap of more than 1.5 periods ends a
/// stretch; within one, linear interpolation moves each reading by less than a period.
EvenPath even_path(const std::vector<double>& t, const Points& p);

}  // namespace filum
