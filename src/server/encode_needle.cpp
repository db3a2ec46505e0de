#include "server/encode_needle.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace filum {
namespace {

using nlohmann::json;

void append(std::string& out, const double* x, int n, int digits) {
  out.push_back('[');
  for (int i = 0; i < n; ++i) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, std::isfinite(x[i]) ? x[i] : 0.0, std::chars_format::general, digits);
    if (i > 0) out.push_back(',');
    out.append(buffer, end.ptr);
  }
  out.push_back(']');
}

json place_json(const GuidePlace& p) {
  json path = json::array();
  for (const Vec3& point : p.path)
    for (int c = 0; c < 3; ++c) path.push_back(std::round(point[c] * 1e8) / 1e8);
  return {{"at", {p.at.x(), p.at.y(), p.at.z()}}, {"vertex", p.vertex}, {"path", path}};
}

const char* word(PassObservation::State state) {
  switch (state) {
    case PassObservation::State::open:
      return "open";
    case PassObservation::State::needle:
      return "needle";
    case PassObservation::State::thread:
      return "thread";
    case PassObservation::State::pulled_out:
      return "pulled-out";
    case PassObservation::State::torn:
      return "torn";
  }
  return "open";
}

/// null without clamps; the gaps' places only where something comes out.
void append_blood(std::string& out, const BloodObservation& b) {
  if (!b.present) {
    out += "null";
    return;
  }
  constexpr double kMlPerMin = 60e6, kMmHg = 133.322;
  out += "{\"clamps\":[";
  for (std::size_t k = 0; k < static_cast<std::size_t>(b.n_clamps); ++k) {
    const Quat& q = b.clamp_W[k].q;
    const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
    out += k > 0 ? ",{\"position\":" : "{\"position\":";
    append(out, b.clamp_W[k].p.data(), 3, 6);
    out += ",\"quaternion\":";
    append(out, wxyz, 4, 6);
    out.append(",\"off\":").append(b.off[k] ? "true}" : "false}");
  }
  const std::array<double, 2> pressure = {b.pressure[0] / kMmHg, b.pressure[1] / kMmHg};
  std::array<double, kLeakSectors> leak{};
  std::transform(b.leak.begin(), b.leak.end(), leak.begin(), [](double q) { return kMlPerMin * q; });
  const double share = b.lumen_length > 0.0 ? 1.0 / b.lumen_length : 0.0;
  const std::array<double, 2> flow = {kMlPerMin * b.through, 1e6 * b.lost}, empty = {share * b.empty_from, share * b.empty_to};
  const auto numbers = [&out](const char* key, const double* x, int n) {
    out.append(",\"").append(key).append("\":");
    append(out, x, n, 5);
  };
  out += "]";
  numbers("pressure", pressure.data(), 2);
  numbers("leak", leak.data(), kLeakSectors);
  numbers("place", b.place[0].data(), 3 * kLeakSectors);
  numbers("empty", empty.data(), 2);
  static constexpr std::array<const char*, 4> kMilking = {"none", "stripping", "filling", "over"};
  out.append(",\"through\":").append(json(flow[0]).dump()).append(",\"lost\":").append(json(flow[1]).dump());
  out.append(",\"milking\":\"").append(kMilking[static_cast<std::size_t>(b.milking)]).append("\"}");
}

}  // namespace

json needle_scene_json(const NeedleDescription& n) {
  if (!n.present) return nullptr;
  return {{"name", n.name}, {"wire_radius", n.wire_radius}, {"bend_radius", n.bend_radius}, {"angle", n.angle}, {"taper", n.taper}};
}

json tissue_scene_json(const TissueDescription& t) {
  if (t.triangles.empty()) return nullptr;
  json triangles = json::array(), rest = json::array();
  for (const auto& corners : t.triangles)
    for (const int i : corners) triangles.push_back(i);
  for (Eigen::Index k = 0; k < t.rest.size(); ++k) rest.push_back(std::round(t.rest.data()[k] * 1e8) / 1e8);
  return {{"name", t.name}, {"kind", t.kind}, {"thickness", t.thickness}, {"radius", t.radius}, {"clamp_reach", t.clamp_reach}, {"second", t.second}, {"triangles", triangles}, {"rest", rest}};
}

json guide_json(const StitchGuide& guide) { return {{"in", place_json(guide.in)}, {"out", place_json(guide.out)}}; }

std::string needle_frame_text(const NeedleObservation& n) {
  if (!n.present) return "null";
  const double wxyz[4] = {n.X_WN.q.w(), n.X_WN.q.x(), n.X_WN.q.y(), n.X_WN.q.z()};
  std::string out = "{\"pose\":{\"position\":";
  append(out, n.X_WN.p.data(), 3, 8);
  out += ",\"quaternion\":";
  append(out, wxyz, 4, 8);
  out += "},\"held\":[";
  for (std::size_t i = 0; i < n.held.size(); ++i) out.append(i > 0 ? "," : "").append(n.held[i] ? "true" : "false");
  return out + "]}";
}

std::string tissue_frame_text(const TissueObservation& t) {
  if (t.n == 0) return "null";
  std::string out = "{\"positions\":";
  append(out, t.positions.data(), static_cast<int>(t.positions.size()), 6);
  out += ",\"passes\":[";
  for (int k = 0; k < t.n_passes; ++k) {
    const PassObservation& p = t.passes[static_cast<std::size_t>(k)];
    out.append(k > 0 ? ",{\"state\":\"" : "{\"state\":\"").append(word(p.state)).append("\",\"entry\":");
    append(out, p.entry_W.data(), 3, 6);
    out += ",\"exit\":";
    if (p.out) append(out, p.exit_W.data(), 3, 6);
    else out += "null";
    out += "}";
  }
  out += "],\"blood\":";
  append_blood(out, t.blood);
  return out + "}";
}

std::string overlay_text(const OverlayView& overlay) {
  if (overlay.kind.empty() || overlay.values == nullptr) return "null";
  std::vector<double> shown = *overlay.values;
  for (double& value : shown) value *= overlay.factor;
  std::string out = "{\"kind\":\"" + overlay.kind + "\",\"unit\":\"" + overlay.unit + "\",\"full\":" + json(overlay.full).dump() + ",\"values\":";
  append(out, shown.data(), static_cast<int>(shown.size()), 3);
  return out + "}";
}

}  // namespace filum
