#include "devices/calibration_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace filum {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Readings by value and direction; values within 1e-9 of each other are one.
using Groups = std::map<std::pair<long long, bool>, std::vector<double>>;
Groups groups_of(const std::vector<CalibrationPoint>& points) {
  Groups groups;
  for (const CalibrationPoint& p : points) groups[{std::llround(p.value * 1e9), p.upwards}].push_back(p.count);
  return groups;
}

double mean_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

std::string objection(const std::vector<CalibrationPoint>& points, const Groups& groups, const CalibrationDemands& d,
                      const std::string& unit, double scale) {
  std::map<long long, int> levels;
  for (const auto& [key, counts] : groups) levels[key.first] += 1;
  if (static_cast<int>(levels.size()) < d.levels)
    return "readings at " + std::to_string(levels.size()) + " values, at least " + std::to_string(d.levels) + " are needed";
  for (const auto& [key, counts] : groups) {
    const std::string at = number(1e-9 * static_cast<double>(key.first) / scale) + " " + unit;
    if (static_cast<int>(counts.size()) < d.repeats)
      return std::to_string(counts.size()) + " reading at " + at + (key.second ? " upwards" : " downwards") + ", at least " +
             std::to_string(d.repeats) + " are needed";
    if (levels[key.first] < 2) return "no reading " + std::string(key.second ? "downwards" : "upwards") + " at " + at;
  }
  for (const CalibrationPoint& p : points) {
    const std::string at = number(p.value / scale) + " " + unit;
    if (!std::isfinite(p.count) || !std::isfinite(p.value)) return "a reading that is no number at " + at;
    if (p.count < d.count_low || p.count > d.count_high) return "the amplifier is saturated at " + at + " (" + number(p.count) + " counts)";
    if (p.noise > d.noise) return "the reading at " + at + " is not steady (" + number(p.noise) + " counts)";
  }
  return {};
}

void fit(const std::vector<CalibrationPoint>& points, CalibrationFit& f) {
  double n = 0.0, c = 0.0, v = 0.0;
  for (const CalibrationPoint& p : points) n += 1.0, c += p.count, v += p.value;
  c /= n;
  v /= n;
  double cc = 0.0, cv = 0.0;
  for (const CalibrationPoint& p : points) {
    cc += (p.count - c) * (p.count - c);
    cv += (p.count - c) * (p.value - v);
  }
  f.gain = cc > 0.0 ? cv / cc : 0.0;
  f.zero = f.gain != 0.0 ? c - v / f.gain : 0.0;
  double square = 0.0;
  for (const CalibrationPoint& p : points) {
    f.residuals.push_back(p.value - f.gain * (p.count - f.zero));
    square += f.residuals.back() * f.residuals.back();
  }
  f.residual = std::sqrt(square / std::max(1.0, n - 2.0));
}

void spread(const Groups& groups, CalibrationFit& f) {
  double square = 0.0, degrees = 0.0;
  for (const auto& [key, counts] : groups) {
    const double mean = mean_of(counts);
    for (double count : counts) square += (count - mean) * (count - mean);
    degrees += static_cast<double>(counts.size()) - 1.0;
    const auto other = groups.find({key.first, !key.second});
    if (other != groups.end())
      f.hysteresis = std::max(f.hysteresis, std::abs(f.gain * (mean - mean_of(other->second))));
  }
  f.repeatability = degrees > 0.0 ? std::abs(f.gain) * std::sqrt(square / degrees) : 0.0;
}

}  // namespace

CalibrationFit fit_line(const std::vector<CalibrationPoint>& points, const CalibrationDemands& d, const std::string& unit,
                        double scale) {
  CalibrationFit f;
  const Groups groups = groups_of(points);
  f.why = objection(points, groups, d, unit, scale);
  if (!f.why.empty()) return f;
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  const auto [first, last] = std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.count < b.count; });
  f.from = low->value;
  f.to = high->value;
  f.count_from = first->count;
  f.count_to = last->count;
  if (f.count_to - f.count_from < d.counts) {
    f.why = "the readings span " + number(f.count_to - f.count_from) + " counts, at least " + number(d.counts) + " are needed: check gain and wiring";
    return f;
  }
  fit(points, f);
  spread(groups, f);
  double noise = 0.0;
  for (const CalibrationPoint& p : points) noise = std::max(noise, p.noise);
  f.uncertainty = std::sqrt(f.residual * f.residual + f.hysteresis * f.hysteresis / 12.0 + f.repeatability * f.repeatability +
                            f.gain * f.gain * noise * noise);
  const double span = f.to - f.from;
  const auto share = [&](double value) { return number(value / scale) + " " + unit + ", " + number(100.0 * value / span) + " % of the range"; };
  if (f.repeatability > d.repeatability * span) f.why = "readings at the same value do not repeat (" + share(f.repeatability) + ")";
  else if (f.hysteresis > d.hysteresis * span) f.why = "too much hysteresis (" + share(f.hysteresis) + ")";
  else if (f.residual > d.residual * span) f.why = "the readings are not on a line (" + share(f.residual) + ")";
  f.good = f.why.empty();
  return f;
}

}  // namespace filum
