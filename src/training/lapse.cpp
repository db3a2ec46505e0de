#include "training/lapse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace filum {
namespace {

Stitch from_passes(const TissueObservation& t, int a, int b, const Vec3& along) {
  const PassObservation& p = t.passes[static_cast<std::size_t>(a)];
  const PassObservation& q = t.passes[static_cast<std::size_t>(b < 0 ? a : b)];
  Stitch s;
  s.first = a;
  s.second = b;
  const bool whole = b >= 0 || p.bite_exit * p.bite_entry < 0.0;  // both sides in one pass: the cut lies between
  s.bite[0] = std::abs(p.bite_entry);
  s.bite[1] = whole ? std::abs(q.bite_exit) : std::numeric_limits<double>::quiet_NaN();
  s.entry_angle = p.entry_angle;
  s.exit_angle = q.exit_angle;
  const Vec3 span = q.exit_rest - p.entry_rest;
  const Vec3 flat(span.x(), span.y(), 0.0);
  const double lengthwise = std::abs(flat.dot(along)), across = std::sqrt(std::max(0.0, flat.squaredNorm() - lengthwise * lengthwise));
  s.obliquity = std::atan2(lengthwise, across);
  s.depth = std::min(p.depth_share, q.depth_share);
  s.position = 0.5 * (p.entry_rest + q.exit_rest).dot(along);
  s.tension = std::max(p.tension, q.tension);
  s.peak_force = std::max(p.peak_force, q.peak_force);
  s.torn = std::max(p.torn, q.torn);
  return s;
}

}  // namespace

LapseRules load_lapse_rules(const std::string& path) {
  const YamlNode file = YamlNode::load(path);
  if (file.text("format") != "filum-lapses/1") file.refuse("format", "filum-lapses/1");
  LapseRules r;
  r.title = file.text("title");
  r.source = file.text("source");
  r.oblique = file.quantity("oblique", "deg", Range::positive());
  r.wide_bite = file.number("wide_bite_thicknesses", Range::positive());
  r.least_depth = file.number("least_depth_share", Range::between(0.0, 1.0));
  r.spacing_variation = file.number("spacing_variation", Range::positive());
  r.spacing_ratio = file.number("spacing_ratio", {1.0, 100.0});
  r.tear = file.quantity("tear", "um", Range::positive());
  file.finish();
  return r;
}

std::vector<Stitch> stitches_of(const TissueObservation& t, const std::vector<double>& pass_time, const Vec3& along) {
  std::vector<Stitch> stitches;
  for (int k = 0; k < t.n_passes; ++k) {
    const PassObservation& p = t.passes[static_cast<std::size_t>(k)];
    if (!p.out) continue;
    const bool pairs = k + 1 < t.n_passes && t.passes[static_cast<std::size_t>(k + 1)].out && t.passes[static_cast<std::size_t>(k + 1)].side != p.side;
    const bool both = p.bite_entry * p.bite_exit < 0.0;
    stitches.push_back(from_passes(t, k, !both && pairs ? k + 1 : -1, along));
    if (!both && pairs) ++k;
    if (static_cast<std::size_t>(k) < pass_time.size()) stitches.back().time = pass_time[static_cast<std::size_t>(k)];
  }
  return stitches;
}

std::vector<double> spacings_of(const std::vector<Stitch>& stitches) {
  std::vector<double> at, gaps;
  for (const Stitch& s : stitches) at.push_back(s.position);
  std::sort(at.begin(), at.end());
  for (std::size_t k = 1; k < at.size(); ++k) gaps.push_back(at[k] - at[k - 1]);
  return gaps;
}

std::vector<Lapse> lapses_of(const LapseRules& rules, const std::vector<Stitch>& stitches, double thickness) {
  std::vector<Lapse> found;
  for (std::size_t k = 0; k < stitches.size(); ++k) {
    const Stitch& s = stitches[k];
    const int i = static_cast<int>(k);
    const double widest = std::isnan(s.bite[1]) ? s.bite[0] : std::max(s.bite[0], s.bite[1]);
    if (s.obliquity > rules.oblique) found.push_back({"oblique", i, s.time, s.obliquity * 180.0 / std::numbers::pi, "deg"});
    if (widest > rules.wide_bite * thickness) found.push_back({"wide-bite", i, s.time, widest / thickness, "thicknesses"});
    if (s.depth < rules.least_depth - 1e-6) found.push_back({"partial-thickness", i, s.time, s.depth, "share"});
    if (s.torn > rules.tear) found.push_back({"wall-tear", i, s.time, s.torn, "m"});
  }
  const std::vector<double> gaps = spacings_of(stitches);
  if (gaps.size() < 2) return found;
  double mean = 0.0, square = 0.0;
  for (const double g : gaps) mean += g / static_cast<double>(gaps.size());
  for (const double g : gaps) square += (g - mean) * (g - mean) / static_cast<double>(gaps.size());
  const double variation = std::sqrt(square) / mean, ratio = *std::max_element(gaps.begin(), gaps.end()) / *std::min_element(gaps.begin(), gaps.end());
  if (variation > rules.spacing_variation || ratio > rules.spacing_ratio) found.push_back({"unequal-spacing", -1, stitches.back().time, variation, "-"});
  return found;
}

}  // namespace filum
