// Capstan over tissue that gives way: a limp thread drawn over a tube under pressure, with the trainer's thread, wall and contact between them.
//
// The tube is the silicone practice tube (models/vessel/silicone-tube.yaml) with both ends held. 1 mN on the slack end bends it by some 0.05 mm and dents it
// under the thread; how far the thread lies round it is read from its own two straight legs, in the same state as the tensions.
// Drawn at 0.03 mm/s it takes as much as at 1 mm/s: the bristles of the contact stay bent from step to step.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/numbers.h"
#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"
#include "evidence/vessel_probe.h"
#include "world/vessel_contact.h"

namespace filum {
namespace {

constexpr double kSlack = 1e-3;                     // [N]
constexpr double kEdge = 50e-6, kHang = 6e-3;       // [m]; the slack leg is to be as long as what is drawn, and straight beyond
constexpr double kWay = 0.6e-3;                     // [m], that is drawn: twelve edges
constexpr double kLength = 4e-3;                    // [m], of the tube
constexpr int kAround = 48;

VesselWall held_tube() {
  TubeShape shape;
  shape.inner_radius = 0.35e-3;
  shape.thickness = 0.15e-3;
  shape.length = kLength;
  shape.around = kAround;
  shape.along = 8;
  VesselMesh mesh = make_tube(shape);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.nodes(2, i) > kLength - 1e-9) mesh.held.push_back(i);
  WallLaw rubber;
  rubber.kind = WallLaw::Kind::neo_hookean;
  rubber.mu = 350e3;
  rubber.lambda = 20e6 - 2.0 / 3.0 * rubber.mu;
  return VesselWall(std::move(mesh), {{"wall", shape.thickness, rubber}}, {});
}

/// [m], outer, half way along.
double widest(const VesselMesh& mesh, const WallState& w) {
  double radius = 0.0;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (std::abs(mesh.nodes(2, i) - 0.5 * kLength) < 1e-9) radius = std::max(radius, w.x.col(i).head<2>().norm());
  return radius;
}

/// Comes up along y, lies round the tube by `angle` [rad], `aside` [m] of its middle row of nodes, and leaves it straight on.
Points over_the_tube(double R, double angle, double aside) {
  const int n = static_cast<int>((angle * R + 1.5 * kHang) / kEdge) + 1;
  Points nodes(3, n);
  for (int i = 0; i < n; ++i) {
    const double s = kEdge * i - kHang, a = std::clamp(s / R, 0.0, angle);
    nodes.col(i) = Vec3(-R * std::cos(a), R * std::sin(a), 0.5 * kLength + aside) + (s - a * R) * Vec3(std::sin(a), std::cos(a), 0.0);
  }
  return nodes;
}

RodMaterial limp() {
  RodMaterial m;  // 10-0 nylon but for its stiffness
  m.EI = m.GJ = 1e-13;  // T R^2/B = 2600
  return m;
}

struct Drawn {
  double tension = kNaN, slack = kNaN;  // [N]
  double angle = kNaN;                  // [rad], between the legs
};

class WallCapstan {
 public:
  WallCapstan(double mu, double angle, double aside)
      : wall_(held_tube()), w_(under_pressure(wall_)), probe_(limp(), over_the_tube(widest(wall_.mesh(), w_) + 5e-6, angle, aside)), contact_(probe_.state.n),
        away_(std::sin(angle), std::cos(angle), 0.0) {
    contact_.law.friction = mu;
    probe_.options = RodStepOptions();
    probe_.options.dt = wall_.options().dt;
    probe_.options.gravity.setZero();
    probe_.rod.tethers.list.reserve(kMostTouches);
    probe_.hold(probe_.state.n - 1);
  }
  double dt() const { return wall_.options().dt; }

  /// One step as the trainer takes it (VesselScene); `move` [m]: of the end that is drawn.
  bool step(double slack, double move) {
    std::vector<RodTether>& held = probe_.rod.tethers.list;
    probe_.rod.boundary.load(1, 0) = -slack;
    probe_.rod.boundary.target.col(probe_.state.n - 1).head<3>() += move * away_;
    wall_.clear_loads();
    held.clear();
    contact_.hold(wall_, w_, touches_, probe_.state, held);
    if (!probe_.rod.step(probe_.state, probe_.memory, probe_.options).sound) return false;
    contact_.follow(wall_, w_, touches_, no_tracks_, probe_.state, held);
    if (!wall_.step(w_).sound) return false;
    wall_.refit(w_);
    contact_.overtake(wall_, w_, touches_, no_tracks_, probe_.state);
    return true;
  }
  Drawn drawn() const {
    const RodState& s = probe_.state;
    const Vec3 a = s.x.col(2) - s.x.col(1), b = s.x.col(s.n - 2) - s.x.col(s.n - 3);
    return {edge_tension(probe_.rod.material, s, s.n - 3), edge_tension(probe_.rod.material, s, 1), std::atan2(a.cross(b).norm(), a.dot(b))};
  }

