#include "world/blood_flow.h"

#include <algorithm>
#include <cmath>

#include "collision/segment_distance.h"
#include "world/observe.h"

namespace filum {
namespace {

constexpr double kRise = 13332.0 / 0.1;   // [Pa/s]
constexpr double kNearArm = 0.5e-3;       // [m], of an arm from jaws that have it between them
constexpr double kOnArm = 0.1e-3;         // [m], of jaws from an arm on which they have closed
constexpr double kAcross = 0.5;           // least cosine between the vessel and the jaws' width
constexpr double kFlat = 1.2;             // of twice the wall: jaws this near hold the vessel shut
constexpr std::uint32_t kOff[2] = {8, 16};  // buttons (world/inputs.h)

double towards(double now, double wanted, double most) noexcept { return now + std::clamp(wanted - now, -most, most); }

}  // namespace


Pose clamp_pose(const VesselModel& vessel, const ClampState& clamp, int which) noexcept {
  Pose X = held_end(vessel, clamp, which);
  if ((X.q * Vec3::UnitY()).z() < 0.0) X.q = X.q * Quat(0, 0, 0, 1);
  return X;
}

BloodFlow::BloodFlow(const VesselModel& vessel) : model_(vessel), line_(vessel.mesh), circulation_(vessel.circulation) { line_.measure(vessel.mesh.nodes, blood_.viscosity); }

void BloodFlow::take_off(BloodState& b, int which, int tool, Observation& o) const noexcept {
  if (b.off[static_cast<std::size_t>(which)] != 0) return;
  b.off[static_cast<std::size_t>(which)] = 1;
  say(o, "clamp-off", tool, which, "-");
  if (which == 0 || b.off[0] != 0) return;
  b.wrong_order = 1;
  say(o, "clamps-wrong-order", tool, 0.0, "-");
}

void BloodFlow::hear(BloodState& b, std::uint32_t buttons, Observation& o) const noexcept {
  for (int k = 0; k < 2; ++k)
    if ((buttons & kOff[k]) != 0) take_off(b, k, -1, o);
}

/// Both arms, above the vessel, are between the jaws, which are commanded to close further and have come to the outer one.
bool BloodFlow::squeezes(const ClampState& clamp, int which, const InstrumentParameters& jaws, const InstrumentState& state) const noexcept {
  const ClampArms arms = clamp_arms(model_);
  const Pose X_TC = state.X_WT.inverse() * clamp_pose(model_, clamp, which);
  double outermost = 0.0, opening = 0.0;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 a = X_TC * Vec3(side * arms.beside, model_.radius, -arms.behind), b = X_TC * Vec3(side * arms.beside, arms.reach, -arms.behind);
    const SegmentPair c = closest_points(a, b, Vec3::Zero(), 0.5 * jaws.jaw_length * Vec3::UnitZ());
    const Vec3 p = a + c.s * (b - a);
    const double half = (jaws.jaw_length - p.z()) * std::sin(0.5 * state.angle);
    const double outer = std::abs(p.x()) + arms.radius;
    if (c.distance > std::hypot(outer, kNearArm) || std::abs(p.y()) > kNearArm || outer > half + kNearArm) return false;
    if (outer < outermost) continue;
    outermost = outer;
    opening = half;
  }
  return 0.5 * jaws.jaw_length * state.grip_command < outermost - kOnArm && opening < outermost + kOnArm;
}

bool BloodFlow::open_with(VesselState& s, int tool, const InstrumentParameters& jaws, const InstrumentState& state, Observation& o) const noexcept {
  for (int k = 0; k < 2; ++k) {
    if (s.blood.off[static_cast<std::size_t>(k)] != 0 || !squeezes(s.clamp, k, jaws, state)) continue;
    take_off(s.blood, k, tool, o);
    return true;
  }
  return false;
}

/// Where the centre line crosses the middle plane of the tool between the tips and the middle of the jaws.
BloodFlow::Between BloodFlow::between(const InstrumentParameters& tool, const InstrumentState& state) const noexcept {
  const Pose X_TW = state.X_WT.inverse();
  for (int k = 1; k < line_.n(); ++k) {
    const Vec3 a = X_TW * line_.middle(k - 1), b = X_TW * line_.middle(k), run = b - a;
    if (a.y() * b.y() > 0.0 || std::abs(run.y()) < kAcross * run.norm()) continue;
    const double f = a.y() / (a.y() - b.y());
    const Vec3 at = a + f * run;
    const double half = (tool.jaw_length - at.z()) * std::sin(0.5 * state.angle);
    if (at.z() < 0.0 || at.z() > 0.5 * tool.jaw_length || std::abs(at.x()) > half + model_.thickness) continue;
    return {line_.along(k - 1) + f * (line_.along(k) - line_.along(k - 1)), at.z()};
  }
  return {};
}

double BloodFlow::stop_angle(const WallState& wall, const InstrumentParameters& tool, const InstrumentState& state) noexcept {
  line_.measure(wall.x, blood_.viscosity);
  const Between where = between(tool, state);
  return where.along < 0.0 ? 0.0 : 2.0 * std::asin(model_.thickness / (tool.jaw_length - where.depth));
}

