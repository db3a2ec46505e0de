#include "analysis/study.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/noise_floor.h"
#include "base/numbers.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kSettle = 2.0;          // [s], in which an object that was let go comes to rest
constexpr double kShortestTremor = 2.0;  // [s]
constexpr std::size_t kFewest = 10;      // readings of the squeeze
constexpr std::size_t kBand = 1;         // 6-12 Hz of tremor.h

// ---- one session

struct Part {
  double from = 0.0, to = 0.0, error_to = 0.0;  // [s]
};

std::vector<Part> parts_of(const ToolSeries& tool, double seconds, double window) {
  std::vector<Part> parts;
  for (std::size_t k = 0; k < tool.held.size(); ++k) {
    const double to = std::min(tool.held[k].to, seconds), next = k + 1 < tool.held.size() ? tool.held[k + 1].from : seconds;
    parts.push_back({tool.held[k].from, to, std::max(to, std::min(to + kSettle, next))});
  }
  if (!parts.empty()) return parts;
  for (double from = 0.0; from + window <= seconds; from += window) parts.push_back({from, from + window, from + window});
  return parts;
}

double grasp_force(const TimedForce& g, double from, double to, double threshold) {
  double sum = 0.0;
  std::size_t n = 0;
  const auto first = std::lower_bound(g.scene.begin(), g.scene.end(), from) - g.scene.begin();
  for (auto k = static_cast<std::size_t>(first); k < g.scene.size() && g.scene[k] < to; ++k) {
    if (!(g.force[k] > threshold)) continue;
    sum += g.force[k];
    ++n;
  }
  return n >= kFewest ? sum / static_cast<double>(n) : kNaN;
}

