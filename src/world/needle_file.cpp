#include "world/needle_file.h"

#include "base/units.h"
#include "world/describe.h"
#include "world/model_file.h"
#include "world/needle_model.h"

namespace filum {
namespace {

// Needles of microsurgery and of the ward, widely taken: a slip of unit or exponent is refused, no needle is.
constexpr Range kNeedleLength{5e-4, 0.1};      // [m], along the wire
constexpr Range kNeedleDensity{500.0, 25e3};   // [kg/m3], plastics to tungsten
constexpr Range kGripStiffness{1.0, 1e7};      // [N/m]

}  // namespace

NeedleShape load_needle(const std::string& path) {
  const YamlNode file = open_model_file(path, "filum-needle/1");
  NeedleShape n;
  n.name = file.text("title");
  n.wire_radius = 0.5 * measured(file, "wire", "um", {20e-6, 500e-6});
  n.circle = measured(file, "circle", "-", Range::between(0.1, 0.7));
  n.bend_radius = measured(file, "length", "mm", kNeedleLength) / n.angle();
  n.density = measured(file, "density", "kg/m3", kNeedleDensity);
  n.taper = measured(file, "taper", "mm", {1e-5, n.length()});
  n.flat_width = measured(file, "flat_width", "um", Range::between(0.0, 2.0 * n.wire_radius));
  n.pad_friction = measured(file, "pad_friction", "-", Range::between(0.0, 2.0));
  n.sheet_friction = measured(file, "sheet_friction", "-", Range::between(0.0, 2.0));
  n.grip_stiffness = measured(file, "grip_stiffness", "N/m", kGripStiffness);
  file.finish();
  return n;
}

void read_needle(const std::string& root, const YamlNode& node, Model& m) {
  auto needle = std::make_shared<NeedleModel>();
  const std::string source = "models/needle/" + node.text("model") + ".yaml";
  m.sources.push_back(source);
  needle->shape = load_needle(root + "/" + source);
  const Eigen::Index last = m.thread_path.cols() - 1;
  const Vec3 along = (m.thread_path.col(last) - m.thread_path.col(last - 1)).normalized();
  const Vec3 normal = read_direction(node, "normal");
  const Vec3 in_plane = along - along.dot(normal) * normal;
  if (in_plane.norm() < 0.5) node.refuse("normal", "a direction across the thread's end");
  const Vec3 y = in_plane.normalized();
  Mat3 frame;  // axes of the swage: its tangent, the normal, and across
  frame << y.cross(normal), y, normal;
  const Vec3 t = needle->shape.tangent(0.0);
  Mat3 own;
  own << t.cross(Vec3::UnitZ()), t, Vec3::UnitZ();
  needle->start.q = Quat(Mat3(frame * own.transpose())).normalized();
  needle->start.p = m.thread_path.col(last) - needle->start.q * needle->shape.point(0.0);
  describe_needle(needle->shape, m.description.needle);
  m.needle = std::move(needle);
}

}  // namespace filum