Balance BloodFlow::balance(const BloodState& b) const noexcept {
  const std::span<const EdgeGap> gaps(b.gaps.data(), static_cast<std::size_t>(b.known));
  const double up = b.off[0] != 0 ? circulation_.upstream() + line_.resistance(0.0, line_.join()) : 0.0;
  const double down = b.off[1] != 0 && !b.milking.shut()
                          ? circulation_.downstream() + line_.resistance(line_.join(), line_.length())
                          : 0.0;
  return balance_blood(circulation_.pressure, up, gaps, down, circulation_.back, blood_);
}

void BloodFlow::measure(BloodState& b, const WallState& wall) noexcept {
  const auto nodes = std::min(model_.mesh.edge_ring[0].size(), b.gaps.size());
  for (std::size_t k = 0; k < (b.known == 0 ? nodes : 1); ++k) {  // all at once when the first clamp comes off
    const auto at = static_cast<std::size_t>(b.next);
    b.gaps[at] = edge_gap(model_.mesh, wall.x, 0, 1, at);
    b.next = static_cast<std::int32_t>((at + 1) % nodes);
  }
  b.known = static_cast<std::int32_t>(nodes);
  line_.measure(wall.x, blood_.viscosity);
}

void BloodFlow::let_forceps_milk(BloodState& b, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states,
                                 Observation& o) const noexcept {
  std::array<double, 3> closed{-1.0, -1.0, -1.0};
  for (std::size_t i = 0; i < tools.size() && i < closed.size(); ++i) {
    const Between where = between(tools[i], states[i]);
    const double gap = 2.0 * (tools[i].jaw_length - where.depth) * std::sin(0.5 * states[i].angle);
    if (where.along >= 0.0 && gap < 2.0 * kFlat * model_.thickness) closed[i] = where.along;
  }
  const std::span<const EdgeGap> gaps(b.gaps.data(), static_cast<std::size_t>(b.known));
  const MilkingNews news = milk(b.milking, line_, closed, b.off[0] != 0 && b.off[1] != 0, circulation_, gaps, blood_, model_.wall.dt);
  constexpr std::array<const char*, 5> kNews = {"", "milking-let-go", "milking-refilled", "milking-stayed-empty", "milking-spoiled"};
  const bool emptied = news == MilkingNews::let_go;
  if (news != MilkingNews::none) say(o, kNews[static_cast<std::size_t>(news)], -1, emptied ? 1e9 * b.milking.volume : b.milking.time, emptied ? "ul" : "s");
}

void BloodFlow::step(VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, Observation& o) noexcept {
  BloodState& b = s.blood;
  if (!b.flowing()) return;
  measure(b, s.wall);
  const Balance now = balance(b);
  let_forceps_milk(b, tools, states, o);
  const Milking& m = b.milking;
  const double empty = m.emptied() ? (m.to - m.from) * m.missing / m.volume / (line_.length() - line_.join()) : 0.0;
  const std::array<double, 2> wanted = {now.pressure, now.pressure * (1.0 - std::min(1.0, empty))};
  const std::size_t near = b.off[0] != 0 ? 0 : 1;  // the stump that blood comes into first
  const double most = kRise * model_.wall.dt, before = s.pressure[near];
  s.pressure[near] = towards(before, wanted[near], most);
  if (before > 0.9 * wanted[near] || s.pressure[1 - near] > 0.0) s.pressure[1 - near] = towards(s.pressure[1 - near], wanted[1 - near], most);
  b.lost += now.leak * std::clamp(s.pressure[near] / std::max(now.pressure, 1.0), 0.0, 1.0) * model_.wall.dt;  // under suction none comes back
}

void BloodFlow::observe(const VesselState& s, BloodObservation& o) noexcept {
  o.present = true;
  o.n_clamps = n_clamps(model_);
  for (int k = 0; k < o.n_clamps; ++k) {
    o.clamp_W[static_cast<std::size_t>(k)] = clamp_pose(model_, s.clamp, k);
    o.off[static_cast<std::size_t>(k)] = k < 2 && s.blood.off[static_cast<std::size_t>(k)] != 0;
  }
  o.wrong_order = s.blood.wrong_order != 0;
  o.pressure = s.pressure;
  o.lost = s.blood.lost;
  line_.measure(s.wall.x, blood_.viscosity);
  o.least_area = line_.least_area();
  o.lumen_length = line_.length();
  if (!s.blood.flowing()) {  // what is told may be of a state before
    o.leaks = o.through = o.empty_from = o.empty_to = 0.0;
    o.leak.fill(0.0);
    o.milking = Milking::idle;
    return;
  }
  const Balance now = balance(s.blood);
  std::array<LeakSector, kLeakSectors> sectors;
  BloodOptions here = blood_;
  here.pressure = std::min(now.pressure, s.pressure[s.blood.off[0] != 0 ? 0 : 1]);
  o.leaks = leak_through({s.blood.gaps.data(), static_cast<std::size_t>(s.blood.known)}, sectors, here);
  for (std::size_t k = 0; k < sectors.size(); ++k) {
    o.leak[k] = sectors[k].flow;
    o.place[k] = sectors[k].place;
  }
  o.through = now.on;
  const Milking& m = s.blood.milking;
  o.milking = m.stage;
  o.empty_from = m.emptied() ? m.to - (m.to - m.from) * m.missing / m.volume : 0.0;
  o.empty_to = m.emptied() ? m.to : 0.0;
}

}  // namespace filum
