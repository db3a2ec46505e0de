#include "server/encode_brain.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "server/vector_json.h"

namespace filum {
namespace {

using nlohmann::json;

constexpr double kMmHg = 133.322387415;  // [Pa]

json flat(const Points& p) {
  json list = json::array();
  for (Eigen::Index k = 0; k < p.size(); ++k) list.push_back(std::round(p.data()[k] * 1e7) / 1e7);
  return list;
}

json flat(const std::vector<std::array<int, 3>>& triangles) {
  json list = json::array();
  for (const auto& t : triangles)
    for (const int i : t) list.push_back(i);
  return list;
}

/// Six digits are a micrometre in a field of some centimetres.
void append(std::string& out, const double* x, int n, double scale) {
  out.push_back('[');
  for (int i = 0; i < n; ++i) {
    char buffer[32];
    const double value = std::isfinite(x[i]) ? x[i] * scale : 0.0;
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 6);
    if (i > 0) out.push_back(',');
    out.append(buffer, end.ptr);
  }
  out.push_back(']');
}

}  // namespace

json brain_scene_json(const BrainDescription& b, int n_tools) {
  if (b.triangles.empty()) return nullptr;
  json blades = json::array(), veins = json::array();
  const auto n = static_cast<std::size_t>(n_tools);  // see describe_brain()
  const bool has_falx = b.blades.back().name == "falx";
  for (std::size_t i = 0; i < n; ++i) {
    json forms = json::array();
    for (std::size_t k = i; k < b.blades.size() - (has_falx ? 1 : 0); k += n) {
      const BladeDescription& form = b.blades[k];
      const std::string name = k < n ? form.name + ", " + std::to_string(std::lround(1e3 * form.width)) + " mm" : form.name;
      forms.push_back({{"name", name}, {"vertices", flat(form.vertices)}, {"triangles", flat(form.triangles)}, {"width", form.width}, {"grip", form.grip}});
    }
    blades.push_back({{"name", b.blades[i].name}, {"forms", forms}});
  }
  for (const VeinShape& v : b.veins) veins.push_back({{"vertex", v.vertex}, {"dura", vector_json(v.dura_W)}});
  return {{"name", b.name},
          {"triangles", flat(b.triangles)},
          {"rest", flat(b.rest)},
          {"blades", blades},
          {"veins", veins},
          {"target", b.target_radius > 0.0 ? json{{"position", vector_json(b.target_W)}, {"radius", b.target_radius}} : json()},
          {"section", {{"rest", flat(b.section_rest)}, {"triangles", flat(b.section_triangles)}}},
          {"falx", has_falx ? json{{"y", b.blades.back().vertices(1, 0)}, {"bottom", b.blades.back().vertices(2, 0)}, {"top", b.blades.back().vertices(2, 2)}} : json()},
          {"bone", b.bone_y < 0.0 ? json(b.bone_y) : json()},
          {"time_compression", b.time_compression}};
}

json retraction_json(const RetractionView& r) {
  if (!r.present) return nullptr;
  return {{"blind", r.blind},           {"pressure", r.pressure},     {"band", r.band},         {"dose", r.dose},   {"dose_band", r.dose_band}, {"loaded", r.loaded},
          {"perfusion", r.perfusion},   {"bands", r.bands},       {"dose_bands", r.dose_bands}, {"alarm", r.alarm},
          {"label", r.label},           {"version", r.version},   {"source", r.source}};
}

std::string brain_frame_text(const Observation& o) {
  const BrainObservation& b = o.brain;
  if (b.n == 0) return "null";
  std::string out;
  out.reserve(static_cast<std::size_t>(b.n) * 40);
  out += "{\"positions\":";
  append(out, b.positions.data(), 3 * b.n, 1.0);
  out += ",\"pressure\":";
  append(out, b.pressure.data(), b.n, 1.0 / kMmHg);
  out += ",\"blades\":[";
  for (int i = 0; i < b.n_blades; ++i) {
    const BladeObservation& blade = b.blades[static_cast<std::size_t>(i)];
    const double row[5] = {blade.force_W.norm(), blade.area * 1e4, blade.peak / kMmHg, blade.mean / kMmHg, blade.tip / kMmHg};
    constexpr const char* kNames[5] = {"force", "area", "peak", "mean", "tip"};
    out += i > 0 ? ",{" : "{";
    for (int k = 0; k < 5; ++k) {
      std::string value;
      append(value, row + k, 1, 1.0);
      out += std::string("\"") + kNames[k] + "\":" + value.substr(1, value.size() - 2) + ",";
    }
    out += "\"form\":" + std::to_string(std::max(0, o.tools[static_cast<std::size_t>(i)].grasped_edge)) + ",";
    out += std::string("\"parked\":") + (blade.parked ? "true" : "false") + ",\"keeps_force\":" + (blade.keeps_force ? "true" : "false") + "}";
  }
  out += "],\"exposed\":";
  std::string exposed;
  append(exposed, &b.exposed, 1, 1.0);
  out += exposed.substr(1, exposed.size() - 2) + ",\"veins_torn\":[";
  for (std::size_t k = 0; k < b.vein_torn.size(); ++k) out += std::string(k > 0 ? "," : "") + (b.vein_torn[k] != 0 ? "1" : "0");
  out += "],\"section\":{\"positions\":";
  append(out, b.section.data(), static_cast<int>(b.section.size()), 1.0);
  out += ",\"stress\":";
  append(out, b.section_stress.data(), static_cast<int>(b.section_stress.size()), 1e-3);
  return out + "}}";
}

}  // namespace filum
