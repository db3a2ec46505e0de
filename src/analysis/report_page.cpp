#include "analysis/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/markup.h"

namespace filum {
namespace {

using Json = nlohmann::ordered_json;

std::string number(const Json& value, double scale = 1.0) {
  if (!value.is_number()) return "-";
  char text[32];
  const double v = scale * value.get<double>();
  std::snprintf(text, sizeof text, std::abs(v) >= 999.5 ? "%.0f" : "%.3g", std::abs(v) < 1e-9 ? 0.0 : v);  // rounding errors are no measurement
  return text;
}

std::string cell(const std::string& text) { return "<td>" + text + "</td>"; }
std::string heading(const Json& t) {
  return "tool " + std::to_string(t["tool"].get<int>()) + ", " + t["space"].get<std::string>() + " space";
}

/// Density over frequency, 0-25 Hz, logarithmic over six decades below its highest value; dashed, the device's noise floor as a mean over
/// each band.
std::string spectrum_svg(const Json& t) {
  constexpr double kWidth = 520.0, kHeight = 200.0, kTo = 25.0;
  constexpr int kDecades = 6;
  const Json& spectrum = t["spectrum"];
  double highest = 0.0;
  for (const Json& d : spectrum["density_m2_per_hz"]) highest = std::max(highest, d.get<double>());
  if (!(highest > 0.0)) return "<p>no power at all</p>";
  const int top = static_cast<int>(std::ceil(std::log10(1e12 * highest)));  // of um^2/Hz
  const auto x = [&](double f) { return kWidth * f / kTo; };
  const auto y = [&](double density) { return std::clamp((top - std::log10(std::max(1e12 * density, 1e-30))) / kDecades, 0.0, 1.0) * kHeight; };
  std::string points, floor, axes;
  char text[200];
  for (std::size_t k = 0; k < spectrum["frequency_hz"].size(); ++k) {
    std::snprintf(text, sizeof text, "%.1f,%.1f ", x(spectrum["frequency_hz"][k].get<double>()), y(spectrum["density_m2_per_hz"][k].get<double>()));
    points += text;
  }
  for (const Json& b : t["bands"]) {
    if (!b["noise_floor_rms_m"].is_number() || b["from_hz"] == 8.0) continue;  // 8-12 Hz lies within 6-12 Hz
    const double from = b["from_hz"], to = b["to_hz"], rms = b["noise_floor_rms_m"];
    if (!(rms > 0.0)) continue;
    std::snprintf(text, sizeof text, "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#009E73\" stroke-width=\"2\" stroke-dasharray=\"5 3\"/>", x(from), y(rms * rms / (to - from)), x(to));
    floor += text;
  }
  for (int f = 0; f <= 25; f += 5) {
    std::snprintf(text, sizeof text, "<text x=\"%.0f\" y=\"214\" text-anchor=\"middle\">%d Hz</text>", x(f), f);
    axes += text;
  }
  for (int d = 0; d <= kDecades; d += 2) {
    const double at = kHeight * d / kDecades;
    std::snprintf(text, sizeof text, "<path d=\"M-4 %.1fH0\" stroke=\"#888\"/><text x=\"-7\" y=\"%.1f\" text-anchor=\"end\">1e%d</text>", at, at + 4.0, top - d);
    axes += text;
  }
  std::snprintf(text, sizeof text, "<rect x=\"%.1f\" y=\"0\" width=\"%.1f\" height=\"200\" fill=\"#0072B2\" opacity=\"0.12\"/>", x(8.0), x(4.0));
  return "<svg viewBox=\"-64 -8 610 232\" width=\"610\" font-size=\"11\" font-family=\"sans-serif\" role=\"img\" aria-label=\"Power spectral density\">" + std::string(text) +
         "<rect width=\"520\" height=\"200\" fill=\"none\" stroke=\"#888\"/><text transform=\"rotate(-90)\" x=\"-100\" y=\"-46\" text-anchor=\"middle\">density [um&sup2;/Hz]</text>" + axes +
         floor + "<polyline fill=\"none\" stroke=\"#D55E00\" stroke-width=\"1.5\" points=\"" + points + "\"/></svg><p>Shaded: 8-12 Hz" + (floor.empty() ? "" : "; dashed: the device's noise floor") + ".</p>";
}

std::string tremor_html(const Json& t) {
  std::string html = "<h3>Tremor, " + heading(t) + ", " + escaped(t["window"].get<std::string>()) + "</h3>";
  if (t.contains("note")) html += "<p>" + escaped(t["note"].get<std::string>()) + "</p>";
  if (!t["resolved"].get<bool>()) html += "<p class=\"refused\">Not resolved: " + escaped(t.value("why", "")) + "</p>";
  html += "<p>" + number(t["seconds"]) + " s at " + number(t["rate_hz"]) + " Hz, " + number(t["gaps"]) + " gaps, jitter " +
          number(t["jitter_ms"]) + " ms; noise floor: " + escaped(t["noise_floor"].get<std::string>()) + "</p>";
  if (!t["measured"].get<bool>()) return html;
  html += "<table><tr><th>band</th><th>rms</th><th>as measured (95 %)</th><th>noise floor</th></tr>";
  for (const Json& b : t["bands"]) {
    const auto root = [](const Json& power) { return power.is_number() ? Json(std::sqrt(power.get<double>())) : Json(); };
    html += "<tr>" + cell(number(b["from_hz"]) + "-" + number(b["to_hz"]) + " Hz") +
            cell(b["resolved"].get<bool>() ? number(b["rms_m"], 1e6) + " um" : escaped(b.value("why", ""))) +
            cell(number(root(b["power_m2"]), 1e6) + " um (" + number(root(b["power_low_m2"]), 1e6) + "-" + number(root(b["power_high_m2"]), 1e6) + ")") +
            cell(number(b["noise_floor_rms_m"], 1e6) + " um") + "</tr>";
  }
  html += "</table>";
  if (t.contains("peak_hz"))
    html += "<p>Peak " + number(t["peak_hz"]) + " Hz, half-power width " + number(t["half_power_width_hz"]) + " Hz (resolution " +
            number(t["resolution_hz"]) + " Hz)</p>";
  return html + spectrum_svg(t);
}

std::string spread_text(const Json& s, double scale = 1.0) {
  if (s["n"] == 0) return "none";
  return number(s["median"], scale) + " (" + number(s["q1"], scale) + " to " + number(s["q3"], scale) + ", n " + number(s["n"]) + ")";
}

std::string smoothness_html(const Json& list) {
  std::string html = "<h3>Smoothness</h3><table><tr><th></th><th>movements</th><th>path</th><th>SPARC</th><th>SPARC, 20 Hz</th><th>LDLJ</th></tr>";
  for (const Json& s : list) {
    html += "<tr>" + cell(heading(s));
    if (s.contains("why")) {
      html += "<td colspan=\"5\">" + escaped(s["why"].get<std::string>()) + "</td></tr>";
      continue;
    }
    html += cell(number(s["movements"])) + cell(number(s["path_length_m"], 1e3) + " mm") + cell(spread_text(s["sparc"])) +
            cell(spread_text(s["sparc_fc20"])) + cell(s["ldlj"].contains("why") ? escaped(s["ldlj"]["why"].get<std::string>()) : spread_text(s["ldlj"])) + "</tr>";
  }
  return html + "</table>";
}

std::string force_html(const Json& list) {
  std::string html = "<h3>Grasp force</h3><table><tr><th></th><th>grasps</th><th>peak [N]</th><th>rise [N/s]</th><th>overshoot [N]</th>"
                     "<th>variation</th><th>over the slip limit [N]</th><th>errors high, low, variable</th></tr>";
  for (const Json& f : list) {
    html += "<tr>" + cell("tool " + number(f["tool"]) + ", " + escaped(f["source"].get<std::string>())) + cell(number(f["grasps"]));
    if (!f.contains("summary")) {
      html += "<td colspan=\"6\">" + escaped(f.value("why", "")) + "</td></tr>";
      continue;
    }
    for (const char* key : {"peak_n", "rise_n_per_s", "overshoot_n", "variation", "excess_over_slip_limit_n"}) html += cell(spread_text(f["summary"][key]));
    const Json& e = f["errors"];
    html += cell(e.contains("why") ? escaped(e["why"].get<std::string>()) : number(e["high"]) + ", " + number(e["low"]) + ", " + number(e["variable"])) + "</tr>";
  }
  html += "</table>";
  for (const Json& f : list)
    if (f.contains("warning")) html += "<p class=\"refused\">Tool " + number(f["tool"]) + ": " + escaped(f["warning"].get<std::string>()) + ".</p>";
  for (const Json& f : list)
    if (f.value("saturated_share", 0.0) > 0.0)
      html += "<p class=\"refused\">Tool " + number(f["tool"]) + ": " + number(f["saturated_share"], 100.0) + " % of the readings at the end of the amplifier's range: peaks are larger than shown.</p>";
  return html;
}

std::string session_html(const Json& s) {
  std::string html = "<h2>" + escaped(s["task"].get<std::string>()) + ", " + escaped(s["started_utc"].get<std::string>()) + "</h2><p>" +
                     escaped(s["file"].get<std::string>()) + "; input: " + escaped(s["input"].get<std::string>()) + "; recorded with " +
                     escaped(s["recorded_with"].get<std::string>()) + "</p>";
  for (const Json& t : s["tremor"]) html += tremor_html(t);
  return html + smoothness_html(s["smoothness"]) + force_html(s["grasp_force"]);
}

}  // namespace

std::string report_page(const AnalysisReport& report) {
  const Json& json = report.json;
  std::string html =
      "<!doctype html><meta charset=\"utf-8\"><title>Filum: analysis</title><style>body{font:15px sans-serif;max-width:70em;margin:2em auto}"
      "table{border-collapse:collapse}td,th{border:1px solid #bbb;padding:.3em .6em;text-align:left}.refused{color:#a33}</style><h1>Analysis</h1>";
  std::vector<std::string> names;
  if (json.contains("sessions")) {
    for (const Json& session : json["sessions"]) {
      html += session_html(session);
      names.push_back(session["file"].get<std::string>());
    }
  } else {
    html += session_html(json);
    names.push_back(json["file"].get<std::string>());
  }
  html += "<h2>Grasp force, accuracy and tremor</h2><p>" + escaped(json["correlation"]["note"].get<std::string>()) + "</p>" +
          scatter_svg(report.panels, names) + "<h2>Settings</h2><table>";
  for (const auto& [key, value] : json["settings"].items()) html += "<tr>" + cell(escaped(key)) + cell(escaped(value.is_string() ? value.get<std::string>() : value.dump())) + "</tr>";
  return html + "</table><p>Derived with " + escaped(json["derived_with"].get<std::string>()) + ".</p>\n";
}

}  // namespace filum
