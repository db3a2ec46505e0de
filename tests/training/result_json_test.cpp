#include "training/result_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace filum {
namespace result_json_test {

/// Way from each stitch to the next [mm], as the result tells it; below zero: null.
std::vector<double> next_mm(const std::vector<double>& positions, double around) {
  Result r;
  r.needle.emplace();
  r.needle->has_tissue = true;
  r.needle->thickness = 0.1e-3;
  for (const double p : positions) {
    Stitch s;
    s.position = p;
    s.around = around;
    r.needle->stitches.push_back(s);
  }
  std::vector<double> next;
  const auto json = nlohmann::json::parse(result_json(r));
  for (const auto& s : json["stitches"]) next.push_back(s["spacing_m"].is_null() ? -1.0 : 1e3 * s["spacing_m"].get<double>());
  return next;
}

void expect_near(const std::vector<double>& got, const std::vector<double>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t k = 0; k < got.size(); ++k) EXPECT_NEAR(got[k], wanted[k], 1e-9) << k;
}

TEST(ResultJson, EachStitchTellsTheWayToTheNextAlongTheCut) {
  expect_near(next_mm({0.8e-3, -0.2e-3, 0.3e-3}, 0.0), {-1.0, 0.5, 0.5});
  expect_near(next_mm({0.8e-3, -0.2e-3, 0.3e-3}, 3e-3), {2.0, 0.5, 0.5});  // round a vessel the last one's is the first
  expect_near(next_mm({0.8e-3}, 3e-3), {-1.0});
  expect_near(next_mm({}, 3e-3), {});
}

TEST(ResultJson, AStitchTellsItsLayersAndInnerBites) {
  Result r;
  r.needle.emplace();
  r.needle->has_tissue = true;
  r.needle->thickness = 0.1e-3;
  Stitch s;
  s.layers = {"adventitia", "media"};
  s.inner[0] = 0.2e-3;
  r.needle->stitches.push_back(s);
  const auto stitch = nlohmann::json::parse(result_json(r))["stitches"][0];
  EXPECT_EQ(stitch["depth_layers"], nlohmann::json({"adventitia", "media"}));
  EXPECT_EQ(stitch["bites_inner_m"], nlohmann::json({0.2e-3, nullptr}));
}

}  // namespace result_json_test
}  // namespace filum
