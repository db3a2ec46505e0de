#include "world/brain_section.h"

#include <cmath>
#include <map>

namespace filum {

double von_mises(const Mat3& stress) noexcept {
  const Mat3 deviator = stress - stress.trace() / 3.0 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

BrainSection cut_mesh(const TetMesh& mesh, double x) {
  constexpr double kNear = 1e-6, kAside = 1e-4;  // [m]
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (std::abs(mesh.nodes(0, i) - x) < kNear) {
      x += kAside;
      break;
    }
  BrainSection cut;
  std::map<std::pair<int, int>, int> number;
  const auto corner = [&](int low, int high) {
    const auto [at, fresh] = number.emplace(std::pair(low, high), static_cast<int>(cut.corners.size()));
    if (fresh) cut.corners.push_back({low, high, (x - mesh.nodes(0, low)) / (mesh.nodes(0, high) - mesh.nodes(0, low))});
    return at->second;
  };
  for (int e = 0; e < mesh.n_tets(); ++e) {
    std::vector<int> below, above;
    for (const int i : mesh.tets[static_cast<std::size_t>(e)]) (mesh.nodes(0, i) < x ? below : above).push_back(i);
    if (below.empty() || above.empty()) continue;
    std::vector<int> ring;  // about the cut: neighbours share a node
    if (below.size() == 2) ring = {corner(below[0], above[0]), corner(below[0], above[1]), corner(below[1], above[1]), corner(below[1], above[0])};
    else
      for (const int b : below)
        for (const int a : above) ring.push_back(corner(b, a));
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
      cut.triangles.push_back({ring[0], ring[k], ring[k + 1]});
      cut.element.push_back(e);
    }
  }
  return cut;
}

}  // namespace filum
