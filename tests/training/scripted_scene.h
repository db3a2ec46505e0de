#pragma once
// Observations made up from known shapes, as a world would show them, for tests of what watches a task.

#include <string>
#include <vector>

#include "tests/training/knot_shapes.h"
#include "world/observation.h"

namespace filum::shapes {

constexpr double kThreadRadius = 12e-6;  // [m]

inline SceneDescription knot_scene() {
  SceneDescription scene;
  scene.task = "knot-square";
  scene.thread_radius = kThreadRadius;
  scene.thread_strength = 0.16;
  scene.dt = 2e-3;
  scene.post = post();
  scene.has_post = true;
  scene.n_tools = 2;
  scene.tools[0].name = "forceps-left";
  scene.tools[1].name = "needle-holder";
  scene.capacity = 400;
  return scene;
}

/// Shows a thread, two instruments far from it, tension in newtons everywhere.
class Scene {
 public:
  explicit Scene(int capacity = 400) {
    o_.positions = Points::Zero(3, capacity);
    o_.arc.assign(static_cast<std::size_t>(capacity), 0.0);
    o_.tension.assign(static_cast<std::size_t>(capacity), 0.0);
    o_.contact.assign(static_cast<std::size_t>(capacity), 0.0);
    o_.radius = kThreadRadius;
    o_.n_tools = 2;
    o_.tools[0].X_WT.p = Vec3(-0.02, 0, 0.01);
    o_.tools[1].X_WT.p = Vec3(0.02, 0, 0.01);
    for (ToolObservation& tool : o_.tools) tool.input_valid = true;
    o_.tools[2].input_valid = false;
  }

  void show(const Points& nodes, double tension = 0.0) {
    o_.n_nodes = static_cast<int>(nodes.cols());
    o_.positions.leftCols(nodes.cols()) = nodes;
    for (double& t : o_.tension) t = tension;
  }

  /// The observation `dt` later.
  const Observation& next(double dt = 2e-3) {
    ++o_.step;
    o_.time += dt;
    return o_;
  }
  Observation& now() { return o_; }

 private:
  Observation o_;
};

/// `shape` blown up about the post's axis: the same knot, loose.
inline Points loosened(const Points& shape, double factor) {
  return ((shape.colwise() - post().p_W) * factor).colwise() + post().p_W;
}

/// A thread that winds `turns` times round the axis of a tool whose tip is at p (frame as the world's).
inline Points wound_round(const Vec3& p, double turns) {
  std::vector<Vec3> curve;
  for (int k = 20; k > 0; --k) curve.push_back(p + Vec3(0.7e-3, -1e-3 * k, 3e-3));
  const int n = static_cast<int>(24 * turns);
  for (int k = 0; k <= n; ++k) {
    const double a = 2.0 * kPi * turns * k / n;
    curve.push_back(p + Vec3(0.7e-3 * std::cos(a), 0.7e-3 * std::sin(a), 3e-3 + 0.4e-3 * k / n));
  }
  const Vec3 out = (curve[curve.size() - 1] - curve[curve.size() - 2]).normalized(), end = curve.back();
  for (int k = 1; k <= 20; ++k) curve.push_back(end + 1e-3 * k * out);
  return from_list(curve);
}

}  // namespace filum::shapes
