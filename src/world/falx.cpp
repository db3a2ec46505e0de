#include "world/falx.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kBeside = 15e-3;  // [m] from the sheet, within which a node of the fissure may come to it
constexpr double kOn = 1e-6;       // [m], nearer than which a node at rest has no side: the bottom of the fissure

bool between(const FalxSheet& sheet, double z) noexcept { return z > sheet.bottom && z < sheet.top; }

}  // namespace

FalxContact::FalxContact(const FalxSheet& sheet, const TetMesh& mesh, const std::vector<int>& surface_nodes, const std::vector<int>& held) : sheet_(sheet) {
  if (!sheet.present()) return;
  for (const int i : surface_nodes) {
    const double away = mesh.nodes(1, i) - sheet.y;
    if (!between(sheet, mesh.nodes(2, i)) || std::abs(away) < kOn || std::abs(away) > kBeside) continue;
    if (!std::binary_search(held.begin(), held.end(), i)) nodes_.push_back({i, away > 0.0 ? 1.0 : -1.0});
  }
}

void FalxContact::append(const LinearFem& fem, const Points& u, std::vector<MovedNode>& moved) const noexcept {
  for (const Node& n : nodes_) {
    const Vec3 x = fem.mesh().nodes.col(n.node) + u.col(n.node);
    const double gap = n.side * (x.y() - sheet_.y);
    if (gap >= 0.0 || !between(sheet_, x.z()) || moved.size() == moved.capacity()) continue;
    MovedNode m;
    m.node = n.node;
    m.prescribed = false;
    m.outward = n.side * Vec3::UnitY();
    m.stiffness = kFalxStiffness * fem.nodal_stiffness(n.node) * Vec3::UnitY() * Vec3::UnitY().transpose();
    m.target = u.col(n.node) - gap * m.outward;
    moved.push_back(m);
  }
}

Pose beside_falx(const FalxSheet& sheet, const RigidSurface& blade, const Pose& before, const Pose& now) noexcept {
  if (!sheet.present()) return now;
  double least = 1.0, most = -1.0, middle = 0.0;  // [m], distances of the points at the sheet's height
  int were = 0;
  for (int k = 0; k < blade.vertices.cols(); ++k) {
    const Vec3 x = now * Vec3(blade.vertices.col(k)), old = before * Vec3(blade.vertices.col(k));
    if (!between(sheet, x.z())) continue;
    least = std::min(least, x.y() - sheet.y);
    most = std::max(most, x.y() - sheet.y);
    middle += x.y() - sheet.y;
    if (between(sheet, old.z())) were += old.y() > sheet.y ? 1 : -1;
  }
  if (least > most) return now;
  const bool above = were != 0 ? were > 0 : middle > 0.0;
  Pose X = now;
  X.p.y() += above ? std::max(0.0, kFalxClearance - least) : std::min(0.0, -kFalxClearance - most);
  return X;
}

}  // namespace filum
