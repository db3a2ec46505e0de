#include "devices/forceps_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/yaml_file.h"

namespace filum {
namespace {

constexpr Range kCounts = {0.0, 65535.0, false};

std::uint16_t nearest_count(double count) noexcept {
  return static_cast<std::uint16_t>(std::lround(std::clamp(count, 0.0, 65535.0)));
}

std::optional<ChannelEvidence> read_evidence(const YamlNode& channel, const std::string& unit) {
  if (!channel.has("evidence")) return std::nullopt;
  const YamlNode node = channel.map("evidence");
  ChannelEvidence e;
  e.residual = node.quantity("residual", unit, Range::not_negative());
  e.hysteresis = node.quantity("hysteresis", unit, Range::not_negative());
  e.repeatability = node.quantity("repeatability", unit, Range::not_negative());
  e.from = node.quantity("from", unit);
  e.to = node.quantity("to", unit);
  if (!(e.to > e.from)) node.refuse("to", "more than from");
  for (const YamlNode& point : node.items_or_none("points")) {  // kept for people; checked, not used
    point.quantity("value", unit);
    point.quantity("count", "count", kCounts);
    point.quantity("noise", "count", Range::not_negative());
    point.quantity("residual", unit);
    point.flag("upwards");
  }
  return e;
}

ForcepsCalibration read(const YamlNode& file) {
  file.choice("format", {"filum-forceps/1"});
  ForcepsCalibration c;
  c.name = file.text("name");
  c.source = file.text("source");
  c.identity = static_cast<std::uint32_t>(file.integer_or("identity", 0, 0, std::numeric_limits<int>::max()));
  c.date = file.text_or("date", "");
  c.sensor = file.text_or("sensor", "");
  const YamlNode angle = file.map("angle");
  c.angle_zero = angle.quantity("zero", "count", kCounts);
  c.angle_gain = angle.quantity("gain", "rad/count");
  if (c.angle_gain == 0.0) angle.refuse("gain", "not zero");
  c.angle_uncertainty = angle.quantity("uncertainty", "rad", Range::not_negative());
  c.angle_limit = angle.quantity("limit", "rad", {0.0, std::numbers::pi / 2, true});
  c.angle_evidence = read_evidence(angle, "rad");
  const YamlNode force = file.map("force");
  c.force_evidence = read_evidence(force, "N");
  c.force_zero = force.quantity("zero", "count", kCounts);
  c.force_gain = force.quantity("gain", "N/count");
  if (c.force_gain == 0.0) force.refuse("gain", "not zero");
  c.force_uncertainty = force.quantity("uncertainty", "N", Range::not_negative());
  c.force_limit = force.quantity("limit", "N", {0.0, 50.0, true});
  file.finish();
  return c;
}

}  // namespace

ForcepsCalibration ForcepsCalibration::load(const std::string& path) {
  return read(YamlNode::load(path));
}

ForcepsCalibration ForcepsCalibration::parse(const std::string& text, const std::string& file_name) {
  return read(YamlNode::parse(text, file_name));
}

double ForcepsCalibration::angle(std::uint16_t count) const noexcept {
  return std::clamp(angle_line().value(count), -angle_limit, angle_limit);
}

double ForcepsCalibration::force(std::uint16_t count) const noexcept {
  return std::clamp(force_line().value(count), 0.0, force_limit);
}

std::uint16_t ForcepsCalibration::angle_count(double angle) const noexcept {
  return nearest_count(angle_line().count(angle));
}

std::uint16_t ForcepsCalibration::force_count(double force) const noexcept {
  return nearest_count(force_line().count(force));
}

}  // namespace filum
