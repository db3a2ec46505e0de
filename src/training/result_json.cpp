#include "training/result_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "training/patency_factors.h"
#include "training/pressure_map.h"
#include "training/rating_scale.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json finite(const std::vector<double>& values) {
  Json list = Json::array();
  for (double value : values) list.push_back(finite(value));
  return list;
}

Json score_json(const Result& r) {
  Json items = Json::array();
  for (const ScoreItem& item : r.items) {
    Json value = nullptr;
    if (item.number) value = finite(*item.number);
    if (!item.text.empty()) value = item.text;
    items.push_back({{"name", item.name},
                     {"title", item.title},
                     {"value", value},
                     {"unit", item.unit},
                     {"points", finite(item.points)},
                     {"max_points", finite(item.max_points)},
                     {"why", item.why}});
  }
  return {{"total", finite(r.total)}, {"max_total", finite(r.max_total)}, {"items", items}};
}

Json knot_json(const Result& r) {
  return {{"class", r.knot.knot_class},
          {"security_newton", r.security ? finite(r.security->slip_force) : Json(nullptr)},
          {"held", r.security && r.security->held}};
}

Json report_json(const KnotReport& k) {
  return {{"composition", k.composition},
          {"half_twists", k.throws},
          {"throws", k.n_throws},
          {"jones", k.jones},
          {"alexander", k.alexander},
          {"determinant", k.determinant},
          {"crossings", k.n_crossings},
          {"encloses_post", k.encloses_post},
          {"post_winding", k.post_winding},
          {"confidence", finite(k.confidence)},
          {"strand_turning_rad", {finite(k.strand_turning[0]), finite(k.strand_turning[1])}},
          {"note", k.note}};
}

Json measures_json(const Measures& m) {
  Json json = {{"time_s", finite(m.seconds)},
          {"throws", m.throws},
          {"short_tail_m", finite(m.short_tail)},
          {"long_tail_m", finite(m.long_tail)},
          {"path_length_m", finite(m.path_length)},
          {"movements", m.movements},
          {"idle_time_s", finite(m.idle_time)},
          {"sparc", finite(m.sparc)},
          {"ldlj", finite(m.ldlj)},
          {"sparc_segments", m.sparc_segments},
          {"ldlj_segments", m.ldlj_segments},
          {"grip_peak_n", finite(m.grip_peak)},
          {"grip_median_n", finite(m.grip_median)},
          {"grasps", m.grasps},
          {"drops", m.drops},
          {"tension_peak_n", finite(m.tension_peak)},
          {"overload_share", finite(m.overload)},
          {"both_moving_share", finite(m.both_moving)},
          {"speed_correlation", finite(m.speed_correlation)},
          {"speed_lag_s", finite(m.speed_lag)},
          {"dominance_share", finite(m.dominance)}};
  if (!m.laboratory) return json;
  json["target_error_m"] = finite(m.target_error);
  json["target_longest_m"] = finite(m.target_longest);
  json["on_target_share"] = finite(m.on_target);
  json["force_share"] = finite(m.force_share);
  json["force_excess_n"] = finite(m.force_excess);
  json["objects_broken"] = m.objects_broken;
  return json;
}

Json pressure_json(const PressureReport& p) {
  const auto mmhg = [](double pascal) { return finite(pascal / kMmHg); };
  Json bands = Json::object();
  for (std::size_t k = 0; k < p.time_in_band.size(); ++k) bands[name_of(static_cast<PressureBand>(k))] = finite(p.time_in_band[k]);
  return {{"peak_mmhg", mmhg(p.peak)},
          {"tip_mmhg", mmhg(p.tip)},
          {"mean_mmhg", mmhg(p.mean)},
          {"force_n", finite(p.force)},
          {"dose", mmhg(p.dose / 60.0)},
          {"dose_unit", "mmHg min"},
          {"risk", finite(p.risk)},
          {"time_in_band", bands},
          {"hold_peak_mmhg", mmhg(p.hold_peak)},
          {"loaded_longest_s", finite(p.loaded_longest)},
          {"releases", p.releases},
          {"slips", p.slips},
          {"edge_cuts", p.edge_cuts},
          {"veins_torn", p.veins_torn},
          {"exposed", finite(p.exposed)},
          {"press_error_mmhg", mmhg(p.press_error)},
          {"perfusion", {{"on", p.limits.perfusion}, {"least_mmhg", mmhg(p.perfusion_least)}, {"injured", p.injured}}},
          {"limits", {{"title", p.limits.title}, {"version", p.limits.version}, {"label", p.limits.label}, {"source", p.limits.source}}}};
}

