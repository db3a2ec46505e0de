#include "training/result_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace filum {
namespace result_json_test {

TEST(ResultJson, AStitchTellsItsLayersInnerBitesAndTheWayToTheNext) {
  Result r;
  r.needle.emplace();
  r.needle->has_tissue = true;
  r.needle->thickness = 0.1e-3;
  Stitch s;
  s.layers = {"adventitia", "media"};
  s.inner[0] = 0.2e-3;
  s.next = 0.4e-3;
  r.needle->stitches.push_back(s);
  r.needle->stitches.emplace_back();
  const auto stitches = nlohmann::json::parse(result_json(r))["stitches"], stitch = stitches[0];
  EXPECT_EQ(stitch["depth_layers"], nlohmann::json({"adventitia", "media"}));
  EXPECT_EQ(stitch["bites_inner_m"], nlohmann::json({0.2e-3, nullptr}));
  EXPECT_EQ(stitch["spacing_m"], 0.4e-3);
  EXPECT_TRUE(stitches[1]["spacing_m"].is_null());
}

/// Flow on beyond the join is that of the join as it is, with its leak, and is named so.
TEST(ResultJson, AJoinTellsItsLeakAndWhatGoesOnThroughIt) {
  Result r;
  r.needle.emplace();
  r.needle->has_tissue = true;
  r.needle->join = JoinReport{};
  r.needle->join->leak = 2e-6 / 60.0;
  r.needle->join->through = 9e-6 / 60.0;
  const auto leak = nlohmann::json::parse(result_json(r))["leak"];
  EXPECT_NEAR(leak["total_ml_per_min"].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(leak["through_ml_per_min"].get<double>(), 9.0, 1e-9);
  EXPECT_FALSE(leak.contains("flow_if_tight_ml_per_min"));
}

}  // namespace result_json_test
}  // namespace filum
