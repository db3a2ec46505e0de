#include "analysis/study_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/markup.h"

namespace filum {
namespace {

std::string number(double value, double scale = 1.0) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", scale * value);
  return text;
}

std::string exact(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string cell(const std::string& text) { return "<td>" + text + "</td>"; }

/// J. Cohen, Statistical Power Analysis for the Behavioral Sciences, 2nd ed. (1988), sec. 3.2: 0.1, 0.3, 0.5.
const char* size_of(double r) {
  const double size = std::abs(r);
  return size < 0.1 ? "none" : size < 0.3 ? "small" : size < 0.5 ? "medium" : "large";
}

std::string effect_row(const std::string& head, const char* level, const Correlation& c, const ScatterPanel& panel) {
  std::string html = "<tr>" + head + "<th scope=\"row\">" + level + "</th>" + cell(std::to_string(c.n));
  if (!c.why.empty()) return html + "<td colspan=\"5\" class=\"refused\">" + escaped(c.why) + "</td></tr>";
  const bool open = c.low <= 0.0 && c.high >= 0.0;
  return html + cell(number(c.r) + " [" + number(c.low) + ", " + number(c.high) + "]") + cell(std::string(size_of(c.r)) + (open ? "; the interval holds 0" : "")) +
         cell(number(c.r * c.r)) + cell(number(c.rank)) + cell(number(c.slope * panel.y_scale / panel.x_scale)) + "</tr>";
}

std::string effects(const TaskStudy& task) {
  std::string html = "<table><thead><tr><th scope=\"col\">Pair</th><th scope=\"col\">Level</th><th scope=\"col\">n</th><th scope=\"col\">r [95 %]</th><th scope=\"col\">Size (Cohen)</th>"
                     "<th scope=\"col\">r&sup2;</th><th scope=\"col\">Spearman</th><th scope=\"col\">Slope, in the units of the plot</th></tr></thead><tbody>";
  for (const StudyPair& p : task.pairs) {
    const std::string head = "<th scope=\"rowgroup\" rowspan=\"4\">" + escaped(p.panel.y_label + " over " + p.panel.x_label) + "</th>";
    html += effect_row(head, "within sessions (parts)", p.windows, p.panel) + effect_row("", "across sessions", p.sessions, p.panel) +
            effect_row("", "across the sessions of one person", p.within_people, p.panel) + effect_row("", "across people", p.people, p.panel);
  }
  return html + "</tbody></table>";
}

std::string session_row(const StudySession& s) {
  const std::string tremor = s.tremor_why.empty() ? number(s.mean.tremor, 1e6) : "<span class=\"refused\">not resolved: " + escaped(s.tremor_why) + "</span>";
  const std::string floor = std::isfinite(s.floor) ? number(s.floor, 1e6) + " (" + escaped(s.floor_source) + ")" : escaped(s.floor_source);
  return "<tr><th scope=\"row\">" + escaped(s.started_utc) + "</th>" + cell(escaped(s.participant)) + cell(escaped(s.input)) + cell(number(s.seconds)) + cell(std::to_string(s.parts.size())) +
         cell(number(s.mean.force, 1e3) + (std::isfinite(s.mean.force) ? " (" + s.force_source + ")" : "")) + cell(number(s.mean.accuracy, 1e6)) + cell(tremor) + cell(floor) + "</tr>";
}

std::string session_table(const TaskStudy& task) {
  std::string html = "<table><thead><tr><th scope=\"col\">Started</th><th scope=\"col\">Code</th><th scope=\"col\">Input</th><th scope=\"col\">Time [s]</th><th scope=\"col\">Parts</th><th scope=\"col\">Grasp force [mN]</th>"
                     "<th scope=\"col\">Distance from the target [um]</th><th scope=\"col\">Tremor, 6-12 Hz [um rms]</th><th scope=\"col\">Noise floor [um rms]</th></tr></thead><tbody>";
  for (const StudySession& s : task.sessions) html += session_row(s);
  return html + "</tbody></table>";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::string head_of(const StudySession& s) { return quoted(s.id) + "," + quoted(s.task) + "," + quoted(s.participant) + "," + quoted(s.started_utc) + "," + quoted(s.input); }
std::string values_of(const StudyValues& v) { return exact(v.force) + "," + exact(v.accuracy) + "," + exact(v.tremor); }

constexpr const char* kStyle =
    "body{font:15px sans-serif;max-width:76em;margin:2em auto;padding:0 1em;color:#111;background:#fff}table{border-collapse:collapse;margin:.6em 0}"
    "td,th{border:1px solid #bbb;padding:.3em .6em;text-align:left;vertical-align:top;font-variant-numeric:tabular-nums}th{font-weight:600}.refused{color:#a33}";

constexpr const char* kReading =
    "<p>r is the effect size: Pearson's with Fisher's interval; within sessions or people, of values less their session's or person's mean (repeated-measures correlation). "
    "Parts of one session follow one another, so the interval within sessions is narrower than it should be; three pairs at four levels are asked at once and the intervals are not widened for it. "
    "Grasp force: mean squeeze while something was grasped. Distance: rms from the target, or of an object from its place. Tremor: rms in 6-12 Hz, free of the device's noise floor; "
    "a session whose tremor does not stand out of its device's floor has none.</p>";

}  // namespace

std::string study_plot(const Study& study, const std::string& task) {
  for (const TaskStudy& t : study.tasks) {
    if (t.task != task) continue;
    std::vector<ScatterPanel> panels;
    std::vector<std::string> names;
    for (const StudyPair& p : t.pairs) panels.push_back(p.panel);
    for (const StudySession& s : t.sessions) names.push_back(s.started_utc + (s.participant.empty() ? "" : "  " + s.participant) + "  " + s.input);
    return scatter_svg(panels, names);
  }
  return {};
}

std::string study_page(const Study& study) {
  std::string html = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Filum: study</title><style>" + std::string(kStyle) +
                     "</style><h1>Grasp force, accuracy and tremor</h1>" + kReading;
  for (const TaskStudy& t : study.tasks) {
    const std::string s = t.sessions.size() == 1 ? " session, " : " sessions, ";
    html += "<h2>" + escaped(t.task) + "</h2><p>" + std::to_string(t.sessions.size()) + s + (t.people == 0 ? "no participant codes" : std::to_string(t.people) + (t.people == 1 ? " person" : " people")) + "</p>" +
            study_plot(study, t.task) + effects(t) + session_table(t);
  }
  html += "<h2>Settings</h2><table><tbody>";
  const nlohmann::ordered_json settings = settings_json(study.options);
  for (const auto& [key, value] : settings.items())
    html += "<tr><th scope=\"row\">" + escaped(key) + "</th>" + cell(escaped(value.is_string() ? value.get<std::string>() : value.dump())) + "</tr>";
  return html + "</tbody></table><p>Derived with " + escaped(study.derived_with) + ".</p></html>\n";
}

std::string sessions_csv(const Study& study) {
  std::string csv = "session,task,participant,started_utc,input,seconds,parts,force_n,accuracy_m,tremor_m,force_source,noise_floor_m,noise_floor,tremor_why,recorded_with,derived_with\n";
  for (const TaskStudy& t : study.tasks)
    for (const StudySession& s : t.sessions)
      csv += head_of(s) + "," + exact(s.seconds) + "," + std::to_string(s.parts.size()) + "," + values_of(s.mean) + "," + s.force_source + "," + exact(s.floor) + "," +
             quoted(s.floor_source) + "," + quoted(s.tremor_why) + "," + quoted(s.recorded_with) + "," + quoted(study.derived_with) + "\n";
  return csv;
}

std::string parts_csv(const Study& study) {
  std::string csv = "session,task,participant,started_utc,input,part,force_n,accuracy_m,tremor_m,derived_with\n";
  for (const TaskStudy& t : study.tasks)
    for (const StudySession& s : t.sessions)
      for (std::size_t k = 0; k < s.parts.size(); ++k)
        csv += head_of(s) + "," + std::to_string(k + 1) + "," + values_of(s.parts[k]) + "," + quoted(study.derived_with) + "\n";
  return csv;
}

}  // namespace filum