Json stitch_json(const Stitch& s, double thickness) {
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  return {{"time", finite(s.time)},
          {"passes", {s.first, s.second}},
          {"bite_m", {finite(s.bite[0]), finite(s.bite[1])}},
          {"bites_inner_m", {finite(s.inner[0]), finite(s.inner[1])}},
          {"bite_thicknesses", {finite(s.bite[0] / thickness), finite(s.bite[1] / thickness)}},
          {"entry_angle_deg", finite(kDegrees * s.entry_angle)},
          {"exit_angle_deg", finite(kDegrees * s.exit_angle)},
          {"obliquity_deg", finite(kDegrees * s.obliquity)},
          {"depth_share", finite(s.depth)},
          {"depth_layers", s.layers},
          {"position_m", finite(s.position)},
          {"spacing_m", finite(s.next)},
          {"tension_n", finite(s.tension)},
          {"peak_force_n", finite(s.peak_force)},
          {"torn_m", finite(s.torn)},
          {"throws", s.throws},
          {"knot", s.knot.empty() ? Json(nullptr) : Json(s.knot)},
          {"tail_mm", finite(1e3 * s.tail)},
          {"short_tail_mm", finite(1e3 * s.short_tail)},
          {"slack_mm", finite(1e3 * s.slack)}};
}

/// Of the walls alone at a held pressure (world/join_test.h). `round` [m]: length of the cut.
Json leak_json(const JoinReport& j, double round) {
  constexpr double kMlPerMin = 60e6;
  Json sectors = Json::array(), edge = Json::array();
  for (const EdgePlace& p : j.edge) edge.push_back({{"angle_deg", 360.0 * p.share}, {"gap_m", finite(p.gap)}});
  for (std::size_t k = 0; k < j.sector_flow.size(); ++k) sectors.push_back(finite(kMlPerMin * j.sector_flow[k]));
  return {{"total_ml_per_min", finite(kMlPerMin * j.leak)},
          {"per_sector", sectors},
          {"gap_m", finite(j.sector_gap)},
          {"open_area_m2", finite(j.area)},
          {"held_mmhg", finite(j.pressure / kMmHg)},
          {"narrowing", finite(j.narrowing)},
          {"through_ml_per_min", finite(kMlPerMin * j.through)},
          {"patent", j.patent},
          {"thread_in_lumen_m", finite(j.thread_inside)},
          {"edge_overlap_thicknesses", finite(j.overlap)},
          {"solver_sound", j.sound},
          {"round_m", finite(round)},
          {"edge", edge}};
}

/// Clamps as the trainee took them off, beside the test at the end.
Json clamps_json(const ClampReport& c) {
  constexpr double kMlPerMin = 60e6, kMm2 = 1e6;
  const char* note = c.wrong_order ? "the downstream clamp came off first: the join is filled and tried against collaterals before its artery, and the order was to be upstream first"
                                   : "upstream first, as asked";
  return {{"upstream_s", finite(c.upstream)},
          {"downstream_s", finite(c.downstream)},
          {"order_right", !c.wrong_order},
          {"note", note},
          {"pressure_mmhg", {finite(c.pressure[0] / kMmHg), finite(c.pressure[1] / kMmHg)}},
          {"leak_ml_per_min", finite(kMlPerMin * c.leak)},
          {"most_leak_ml_per_min", finite(kMlPerMin * c.most_leak)},
          {"through_ml_per_min", finite(kMlPerMin * c.through)},
          {"lost_ml", finite(1e6 * c.lost)},
          {"least_lumen_before_mm2", finite(kMm2 * c.area_before)},
          {"least_lumen_mm2", finite(kMm2 * c.area)}};
}

Json milking_json(const MilkingReport& m) {
  return {{"tests", m.tests()},
          {"refilled", m.refilled},
          {"stayed_empty", m.stayed_empty},
          {"spoiled", m.spoiled},
          {"refill_s", finite(m.seconds)},
          {"emptied_ml", finite(1e6 * m.volume)},
          {"note", "a refill shows flow, not a good join: stitches that catch both walls are missed by it (clinical.md, MPT)"}};
}

/// The items of a rating scale with what the simulator estimates of them; null: left to the rater.
Json scale_json(const RatingScale& s, const NeedleReport& report) {
  Json items = Json::array();
  const std::vector<ScaleEstimate> all = estimates(s, report);
  for (std::size_t k = 0; k < s.items.size(); ++k) {
    const ScaleItem& item = s.items[k];
    const ScaleEstimate& e = all[k];
    items.push_back({{"name", item.name},
                     {"title", item.title},
                     {"points", item.words},
                     {"estimate", e.points ? Json(*e.points) : Json(nullptr)},
                     {"value", e.value ? finite(*e.value) : Json(nullptr)},
                     {"unit", e.unit},
                     {"why", e.why}});
  }
  return {{"name", s.name}, {"title", s.title}, {"source", s.source}, {"label", "simulator-derived estimates, not validated"}, {"most", s.most}, {"better", s.fewer_is_better ? "fewer" : "more"}, {"items", items}};
}

