// The directors of a rod: its reference frames are carried along in time, so that what they show depends on the way that was taken; the
// material frames must not.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "evidence/linking.h"
#include "base/numbers.h"
#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"

namespace filum {
namespace {

/// Angle [rad] by which the director of an edge has turned when the edge was led once round a cone of half angle `cone` in `steps`.
double cone_holonomy(int steps, double cone) {
  const auto along = [&](double turn) { return Vec3(std::cos(cone), std::sin(cone) * std::cos(turn), std::sin(cone) * std::sin(turn)); };
  Points nodes = Points::Zero(3, 2);
  nodes.col(1) = along(0.0);
  RodState s = RodState::from_nodes(nodes, 2);
  RodGeometry g(2);
  const Vec3 before = s.d1.col(0);
  for (int k = 1; k <= steps; ++k) {
    nodes.col(1) = along(2.0 * kPi * k / steps);
    update_geometry(s, nodes, s.theta, g);
    accept_geometry(g, nodes, s.theta, s);
  }
  const Vec3 after = s.d1.col(0);
  return std::atan2(before.cross(after).dot(nodes.col(1)), before.dot(after));
}

void list_cone(ProblemList& list) {
  constexpr double kCone = 40.0 * kPi / 180.0;
  ValidationProblem p;
  p.name = "frame-cone";
  p.source = "Gauss & Bonnet: parallel transport round a closed curve on the sphere turns by the solid angle inside, 2 pi (1 - cos a)";
  p.quantity = "angle by which the reference director of an edge turns that was led round a cone of 40 degrees, 400 steps";
  p.unit = "rad";
  p.expected = 2.0 * kPi * (1.0 - std::cos(kCone));
  p.tolerance = 1e-3;
  p.least_order = 1.9;
  p.note = "order in the step";
  list.push_back({p, [](ValidationProblem& r) {
                    r.got = cone_holonomy(400, kCone);
                    r.order = observed_order(cone_holonomy(100, kCone), cone_holonomy(200, kCone), r.got);
                  }});
}

/// How a rod of length 1 stands: its tangent leaves the axis by tilt sin^2(pi s) and goes round it by winding 2 pi s and a constant angle.
struct Shape {
  double tilt, winding, azimuth;  // [rad], [turns], [rad]
};

Points nodes_of(const Shape& shape, int n) {
  Points x = Points::Zero(3, n);
  const int edges = n - 1;
  for (int j = 0; j < edges; ++j) {  // the first and the last edge along the axis
    const double s = static_cast<double>(j) / (edges - 1), tilt = shape.tilt * std::pow(std::sin(kPi * s), 2);
    const double round = 2.0 * kPi * shape.winding * s + shape.azimuth;
    x.col(j + 1) = x.col(j) + Vec3(std::cos(tilt), std::sin(tilt) * std::cos(round), std::sin(tilt) * std::sin(round)) / edges;
  }
  return x;
}

constexpr int kNodes = 61;
constexpr Shape kHelix = {1.2, 3.0, 0.0};

/// A rod between clamps, led through the shapes in turn; its twist finds its own rest all the while.
RodProbe led_rod(const std::vector<Shape>& way) {
  RodProbe probe(slender_rod(1.0, 0.7, 1.0, 1e3, 1e-3), nodes_of({0.0, 0.0, 0.0}, kNodes));
  probe.options.dt = 1e3;
  for (int i = 0; i < kNodes; ++i) probe.hold_position(i);
  for (int j : {0, kNodes - 2}) probe.hold_angle(j);
  constexpr int kSteps = 60;
  for (std::size_t leg = 1; leg < way.size(); ++leg)
    for (int k = 1; k <= kSteps; ++k) {
      const double part = static_cast<double>(k) / kSteps;
      const auto between = [part](double a, double b) { return a + part * (b - a); };
      const Shape &from = way[leg - 1], &to = way[leg];
      probe.rod.boundary.target.topRows<3>() =
          nodes_of({between(from.tilt, to.tilt), between(from.winding, to.winding), between(from.azimuth, to.azimuth)}, kNodes);
      probe.state.v.setZero();
      probe.state.theta_dot.setZero();
      probe.rod.step(probe.state, probe.memory, probe.options);
    }
  return probe;
}

/// Straight up into a helix; or by way of a plane bow to the other side, that is then wound up.
RodProbe helix_led(bool round_about) {
  return round_about ? led_rod({{0.0, 0.0, 2.0}, {kHelix.tilt, 0.0, 2.0}, kHelix}) : led_rod({{0.0, kHelix.winding, kHelix.azimuth}, kHelix});
}

/// Twist over minus the writhe of a rod that was clamped straight and led into a helix; its ends go on straight for a million lengths.
double twist_over_writhe() {
  const RodProbe probe = helix_led(false);
  const RodState& s = probe.state;
  Points curve(3, s.n + 2);
  curve << s.x.col(0) - Vec3(1e6, 0, 0), s.x.leftCols(s.n), s.x.col(s.n - 1) + Vec3(1e6, 0, 0);
  double twist = 0.0;
  for (int i = 1; i + 1 < s.n; ++i) twist += s.theta[i] - s.theta[i - 1] + s.ref_twist[i];
  return -twist / (2.0 * kPi * writhe(curve));
}

/// Largest angle [rad] between the directors of the same edge in two rods: of the material (.x) and of the reference (.y).
Eigen::Vector2d angles_between(const RodState& a, const RodState& b) {
  RodGeometry ga(a.n), gb(b.n);
  update_geometry(a, a.x, a.theta, ga);
  update_geometry(b, b.x, b.theta, gb);
  Eigen::Vector2d worst = Eigen::Vector2d::Zero();
  for (int j = 0; j + 1 < a.n; ++j) {
    const auto angle = [](const Vec3& u, const Vec3& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); };
    worst[0] = std::max(worst[0], angle(ga.m1.col(j), gb.m1.col(j)));
    worst[1] = std::max(worst[1], angle(ga.d1.col(j), gb.d1.col(j)));
  }
  return worst;
}

void list_ways(ProblemList& list) {
  ValidationProblem p;
  p.name = "frame-writhe";
  p.source = "Calugareanu 1961, White 1969: twist + writhe of a rod between clamps do not change while it moves";
  p.quantity = "twist over minus the writhe of a rod that was clamped straight and led into a helix of three turns";
  p.expected = 1.0;
  p.tolerance = 1e-9;
  p.note = "no order: holds for a polygon as it stands";
  list.push_back({p, [](ValidationProblem& r) { r.got = twist_over_writhe(); }});
  p.name = "frame-path";
  p.source = "A rod at rest between clamps has one twist, whatever way it was led";
  p.quantity = "largest angle between the material directors of two rods led to the same shape by two ways";
  p.unit = "rad";
  p.expected = 0.0;
  p.tolerance = 1e-9;
  p.note = "no order: exact on any mesh";
  list.push_back({p, [](ValidationProblem& r) {
                    const Eigen::Vector2d angles = angles_between(helix_led(false).state, helix_led(true).state);
                    r.got = angles[0];
                    char text[80];
                    std::snprintf(text, sizeof text, "; the reference directors differ by up to %.2f rad", angles[1]);
                    r.note += text;
                  }});
}

}  // namespace

void list_frames(ProblemList& list) {
  list_cone(list);
  list_ways(list);
}

}  // namespace filum
