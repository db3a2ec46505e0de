// The map of a task that was run: retraction_test.

#include "training/pressure_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace filum {
namespace pressure_map_test {

constexpr auto kBins = static_cast<std::size_t>(kProfileBins);

/// One blade, without pressure, ten moments a second.
PressureReport report(std::size_t moments) {
  PressureReport p;
  for (std::size_t k = 0; k < moments; ++k) p.time.push_back(0.1 * static_cast<double>(k));
  p.blade_names = {"left"};
  p.profiles[0].assign(moments * kBins, 0.0);
  return p;
}

/// A press of a tenth of a second within an hour is still to be seen, in the column of its moment alone.
TEST(PressureMap, AMomentsPeakOutlivesTheThinning) {
  for (const std::size_t moment : {std::size_t{0}, std::size_t{35999}, std::size_t{17 * 60 + 59}, std::size_t{18 * 60}}) {
    PressureReport p = report(36000);
    p.profiles[0][moment * kBins + 5] = 30.0 * kMmHg;
    const auto map = pressure_map_json(p);
    ASSERT_EQ(map["time"].size(), kMapColumns);
    const auto& pressure = map["blades"][0]["pressure"];
    ASSERT_EQ(pressure.size(), kMapColumns * kBins);
    const std::size_t column = moment / 60;
    EXPECT_EQ(map["time"][column], p.time[60 * column]);
    for (std::size_t k = 0; k < pressure.size(); ++k) EXPECT_EQ(pressure[k], k == column * kBins + 5 ? 30.0 : 0.0) << k;
  }
}

TEST(PressureMap, ThinsOnlyWhatIsTooLong) {
  EXPECT_EQ(pressure_map_json(report(kMapColumns))["time"].size(), kMapColumns);
  EXPECT_EQ(pressure_map_json(report(kMapColumns + 1))["time"].size(), kMapColumns / 2 + 1) << "every other, and what is left over";
  EXPECT_TRUE(pressure_map_json(report(0))["time"].empty());
}

TEST(PressureMap, SpeaksTheUnitsOfThePageInTenths) {
  PressureReport p = report(1);
  p.place_peak = {12.34 * kMmHg, std::numeric_limits<double>::infinity()};
  p.place_dose = {60.0 * 7.06 * kMmHg, std::numeric_limits<double>::quiet_NaN()};
  p.limits.dose_bands[2] = 60.0 * 250.0 * kMmHg;
  p.rest.resize(3, 2);
  p.rest << 1e-3, 4e-3, -2.26e-3, 5e-3, 3e-3, 6e-3;
  p.triangles = {{0, 1, 0}, {1, 0, 1}};
  const auto map = pressure_map_json(p);
  EXPECT_EQ(map["peak"], nlohmann::ordered_json({12.3, 0.0})) << "what is no number cannot be drawn";
  EXPECT_EQ(map["dose"], nlohmann::ordered_json({7.1, 0.0}));
  EXPECT_EQ(map["dose_red"], 250.0);
  EXPECT_EQ(map["rest"], nlohmann::ordered_json({1.0, -2.3, 3.0, 4.0, 5.0, 6.0})) << "vertex by vertex";
  EXPECT_EQ(map["triangles"], nlohmann::ordered_json({0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(map["bins"], kProfileBins);
  EXPECT_EQ(map["bin_mm"], 1e3 * kProfileBin);
}

/// A scene of two blades of which one was not there, or whose profile is of other moments.
TEST(PressureMap, LeavesOutABladeWithoutItsProfile) {
  PressureReport p = report(3);
  p.blade_names = {"left", "right"};
  EXPECT_EQ(pressure_map_json(p)["blades"].size(), 1u);
  p.profiles[1].assign(3 * kBins, kMmHg);
  const auto both = pressure_map_json(p);
  ASSERT_EQ(both["blades"].size(), 2u);
  EXPECT_EQ(both["blades"][1]["name"], "right");
  EXPECT_EQ(both["blades"][1]["pressure"][0], 1.0);
  p.profiles[0].pop_back();
  EXPECT_EQ(pressure_map_json(p)["blades"][0]["name"], "right");
}

}  // namespace pressure_map_test
}  // namespace filum
