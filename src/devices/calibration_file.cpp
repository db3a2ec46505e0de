#include "devices/calibration_file.h"

#include <cstdio>

#include "base/yaml_file.h"

namespace filum {
namespace {

std::vector<CalibrationPoint> read_points(const YamlNode& file, const std::string& key, const std::string& unit) {
  std::vector<CalibrationPoint> points;
  for (const YamlNode& node : file.items(key)) {
    CalibrationPoint p;
    p.value = node.quantity("value", unit, Range::between(-100.0, 100.0));
    p.count = node.quantity("count", "count", Range::between(0.0, 65535.0));
    p.noise = node.quantity_or("noise", "count", 0.0, Range::not_negative());
    p.upwards = node.choice("approached", {"upwards", "downwards"}) == "upwards";
    points.push_back(p);
  }
  return points;
}

CalibrationReadings read(const YamlNode& file) {
  file.choice("format", {"filum-calibration-points/1"});
  CalibrationReadings readings{read_points(file, "angle", "rad"), read_points(file, "force", "N")};
  file.finish();
  return readings;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// Words of people inside double quotes.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text)
    if (c >= ' ' && c != '"' && c != '\\') out += c;
  return out + "\"";
}

std::string channel_text(const std::string& unit, double limit, const std::vector<CalibrationPoint>& points, const CalibrationFit& f) {
  const auto with_unit = [&](double value) { return number(value) + " " + unit; };
  std::string text = "  zero: " + number(f.zero) + " count\n  gain: " + number(f.gain) + " " + unit + "/count\n  uncertainty: " +
                     with_unit(f.uncertainty) + "\n  limit: " + with_unit(limit) + "\n  evidence:\n    residual: " +
                     with_unit(f.residual) + "\n    hysteresis: " + with_unit(f.hysteresis) + "\n    repeatability: " +
                     with_unit(f.repeatability) + "\n    from: " + with_unit(f.from) + "\n    to: " + with_unit(f.to) + "\n    points:\n";
  for (std::size_t k = 0; k < points.size(); ++k) {
    const CalibrationPoint& p = points[k];
    text += "      - { value: " + with_unit(p.value) + ", count: " + number(p.count) + " count, noise: " + number(p.noise) +
            " count, residual: " + with_unit(f.residuals[k]) + ", upwards: " + (p.upwards ? "true" : "false") + " }\n";
  }
  return text;
}

}  // namespace

CalibrationReadings load_readings(const std::string& path) { return read(YamlNode::load(path)); }
CalibrationReadings parse_readings(const std::string& text, const std::string& file_name) {
  return read(YamlNode::parse(text, file_name));
}

std::string calibration_text(const CalibrationHeader& h, const CalibrationReadings& readings, const CalibrationFit& angle,
                             const CalibrationFit& force) {
  return "format: filum-forceps/1\nname: " + quoted(h.name) + "\nsource: \"filum calibrate forceps\"\ndate: " + quoted(h.date) +
         "\nsensor: " + quoted(h.sensor) + "\nidentity: " + std::to_string(h.identity) + "\nangle:\n" +
         channel_text("rad", h.angle_limit, readings.angle, angle) + "force:\n" +
         channel_text("N", h.force_limit, readings.force, force);
}

}  // namespace filum
