#include "physics/thread_grasp.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

Vec3 pulled(const HeldPoint& h, const Points& x, const Pose& X) noexcept {
  return (1.0 - h.s) * x.col(h.edge) + h.s * x.col(h.edge + 1) - X * h.point.anchor_T;
}

}  // namespace

ThreadGrasps::ThreadGrasps(int n_tools) : tools(static_cast<std::size_t>(n_tools)) {
  held_.reserve(static_cast<std::size_t>(n_tools * kGraspPointsPerTool));
}

std::pair<int, double> locate_arc(const RodState& s, double arc) noexcept {
  double at = s.arc_start;
  for (int j = 0; j + 1 < s.n; ++j) {
    if (arc <= at + s.rest_length[j] || j + 2 == s.n)
      return {j, std::clamp((arc - at) / s.rest_length[j], 0.0, 1.0)};
    at += s.rest_length[j];
  }
  return {0, 0.0};
}

void ThreadGrasps::locate(const std::vector<GraspPoint>& points, const RodState& s) noexcept {
  held_.clear();
  for (const GraspPoint& p : points) {
    const auto [edge, fraction] = locate_arc(s, p.arc);
    HeldPoint& h = held_.emplace_back();
    h.edge = edge;
    h.s = fraction;
    h.point = p;
  }
  for (HeldPoint& h : held_) {
    const auto mates = std::count_if(held_.begin(), held_.end(), [&](const HeldPoint& o) { return o.point.tool == h.point.tool; });
    h.share = 1.0 / static_cast<double>(mates);
  }
}

double ThreadGrasps::energy(const Points& x) const noexcept {
  double u = 0.0;
  for (const HeldPoint& h : held_) {
    const GraspTool& tool = tools[static_cast<std::size_t>(h.point.tool)];
    const Vec3 xi = pulled(h, x, tool.X_now);
    const Vec3 n = tool.X_now.q * Vec3::UnitX();
    const double across = xi.dot(n);
    u += 0.5 * tool.pads.stiffness * across * across;
    u += coulomb(xi - across * n, n, 2.0 * tool.grip_force * h.share, tool.pads.friction, tool.pads.stiffness).energy;
  }
  return u;
}

void ThreadGrasps::add_gradient(const Points& x, Eigen::Matrix4Xd& gradient) noexcept {
  for (GraspTool& t : tools) t.force = t.torque = Vec3::Zero();
  for (HeldPoint& h : held_) {
    GraspTool& tool = tools[static_cast<std::size_t>(h.point.tool)];
    const Vec3 xi = pulled(h, x, tool.X_now);
    const Vec3 n = tool.X_now.q * Vec3::UnitX();
    const double across = xi.dot(n);
    h.friction = coulomb(xi - across * n, n, 2.0 * tool.grip_force * h.share, tool.pads.friction, tool.pads.stiffness);
    h.slid = xi - across * n - h.friction.xi;
    const Vec3 on_thread = -tool.pads.stiffness * across * n + h.friction.force;
    gradient.col(h.edge).head<3>() -= (1.0 - h.s) * on_thread;
    gradient.col(h.edge + 1).head<3>() -= h.s * on_thread;
    tool.force -= on_thread;
    tool.torque -= (tool.X_now.q * h.point.anchor_T).cross(on_thread);
  }
}

void ThreadGrasps::add_stiffness(const ChainSlots& chain, BlockCholesky& matrix) const noexcept {
  for (const HeldPoint& h : held_) {
    const GraspTool& tool = tools[static_cast<std::size_t>(h.point.tool)];
    const Vec3 n = tool.X_now.q * Vec3::UnitX();
    const Mat3 k = tool.pads.stiffness * n * n.transpose() + h.friction.stiffness;
    matrix.add_diagonal(h.edge, pad((1.0 - h.s) * (1.0 - h.s) * k));
    matrix.add_diagonal(h.edge + 1, pad(h.s * h.s * k));
    matrix.add(chain.next[h.edge], pad(h.s * (1.0 - h.s) * k));
  }
}

int ThreadGrasps::update_points(std::vector<GraspPoint>& points) const noexcept {
  for (std::size_t k = 0; k < held_.size() && k < points.size(); ++k) {
    const GraspTool& tool = tools[static_cast<std::size_t>(held_[k].point.tool)];
    points[k].anchor_T += tool.X_now.q.conjugate() * held_[k].slid;
  }
  std::erase_if(points, [&](const GraspPoint& p) {
    const Pads& pads = tools[static_cast<std::size_t>(p.tool)].pads;
    return std::abs(p.anchor_T.y()) > pads.half_width || p.anchor_T.z() < 0.0 || p.anchor_T.z() > pads.length;
  });
  return static_cast<int>(points.size());
}

int grasp_between(const Pads& pads, const Pose& X_WT, int tool, const RodState& s, double reach, std::vector<GraspPoint>& points) noexcept {
  const Pose X_TW = X_WT.inverse();
  double first = -1.0, last = -1.0;  // [m], stretch of the thread inside, by material coordinate
  double at = s.arc_start;
  for (int j = 0; j + 1 < s.n; ++j) {
    if (s.alive[j] == 0) {  // nothing is there; what is held ends here
      if (last >= 0.0) break;
      at += s.rest_length[j];
      continue;
    }
    const Vec3 a = X_TW * Vec3(s.x.col(j)), b = X_TW * Vec3(s.x.col(j + 1));
    const int samples = std::max(2, static_cast<int>(std::ceil((b - a).norm() / (0.5 * pads.half_width))));
    for (int k = 0; k <= samples; ++k) {
      const double f = static_cast<double>(k) / samples;
      const Vec3 p = (1.0 - f) * a + f * b;
      const bool inside = std::abs(p.x()) < reach && std::abs(p.y()) < pads.half_width && p.z() > 0.0 && p.z() < pads.length;
      if (!inside) continue;
      const double arc = at + f * s.rest_length[j];
      if (first < 0.0) first = arc;
      if (arc - last > 2e-3 && last >= 0.0) break;  // another strand: one is held
      last = arc;
    }
    at += s.rest_length[j];
  }
  if (first < 0.0) return 0;
  const int n = last > first ? kGraspPointsPerTool : 1;
  for (int k = 0; k < n; ++k) {
    const double arc = n == 1 ? first : first + (last - first) * k / (n - 1);
    const auto [edge, f] = locate_arc(s, arc);
    GraspPoint p;
    p.tool = tool;
    p.arc = arc;
    p.anchor_T = X_TW * ((1.0 - f) * s.x.col(edge) + f * s.x.col(edge + 1)).eval();
    points.push_back(p);
  }
  return n;
}

}  // namespace filum
