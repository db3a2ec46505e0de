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

}  // namespace result_json_test
}  // namespace filum
