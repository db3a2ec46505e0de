#include "analysis/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "training/metrics.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmoothnessRate = 100.0;  // [Hz]
constexpr double kAntiAlias = 40.0;        // [Hz]

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// ---- tremor

/// A script has no sensor: what it says is exact, and so its noise floor is zero.
bool is_script(const RecordedSession& session) { return session.meta.input.starts_with("demonstrat"); }

const ToolSeries* tool_of(const RecordedSession& session, int tool) {
  for (const ToolSeries& t : session.tools)
    if (t.tool == tool) return &t;
  return nullptr;
}

struct Floor {
  std::optional<EvenPath> path;
  std::string source;
};

Floor floor_for(const AnalysisInput& input, const RecordedSession& session, int tool, bool hand, const EvenPath& path) {
  if (input.clamped) {
    const ToolSeries* clamped = tool_of(*input.clamped, tool);
    if (!clamped) return {std::nullopt, "the clamped recording does not hold this tool"};
    return {(hand ? clamped->hand : clamped->scene).even(), "clamped tool: " + input.clamped->file};
  }
  if (!is_script(session)) return {std::nullopt, "not measured"};
  EvenPath zero = path;
  for (Points& p : zero.stretches) p.setZero();
  return {zero, "zero: a script has no sensor"};
}

Json band_json(const TremorBand& band) {
  Json json = {{"from_hz", band.from},
               {"to_hz", band.to},
               {"power_m2", finite(band.power.value)},
               {"power_low_m2", finite(band.power.low)},
               {"power_high_m2", finite(band.power.high)},
               {"noise_floor_rms_m", finite(std::sqrt(band.floor))},
               {"resolved", band.resolved},
               {"rms_m", finite(band.rms)}};
  if (!band.resolved) json["why"] = band.why;
  return json;
}

Json spectrum_json(const Spectrum& s) {
  Json frequency = Json::array(), density = Json::array();
  for (std::size_t k = 0; k < s.density.size() && s.frequency(k) <= 25.0; ++k) {
    frequency.push_back(s.frequency(k));
    density.push_back(s.density[k]);
  }
  return {{"frequency_hz", frequency}, {"density_m2_per_hz", density}};
}

Json tremor_json(const Tremor& t, const EvenPath& path, const Floor& floor) {
  Json json = {{"measured", t.measured},
               {"resolved", t.resolved()},
               {"rate_hz", finite(path.fs)},
               {"jitter_ms", finite(1e3 * path.jitter)},
               {"gaps", path.gaps},
               {"seconds", path.seconds()},
               {"noise_floor", floor.source}};
  if (!t.why.empty()) json["why"] = t.why;
  if (!t.measured) return json;
  json["segments"] = t.spectrum.segments;
  json["degrees_of_freedom"] = t.spectrum.degrees;
  json["resolution_hz"] = t.spectrum.resolution();
  json["measured_rms_m"] = finite(t.rms);
  json["range_m"] = finite(t.range);
  json["relative_power_8_12"] = finite(t.relative_power);
  json["bands"] = Json::array();
  for (const TremorBand& band : t.bands) json["bands"].push_back(band_json(band));
  if (t.resolved()) {
    json["peak_hz"] = finite(t.peak.frequency);
    json["half_power_width_hz"] = finite(t.peak.half_width);
    json["width_is_the_windows"] = t.peak.narrow;
  }
  json["spectrum"] = spectrum_json(t.spectrum);
  return json;
}

std::vector<Window> windows_of(const ToolSeries& tool, double seconds) {
  return tool.holds.empty() ? std::vector<Window>{{"whole session", 0.0, seconds}} : tool.holds;
}

Json all_tremor(const AnalysisInput& input, const RecordedSession& session, const AnalysisOptions& o) {
  Json list = Json::array();
  for (const ToolSeries& tool : session.tools) {
    for (const Window& window : windows_of(tool, session.seconds)) {
      for (const bool hand : {true, false}) {
        const EvenPath path = (hand ? tool.hand : tool.scene).cut(window.from, window.to).even();
        const Floor floor = floor_for(input, session, tool.tool, hand, path);
        Json json = {{"tool", tool.tool}, {"space", hand ? "hand" : "scene"}, {"window", window.name},
                     {"from_s", window.from}, {"to_s", window.to}};
        if (tool.holds.empty()) json["note"] = "no hold in this session: voluntary movement is in the bands";
        json.update(tremor_json(tremor_of(path, floor.path, o.tremor), path, floor));
        list.push_back(std::move(json));
      }
    }
  }
  return list;
}

// ---- smoothness

