#pragma once
// Measures of movement, grip and thread from evenly sampled series. Lengths in metres, times in seconds.
//
// SPARC: Balasubramanian, Melendez-Calderon, Burdet 2012 (IEEE TBME 59:2126) and Balasubramanian et al. 2015
// (J NeuroEng Rehabil 12:112), as in the authors' program. LDLJ: log dimensionless jerk of the speed, same
// paper. Both are for discrete moves of a few seconds: segment first (movements()), then report the median
// over segments. Both are negative; closer to zero is smoother. SPARC's arc length is cut at fc = 10 Hz,
// which physiological tremor (8-12 Hz) straddles. Frames: speeds and paths are those of the tool tips in the
// scene, not of the hand.

#include <array>
#include <cstddef>
#include <vector>

#include "base/pose.h"

namespace filum {

inline constexpr double kMetricRate = 100.0;  // [Hz], at which the series below are sampled

struct SparcOptions {
  double fc = 10.0;         // [Hz], highest frequency looked at
  double amplitude = 0.05;  // of the largest; the band ends where the spectrum last exceeds it
  int padding = 4;          // the spectrum has 2^(ceil(log2 n) + padding) points
};

/// Spectral arc length of a speed profile [any unit] sampled at fs [Hz]; NaN for fewer than 4 samples or no
/// motion.
double sparc(const std::vector<double>& speed, double fs, const SparcOptions& options = {});

/// Log dimensionless jerk of a speed profile, -ln(T^3 / v_peak^2 * integral of (d2v/dt2)^2 dt); low-pass
/// first. NaN for fewer than 4 samples or no motion.
double ldlj(const std::vector<double>& speed, double fs);

/// Butterworth low-pass, no phase shift: a second-order section run forwards and backwards (fourth order in
/// all), its cut-off corrected so that the two passes together are at -3 dB at fc [Hz]. Ends are continued by
/// odd reflection.
std::vector<double> low_pass(const std::vector<double>& signal, double fs, double fc);

/// Speed [m/s] of a path [m, 3 x n] by central differences.
std::vector<double> speed_of(const Points& path, double fs);

/// Length of a path. [m]
double path_length(const Points& path);

struct MovementOptions {
  double cut_off = 6.0;     // [Hz], low-pass of the speed before counting
  double threshold = 5e-3;  // [m/s], a movement's peak exceeds it ...
  double rest = 2.0e-3;     // [m/s], ... and the speed falls below this before the next begins
  double shortest = 0.10;   // [s], shorter bursts are not counted
};

/// Half-open range of samples.
struct Segment {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// Movements: stretches between rests of the low-passed speed that hold a peak above the threshold.
std::vector<Segment> movements(const std::vector<double>& speed, double fs,
                               const MovementOptions& options = {});

/// Time spent below the rest speed. [s]
double idle_time(const std::vector<double>& speed, double fs, const MovementOptions& options = {});

struct Spread {
  double median = 0.0, low = 0.0, high = 0.0;  // quartiles
  int n = 0;
};
/// Median and quartiles of finite values; n = 0 and NaN if there are none.
Spread spread_of(std::vector<double> values);

/// SPARC and LDLJ (of the speed low-passed at 20 Hz) of each movement between 0.3 s and 10 s. Noise ruins
/// LDLJ long before SPARC: a movement whose peak speed is below kLdljSignalToNoise times what the low-pass
/// takes away gives no LDLJ.
inline constexpr double kLdljSignalToNoise = 100.0;
struct Smoothness {
  Spread sparc, ldlj;
};
Smoothness smoothness_of(const std::vector<double>& speed, double fs, const std::vector<Segment>& segments);

struct Bimanual {
  double both_moving = 0.0;  // share of the time in which both tools move, 0..1
  double correlation =
      0.0;  // largest correlation of the two speeds over lags up to 0.5 s, -1..1; NaN if one is still
  double lag = 0.0;        // [s], at which it is largest; > 0: the second tool follows the first
  double dominance = 0.5;  // share of the second tool in the sum of both paths, 0..1
};
Bimanual bimanual(const Points& first, const Points& second, double fs, const MovementOptions& options = {});

/// Peaks of a force: stretches above `threshold` [N], the largest value of each. [N]
std::vector<double> force_peaks(const std::vector<double>& force, double threshold);

}  // namespace filum
