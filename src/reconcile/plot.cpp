#include "reconcile/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/markup.h"

namespace filum::reconcile {
namespace {

constexpr int kMost = 500;  // points of one curve that are drawn

std::string coordinate(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", std::abs(v) < 1e-300 ? 0.0 : v);
  return text;
}

struct Frame {
  double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
  int width, height;
  double px(double x) const { return 58 + (x - x0) / (x1 - x0) * (width - 70); }
  double py(double y) const { return height - 36 - (y - y0) / (y1 - y0) * (height - 62); }
};

/// About four round values within [low, high], steps of 1, 2 or 5.
std::vector<double> ticks(double low, double high) {
  const double rough = (high - low) / 4.0, decade = std::pow(10.0, std::floor(std::log10(rough))), part = rough / decade;
  const double step = decade * (part < 1.5 ? 1.0 : part < 3.5 ? 2.0 : part < 7.5 ? 5.0 : 10.0);
  std::vector<double> out;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0) out.push_back(std::abs(k) < 0.5 ? 0.0 : k * step);
  return out;
}

void widen(double& low, double& high) {
  if (!(low < high)) low -= 0.5 * (std::abs(low) + 1e-12), high += 0.5 * (std::abs(high) + 1e-12);
}

std::string curve(const Curve& c, const Frame& f) {
  std::string out, points;
  const Eigen::Index step = std::max<Eigen::Index>(1, c.x.size() / kMost);
  char text[64];
  for (Eigen::Index i = 0; i < c.x.size(); i += step) {
    if (!std::isfinite(c.y[i])) continue;
    if (c.dots) {
      std::snprintf(text, sizeof text, "M%.1f %.1fh.1", f.px(c.x[i]), f.py(c.y[i]));
      points += text;
    } else {
      std::snprintf(text, sizeof text, "%s%.1f %.1f", points.empty() ? "M" : "L", f.px(c.x[i]), f.py(c.y[i]));
      points += text;
    }
  }
  if (c.low.size() > 0) {
    for (Eigen::Index i = (c.x.size() - 1) / step * step; i >= 0; i -= step) {
      if (!std::isfinite(c.low[i])) continue;
      std::snprintf(text, sizeof text, "L%.1f %.1f", f.px(c.x[i]), f.py(c.low[i]));
      points += text;
    }
    return "<path d='" + points + "Z' fill='" + c.colour + "' stroke='none'/>";
  }
  return "<path d='" + points + "' fill='none' stroke='" + c.colour + "' stroke-width='" + (c.dots ? "2.2" : "1.4") + "' stroke-linecap='round'/>";
}

}  // namespace

std::string plot(const PlotText& text, const std::vector<Curve>& curves, int width, int height) {
  Frame f;
  f.width = width;
  f.height = height;
  for (const Curve& c : curves)
    for (Eigen::Index i = 0; i < c.x.size(); ++i)
      if (std::isfinite(c.y[i])) f.x0 = std::min(f.x0, c.x[i]), f.x1 = std::max(f.x1, c.x[i]), f.y0 = std::min(f.y0, c.y[i]), f.y1 = std::max(f.y1, c.y[i]);
  for (const Curve& c : curves)
    for (const double low : c.low)
      if (std::isfinite(low)) f.y0 = std::min(f.y0, low);
  if (!std::isfinite(f.x0)) return "";
  widen(f.x0, f.x1);
  widen(f.y0, f.y1);
  std::string out = "<svg viewBox='0 0 " + std::to_string(width) + " " + std::to_string(height) + "' width='" + std::to_string(width) + "' role='img'>";
  const auto label = [&](double x, double y, const std::string& s, const char* anchor) {
    out += "<text x='" + coordinate(x) + "' y='" + coordinate(y) + "' text-anchor='" + anchor + "'>" + escaped(s) + "</text>";
  };
  out += "<rect x='58' y='26' width='" + std::to_string(width - 70) + "' height='" + std::to_string(height - 62) + "' fill='none' stroke='#999'/>";
  label(58, 16, text.title, "start");
  const auto mark = [&](double x0, double y0, double x1, double y1) {
    char line[120];
    std::snprintf(line, sizeof line, "<path d='M%.1f %.1fL%.1f %.1f' stroke='#999'/>", x0, y0, x1, y1);
    out += line;
  };
  for (const double x : ticks(f.x0, f.x1)) mark(f.px(x), height - 36, f.px(x), height - 32), label(f.px(x), height - 20, coordinate(x), "middle");
  for (const double y : ticks(f.y0, f.y1)) mark(54, f.py(y), 58, f.py(y)), label(52, f.py(y) + 4, coordinate(y), "end");
  label(0.5 * (58 + width), height - 6, text.x, "middle");
  out += "<text transform='rotate(-90)' x='" + std::to_string(-height / 2) + "' y='12' text-anchor='middle'>" + escaped(text.y) + "</text>";
  for (const Curve& c : curves) out += curve(c, f);
  return out + "</svg>";
}

std::string heat_map(const std::vector<std::string>& rows, const std::vector<std::vector<double>>& cells, double most) {
  const int h = 16, left = 200, w = 560;
  std::string out = "<svg viewBox='0 0 " + std::to_string(left + w) + " " + std::to_string(h * static_cast<int>(rows.size())) + "' width='" + std::to_string(left + w) + "'>";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const int y = static_cast<int>(r) * h;
    out += "<text x='" + std::to_string(left - 6) + "' y='" + std::to_string(y + 12) + "' text-anchor='end'>" + escaped(rows[r]) + "</text>";
    const double step = static_cast<double>(w) / static_cast<double>(std::max<std::size_t>(1, cells[r].size()));
    for (std::size_t k = 0; k < cells[r].size(); ++k) {
      const int shade = 255 - static_cast<int>(220 * std::clamp(cells[r][k] / most, 0.0, 1.0));
      char text[160];
      std::snprintf(text, sizeof text, "<rect x='%.1f' y='%d' width='%.1f' height='%d' fill='rgb(%d,%d,%d)'/>", left + step * static_cast<double>(k), y, step + 0.3, h - 1, 255 - (255 - shade) / 3, shade, shade);
      out += text;
    }
  }
  return out + "</svg>";
}

}  // namespace filum::reconcile
