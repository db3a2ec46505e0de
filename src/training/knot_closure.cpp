#include "training/knot_closure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace filum {
namespace {

constexpr int kDirections = 96;
constexpr double kApart = 0.766;  // cosine of 40 degrees

/// Evenly spread unit vectors (Fibonacci sphere).
Points sphere_directions() {
  Points directions(3, kDirections);
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / kDirections, r = std::sqrt(1.0 - z * z);
    directions.col(k) = Vec3(r * std::cos(golden * k), r * std::sin(golden * k), z);
  }
  return directions;
}

/// Up to `count` free directions from `tip`, best first. `others` are the remaining nodes.
std::vector<Vec3> free_directions(const Vec3& tip, const Points& others, int count) {
  static const Points kSphere = sphere_directions();
  Points seen = others.colwise() - tip;
  for (Eigen::Index k = 0; k < seen.cols(); ++k) seen.col(k) /= std::max(seen.col(k).norm(), 1e-300);
  // For each direction the cosine of the nearest part of the thread: the smaller, the freer.
  const Eigen::VectorXd nearest = (kSphere.transpose() * seen).rowwise().maxCoeff();
  std::vector<int> order(kDirections);
  for (int k = 0; k < kDirections; ++k) order[static_cast<std::size_t>(k)] = k;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return nearest[a] < nearest[b]; });
  std::vector<Vec3> chosen;
  for (int k : order) {
    const Vec3 d = kSphere.col(k);
    const bool apart =
        std::all_of(chosen.begin(), chosen.end(), [&](const Vec3& c) { return c.dot(d) < kApart; });
    if (apart) chosen.push_back(d);
    if (static_cast<int>(chosen.size()) == count) break;
  }
  return chosen;
}

/// Where the ray from p along d leaves the sphere.
Vec3 exit_point(const Vec3& p, const Vec3& d, const Vec3& centre, double radius) {
  const Vec3 q = p - centre;
  const double b = q.dot(d);
  return p + (-b + std::sqrt(b * b - q.squaredNorm() + radius * radius)) * d;
}

}  // namespace

std::vector<Closure> free_closures(const Points& nodes, int count) {
  const Eigen::Index n = nodes.cols();
  const int each = std::min(count, 3);
  const std::vector<Vec3> first = free_directions(nodes.col(0), nodes.rightCols(n - 1), each);
  const std::vector<Vec3> last = free_directions(nodes.col(n - 1), nodes.leftCols(n - 1), each);
  std::vector<Closure> closures;
  for (std::size_t merit = 0; merit < first.size() + last.size(); ++merit) {
    for (std::size_t i = 0; i <= merit; ++i) {
      const std::size_t j = merit - i;
      if (i >= first.size() || j >= last.size()) continue;
      if (static_cast<int>(closures.size()) < count) closures.push_back({first[i], last[j]});
    }
  }
  return closures;
}

Points close_curve(const Points& nodes, const Closure& closure) {
  const Eigen::Index n = nodes.cols();
  const Vec3 centre = 0.5 * (nodes.rowwise().minCoeff() + nodes.rowwise().maxCoeff());
  const double reach = (nodes.colwise() - centre).colwise().norm().maxCoeff();
  const double far = 4.0 * std::max(reach, 1e-12);
  const Vec3 out = exit_point(nodes.col(n - 1), closure.last, centre, far);
  const Vec3 back = exit_point(nodes.col(0), closure.first, centre, far);
  // Round the sphere by way of the middle direction, so that no chord comes near the thread.
  Vec3 middle = (out - centre) + (back - centre);
  if (middle.norm() < far) {
    middle = (out - centre).cross(back - centre);
    if (middle.norm() < 1e-3 * far * far) middle = (out - centre).unitOrthogonal();
  }
  Points closed(3, n + 3);
  closed.leftCols(n) = nodes;
  closed.col(n) = out;
  closed.col(n + 1) = centre + far * middle.normalized();
  closed.col(n + 2) = back;
  return closed;
}

}  // namespace filum
