#include "training/rating_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/numbers.h"

namespace filum {
namespace {

/// The ten of the Anastomosis Lapse Index; a loose knot is none of them.
const std::vector<std::string> kIndexLapses = {"disrupted-line", "back-wall", "oblique", "wide-bite", "partial-thickness",
                                               "unequal-spacing", "wall-tear", "too-tight", "thread-in-lumen", "edge-overlap"};

bool is_lapse(const std::string& measure) { return std::find(kIndexLapses.begin(), kIndexLapses.end(), measure) != kIndexLapses.end(); }

std::vector<std::string> measures() {
  std::vector<std::string> all = {"leak", "back-walls", "spacing-variation", "bite-widest", "bite-narrowest", "bite-inequality",
                                  "lapses", "knots-secure", "slack-most", "tail-longest", "tail-shortest"};
  all.insert(all.end(), kIndexLapses.begin(), kIndexLapses.end());
  return all;
}

Range range_of(const YamlNode& node, const std::string& key) {
  const std::vector<double> ends = node.quantities(key, "-");
  if (ends.size() != 2 || !(ends[0] <= ends[1])) node.refuse(key, "two numbers, from and to");
  return Range::between(ends[0], ends[1]);
}

ScaleCriterion criterion_of(const YamlNode& node, int most) {
  constexpr std::array<const char*, 5> kKeys = {"one", "two", "three", "four", "five"};
  ScaleCriterion c;
  c.measure = node.choice("measure", measures());
  c.title = node.text("title");
  c.unit = node.text_or("unit", "-");
  c.source = node.text("source");
  for (int k = 0; k < most; ++k) {
    const std::string key = kKeys[static_cast<std::size_t>(k)];
    c.points.push_back(range_of(node, key));
    if (k > 0 && (c.points[static_cast<std::size_t>(k)].low < c.points[static_cast<std::size_t>(k - 1)].low || c.points[static_cast<std::size_t>(k)].high > c.points[static_cast<std::size_t>(k - 1)].high))
      node.refuse(key, "a range within that of fewer points");
  }
  return c;
}

ScaleItem item_of(const YamlNode& node, int most) {
  ScaleItem item;
  item.name = node.text("name");
  item.title = node.text("title");
  item.words = node.texts("points");
  if (static_cast<int>(item.words.size()) != most + 1) node.refuse("points", "what 0 to " + std::to_string(most) + " points mean");
  for (const YamlNode& one : node.items_or_none("criteria")) item.criteria.push_back(criterion_of(one, most));
  item.rater = node.text_or("rater", "");
  if (item.criteria.empty() == item.rater.empty()) node.refuse("rater", "either criteria, or why it is left to the rater");
  return item;
}

/// The most (or least) over the stitches that join both sides; NaN if it is not known of one.
template <class Value>
double over_stitches(const NeedleReport& r, bool most, Value value) {
  double found = kNaN;
  for (const Stitch& s : r.stitches) {
    if (!s.joins) continue;
    const double v = value(s);
    if (std::isnan(v)) return v;
    found = most ? std::fmax(found, v) : std::fmin(found, v);
  }
  return found;
}

/// As the lapse has it: of every bite that holds, a lone one as well.
double widest_bite(const NeedleReport& r) {
  double found = kNaN;
  for (const Stitch& s : r.stitches)
    if (!s.lost) found = std::fmax(found, std::fmax(s.bite[0], s.bite[1]));
  return found;
}

/// Share of the stitches that are tied with a knot that holds in nylon: square, surgeon's, three throws.
double secure_share(const NeedleReport& r) {
  double whole = 0.0, tied = 0.0;
  for (const Stitch& s : r.stitches) {
    if (!s.joins) continue;
    whole += 1.0;
    tied += s.knot == "square" || s.knot == "surgeons" || s.knot == "triple" ? 1.0 : 0.0;
  }
  return whole > 0.0 ? tied / whole : kNaN;
}

/// Whether a report without this lapse says that it is absent.
bool looked_for(const std::string& lapse, const NeedleReport& r) {
  if (lapse == "disrupted-line") return r.line_tested;
  if (lapse == "thread-in-lumen" || lapse == "edge-overlap") return r.join && r.join->sound;
  if (lapse == "unequal-spacing") return r.spacings.size() > 1;
  return !r.stitches.empty();
}

double lapse_count(const std::string& lapse, const NeedleReport& r) {
  const double count = count_of(r.lapses, lapse);
  return count > 0.0 || looked_for(lapse, r) ? count : kNaN;
}

int points_of(const ScaleCriterion& c, double value) {
  int points = 0;
  for (const Range& range : c.points) points += range.contains(value) ? 1 : 0;
  return points;
}

std::string reason(const ScaleCriterion& c, double value) {
  char text[64];
  std::snprintf(text, sizeof text, ": %.3g%s%s", value, c.unit == "-" ? "" : " ", c.unit == "-" ? "" : c.unit.c_str());
  return c.title + text;
}

ScaleEstimate estimate(const ScaleItem& item, bool fewer_is_better, const NeedleReport& report) {
  ScaleEstimate e;
  if (item.criteria.empty()) {
    e.why = "left to the rater: " + item.rater;
    return e;
  }
  for (const ScaleCriterion& c : item.criteria) {
    const double value = scale_value(c.measure, report);
    if (std::isnan(value)) return {std::nullopt, std::nullopt, "-", "left to the rater: " + c.title + " could not be measured"};
    const int points = points_of(c, value);
    if (e.points && (fewer_is_better ? points <= *e.points : points >= *e.points)) continue;
    e = {points, value, c.unit, reason(c, value)};
  }
  return e;
}

}  // namespace

RatingScale parse_rating_scale(const YamlNode& file) {
  if (file.text("format") != "filum-scale/1") file.refuse("format", "filum-scale/1");
  RatingScale s;
  s.name = file.text("name");
  s.title = file.text("title");
  s.source = file.text("source");
  s.most = file.integer("most", 1, 5);
  s.fewer_is_better = file.has("better") && file.choice("better", {"more", "fewer"}) == "fewer";
  for (const YamlNode& node : file.items("items")) {
    s.items.push_back(item_of(node, s.most));
    const auto same = [&](const ScaleItem& other) { return other.name == s.items.back().name; };
    if (std::count_if(s.items.begin(), s.items.end(), same) > 1) node.refuse("name", "a name of its own");
  }
  file.finish();
  return s;
}

RatingScale load_rating_scale(const std::string& path) { return parse_rating_scale(YamlNode::load(path)); }

double scale_value(const std::string& measure, const NeedleReport& r) {
  if (!r.has_tissue) return kNaN;
  if (measure == "leak") return r.join && r.join->sound ? 60e6 * r.join->leak : kNaN;
  if (measure == "lapses") return static_cast<double>(r.lapses.size());
  if (measure == "back-walls") return count_of(r.lapses, "back-wall");
  if (is_lapse(measure)) return lapse_count(measure, r);
  if (measure == "spacing-variation") return variation(r.spacings);
  if (measure == "bite-widest") return widest_bite(r) / r.thickness;
  if (measure == "bite-narrowest") return over_stitches(r, false, [](const Stitch& s) { return std::min(s.bite[0], s.bite[1]); }) / r.thickness;
  if (measure == "bite-inequality") return over_stitches(r, true, [](const Stitch& s) { return std::abs(s.bite[0] - s.bite[1]) / std::max(s.bite[0], s.bite[1]); });
  if (measure == "knots-secure") return secure_share(r);
  if (measure == "slack-most") return 1e3 * over_stitches(r, true, [](const Stitch& s) { return s.slack; });
  if (measure == "tail-longest") return 1e3 * over_stitches(r, true, [](const Stitch& s) { return s.tail; });
  if (measure == "tail-shortest") return 1e3 * over_stitches(r, false, [](const Stitch& s) { return s.short_tail; });
  return kNaN;
}

std::vector<ScaleEstimate> estimates(const RatingScale& scale, const NeedleReport& report) {
  std::vector<ScaleEstimate> all;
  for (const ScaleItem& item : scale.items) all.push_back(estimate(item, scale.fewer_is_better, report));
  return all;
}

}  // namespace filum
