#include "training/lapse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "base/numbers.h"
#include "training/cut_line.h"
#include "training/stitch_pairs.h"

namespace filum {
namespace {

std::vector<std::string> layers_of(const PassObservation& p, const TissueDescription& scene) {
  std::vector<std::string> names;
  for (const TissueLayer& l : scene.layers)
    if (std::min(p.deep, l.to) - std::max(p.shallow, l.from) > 1e-6) names.push_back(l.name);
  return names;
}

Stitch from_passes(const TissueObservation& t, int a, int b, const CutLine& cut, const TissueDescription& scene) {
  const PassObservation& p = t.passes[static_cast<std::size_t>(a)];
  const PassObservation& q = t.passes[static_cast<std::size_t>(b < 0 ? a : b)];
  Stitch s;
  s.first = a;
  s.second = b;
  const bool whole = b >= 0 || is_whole(p);
  s.bite[0] = std::abs(p.bite_entry);
  s.bite[1] = whole ? std::abs(q.bite_exit) : std::numeric_limits<double>::quiet_NaN();
  s.entry_angle = p.entry_angle;
  s.exit_angle = q.out ? q.exit_angle : kNaN;
  const CutPlace in{p.entry_rest, p.side}, out = q.out ? CutPlace{q.exit_rest, q.side} : in;
  // Two stumps lie apart in the open clamp, and that space is no part of a bite.
  const bool stumps = scene.lumen && scene.edges[0].rim.empty();
  const double across = stumps && whole ? s.bite[0] + s.bite[1] : cut.across(in, out);
  s.obliquity = whole ? std::atan2(std::abs(cut.along(in, out)), across) : kNaN;
  s.depth = std::min(p.depth_share, q.depth_share);
  s.position = cut.position(in, out);
  s.tension = std::max(p.tension, q.tension);
  s.peak_force = std::max(p.peak_force, q.peak_force);
  s.torn = std::max(p.torn, q.torn);
  s.lost = is_lost(p) || is_lost(q);
  s.joins = whole && p.state == PassObservation::State::thread && q.state == PassObservation::State::thread;
  if (b >= 0 || (!whole && p.out)) s.inner[0] = std::abs(p.bite_exit);
  if (b >= 0) s.inner[1] = std::abs(q.bite_entry);
  s.layers = layers_of(p.depth_share <= q.depth_share ? p : q, scene);
  return s;
}

/// [rad], between where pass k came into the lumen and where the next one left it; 0 if they are no such two.
double turn_through_lumen(const TissueObservation& t, int k, const CutLine& cut) {
  if (k < 0 || k + 1 >= t.n_passes) return 0.0;
  const PassObservation &in = t.passes[static_cast<std::size_t>(k)], &out = t.passes[static_cast<std::size_t>(k + 1)];
  if (!in.out || in.exit_depth < 0.5 || out.entry_depth < 0.5) return 0.0;
  return cut.round_lumen({in.exit_rest, in.side}, {out.entry_rest, out.side});
}

const std::vector<std::string> kLapses = {"oblique", "wide-bite", "partial-thickness", "unequal-spacing", "back-wall", "loose-knot", "too-tight",
                                          "wall-tear", "thread-in-lumen", "disrupted-line", "edge-overlap"};

double wrapped(double a) { return a - kTurn * std::floor(a / kTurn); }

constexpr double kBeside = 1e-6;  // [rad]: a node of the edge at a stitch is not between two

/// [m], at an angle round the cut: linear between the two nodes beside it.
double gap_at(const std::vector<EdgePlace>& edge, double angle) {
  const auto after = std::find_if(edge.begin(), edge.end(), [&](const EdgePlace& p) { return kTurn * p.share > angle; });
  const EdgePlace &next = after == edge.end() ? edge.front() : *after, &before = after == edge.begin() ? edge.back() : *(after - 1);
  const double span = wrapped(kTurn * (next.share - before.share)), past = angle - kTurn * before.share + (after == edge.begin() ? kTurn : 0.0);
  const double t = span > 0.0 ? std::clamp(past / span, 0.0, 1.0) : 0.0;
  return (1.0 - t) * before.gap + t * next.gap;
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
  r.back_wall = file.quantity_or("back_wall", "deg", r.back_wall, Range::between(0.0, std::numbers::pi));
  r.overlap = file.number_or("edge_overlap_thicknesses", r.overlap, Range::positive());
  r.tight = file.quantity_or("too_tight", "N/m", r.tight, Range::positive());
  r.slack = file.quantity_or("loose_slack", "mm", r.slack, Range::positive());
  r.loose_gap = file.number_or("loose_gap_thicknesses", r.loose_gap, Range::positive());
  r.line_gap = file.number_or("line_gap_thicknesses", r.line_gap, Range::positive());
  r.neighbours = file.quantity_or("neighbours", "deg", r.neighbours, Range::between(0.0, std::numbers::pi));
  r.thread_inside = file.quantity_or("thread_inside", "mm", r.thread_inside, Range::positive());
  if (file.has("critical")) r.critical = file.texts("critical");
  for (const std::string& name : r.critical)
    if (std::find(kLapses.begin(), kLapses.end(), name) == kLapses.end()) file.refuse("critical", "names of lapses, such as back-wall");
  file.finish();
  return r;
}

std::vector<Stitch> stitches_of(const LapseRules& rules, const TissueObservation& t, const std::vector<std::array<int, 2>>& pairs,
                                const std::vector<double>& pass_time, const TissueDescription& scene) {
  const CutLine cut(scene);
  std::vector<Stitch> stitches;
  for (int k = 0; k < t.n_passes; ++k) {
    if (const PassObservation& p = t.passes[static_cast<std::size_t>(k)]; !p.out && p.torn <= rules.tear) continue;
    if (std::any_of(pairs.begin(), pairs.end(), [k](const auto& pair) { return pair[1] == k; })) continue;
    const auto pair = std::find_if(pairs.begin(), pairs.end(), [k](const auto& one) { return one[0] == k; });
    const auto came_in = std::find_if(stitches.begin(), stitches.end(), [k](const Stitch& s) { return std::max(s.first, s.second) == k - 1; });
    if (scene.lumen && pair == pairs.end() && came_in != stitches.end() && turn_through_lumen(t, k - 1, cut) > rules.back_wall) {
      came_in->torn = std::max(came_in->torn, t.passes[static_cast<std::size_t>(k)].torn);
      came_in->peak_force = std::max(came_in->peak_force, t.passes[static_cast<std::size_t>(k)].peak_force);
      continue;
    }
    stitches.push_back(from_passes(t, k, pair == pairs.end() ? -1 : (*pair)[1], cut, scene));
    const auto last = static_cast<std::size_t>(std::max(k, stitches.back().second));
    if (last < pass_time.size()) stitches.back().time = pass_time[last];
  }
  return stitches;
}

std::vector<double> ways_to_next(const std::vector<Stitch>& stitches, const TissueDescription& scene) {
  const double round = scene.lumen ? kTurn * CutLine(scene).radius() : 0.0;  // [m]
  std::vector<std::pair<double, std::size_t>> at;                           // place of each, ascending
  for (std::size_t k = 0; k < stitches.size(); ++k)
    if (const double p = stitches[k].position; !stitches[k].lost) at.emplace_back(scene.lumen ? p - round * std::floor(p / round) : p, k);
  std::sort(at.begin(), at.end());
  std::vector<double> ways(stitches.size(), kNaN);
  for (std::size_t k = 1; k < at.size(); ++k) ways[at[k - 1].second] = at[k].first - at[k - 1].first;
  if (scene.lumen && at.size() > 1) ways[at.back().second] = round - (at.back().first - at.front().first);
  return ways;
}

std::vector<double> spacings_of(const std::vector<Stitch>& stitches, const TissueDescription& scene, bool complete) {
  std::vector<double> gaps = ways_to_next(stitches, scene);
  std::erase_if(gaps, [](double gap) { return std::isnan(gap); });
  if (scene.lumen && !complete && !gaps.empty()) gaps.erase(std::max_element(gaps.begin(), gaps.end()));
  return gaps;
}

double variation(const std::vector<double>& spacings) {
  if (spacings.size() < 2) return kNaN;
  double mean = 0.0, square = 0.0;
  for (const double g : spacings) mean += g / static_cast<double>(spacings.size());
  for (const double g : spacings) square += (g - mean) * (g - mean) / static_cast<double>(spacings.size());
  return std::sqrt(square) / mean;
}

double count_of(const std::vector<Lapse>& lapses, std::string_view name) {
  return static_cast<double>(std::count_if(lapses.begin(), lapses.end(), [&](const Lapse& l) { return name == l.name; }));
}

std::vector<Lapse> lapses_of(const LapseRules& rules, const std::vector<Stitch>& stitches, const std::vector<double>& spacings, double thickness, double end) {
  std::vector<Lapse> found;
  for (std::size_t k = 0; k < stitches.size(); ++k) {
    const Stitch& s = stitches[k];
    const int i = static_cast<int>(k);
    if (s.torn > rules.tear) found.push_back({"wall-tear", i, std::isnan(s.tear_time) ? s.time : s.tear_time, s.torn, "m"});
    if (s.lost) continue;
    const double widest = std::fmax(s.bite[0], s.bite[1]), bite = std::fmin(s.bite[0], s.bite[1]);
    if (s.obliquity > rules.oblique) found.push_back({"oblique", i, s.time, s.obliquity * 180.0 / std::numbers::pi, "deg"});
    if (widest > rules.wide_bite * thickness) found.push_back({"wide-bite", i, s.time, widest / thickness, "thicknesses"});
    if (s.depth < rules.least_depth - 1e-6) found.push_back({"partial-thickness", i, s.time, s.depth, "share"});
    if (s.tension > rules.tight * bite) found.push_back({"too-tight", i, end, s.tension / bite, "N/m"});
    if (s.slack > rules.slack) found.push_back({"loose-knot", i, end, s.slack, "m"});
  }
  if (spacings.size() < 2) return found;
  const double varied = variation(spacings), ratio = *std::max_element(spacings.begin(), spacings.end()) / *std::min_element(spacings.begin(), spacings.end());
  if (varied > rules.spacing_variation || ratio > rules.spacing_ratio) found.push_back({"unequal-spacing", -1, stitches.back().time, varied, "-"});
  return found;
}

void find_back_walls(const LapseRules& rules, const TissueObservation& t, const std::vector<double>& pass_time, const TissueDescription& scene,
                     const std::vector<Stitch>& stitches, std::vector<Lapse>& found) {
  if (!scene.lumen) return;
  const CutLine cut(scene);
  for (int k = 0; k + 1 < t.n_passes; ++k) {
    const double turn = turn_through_lumen(t, k, cut);
    if (turn <= rules.back_wall) continue;
    const auto of = std::find_if(stitches.begin(), stitches.end(), [&](const Stitch& s) { return s.first == k || s.second == k; });
    const double time = static_cast<std::size_t>(k) < pass_time.size() ? pass_time[static_cast<std::size_t>(k)] : 0.0;
    found.push_back({"back-wall", of == stitches.end() ? -1 : static_cast<int>(of - stitches.begin()), time, turn * 180.0 / std::numbers::pi, "deg"});
  }
}

void find_join_lapses(const LapseRules& rules, const JoinReport& join, double time, std::vector<Lapse>& found) {
  if (join.thread_inside > rules.thread_inside) found.push_back({"thread-in-lumen", -1, time, join.thread_inside, "m"});
  if (join.overlap > rules.overlap) found.push_back({"edge-overlap", -1, time, join.overlap, "thicknesses"});
}

void find_gap_lapses(const LapseRules& rules, const JoinReport& join, const TissueDescription& scene, const std::vector<Stitch>& stitches, bool complete,
                     double time, std::vector<Lapse>& found) {
  if (!scene.lumen || join.edge.empty()) return;
  const CutLine cut(scene);
  std::vector<std::pair<double, int>> at;  // angle of each stitch, ascending
  const auto told = [&](int k) { return std::any_of(found.begin(), found.end(), [&](const Lapse& l) { return l.stitch == k && std::string_view(l.name) == "loose-knot"; }); };
  for (std::size_t k = 0; k < stitches.size(); ++k) {
    if (!stitches[k].joins) continue;
    at.emplace_back(wrapped(stitches[k].position / cut.radius()), static_cast<int>(k));
    const double gap = gap_at(join.edge, at.back().first) / scene.thickness;
    if (gap > rules.loose_gap && !told(static_cast<int>(k))) found.push_back({"loose-knot", static_cast<int>(k), time, gap, "thicknesses"});
  }
  std::sort(at.begin(), at.end());
  for (std::size_t k = 0; k < at.size() && at.size() > 1; ++k) {
    const double from = at[k].first, span = wrapped(at[(k + 1) % at.size()].first - from);
    if (!complete && span > rules.neighbours) continue;
    double widest = 0.0;
    for (const EdgePlace& p : join.edge)
      if (const double on = wrapped(kTurn * p.share - from); on > kBeside && on < span - kBeside) widest = std::max(widest, p.gap / scene.thickness);
    if (widest > rules.line_gap) found.push_back({"disrupted-line", at[k].second, time, widest, "thicknesses"});
  }
}

void mark_critical(const LapseRules& rules, std::vector<Lapse>& found) {
  for (Lapse& l : found) l.critical = std::find(rules.critical.begin(), rules.critical.end(), l.name) != rules.critical.end();
}

}  // namespace filum
