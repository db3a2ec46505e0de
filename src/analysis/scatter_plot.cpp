#include "analysis/scatter_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace filum {
namespace {

constexpr double kSide = 260.0, kMargin = 64.0;  // [px]
// Okabe & Ito: told apart with any colour vision.
constexpr std::array<const char*, 7> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#000000"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string px(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  double share(double v) const { return high > low ? (v - low) / (high - low) : 0.5; }
};

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" text-anchor=\"" + anchor + "\">" + escaped(text) +
         "</text>\n";
}

std::string caption(const Correlation& c, const std::string& where) {
  if (!c.why.empty()) return where + ": " + c.why;
  return where + ": r = " + number(c.r) + " [" + number(c.low) + ", " + number(c.high) + "], n = " + std::to_string(c.n);
}

std::string panel_svg(const ScatterPanel& panel, double left) {
  Axis x, y;
  for (const PairGroup& g : panel.groups) {
    for (double v : g.x) x.take(v);
    for (double v : g.y) y.take(v);
  }
  const double top = kMargin, bottom = kMargin + kSide;
  std::string svg = "<rect x=\"" + px(left) + "\" y=\"" + px(top) + "\" width=\"" + px(kSide) + "\" height=\"" +
                    px(kSide) + "\" fill=\"none\" stroke=\"#888\"/>\n";
  for (std::size_t i = 0; i < panel.groups.size(); ++i) {
    const PairGroup& g = panel.groups[i];
    for (std::size_t k = 0; k < g.x.size(); ++k) {
      svg += "<circle cx=\"" + px(left + kSide * x.share(g.x[k])) + "\" cy=\"" +
             px(bottom - kSide * y.share(g.y[k])) + "\" r=\"3\" fill=\"" + kColours[i % kColours.size()] + "\"/>\n";
    }
  }
  svg += text_at(left + 0.5 * kSide, bottom + 34, "middle", panel.x_label);
  svg += text_at(left + 0.5 * kSide, top - 34, "middle", panel.y_label + " (upwards)");
  svg += text_at(left + 0.5 * kSide, top - 20, "middle", caption(panel.within, "within"));
  svg += text_at(left + 0.5 * kSide, top - 6, "middle", caption(panel.across, "across"));
  if (x.high >= x.low) {
    svg += text_at(left, bottom + 16, "middle", number(x.low)) + text_at(left + kSide, bottom + 16, "middle", number(x.high));
    svg += text_at(left - 4, bottom, "end", number(y.low)) + text_at(left - 4, top + 10, "end", number(y.high));
  }
  return svg;
}

}  // namespace

std::string scatter_svg(const std::vector<ScatterPanel>& panels, const std::vector<std::string>& group_names) {
  const double width = static_cast<double>(panels.size()) * (kSide + 2.0 * kMargin);
  const double height = kSide + 2.0 * kMargin + 16.0 * static_cast<double>(group_names.size());
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + px(width) + "\" height=\"" + px(height) +
                    "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (std::size_t i = 0; i < panels.size(); ++i)
    svg += panel_svg(panels[i], kMargin + static_cast<double>(i) * (kSide + 2.0 * kMargin));
  for (std::size_t i = 0; i < group_names.size(); ++i) {
    const double y = kSide + 2.0 * kMargin + 16.0 * static_cast<double>(i);
    svg += "<circle cx=\"" + px(kMargin) + "\" cy=\"" + px(y - 4) + "\" r=\"4\" fill=\"" +
           kColours[i % kColours.size()] + "\"/>\n" + text_at(kMargin + 10, y, "start", group_names[i]);
  }
  return svg + "</svg>\n";
}

}  // namespace filum
