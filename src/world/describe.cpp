#include "world/describe.h"

#include <algorithm>

#include "world/blood_flow.h"
#include "world/brain_section.h"

namespace filum {
namespace {

/// As two triangles in the field's frame.
BladeDescription falx_surface(const BrainModel& m) {
  const double x = m.cortex.mesh.nodes.row(0).cwiseAbs().maxCoeff();
  BladeDescription d;
  d.name = "falx";
  d.vertices.resize(3, 4);
  d.vertices << -x, x, x, -x, m.falx.y, m.falx.y, m.falx.y, m.falx.y, m.falx.bottom, m.falx.bottom, m.falx.top, m.falx.top;
  d.triangles = {{0, 1, 2}, {0, 2, 3}};
  return d;
}

/// Both sides of a cut at rest, their rims the same way round, each from its node furthest towards where the angle is zero.
std::array<CutEdge, 2> cut_edges(const VesselModel& v) {
  std::array<CutEdge, 2> edges;
  const auto pose = stump_poses(v.clamp, v.shape.stretch * v.shape.length);
  std::array<Vec3, 2> area{Vec3::Zero(), Vec3::Zero()};
  for (std::size_t part = 0; part < 2; ++part) {
    std::vector<Vec3>& rim = edges[part].rim;
    for (const int i : v.mesh.edge_ring[part]) rim.push_back(v.mesh.nodes.col(i));
    for (std::size_t k = 0; k < rim.size(); ++k) area[part] += 0.5 * (rim[k] - rim[0]).cross(rim[(k + 1) % rim.size()] - rim[0]);
    if (area[part].dot(area[0]) < 0.0) std::reverse(rim.begin(), rim.end());
    const auto first = std::max_element(rim.begin(), rim.end(), [&](const Vec3& p, const Vec3& q) { return p.dot(v.cut_along) < q.dot(v.cut_along); });
    std::rotate(rim.begin(), first, rim.end());
    edges[part].axis = pose[part].q * Vec3::UnitZ();
    edges[part].origin = pose[part].p;
  }
  return edges;
}

}  // namespace

RigidSurface surface_of_shape(const BladeShape& shape) {
  constexpr double kCell = 2.5e-3;  // [m]
  return blade_surface(shape, std::max(4, static_cast<int>(shape.length / kCell)), std::max(2, static_cast<int>(shape.width / kCell)));
}

void describe_brain(const BrainModel& model, BrainDescription& b) {
  const std::vector<int>& nodes = model.cortex.surface_nodes;
  const auto vertex = [&](int node) { return static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin()); };
  b.name = model.name;
  b.rest.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k) b.rest.col(static_cast<Eigen::Index>(k)) = model.cortex.mesh.nodes.col(nodes[k]);
  for (const Triangle& t : model.cortex.surface) b.triangles.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
  // blade i is tool i; after the blades the second form of each, and so on; a falx comes last, where it stands
  for (std::size_t form = 0; form < model.blades.front().size(); ++form)
    for (std::size_t i = 0; i < model.blades.size(); ++i) {
      const BladeShape& shape = model.blades[i][form];
      const RigidSurface surface = surface_of_shape(shape);
      b.blades.push_back({form == 0 ? model.blade_names[i] : shape.name, surface.vertices, surface.triangles, shape.width, shape.grip});
    }
  if (model.falx.present()) b.blades.push_back(falx_surface(model));
  for (const BridgingVein& v : model.veins) b.veins.push_back({vertex(v.node), v.dura_W});
  const BrainSection section = cut_mesh(model.cortex.mesh, model.section_x);
  b.section_triangles = section.triangles;
  b.section_rest.resize(3, static_cast<Eigen::Index>(section.corners.size()));
  for (std::size_t k = 0; k < section.corners.size(); ++k) b.section_rest.col(static_cast<Eigen::Index>(k)) = corner_place(section.corners[k], model.cortex.mesh.nodes);
  b.target_W = model.target_W;
  b.target_radius = model.target_radius;
  b.bone_y = model.bone_y;
  b.time_compression = model.time_compression;
}

void describe_needle(const NeedleShape& shape, NeedleDescription& d) {
  d.present = true;
  d.name = shape.name;
  d.wire_radius = shape.wire_radius;
  d.bend_radius = shape.bend_radius;
  d.angle = shape.angle();
  d.taper = shape.taper;
}

void describe_tissue(const VesselModel& model, TissueDescription& d) {
  d.name = model.name;
  d.kind = model.kind;
  d.thickness = model.thickness;
  double deep = 0.0;
  for (auto l = model.layers.rbegin(); l != model.layers.rend(); ++l) {
    const double from = deep;
    deep += l->thickness / model.thickness;
    d.layers.push_back({l->name, from, deep});
  }
  d.cut_along = model.cut_along;
  d.lumen = model.lumen;
  d.axis = model.clamp.X_WB.q * Vec3::UnitZ();
  d.middle = model.clamp.X_WB.p;
  if (model.clamp.side) {
    const auto& part = model.mesh.node_part;
    d.second = static_cast<int>(std::find(part.begin(), part.end(), 1) - part.begin());
    d.edges = cut_edges(model);
  }
  d.radius = model.radius;
  d.clamp_reach = model.lumen ? clamp_arms(model).reach : 0.0;
  d.rest = model.mesh.nodes;
  for (const Triangle& t : face_triangles(model.mesh)) d.triangles.push_back({t[0], t[1], t[2]});
}

}  // namespace filum