 private:
  static WallState under_pressure(VesselWall& wall) {
    WallState w = wall.first_state();
    wall.set_pressure(0, 13332.0);
    wall.settle(w, 500);
    wall.refit(w);
    return w;
  }

  VesselWall wall_;
  WallState w_;
  RodProbe probe_;
  VesselContact contact_;
  TouchState touches_;
  TrackState no_tracks_;
  Vec3 away_;
};

/// Mean over the last two thirds of what is drawn.
struct Means {
  double over_euler = kNaN;  // ratio of tensions over exp(mu angle) of the same state
  double ratio = kNaN, angle = kNaN;
};

Means draw(double mu, double angle, double speed, double way, double aside = 0.0) {
  WallCapstan rig(mu, angle, aside);
  for (int k = 1; k <= 100; ++k)
    if (!rig.step(kSlack * std::min(1.0, k / 50.0), 0.0)) return {};
  const double move = speed * rig.dt();
  const int steps = static_cast<int>(std::lround(way / move)), before = steps / 3;
  Means mean{0.0, 0.0, 0.0};
  for (int k = 0; k < steps; ++k) {
    if (!rig.step(kSlack, move)) return {};
    if (k < before) continue;
    const Drawn d = rig.drawn();
    const double share = 1.0 / (steps - before);
    mean.over_euler += share * d.tension / d.slack / std::exp(mu * d.angle);
    mean.ratio += share * d.tension / d.slack;
    mean.angle += share * d.angle;
  }
  return mean;
}

void list_one(ProblemList& list, const char* label, double mu, double angle, const char* turn) {
  ValidationProblem p;
  p.name = std::string("capstan-wall-").append(label);
  p.source = "Euler-Eytelwein, T2/T1 = exp(mu theta), theta between the thread's legs; silicone tube of 1 mm outside at 100 mmHg, 1 mN on the slack end";
  p.quantity = std::string("ratio of tensions over exp(mu theta), ") + turn + " over a vessel wall, mu = " + (mu < 0.2 ? "0.1" : "0.3") + ", followed to no travel a step";
  p.expected = 1.0;
  // a touch presses along its facet's normal, which is off by up to pi/48 either way (rms 0.038): of some 30 touches that bear T pi/30 each 2 % of T, in one state;
  // chords of 50 um turn by phi = 0.1 at a node: phi^2/12 = 0.1 % of the exponent
  p.tolerance = 2e-2;
  p.note = "order one, from 8, 4 and 2 um a step (4, 2 and 1 mm/s): in a step the wall's normals are those of its start, so that thread drawn by d climbs by d/R "
           "and takes T theta d/R more";
  list.push_back({p, [mu, angle](ValidationProblem& r) {
                    const std::array<Means, 3> m{draw(mu, angle, 4e-3, kWay), draw(mu, angle, 2e-3, kWay), draw(mu, angle, 1e-3, kWay)};
                    follow_first_order(r, {m[0].over_euler, m[1].over_euler, m[2].over_euler});
                    char seen[120];
                    std::snprintf(seen, sizeof seen, "; there ratio %.4f, theta %.4f rad, exp(mu theta) %.4f", m[2].ratio, m[2].angle, std::exp(mu * m[2].angle));
                    r.quantity += seen;
                  }});
}

void list_slow(ProblemList& list, const char* name, const char* where, double aside) {
  constexpr double kMu = 0.3, kSpeed = 30e-6, kSlowWay = 300e-6;  // [-], [m/s], [m]: 0.06 um a step
  ValidationProblem p;
  p.name = name;
  p.source = "Euler-Eytelwein as above; Coulomb friction does not depend on speed";
  p.quantity = std::string("ratio of tensions over exp(mu theta), half a turn over a vessel wall, mu = 0.3, drawn at 0.03 mm/s").append(where);
  p.expected = 1.0;
  p.tolerance = 2e-2;
  p.note = "no order: the climb T theta d/R that the others follow to nothing is 4e-4 here; what is left is the facets' normals";
  list.push_back({p, [aside](ValidationProblem& r) {
                    const Means m = draw(kMu, kPi, kSpeed, kSlowWay, aside);
                    r.got = m.over_euler;
                    char seen[120];
                    std::snprintf(seen, sizeof seen, "; there ratio %.4f, theta %.4f rad", m.ratio, m.angle);
                    r.quantity += seen;
                  }});
}

}  // namespace

void list_wall_capstan(ProblemList& list) {
  list_slow(list, "capstan-wall-slow-0.3", "", 0.0);
  list_slow(list, "capstan-wall-slow-beside-0.3", ", laid 20 um beside the dent's bottom, on folds of the mesh", 20e-6);
  list_one(list, "0.1", 0.1, kPi, "half a turn");
  list_one(list, "0.3", 0.3, kPi, "half a turn");
  list_one(list, "quarter-0.3", 0.3, 0.5 * kPi, "a quarter of a turn");
}

}  // namespace filum
