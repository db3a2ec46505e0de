#include "analysis/scatter_plot.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace filum {
namespace scatter_plot_test {

TEST(ScatterPlot, DrawsOneDotAPairAndKeepsNamesOutOfTheMarkup) {
  ScatterPanel panel{"x [N]", "y [m]", {{{1, 2, 3}, {3, 2, 1}}, {{5}, {6}}}, {}, {}};
  panel.within.why = panel.across.why = "fewer than 4 pairs";
  const std::string svg = scatter_svg({panel, panel}, {"a<b>.rec", "c&d.rec"});
  std::size_t dots = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++dots;
  EXPECT_EQ(dots, 2u * 4u + 2u);  // pairs and the legend; means are rings
  EXPECT_NE(svg.find("a&lt;b&gt;.rec"), std::string::npos);
  EXPECT_NE(svg.find("c&amp;d.rec"), std::string::npos);
  EXPECT_NE(svg.find("fewer than 4 pairs"), std::string::npos);
  EXPECT_EQ(svg.rfind("</svg>\n"), svg.size() - 7);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(ScatterPlot, LinesAreThoseOfTheCorrelationInTheUnitsShown) {
  // Two sessions with slope 2 within; their means (1, 5) and (3, 1) fall with slope -2.
  ScatterPanel panel{"x [mN]", "y [um]", {{{0.0, 2.0}, {3.0, 7.0}}, {{2.0, 4.0}, {-1.0, 3.0}}}, {}, {}, 1e3, 1e6};
  panel.within.slope = 2.0;
  panel.across.slope = -2.0;
  const std::string svg = scatter_svg({panel}, {"a", "b"});
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = svg.find("<path clip-path", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 3u);
  // x from 0 to 4000 mN is drawn over 260 px with 6 % room at each end; y from -1e6 to 7e6 um likewise.
  const auto px = [](double x) { return 70.0 + 260.0 * (x / 4.0 + 0.06) / 1.12; };
  const auto py = [](double y) { return 74.0 + 260.0 * (1.0 - ((y + 1.0) / 8.0 + 0.06) / 1.12); };
  char text[80];
  std::snprintf(text, sizeof text, "M%.1f %.1fL%.1f %.1f\" stroke=\"#000\"", px(1), py(5), px(3), py(1));
  EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_NE(svg.find(">1e+03<"), std::string::npos) << "a round tick";
}

TEST(ScatterPlot, AnEmptyPanelIsAFrame) {
  ScatterPanel panel{"x", "y", {}, {}, {}};
  EXPECT_NE(scatter_svg({panel}, {}).find("<rect"), std::string::npos);
}

}  // namespace scatter_plot_test
}  // namespace filum