/// The longest stretch at about 100 Hz.
std::pair<Points, double> slow_path(const EvenPath& path) {
  if (path.stretches.empty()) return {Points(3, 0), path.fs};
  const Points& p = *std::max_element(path.stretches.begin(), path.stretches.end(),
                                      [](const Points& a, const Points& b) { return a.cols() < b.cols(); });
  const auto every = std::max<Eigen::Index>(1, std::lround(path.fs / kSmoothnessRate));
  Points slow(3, (p.cols() + every - 1) / every);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> x(static_cast<std::size_t>(p.cols()));
    for (Eigen::Index k = 0; k < p.cols(); ++k) x[static_cast<std::size_t>(k)] = p(axis, k);
    if (every > 1) x = low_pass(x, path.fs, kAntiAlias);
    for (Eigen::Index k = 0; k < slow.cols(); ++k) slow(axis, k) = x[static_cast<std::size_t>(k * every)];
  }
  return {slow, path.fs / static_cast<double>(every)};
}

Json spread_json(const Spread& s) {
  return {{"median", finite(s.median)}, {"q1", finite(s.low)}, {"q3", finite(s.high)}, {"n", s.n}};
}

Json smoothness_json(const ToolSeries& tool, bool hand) {
  const auto [path, fs] = slow_path((hand ? tool.hand : tool.scene).even());
  Json json = {{"tool", tool.tool}, {"space", hand ? "hand" : "scene"}};
  if (path.cols() < 16 || fs < 40.0) {
    json["why"] = "sampled at less than 40 Hz, or no stretch without gaps";
    return json;
  }
  const std::vector<double> speed = speed_of(path, fs);
  const std::vector<Segment> segments = movements(speed, fs);
  const Smoothness smooth = smoothness_of(speed, fs, segments);
  std::vector<double> wide;
  for (const Segment& s : segments) {
    const std::vector<double> part(speed.begin() + static_cast<std::ptrdiff_t>(s.begin),
                                   speed.begin() + static_cast<std::ptrdiff_t>(s.end));
    const double seconds = static_cast<double>(s.size()) / fs;
    if (seconds >= 0.3 && seconds <= 10.0) wide.push_back(sparc(part, fs, {.fc = 20.0}));
  }
  json["rate_hz"] = fs;
  json["movements"] = segments.size();
  json["path_length_m"] = path_length(path);
  json["idle_time_s"] = idle_time(speed, fs);
  json["sparc"] = spread_json(smooth.sparc);
  json["sparc_fc20"] = spread_json(spread_of(wide));
  json["ldlj"] = spread_json(smooth.ldlj);
  if (smooth.ldlj.n == 0) json["ldlj"]["why"] = "no movement of 0.3-10 s that is 100 times clear of noise";
  return json;
}

// ---- grasp force

std::vector<Grasp> grasps_of(const ToolSeries& tool, const GraspOptions& o) {
  const TimedForce& g = tool.grip;
  if (g.clock.size() < 16) return {};
  Points as_path = Points::Zero(3, static_cast<Eigen::Index>(g.force.size()));
  for (std::size_t k = 0; k < g.force.size(); ++k) as_path(0, static_cast<Eigen::Index>(k)) = g.force[k];
  const EvenPath even = even_path(g.clock, as_path);
  std::vector<Grasp> all;
  double at = g.scene.front();
  for (const Points& stretch : even.stretches) {
    std::vector<double> force(static_cast<std::size_t>(stretch.cols()));
    for (Eigen::Index k = 0; k < stretch.cols(); ++k) force[static_cast<std::size_t>(k)] = stretch(0, k);
    const std::vector<Grasp> found = find_grasps(force, even.fs, at, tool.held, o);
    all.insert(all.end(), found.begin(), found.end());
    at += static_cast<double>(stretch.cols()) / even.fs;
  }
  return all;
}

Json grasp_json(const Grasp& g) {
  return {{"from_s", g.from},           {"to_s", g.to},
          {"peak_n", g.peak},           {"plateau_n", g.plateau},
          {"rise_n_per_s", g.rise},     {"overshoot_n", g.overshoot},
          {"variation", g.variation},   {"excess_over_slip_limit_n", g.excess ? Json(*g.excess) : Json(nullptr)},
          {"slipped", g.slipped}};
}

