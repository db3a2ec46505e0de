#include "world/join_test.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>

#include "physics/rod_pieces.h"
#include "physics/vessel_edge.h"
#include "physics/vessel_flow.h"
#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace {

constexpr double kFree = 0.5e-3;  // [m], of thread beside a bite that may lie in the lumen
constexpr int kThreadIterations = 100;  // Newton, at most in a step; with a live step's 20 one of 200 steps left 0.3 mN

/// Is q in the tube through these rings?
bool within(const std::vector<LumenRing>& rings, const Vec3& q) {
  for (std::size_t k = 1; k < rings.size(); ++k) {
    const Vec3 a = rings[k - 1].middle, run = rings[k].middle - a;
    const double t = (q - a).dot(run) / run.squaredNorm();
    if (t < 0.0 || t > 1.0) continue;
    const double area = (1.0 - t) * rings[k - 1].area + t * rings[k].area;
    if ((q - a - t * run).squaredNorm() * std::numbers::pi < area) return true;
  }
  return false;
}

struct Stretch {
  double low, high;
};

/// Thread that a pass holds; none once it was pulled or torn out.
std::optional<Stretch> held_by(const NeedleTrack& t, double whole) {
  if (t.n == 0 || t.ended != 0) return std::nullopt;
  Stretch s{whole + t.knots[0].strand, whole + t.knots[0].strand};
  for (int j = 1; j < t.n; ++j) {
    s.low = std::min(s.low, whole + t.knots[static_cast<std::size_t>(j)].strand);
    s.high = std::max(s.high, whole + t.knots[static_cast<std::size_t>(j)].strand);
  }
  return s;
}

bool unparted(const RodState& t, const Stretch& s) {
  double arc = t.arc_start;
  for (int i = 0; i + 1 < t.n; arc += t.rest_length[i++])
    if (t.alive[i] == 0 && arc + t.rest_length[i] > s.low && arc < s.high) return false;
  return true;
}

/// Thread between the two bites of each stitch, or in a bite alone, with some on either side.
std::vector<Stretch> between_bites(const TrackState& s, const RodState& thread, double whole) {
  std::vector<Stretch> list;
  int half = -1;  // part of a bite, the last of the list, that waits for the other side
  for (int k = 0; k < s.n; ++k) {
    const NeedleTrack& t = s.tracks[static_cast<std::size_t>(k)];
    const std::optional<Stretch> own = held_by(t, whole);
    if (!own) continue;
    if (half >= 0 && half != t.part) {
      const Stretch both{std::min(list.back().low, own->low), std::max(list.back().high, own->high)};
      if (unparted(thread, both)) {
        list.back() = both;
        half = -1;
        continue;
      }
    }
    list.push_back(*own);
    half = t.part;
  }
  for (Stretch& stretch : list) stretch = {stretch.low - kFree, stretch.high + kFree};
  return list;
}

/// Unit, from the first vessel to the second through the cut: the vessel's axis, or out of an opening as it now stands.
Vec3 way_across(const VesselModel& vessel, const Points& x) {
  if (!vessel.clamp.side) return vessel.clamp.X_WB.q * Vec3::UnitZ();
  const std::vector<int>& ring = vessel.mesh.edge_ring[0];
  Vec3 area = Vec3::Zero(), middle = Vec3::Zero();
  for (std::size_t k = 0; k < ring.size(); ++k) {
    area += Vec3(x.col(ring[k])).cross(Vec3(x.col(ring[(k + 1) % ring.size()])));
    middle += x.col(ring[k]) / static_cast<double>(ring.size());
  }
  return area.normalized() * ((middle - vessel.clamp.X_WB.p).dot(area) < 0.0 ? -1.0 : 1.0);
}

double lumen_area(const std::vector<LumenRing>& rings) {
  std::vector<double> areas;
  for (const LumenRing& r : rings) areas.push_back(r.area);
  std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2), areas.end());
  return areas[areas.size() / 2];
}

/// Steps the scene while the pressures rise, one stump after the other. False if something went wrong on the way.
bool let_blood_in(World& world, const JoinTestOptions& o) {
  const double dt = world.description().dt;
  const int rise = static_cast<int>(std::lround(o.rise / dt)), all = 2 * rise + static_cast<int>(std::lround(o.hold / dt));
  State s = world.state();
  s.tissue.blood = {};  // pressure is set from here on
  bool sound = true;
  for (int k = 1; k <= all; ++k) {
    for (int part = 0; part < 2; ++part)
      s.tissue.pressure[static_cast<std::size_t>(part)] = o.pressure * std::clamp(static_cast<double>(k - part * rise) / rise, 0.0, 1.0);
    if (k <= 2 * rise) world.restore(s);
    world.step(Inputs{});
    if (k <= 2 * rise) s = world.state();
    const Observation& now = world.observation();
    for (int e = 0; e < now.n_events; ++e) sound = sound && std::string_view(now.events[static_cast<std::size_t>(e)].name) != "solver-trouble";
  }
  return sound && world.state().tissue.wall.x.allFinite();
}

