#include "world/model_file.h"

namespace filum {

YamlNode open_model_file(const std::string& path, const std::string& format) {
  YamlNode file = YamlNode::load(path);
  if (file.text("format") != format) file.refuse("format", format);
  return file;
}

double measured(const YamlNode& node, const std::string& key, const std::string& unit, const Range& range) {
  const YamlNode field = node.map(key);
  if (field.text("source").empty()) field.refuse("source", "where the number comes from");
  field.quantity("uncertainty", unit, Range::not_negative());
  return field.quantity("value", unit, range);
}

Vec3 read_direction(const YamlNode& node, const std::string& key) {
  const Vec3 v = node.vec3(key, "-");
  if (v.norm() < 1e-6) node.refuse(key, "a direction");
  return v.normalized();
}

Vec3 read_point(const YamlNode& node, const std::string& key) {
  const Vec3 p = node.vec3(key, "mm");
  if (!(p.norm() <= 1.0)) node.refuse(key, "a point within 1000 mm of the origin");
  return p;
}

Pose read_pose(const YamlNode& node) {
  Pose X;
  X.p = read_point(node, "p");
  const Vec3 z = read_direction(node, "handle");
  const Vec3 side = read_direction(node, "opening");
  const Vec3 x = side - side.dot(z) * z;
  if (x.norm() < 1e-6) node.refuse("opening", "a direction that is not along the handle");
  Mat3 r;
  r << x.normalized(), z.cross(x.normalized()), z;
  X.q = Quat(r);
  return X;
}

}  // namespace filum