Json grasp_summary(const std::vector<Grasp>& grasps) {
  std::vector<double> peak, rise, overshoot, variation, excess;
  for (const Grasp& g : grasps) {
    peak.push_back(g.peak);
    rise.push_back(g.rise);
    overshoot.push_back(g.overshoot);
    variation.push_back(g.variation);
    if (g.excess) excess.push_back(*g.excess);
  }
  return {{"peak_n", spread_json(spread_of(peak))},
          {"rise_n_per_s", spread_json(spread_of(rise))},
          {"overshoot_n", spread_json(spread_of(overshoot))},
          {"variation", spread_json(spread_of(variation))},
          {"excess_over_slip_limit_n", spread_json(spread_of(excess))}};
}

Json force_json(const ToolSeries& tool, const std::optional<GraspBands>& bands, const AnalysisOptions& o) {
  const std::vector<Grasp> grasps = grasps_of(tool, o.grasp);
  Json json = {{"tool", tool.tool}, {"source", tool.grip.source}, {"grasps", grasps.size()}};
  if (tool.grip.source == "none") {
    json["why"] = "no squeeze was measured";
    return json;
  }
  json["saturated_share"] = tool.grip.force.empty() ? 0.0 : static_cast<double>(tool.grip.saturated) / static_cast<double>(tool.grip.force.size());
  json["summary"] = grasp_summary(grasps);
  if (bands) {
    const GraspErrors errors = errors_of(grasps, *bands);
    const double n = std::max(1.0, static_cast<double>(grasps.size()));
    double minutes = 0.0;
    for (const Grasp& g : grasps) minutes += (g.to - g.from) / 60.0;
    json["errors"] = {{"high", errors.high}, {"low", errors.low}, {"variable", errors.variable},
                      {"per_grasp", (errors.high + errors.low + errors.variable) / n},
                      {"per_active_minute", minutes > 0.0 ? Json((errors.high + errors.low + errors.variable) / minutes) : Json(nullptr)},
                      {"bands", {{"peak_p5_n", bands->peak_low}, {"peak_p95_n", bands->peak_high},
                                 {"variation_p95", bands->variation_high}, {"expert_grasps", bands->n}}}};
  } else {
    json["errors"] = {{"why", "no reference recordings of experts (--reference)"}};
  }
  json["each"] = Json::array();
  for (const Grasp& g : grasps) json["each"].push_back(grasp_json(g));
  return json;
}

// ---- correlation

/// What is known of one window: NaN where it was not measured.
struct WindowValues {
  double force = kNaN, accuracy = kNaN, tremor = kNaN;  // [N], [m], [m]
};

double mean_force(const TimedForce& g, double from, double to) {
  double sum = 0.0, n = 0.0;
  const auto first = std::lower_bound(g.scene.begin(), g.scene.end(), from) - g.scene.begin();
  for (auto k = static_cast<std::size_t>(first); k < g.scene.size() && g.scene[k] < to; ++k, n += 1.0) sum += g.force[k];
  return n > 0.0 ? sum / n : kNaN;
}

