#include "analysis/scatter_plot.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace filum {
namespace {

TEST(ScatterPlot, DrawsOneDotAPairAndKeepsNamesOutOfTheMarkup) {
  ScatterPanel panel{"x [N]", "y [m]", {{{1, 2, 3}, {3, 2, 1}}, {{5}, {6}}}, {}, {}};
  panel.within.why = panel.across.why = "fewer than 4 pairs";
  const std::string svg = scatter_svg({panel, panel}, {"a<b>.rec", "c&d.rec"});
  std::size_t dots = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++dots;
  EXPECT_EQ(dots, 2u * 4u + 2u);  // pairs and the legend
  EXPECT_NE(svg.find("a&lt;b&gt;.rec"), std::string::npos);
  EXPECT_NE(svg.find("c&amp;d.rec"), std::string::npos);
  EXPECT_NE(svg.find("fewer than 4 pairs"), std::string::npos);
  EXPECT_EQ(svg.rfind("</svg>\n"), svg.size() - 7);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(ScatterPlot, AnEmptyPanelIsAFrame) {
  ScatterPanel panel{"x", "y", {}, {}, {}};
  EXPECT_NE(scatter_svg({panel}, {}).find("<rect"), std::string::npos);
}

}  // namespace
}  // namespace filum