void add_needle(const NeedleReport& n, Json& json) {
  json["needle"] = {{"takes", n.takes}, {"drops", n.drops}, {"angle_error_rad", finite(n.angle_error)}, {"held_at_share", finite(n.share)}, {"present_error_m", finite(n.present_error)}};
  if (n.out_of_turn >= 0) json["needle"]["stitches_out_of_turn"] = n.out_of_turn;
  json["handling"] = {{"adventitia", n.handling.folds}, {"through_wall", n.handling.walls}, {"slipped", n.handling.slips}, {"most_pull_n", finite(n.handling.pull)}};
  if (!n.has_tissue) return;
  json["stitches"] = Json::array();
  for (const Stitch& s : n.stitches) json["stitches"].push_back(stitch_json(s, n.thickness));
  json["spacings_m"] = finite(n.spacings);
  json["lapses"] = Json::array();
  for (const Lapse& l : n.lapses) json["lapses"].push_back({{"name", l.name}, {"stitch", l.stitch}, {"time", finite(l.time)}, {"value", finite(l.value)}, {"unit", l.unit}, {"critical", l.critical}});
  json["lapse_rules"] = n.rules;
  for (const auto& scale : n.scales) json["scales"].push_back(scale_json(*scale, n));
  json["tissue_soundness"] = finite(n.soundness);
  if (n.join) json["leak"] = leak_json(*n.join, n.round);
  if (n.clamps) json["clamps"] = clamps_json(*n.clamps);
  if (n.milking) json["milking"] = milking_json(*n.milking);
  const std::vector<PatencyFactor> factors = patency_factors(n);
  if (factors.empty()) return;
  json["thrombosis_factors"] = Json::array();
  for (const PatencyFactor& f : factors)
    json["thrombosis_factors"].push_back({{"name", f.name}, {"title", f.title}, {"value", finite(f.value)}, {"unit", f.unit}, {"raised", f.raised}, {"source", f.source}});
}

Json events_json(const std::vector<TaskEvent>& events) {
  Json list = Json::array();
  for (const TaskEvent& e : events) {
    list.push_back({{"time", finite(e.time)},
                    {"name", e.name},
                    {"tool", e.tool},
                    {"value", finite(e.value)},
                    {"unit", e.unit},
                    {"text", e.text}});
  }
  return list;
}

/// Samples that are not numbers are left out: the schema of curves and paths knows no null.
Json curve_json(const Curve& c) {
  std::vector<double> time, value;
  for (std::size_t i = 0; i < std::min(c.time.size(), c.value.size()); ++i) {
    if (!std::isfinite(c.time[i]) || !std::isfinite(c.value[i])) continue;
    time.push_back(c.time[i]);
    value.push_back(c.value[i]);
  }
  return {{"name", c.name}, {"title", c.title}, {"unit", c.unit}, {"time", time}, {"value", value}};
}

Json path_json(const ToolPath& p) {
  std::vector<double> time, positions;
  for (std::size_t i = 0; i < std::min(p.time.size(), p.positions.size() / 3); ++i) {
    const double* at = p.positions.data() + 3 * i;
    if (!std::isfinite(p.time[i] + at[0] + at[1] + at[2])) continue;
    time.push_back(p.time[i]);
    positions.insert(positions.end(), at, at + 3);
  }
  return {{"tool", p.tool}, {"name", p.name}, {"positions", positions}, {"time", time}};
}

}  // namespace

std::string result_json(const Result& r, bool full) {
  Json json = {{"task", r.task},
               {"title", r.title},
               {"finished", r.finished},
               {"passed", r.passed},
               {"seconds", finite(r.seconds)},
               {"score", score_json(r)},
               {"knot", r.has_knot ? knot_json(r) : Json(nullptr)},
               {"events", events_json(r.events)}};
  if (r.pressure) {
    json["pressure"] = pressure_json(*r.pressure);
    json["pressure_map"] = pressure_map_json(*r.pressure);
  }
  if (r.needle) add_needle(*r.needle, json);
  json["series"] = Json::array();
  for (const Curve& c : r.series) json["series"].push_back(curve_json(c));
  json["paths"] = Json::array();
  for (const ToolPath& p : r.paths) json["paths"].push_back(path_json(p));
  json["verdict"] = r.verdict;
  if (full) {
    json["measures"] = measures_json(r.measures);
    if (r.has_knot) json["knot_report"] = report_json(r.knot);
    if (r.security) {
      json["security"] = {{"held", r.security->held},
                          {"slip_force_newton", finite(r.security->slip_force)},
                          {"max_pull_newton", finite(r.security->max_pull)},
                          {"elongation_m", finite(r.security->elongation)}};
    }
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace filum
