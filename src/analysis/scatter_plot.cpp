#include "analysis/scatter_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/markup.h"

namespace filum {
namespace {

constexpr double kSide = 260.0, kLeft = 70.0, kTop = 74.0, kRight = 24.0, kBottom = 52.0, kLine = 16.0;  // [px]
constexpr std::size_t kMostNames = 14;
// Okabe & Ito: told apart with any colour vision.
constexpr std::array<const char*, 7> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#000000"};

std::string coordinate(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string px(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

/// One axis of a panel: values to pixels, with round ticks.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity(), step = 1.0;
  bool empty() const { return !(high >= low); }
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  /// Room on both sides, and ticks at 1, 2 or 5 times a power of ten.
  void round() {
    if (empty()) return;
    const double room = high > low ? 0.06 * (high - low) : std::max(1e-9, 0.5 * std::abs(high));
    low -= room;
    high += room;
    const double wish = (high - low) / 5.0, power = std::pow(10.0, std::floor(std::log10(wish)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0})
      if ((step = factor * power) >= wish) break;
  }
  double share(double v) const { return (v - low) / (high - low); }
  std::vector<double> ticks() const {
    std::vector<double> at;
    for (double k = std::ceil(low / step); k * step <= high; ++k) at.push_back(k * step);
    return at;
  }
};

std::string text_at(double x, double y, const std::string& anchor, const std::string& text, const std::string& more = "") {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" + escaped(text) + "</text>\n";
}

std::string caption(const Correlation& c, const std::string& where) {
  if (!c.why.empty()) return where + ": " + c.why;
  return where + ": r = " + coordinate(c.r) + " [" + coordinate(c.low) + ", " + coordinate(c.high) + "], n = " + std::to_string(c.n);
}

std::string without_unit(const std::string& label) { return label.substr(0, label.find(" [")); }

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// What is drawn of one panel: frame, ticks, lines, dots.
class Panel {
 public:
  Panel(const ScatterPanel& panel, double left) : panel_(panel), left_(left) {
    for (const PairGroup& g : panel.groups) {
      for (const double v : g.x) x_.take(panel.x_scale * v);
      for (const double v : g.y) y_.take(panel.y_scale * v);
    }
    x_.round();
    y_.round();
  }

  std::string svg() const {
    std::string out = "<rect x=\"" + px(left_) + "\" y=\"" + px(kTop) + "\" width=\"" + px(kSide) + "\" height=\"" + px(kSide) + "\" fill=\"none\" stroke=\"#888\"/>\n";
    out += text_at(left_ + 0.5 * kSide, kTop - 46, "middle", without_unit(panel_.y_label) + " over " + without_unit(panel_.x_label), " font-weight=\"bold\"");
    out += text_at(left_ + 0.5 * kSide, kTop - 28, "middle", caption(panel_.within, "within sessions"));
    out += text_at(left_ + 0.5 * kSide, kTop - 12, "middle", caption(panel_.across, "across sessions"));
    out += text_at(left_ + 0.5 * kSide, kTop + kSide + 36, "middle", panel_.x_label);
    const double up = left_ - 50, middle = kTop + 0.5 * kSide;
    out += text_at(up, middle, "middle", panel_.y_label, " transform=\"rotate(-90 " + px(up) + " " + px(middle) + ")\"");
    if (x_.empty()) return out + text_at(left_ + 0.5 * kSide, middle, "middle", "no pairs");
    return out + ticks() + lines() + dots();
  }

 private:
  double across(double x) const { return left_ + kSide * x_.share(panel_.x_scale * x); }
  double down(double y) const { return kTop + kSide * (1.0 - y_.share(panel_.y_scale * y)); }

  std::string ticks() const {
    std::string out;
    const auto line = [&](double x0, double y0, double x1, double y1) {
      out += "<path d=\"M" + px(x0) + " " + px(y0) + "L" + px(x1) + " " + px(y1) + "\" stroke=\"#888\"/>\n";
    };
    for (const double t : x_.ticks()) {
      const double at = left_ + kSide * x_.share(t);
      line(at, kTop + kSide, at, kTop + kSide + 4);
      out += text_at(at, kTop + kSide + 17, "middle", coordinate(std::abs(t) < 1e-9 * x_.step ? 0.0 : t));
    }
    for (const double t : y_.ticks()) {
      const double at = kTop + kSide * (1.0 - y_.share(t));
      line(left_ - 4, at, left_, at);
      out += text_at(left_ - 7, at + 4, "end", coordinate(std::abs(t) < 1e-9 * y_.step ? 0.0 : t));
    }
    return out;
  }

  /// A line of `slope` through a point, from x0 to x1, in the data's own units; cut off by the frame.
  std::string line(double slope, double x, double y, double x0, double x1, const std::string& style) const {
    return "<path clip-path=\"url(#" + clip() + ")\" d=\"M" + px(across(x0)) + " " + px(down(y + slope * (x0 - x))) + "L" + px(across(x1)) + " " +
           px(down(y + slope * (x1 - x))) + "\" " + style + "/>\n";
  }

  std::string lines() const {
    std::string out = "<clipPath id=\"" + clip() + "\"><rect x=\"" + px(left_) + "\" y=\"" + px(kTop) + "\" width=\"" + px(kSide) + "\" height=\"" + px(kSide) + "\"/></clipPath>\n";
    std::vector<double> mx, my;
    for (std::size_t i = 0; i < panel_.groups.size(); ++i) {
      const PairGroup& g = panel_.groups[i];
      if (g.x.empty()) continue;
      mx.push_back(mean(g.x));
      my.push_back(mean(g.y));
      if (g.x.size() < 2 || !panel_.within.why.empty()) continue;
      const auto [low, high] = std::minmax_element(g.x.begin(), g.x.end());
      out += line(panel_.within.slope, mx.back(), my.back(), *low, *high, "stroke=\"" + std::string(colour(i)) + "\" stroke-width=\"1\"");
    }
    if (!panel_.across.why.empty() || mx.empty()) return out;
    const auto [low, high] = std::minmax_element(mx.begin(), mx.end());
    return out + line(panel_.across.slope, mean(mx), mean(my), *low, *high, "stroke=\"#000\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"");
  }

  std::string dots() const {
    std::string out;
    for (std::size_t i = 0; i < panel_.groups.size(); ++i) {
      const PairGroup& g = panel_.groups[i];
      for (std::size_t k = 0; k < g.x.size(); ++k)
        out += "<circle cx=\"" + px(across(g.x[k])) + "\" cy=\"" + px(down(g.y[k])) + "\" r=\"2.2\" fill-opacity=\"0.55\" fill=\"" + colour(i) + "\"/>\n";
      if (!g.x.empty())
        out += "<path d=\"M" + px(across(mean(g.x)) - 5) + " " + px(down(mean(g.y))) + "a5 5 0 1 0 10 0a5 5 0 1 0 -10 0\" fill=\"#fff\" stroke-width=\"2\" stroke=\"" + colour(i) + "\"/>\n";
    }
    return out;
  }

  std::string clip() const { return "frame" + px(left_); }
  static const char* colour(std::size_t i) { return kColours[i % kColours.size()]; }

  const ScatterPanel& panel_;
  double left_;
  Axis x_, y_;
};

}  // namespace

std::string scatter_svg(const std::vector<ScatterPanel>& panels, const std::vector<std::string>& group_names) {
  const bool named = group_names.size() <= kMostNames;
  const double each = kLeft + kSide + kRight, names_at = kTop + kSide + kBottom;
  const double width = std::max(1.0, static_cast<double>(panels.size())) * each, height = names_at + (named ? kLine * static_cast<double>(group_names.size()) : 0.0) + 4.0;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + px(width) + " " + px(height) + "\" width=\"" + px(width) + "\" height=\"" + px(height) +
                    "\" style=\"max-width:100%;height:auto\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (std::size_t i = 0; i < panels.size(); ++i) svg += Panel(panels[i], kLeft + static_cast<double>(i) * each).svg();
  for (std::size_t i = 0; named && i < group_names.size(); ++i) {
    const double y = names_at + kLine * static_cast<double>(i);
    svg += "<circle cx=\"" + px(kLeft) + "\" cy=\"" + px(y - 4) + "\" r=\"4\" fill=\"" +
           kColours[i % kColours.size()] + "\"/>\n" + text_at(kLeft + 10, y, "start", group_names[i]);
  }
  return svg + "</svg>\n";
}

}  // namespace filum