std::vector<EdgeGap> gaps_of(const VesselMesh& mesh, const Points& x) {
  std::vector<EdgeGap> gaps;
  for (std::size_t k = 0; k < mesh.edge_ring[0].size(); ++k) gaps.push_back(edge_gap(mesh, x, 0, 1, k));
  return gaps;
}

/// From report.edge.
void report_leak(const BloodOptions& blood, JoinTestReport& report) {
  std::array<LeakSector, kJoinSectors> sectors;
  report.leak = leak_through(report.edge, sectors, blood);
  for (std::size_t k = 0; k < sectors.size(); ++k) {
    report.flow[k] = sectors[k].flow;
    report.gap[k] = sectors[k].gap;
    report.area += sectors[k].area;
  }
}

double narrowing_at_join(const VesselMesh& mesh, const Points& x) {
  const Passage way = passage_of(mesh);
  std::vector<LumenRing> rings = lumen_rings(way, x);
  const auto second = rings.begin() + static_cast<std::ptrdiff_t>(way.second);
  const double usual = 0.5 * (lumen_area({rings.begin(), second}) + lumen_area({second, rings.end()}));
  const auto held = static_cast<std::ptrdiff_t>(way.second / 4);  // next to the clamps, which keep a vessel at the width that it had empty
  rings.erase(rings.end() - held, rings.end());
  rings.erase(rings.begin(), rings.begin() + held);
  return narrowing_of(rings, usual);
}

/// As the trainee sees it with both clamps off (blood_flow.h).
double flow_onwards(const VesselModel& vessel, const Points& x, const std::vector<EdgeGap>& gaps, const BloodOptions& blood) {
  LumenLine line(vessel.mesh);
  line.measure(x, blood.viscosity);
  return balance_join(line, gaps, vessel.circulation, blood).on;
}

/// The scene with a wall and a thread that are balanced to their tolerance in every step: what is measured is a rest, and there is no hurry.
std::shared_ptr<const Model> balanced(const Model& model) {
  auto m = std::make_shared<Model>(model);
  auto vessel = std::make_shared<VesselModel>(*model.vessel);
  vessel->wall.strict_iterations = WallOptions().strict_iterations;
  m->step.max_iterations = std::max(m->step.max_iterations, kThreadIterations);
  m->vessel = vessel;
  return m;
}

}  // namespace

double edge_overlap(const VesselModel& vessel, const Points& x) {
  const Vec3 axis = way_across(vessel, x), middle = vessel.clamp.X_WB.p;
  const auto outward = [&](int i) {
    const Vec3 r = x.col(i) - middle;
    return Vec3((r - r.dot(axis) * axis).normalized());
  };
  double most = 0.0;
  for (const int i : vessel.mesh.edge_ring[0]) {
    double nearest = -2.0, reach = 0.0;
    for (const int j : vessel.mesh.edge_ring[1]) {
      const double like = outward(i).dot(outward(j));
      if (like <= nearest) continue;
      nearest = like;
      reach = (x.col(i) - x.col(j)).dot(axis);
    }
    most = std::max(most, reach);
  }
  return most;
}

double thread_in_lumen(const Model& model, const State& state) {
  const RodState& t = state.thread;
  const VesselMesh& mesh = model.vessel->mesh;
  const std::array<std::vector<LumenRing>, 2> rings = {lumen_rings(mesh, state.tissue.wall.x, 0), lumen_rings(mesh, state.tissue.wall.x, 1)};
  const double whole = arc_of_end(t);
  const std::vector<Stretch> free = between_bites(state.tissue.tracks, t, whole);
  double inside = 0.0, arc = t.arc_start;
  for (int i = 0; i + 1 < t.n; arc += t.rest_length[i++]) {
    if (t.alive[i] == 0) continue;
    const double middle = arc + 0.5 * t.rest_length[i];
    if (std::any_of(free.begin(), free.end(), [&](const Stretch& s) { return middle > s.low && middle < s.high; })) continue;
    const Vec3 q = 0.5 * (t.x.col(i) + t.x.col(i + 1));
    if (within(rings[0], q) || within(rings[1], q)) inside += t.rest_length[i];
  }
  return inside;
}

JoinTestReport join_test(const Model& model, const State& state, const JoinTestOptions& o) {
  JoinTestReport report;
  const VesselMesh& mesh = model.vessel->mesh;
  report.thread_inside = thread_in_lumen(model, state);
  const Points& before = state.tissue.wall.x;
  report.overlap = std::max({edge_overlap(*model.vessel, before), edge_roll(mesh, before, 0), edge_roll(mesh, before, 1)});
  World world(balanced(model));
  world.restore(state);
  report.sound = let_blood_in(world, o);
  const Points& x = world.state().tissue.wall.x;
  BloodOptions blood;
  blood.pressure = o.pressure;
  blood.seal = o.seal;
  report.edge = gaps_of(mesh, x);
  report_leak(blood, report);
  report.narrowing = narrowing_at_join(mesh, x);
  report.through = flow_onwards(*model.vessel, x, report.edge, blood);
  report.patent = is_patent(report.narrowing, report.through, model.vessel->circulation);
  return report;
}

}  // namespace filum
