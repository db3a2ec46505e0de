#include "physics/wall_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "collision/point_triangle.h"

namespace filum {
namespace {

constexpr int kMostHops = 12;
constexpr double kRim = 1e-6;

/// Corners of the face of an element where local coordinate `axis` is -1 (end 0) or 1.
std::array<int, 4> face_nodes(const std::array<int, 8>& element, int axis, int end) {
  std::array<int, 4> nodes{};
  std::size_t n = 0;
  for (int a = 0; a < 8; ++a)
    if (((a >> axis) & 1) == end) nodes[n++] = element[static_cast<std::size_t>(a)];
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

WallWalk::WallWalk(const VesselWall& wall) {
  const VesselMesh& mesh = wall.mesh();
  std::map<std::array<int, 4>, std::pair<int, int>> open;
  neighbour_.assign(mesh.elements.size(), {-1, -1, -1, -1, -1, -1});
  for (int e = 0; e < mesh.n_elements(); ++e) {
    for (int f = 0; f < 6; ++f) {
      const auto key = face_nodes(mesh.elements[static_cast<std::size_t>(e)], f / 2, f % 2);
      const auto [it, fresh] = open.try_emplace(key, e, f);
      if (fresh) continue;
      neighbour_[static_cast<std::size_t>(e)][static_cast<std::size_t>(f)] = it->second.first;
      neighbour_[static_cast<std::size_t>(it->second.first)][static_cast<std::size_t>(it->second.second)] = e;
      open.erase(it);
    }
  }
  for (const WallFace& face : mesh.faces) {
    if (face.surface != WallSurface::edge) continue;
    Rim rim;
    rim.part = mesh.part[static_cast<std::size_t>(face.element)];
    for (std::size_t k = 0; k < 4; ++k)
      rim.corner[k] = mesh.nodes.col(mesh.elements[static_cast<std::size_t>(face.element)][static_cast<std::size_t>(face.corner[k])]);
    rim_.push_back(rim);
  }
}

WallPoint WallWalk::move(const VesselWall& wall, const WallState& state, const Vec3& q, const WallPoint& guess, bool& inside) const noexcept {
  WallPoint at = guess;
  for (int hop = 0; hop < kMostHops; ++hop) {
    at = wall.locate(state, q, at);
    int axis = 0;
    const double beyond = at.local.cwiseAbs().maxCoeff(&axis) - 1.0;
    inside = beyond <= kRim;
    if (inside) return at;
    const int face = 2 * axis + (at.local[axis] > 0.0 ? 1 : 0);
    const int next = neighbour_[static_cast<std::size_t>(at.element)][static_cast<std::size_t>(face)];
    if (next < 0) break;
    at.element = next;
    at.local.setZero();
  }
  at.local = at.local.cwiseMax(-1.0).cwiseMin(1.0);
  return at;
}

Vec3 WallWalk::at_rest(const VesselWall& wall, const WallPoint& at) const noexcept {
  const auto& nodes = wall.mesh().elements[static_cast<std::size_t>(at.element)];
  const auto w = corner_weights(at.local);
  Vec3 p = Vec3::Zero();
  for (int a = 0; a < 8; ++a) p += w[a] * wall.mesh().nodes.col(nodes[static_cast<std::size_t>(a)]);
  return p;
}

double WallWalk::bite(const VesselWall& wall, const WallPoint& at) const noexcept {
  const Vec3 p = at_rest(wall, at);
  const int part = wall.mesh().part[static_cast<std::size_t>(at.element)];
  double least = std::numeric_limits<double>::infinity();
  for (const Rim& rim : rim_) {
    if (rim.part != part) continue;
    for (int half = 0; half < 2; ++half) {
      const auto j = static_cast<std::size_t>(1 + half);
      least = std::min(least, (closest_on_triangle(p, rim.corner[0], rim.corner[j], rim.corner[j + 1]).point - p).norm());
    }
  }
  return least;
}

}  // namespace filum