double target_error(const ToolSeries& tool, double from, double to) {
  double square = 0.0, n = 0.0;
  for (const auto& [time, error] : tool.target_error) {
    if (time < from || time > to) continue;
    square += error * error;
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(square / n) : kNaN;
}

double tremor_power(const ToolSeries& tool, const Part& part, const AnalysisOptions& o) {
  TremorOptions once = o.tremor;
  once.shortest = std::max(kShortestTremor, 0.9 * std::min(o.window, part.to - part.from));
  once.welch.segment = 0.45 * std::min(o.window, part.to - part.from);
  const Tremor t = tremor_of(tool.hand.cut(part.from, part.to).even(), std::nullopt, once);
  return t.measured ? t.bands[kBand].power.value : kNaN;
}

/// Whether the session's tremor stands out of its device's noise: in one of its holds, or as a whole where it has none.
void judge_tremor(const RecordedSession& session, const ToolSeries& tool, const RecordedSession* clamped, const AnalysisOptions& o, StudySession& s) {
  std::vector<Window> windows = tool.holds;
  if (windows.empty()) windows.push_back({"whole session", 0.0, session.seconds});
  s.tremor_why = "no readings of the tool's position";
  for (const Window& w : windows) {
    const EvenPath path = tool.hand.cut(w.from, w.to).even();
    const NoiseFloor floor = noise_floor(session, clamped, tool.tool, true, path);
    const Tremor t = tremor_of(path, floor.path, o.tremor);
    s.floor_source = floor.source;
    if (!t.measured) {
      s.tremor_why = t.why;
      continue;
    }
    const TremorBand& band = t.bands[kBand];
    s.floor = std::sqrt(band.floor);
    s.tremor_why = band.why;
    if (band.resolved) return;
  }
}

/// The tool that the task looks at; else the first that squeezed.
const ToolSeries* tool_studied(const RecordedSession& session) {
  for (const ToolSeries& t : session.tools)
    if (!t.target_error.empty()) return &t;
  for (const ToolSeries& t : session.tools)
    if (!t.grip.force.empty()) return &t;
  return nullptr;
}

double mean_known(const std::vector<StudyValues>& parts, double StudyValues::*value) {
  double sum = 0.0, n = 0.0;
  for (const StudyValues& v : parts) {
    if (std::isnan(v.*value)) continue;
    sum += v.*value;
    n += 1.0;
  }
  return n > 0.0 ? sum / n : kNaN;
}

// ---- all of them

struct Measure {
  double StudyValues::*value;
  const char* label;
  double scale;
};
constexpr Measure kForce{&StudyValues::force, "grasp force [mN]", 1e3}, kAccuracy{&StudyValues::accuracy, "distance from the target [um]", 1e6},
    kTremor{&StudyValues::tremor, "tremor, 6-12 Hz [um]", 1e6};

bool both(const StudyValues& v, const Measure& x, const Measure& y) { return !std::isnan(v.*x.value) && !std::isnan(v.*y.value); }

/// Means of the sessions' pairs, in one group or in one for each person.
PairGroup session_means(const std::vector<PairGroup>& sessions) {
  PairGroup means;
  for (const PairGroup& g : sessions) {
    if (g.x.empty()) continue;
    const auto mean = [](const std::vector<double>& v) {
      double sum = 0.0;
      for (const double value : v) sum += value;
      return sum / static_cast<double>(v.size());
    };
    means.x.push_back(mean(g.x));
    means.y.push_back(mean(g.y));
  }
  return means;
}

StudyPair pair_of(const char* name, const Measure& x, const Measure& y, const std::vector<StudySession>& sessions) {
  StudyPair pair;
  pair.name = name;
  std::map<std::string, std::vector<PairGroup>> people;
  for (const StudySession& s : sessions) {
    PairGroup group;
    for (const StudyValues& v : s.parts) {
      if (!both(v, x, y)) continue;
      group.x.push_back(v.*x.value);
      group.y.push_back(v.*y.value);
    }
    if (!s.participant.empty()) people[s.participant].push_back(group);
    pair.panel.groups.push_back(std::move(group));
  }
  std::vector<PairGroup> of_people;
  for (const auto& [code, groups] : people) of_people.push_back(session_means(groups));
  const PairGroup all = session_means(pair.panel.groups), means = session_means(of_people);
  pair.windows = pair.panel.within = correlate_within(pair.panel.groups);
  pair.sessions = pair.panel.across = correlate(all.x, all.y);
  pair.within_people = correlate_within(of_people);
  pair.people = correlate(means.x, means.y);
  if (!pair.within_people.why.empty()) pair.within_people.why = "too few people with several sessions under one code";
  if (!pair.people.why.empty() && pair.people.n < 4) pair.people.why = "fewer than 4 people";
  pair.panel.x_label = x.label;
  pair.panel.y_label = y.label;
  pair.panel.x_scale = x.scale;
  pair.panel.y_scale = y.scale;
  return pair;
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json values_json(const StudyValues& v) {
  return {{"force_n", finite(v.force)}, {"accuracy_m", finite(v.accuracy)}, {"tremor_m", finite(v.tremor)}};
}

Json session_json(const StudySession& s) {
  Json json = {{"id", s.id},           {"task", s.task},       {"participant", s.participant},   {"started_utc", s.started_utc},
               {"input", s.input},     {"recorded_with", s.recorded_with}, {"seconds", s.seconds}, {"mean", values_json(s.mean)},
               {"force_source", s.force_source}, {"noise_floor_m", finite(s.floor)}, {"noise_floor", s.floor_source}};
  if (!s.tremor_why.empty()) json["tremor_why"] = s.tremor_why;
  json["parts"] = Json::array();
  for (const StudyValues& v : s.parts) json["parts"].push_back(values_json(v));
  return json;
}

}  // namespace

StudySession study_session(const RecordedSession& session, const RecordedSession* clamped, const AnalysisOptions& o) {
  StudySession s{session.file,       session.meta.task,    session.meta.participant, session.meta.started_utc, session.meta.input,
                 session.meta.program, session.seconds, {}, {}, "none", kNaN, "not measured", "no tool was moved"};
  const ToolSeries* tool = tool_studied(session);
  if (!tool) return s;
  s.force_source = tool->grip.source;
  judge_tremor(session, *tool, clamped, o, s);
  for (const Part& part : parts_of(*tool, session.seconds, o.window)) {
    StudyValues v;
    v.force = grasp_force(tool->grip, part.from, part.to, o.grasp.threshold);
    v.accuracy = target_error(*tool, part.from, part.error_to);
    // Away from the target the tip is on its way: what is in the band then is no tremor.
    if (s.tremor_why.empty() && !std::isnan(v.accuracy)) v.tremor = std::sqrt(std::max(0.0, tremor_power(*tool, part, o) - s.floor * s.floor));
    s.parts.push_back(v);
  }
  s.mean = {mean_known(s.parts, &StudyValues::force), mean_known(s.parts, &StudyValues::accuracy), mean_known(s.parts, &StudyValues::tremor)};
  return s;
}

std::array<StudyPair, 3> study_pairs(const std::vector<StudySession>& sessions) {
  return {pair_of("force_accuracy", kForce, kAccuracy, sessions), pair_of("force_tremor", kForce, kTremor, sessions),
          pair_of("tremor_accuracy", kTremor, kAccuracy, sessions)};
}

Study study_of(const std::vector<StudySession>& sessions, const std::string& program, const AnalysisOptions& options) {
  std::map<std::string, std::vector<StudySession>> by_task;
  for (const StudySession& s : sessions) by_task[s.task].push_back(s);
  Study study{{}, program, options};
  for (auto& [task, of_task] : by_task) {
    std::set<std::string> people;
    for (const StudySession& s : of_task)
      if (!s.participant.empty()) people.insert(s.participant);
    auto pairs = study_pairs(of_task);
    study.tasks.push_back({task, std::move(of_task), people.size(), std::move(pairs)});
  }
  return study;
}

Json correlation_json(const Correlation& c) {
  Json json = {{"n", c.n}, {"r", finite(c.r)}, {"low_95", finite(c.low)}, {"high_95", finite(c.high)}, {"r_squared", finite(c.r * c.r)}, {"slope", finite(c.slope)}};
  if (c.groups > 0) json["groups"] = c.groups;
  if (std::isfinite(c.rank)) json["spearman"] = c.rank;
  if (!c.why.empty()) json["why"] = c.why;
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
          {"anti_alias_hz", kSmoothnessAntiAlias},
          {"grasp_threshold_n", o.grasp.threshold},
          {"grasp_low_pass_hz", o.grasp.cut_off},
          {"correlation_window_s", o.window}};
}

Json study_json(const Study& study) {
  Json json = {{"derived_with", study.derived_with}, {"settings", settings_json(study.options)}, {"tasks", Json::array()}};
  for (const TaskStudy& t : study.tasks) {
    Json task = {{"task", t.task}, {"people", t.people}, {"correlation", Json::object()}, {"sessions", Json::array()}};
    for (const StudyPair& p : t.pairs)
      task["correlation"][p.name] = {{"windows", correlation_json(p.windows)}, {"sessions", correlation_json(p.sessions)},
                                     {"within_people", correlation_json(p.within_people)}, {"people", correlation_json(p.people)}};
    for (const StudySession& s : t.sessions) task["sessions"].push_back(session_json(s));
    json["tasks"].push_back(std::move(task));
  }
  return json;
}

}  // namespace filum
