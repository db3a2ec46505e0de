#include "analysis/report.h"

#include <algorithm>
#include <cmath>

#include "analysis/noise_floor.h"
#include "analysis/study.h"
#include "training/metrics.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kSmoothnessRate = 100.0;  // [Hz]

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// ---- tremor

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

Json tremor_json(const Tremor& t, const EvenPath& path, const NoiseFloor& floor) {
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
        const NoiseFloor floor = noise_floor(session, input.clamped ? &*input.clamped : nullptr, tool.tool, hand, path);
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
    if (every > 1) x = low_pass(x, path.fs, kSmoothnessAntiAlias);
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
  for (std::size_t i = 0; i < even.stretches.size(); ++i) {
    const Points& stretch = even.stretches[i];
    std::vector<double> force(static_cast<std::size_t>(stretch.cols()));
    for (Eigen::Index k = 0; k < stretch.cols(); ++k) force[static_cast<std::size_t>(k)] = stretch(0, k);
    const std::vector<Grasp> found = find_grasps(force, even.fs, even.starts[i], tool.held, o, [&](double t) { return g.scene_time(t); });
    all.insert(all.end(), found.begin(), found.end());
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
  if (tool.grip.foreign) json["warning"] = "recorded with the calibration of another handle: openings and forces may be wrong";
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

Json all_correlations(const AnalysisInput& input, const AnalysisOptions& o, std::vector<ScatterPanel>& panels) {
  std::vector<StudySession> sessions;
  for (const RecordedSession& session : input.sessions) sessions.push_back(study_session(session, input.clamped ? &*input.clamped : nullptr, o));
  Json json;
  for (const StudyPair& pair : study_pairs(sessions)) {
    panels.push_back(pair.panel);
    json[pair.name] = {{"within", correlation_json(pair.windows)}, {"across", correlation_json(pair.sessions)},
                       {"within_people", correlation_json(pair.within_people)}, {"people", correlation_json(pair.people)}};
  }
  json["note"] = "parts of one session follow one another: the interval within is narrower than it should be; tremor is free of the device's noise floor and counts only where it stands out of it";
  return json;
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