double target_error(const ToolSeries& tool, double from, double to) {
  double square = 0.0, n = 0.0;
  for (const auto& [time, error] : tool.target_error) {
    if (time < from || time >= to) continue;
    square += error * error;
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(square / n) : kNaN;
}

std::vector<WindowValues> window_values(const RecordedSession& session, const AnalysisOptions& o) {
  std::vector<WindowValues> all;
  for (const ToolSeries& tool : session.tools) {
    if (tool.target_error.empty() && tool.grip.force.empty()) continue;
    for (double from = 0.0; from + o.window <= session.seconds; from += o.window) {
      WindowValues v;
      v.force = mean_force(tool.grip, from, from + o.window);
      v.accuracy = target_error(tool, from, from + o.window);
      const EvenPath path = tool.hand.cut(from, from + o.window).even();
      TremorOptions once = o.tremor;
      once.shortest = 0.9 * o.window;
      once.welch.segment = 0.45 * o.window;
      const Tremor t = tremor_of(path, std::nullopt, once);
      if (t.measured && !std::isnan(v.accuracy)) v.tremor = std::sqrt(t.bands[1].power.value);
      all.push_back(v);
    }
  }
  return all;
}

Json correlation_json(const Correlation& c, bool within) {
  Json json = {{"n", c.n}, {"r", finite(c.r)}, {"low_95", finite(c.low)}, {"high_95", finite(c.high)},
               {"r_squared", finite(c.r * c.r)}, {"slope", finite(c.slope)}};
  if (within) json["sessions"] = c.groups;
  if (!within) json["spearman"] = finite(c.rank);
  if (!c.why.empty()) json["why"] = c.why;
  return json;
}

ScatterPanel panel_for(const std::vector<std::vector<WindowValues>>& sessions, double WindowValues::*x, double WindowValues::*y,
                       const char* x_label, const char* y_label) {
  ScatterPanel panel{x_label, y_label, {}, {}, {}};
  std::vector<double> mean_x, mean_y;
  for (const auto& windows : sessions) {
    PairGroup group;
    for (const WindowValues& v : windows) {
      if (std::isnan(v.*x) || std::isnan(v.*y)) continue;
      group.x.push_back(v.*x);
      group.y.push_back(v.*y);
    }
    if (!group.x.empty()) {
      double sx = 0.0, sy = 0.0;
      for (std::size_t k = 0; k < group.x.size(); ++k) sx += group.x[k], sy += group.y[k];
      mean_x.push_back(sx / static_cast<double>(group.x.size()));
      mean_y.push_back(sy / static_cast<double>(group.x.size()));
    }
    panel.groups.push_back(std::move(group));
  }
  panel.within = correlate_within(panel.groups);
  panel.across = correlate(mean_x, mean_y);
  return panel;
}

Json all_correlations(const AnalysisInput& input, const AnalysisOptions& o, std::vector<ScatterPanel>& panels) {
  std::vector<std::vector<WindowValues>> sessions;
  for (const RecordedSession& session : input.sessions) sessions.push_back(window_values(session, o));
  panels.push_back(panel_for(sessions, &WindowValues::force, &WindowValues::accuracy, "grasp force [N]", "distance from the target [m]"));
  panels.push_back(panel_for(sessions, &WindowValues::force, &WindowValues::tremor, "grasp force [N]", "tremor 6-12 Hz [m]"));
  panels.push_back(panel_for(sessions, &WindowValues::tremor, &WindowValues::accuracy, "tremor 6-12 Hz [m]", "distance from the target [m]"));
  const char* names[] = {"force_accuracy", "force_tremor", "tremor_accuracy"};
  Json json;
  for (std::size_t i = 0; i < panels.size(); ++i)
    json[names[i]] = {{"within", correlation_json(panels[i].within, true)}, {"across", correlation_json(panels[i].across, false)}};
  json["note"] = "windows of one session follow one another: the interval within is narrower than it should be; tremor is as measured, with the device's noise";
  return json;
}

Json settings_json(const AnalysisOptions& o) {
  return {{"psd", "Welch, Hann window, half overlap, segments freed of their straight line, axes added"},
          {"segment_s", o.tremor.welch.segment},
          {"confidence", o.tremor.welch.confidence},
          {"high_pass_hz", o.tremor.high_pass},
          {"speed_low_pass_hz", 20.0},
          {"sparc_fc_hz", 10.0},
          {"sparc_amplitude", 0.05},
          {"anti_alias_hz", kAntiAlias},
          {"grasp_threshold_n", o.grasp.threshold},
          {"grasp_low_pass_hz", o.grasp.cut_off},
          {"correlation_window_s", o.window}};
}

Json session_json(const AnalysisInput& input, const RecordedSession& session, const std::optional<GraspBands>& bands,
                  const AnalysisOptions& o) {
  Json json = {{"file", session.file}, {"task", session.meta.task}, {"participant", session.meta.participant},
               {"started_utc", session.meta.started_utc}, {"input", session.meta.input}, {"recorded_with", session.meta.program},
               {"seconds", session.seconds}};
  json["tremor"] = all_tremor(input, session, o);
  json["smoothness"] = Json::array();
  json["grasp_force"] = Json::array();
  for (const ToolSeries& tool : session.tools) {
    json["smoothness"].push_back(smoothness_json(tool, true));
    json["smoothness"].push_back(smoothness_json(tool, false));
    json["grasp_force"].push_back(force_json(tool, bands, o));
  }
  return json;
}

}  // namespace

AnalysisReport analyse(const AnalysisInput& input, const std::string& program, const AnalysisOptions& o) {
  AnalysisReport report;
  std::vector<Grasp> experts;
  for (const RecordedSession& session : input.reference)
    for (const ToolSeries& tool : session.tools)
      for (const Grasp& grasp : grasps_of(tool, o.grasp)) experts.push_back(grasp);
  std::optional<GraspBands> bands;
  if (!experts.empty()) bands = bands_of(experts);
  Json sessions = Json::array();
  for (const RecordedSession& session : input.sessions) sessions.push_back(session_json(input, session, bands, o));
  report.json = sessions.front();
  report.json["derived_with"] = program;
  report.json["settings"] = settings_json(o);
  report.json["correlation"] = all_correlations(input, o, report.panels);
  if (input.sessions.size() > 1) report.json["sessions"] = std::move(sessions);
  return report;
}

}  // namespace filum
