#include "training/pressure_map.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

/// A tenth of a unit is what a colour can tell.
double tenth(double value, double unit) { return std::isfinite(value) ? std::round(10.0 * value / unit) / 10.0 : 0.0; }

Json tenths(const std::vector<double>& values, double unit) {
  Json list = Json::array();
  for (const double v : values) list.push_back(tenth(v, unit));
  return list;
}

/// One row of a blade: pressure of the bins at each moment, moment by moment.
Json columns(const std::vector<double>& profile, std::size_t moments, std::size_t stride) {
  constexpr auto kBins = static_cast<std::size_t>(kProfileBins);
  Json list = Json::array();
  for (std::size_t from = 0; from < moments; from += stride)
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      double most = 0.0;
      for (std::size_t k = from; k < std::min(moments, from + stride); ++k) most = std::max(most, profile[k * kBins + bin]);
      list.push_back(tenth(most, kMmHg));
    }
  return list;
}

}  // namespace

Json pressure_map_json(const PressureReport& p) {
  const std::size_t moments = p.time.size(), stride = std::max<std::size_t>(1, (moments + kMapColumns - 1) / kMapColumns);
  Json time = Json::array(), blades = Json::array(), rest = Json::array(), triangles = Json::array();
  for (std::size_t k = 0; k < moments; k += stride) time.push_back(p.time[k]);
  for (std::size_t i = 0; i < p.blade_names.size() && i < p.profiles.size(); ++i)
    if (p.profiles[i].size() == moments * static_cast<std::size_t>(kProfileBins))
      blades.push_back({{"name", p.blade_names[i]}, {"pressure", columns(p.profiles[i], moments, stride)}});
  for (Eigen::Index k = 0; k < p.rest.size(); ++k) rest.push_back(tenth(p.rest.data()[k], 1e-3));
  for (const auto& t : p.triangles)
    for (const int i : t) triangles.push_back(i);
  return {{"time", time},           {"bins", kProfileBins}, {"bin_mm", 1e3 * kProfileBin},
          {"blades", blades},       {"rest", rest},         {"triangles", triangles},
          {"peak", tenths(p.place_peak, kMmHg)}, {"dose", tenths(p.place_dose, 60.0 * kMmHg)},
          {"dose_red", tenth(p.limits.dose_bands[2], 60.0 * kMmHg)}};
}

}  // namespace filum
