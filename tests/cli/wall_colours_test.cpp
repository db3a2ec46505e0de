#include "cli/wall_colours.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace wall_colours_test {

TEST(WallColours, ShowsWhatWasAskedForAndNothingElse) {
  const auto model = load_model(FILUM_SOURCE_DIR, "vessel-stitch");
  WallColours colours(model);
  Observation o;
  o.tissue.n = model->vessel->mesh.n_nodes();
  o.tissue.positions = model->description.tissue.rest;
  EXPECT_TRUE(colours.view(o).kind.empty()) << "nothing until asked";
  colours.choose("strain");
  const OverlayView rest = colours.view(o);
  ASSERT_NE(rest.values, nullptr);
  ASSERT_EQ(rest.values->size(), static_cast<std::size_t>(o.tissue.n));
  EXPECT_LT(*std::max_element(rest.values->begin(), rest.values->end()), 1e-9) << "the scene as it begins has none";
  o.tissue.positions *= 1.1;
  const OverlayView stretched = colours.view(o);
  EXPECT_NEAR(stretched.factor * (*stretched.values)[7], 10.0, 1e-6);
  EXPECT_EQ(stretched.unit, "%");
  colours.choose("pressure");
  EXPECT_EQ(colours.view(o).kind, "pressure");
  colours.choose("none");
  EXPECT_TRUE(colours.view(o).kind.empty());
  o.tissue.n = 0;
  colours.choose("strain");
  EXPECT_TRUE(colours.view(o).kind.empty()) << "a scene without tissue";
}

}  // namespace wall_colours_test
}  // namespace filum
