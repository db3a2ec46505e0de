#include "world/vessel_scene.h"

#include <algorithm>

#include "base/hash.h"
#include "physics/rod_pieces.h"
#include "world/observe.h"

namespace filum {
namespace {

constexpr double kSlideSpeed = 0.5e-3, kTurnSpeed = 1.5;  // [m/s], [rad/s], of the clamp
constexpr std::uint32_t kCut = 2, kNext = 4;             // buttons (world/inputs.h)
constexpr int kFalling = 125;    // steps in which an empty vein loses its pressure at the start
constexpr double kLying = 3e-4;  // [m/s], of a wall that lies
constexpr int kSettling = 500;  // steps at most until the tissue stands still at the start

PassObservation::State state_of(const NeedleTrack& t) noexcept {
  if (t.ended == 2) return PassObservation::State::torn;
  if (t.ended == 1) return PassObservation::State::pulled_out;
  if (t.out == 0) return PassObservation::State::open;
  return t.knots[0].strand >= 0.0 || t.knots[static_cast<std::size_t>(t.n - 1)].strand >= 0.0 ? PassObservation::State::needle : PassObservation::State::thread;
}

std::uint64_t hash_point(const WallPoint& p, std::uint64_t h) noexcept {
  const std::array<double, 4> row = {static_cast<double>(p.element), p.local.x(), p.local.y(), p.local.z()};
  return hash_bytes(row.data(), sizeof(row), h);
}

/// Of a tool that holds tissue.
std::uint64_t hash_grip(const WallGrip& g, std::uint64_t h) noexcept {
  const std::array<double, 5> row = {static_cast<double>(g.n), static_cast<double>(g.through), g.stop, g.leave, g.pull};
  h = hash_bytes(row.data(), sizeof(row), h);
  for (int k = 0; k < g.n; ++k) {
    const WallGripPlace& place = g.places[static_cast<std::size_t>(k)];
    for (std::size_t side = 0; side < 2; ++side) {
      h = hash_bytes(place.offset_T[side].data(), 3 * sizeof(double), h);
      h = hash_point(place.at[side], hash_bytes(place.slid_T[side].data(), 3 * sizeof(double), h));
    }
  }
  return h;
}

std::uint64_t hash_blood(const BloodState& b, std::uint64_t h) noexcept {
  const Milking& m = b.milking;
  const std::array<double, 15> row = {static_cast<double>(b.off[0]), static_cast<double>(b.off[1]), static_cast<double>(b.wrong_order), static_cast<double>(b.known),
                                      static_cast<double>(b.next), b.lost, static_cast<double>(m.stage), static_cast<double>(m.up), static_cast<double>(m.down),
                                      m.up_at, m.from, m.to, m.volume, m.missing, m.time};
  h = hash_bytes(row.data(), sizeof(row), h);
  for (int k = 0; k < b.known; ++k) {
    const EdgeGap& g = b.gaps[static_cast<std::size_t>(k)];
    const std::array<double, 6> gap = {g.gap, g.depth, g.length, g.place.x(), g.place.y(), g.place.z()};
    h = hash_bytes(gap.data(), sizeof(gap), h);
  }
  return h;
}

}  // namespace

VesselScene::VesselScene(const VesselModel& model, const NeedleShape& needle, int thread_capacity)
    : model_(model), wall_(model.mesh, model.layers, model.wall), tracks_(model.track, needle, wall_), contact_(thread_capacity), stray_(model.thickness), wire_(needle) {
  if (model.lumen) blood_ = std::make_unique<BloodFlow>(model_);
}

VesselState VesselScene::start(const Vec3& point) {
  VesselState s;
  s.wall = wall_.first_state();
  wall_.settle(s.wall, kSettling);
  if (model_.slack < 0.0) fall_flat(s);
  wall_.refit(s.wall);
  s.tracks.point_before = point;
  s.clamp.gap = model_.clamp.gap;
  s.clamp.turn = model_.clamp.turn;
  return s;
}

/// The stumps as they lie with no blood in them.
void VesselScene::fall_flat(VesselState& s) {
  s.pressure.fill(model_.slack);
  WallOptions patient = model_.wall;
  patient.strict_iterations = patient.max_iterations = 60;  // steps left unbalanced on the way go on swinging at rest
  VesselWall wall(model_.mesh, model_.layers, patient);
  for (int k = 1; k <= kSettling; ++k) {
    for (int part = 0; part < wall.n_parts(); ++part) wall.set_pressure(part, model_.slack * std::min(1.0, static_cast<double>(k) / kFalling));
    wall.refit(s.wall);
    wall.meet(s.wall);
    wall.step(s.wall);
    if (k > kFalling + 50 && s.wall.v.colwise().norm().maxCoeff() < kLying) break;
  }
  s.wall.v.setZero();
}

void VesselScene::size_observation(Observation& o) const {
  o.tissue.n = model_.mesh.n_nodes();
  o.tissue.positions = model_.mesh.nodes;
}

void VesselScene::hold(const VesselState& s, const Pose& X_WN, bool held, const RodState& thread, std::vector<RodTether>& on_needle,
                       std::vector<RodTether>& on_thread) noexcept {
  wall_.clear_loads();
  tracks_.hold(wall_, s.wall, s.tracks, X_WN, &thread, on_needle, on_thread);
  contact_.hold(wall_, s.wall, s.touches, thread, on_thread);
  wire_.hold(wall_, s.wall, s.wire, s.tracks, X_WN, held, on_needle);
}

void VesselScene::handle_clamp(VesselState& s, std::uint32_t buttons, Observation& o) const noexcept {
  if (!model_.lumen) return;
  ClampState& c = s.clamp;
  blood_->hear(s.blood, buttons, o);
  if (s.blood.flowing()) return;
  const std::uint32_t pressed = buttons & ~c.down, let_go = c.down & ~buttons;
  if ((pressed & kNext) != 0) {
    c.over = (c.over + 1) % static_cast<std::int32_t>(model_.turns.size());
    say(o, "clamp-turned", -1, model_.turns[static_cast<std::size_t>(c.over)], "rad");
  }
  if ((pressed & kCut) != 0) c.closing = c.closing != 0 ? 0 : 1;
  if ((let_go & kCut) != 0) say(o, "clamp-slid", -1, c.gap, "m");
  c.down = buttons & (kCut | kNext);
  DoubleClamp now = model_.clamp;
  now.gap = c.gap;
  now.turn = c.turn;
  const double gap = (buttons & kCut) == 0 ? c.gap : c.closing != 0 ? model_.closed_gap : model_.clamp.gap;
  now = approach(now, gap, model_.clamp.turn + model_.turns[static_cast<std::size_t>(c.over)], model_.wall.dt, kSlideSpeed, kTurnSpeed);
  c.gap = now.gap;
  c.turn = now.turn;
}

void VesselScene::move_clamp(const VesselState& s) noexcept {
  if (!model_.lumen) return;
  DoubleClamp now = model_.clamp;
  now.gap = s.clamp.gap;
  now.turn = s.clamp.turn;
  if (now.gap == model_.clamp.gap && now.turn == model_.clamp.turn) {  // as the mesh was made, without rounding
    for (int part = 0; part < 2; ++part) wall_.place_clamp(part, {});
    return;
  }
  const auto motion = clamp_motion(model_.clamp, now, model_.shape.stretch * model_.shape.length);
  for (int part = 0; part < 2; ++part) wall_.place_clamp(part, motion[static_cast<std::size_t>(part)]);
}

double VesselScene::stop_angle(const VesselState& s, int tool, const GrippingTool& jaws) const noexcept {
  const WallGrip& grip = s.grips[static_cast<std::size_t>(tool)];
  if (grip.n > 0) return grip.stop;
  return blood_ ? blood_->stop_angle(s.wall, jaws.parameters, jaws.state) : 0.0;
}

void VesselScene::meet_jaws(VesselState& s, int tool, const GrippingTool& jaws, bool may_take, Observation& o) const noexcept {
  WallGrip& grip = s.grips[static_cast<std::size_t>(tool)];
  if (grip.n > 0) {
    if (jaws.state.angle <= grip.leave) return;
    say(o, "tissue-released", tool, grip.pull, "N");
    grip = {};
    return;
  }
  if (!may_take || (blood_ && blood_->stop_angle(s.wall, jaws.parameters, jaws.state) > 0.0)) return;  // a vessel is milked, not grasped
  if (take_wall(wall_, s.wall, jaws, {model_.thickness, model_.adventitia}, grip)) say(o, grip.through != 0 ? "wall-taken" : "tissue-taken", tool, 0.0, "-");
}

void VesselScene::hold_back(const VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<ObstacleBody>& from,
                            std::vector<InstrumentState>& states) const noexcept {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    InstrumentState& tool = states[i];
    const Pose& before = from[i].X_start;
    const double share = contact_.free_way(wall_, s.wall, tools[i], before, tool);
    if (share >= 1.0) continue;
    tool.X_WT = {before.p + share * (tool.X_WT.p - before.p), before.q.slerp(share, tool.X_WT.q)};
    tool.v *= share;
    tool.w *= share;
  }
}

void VesselScene::press(VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, Observation& o) noexcept {
  if (blood_) blood_->step(s, tools, states, o);
  contact_.press(wall_, s.wall, tools, states);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    WallGrip& grip = s.grips[i];
    if (grip.n == 0) continue;
    pull_wall(wall_, s.wall, {tools[i], states[i]}, grip);
    if (grip.n > 0) continue;
    say(o, "tissue-slipped", static_cast<int>(i), states[i].grip_force, "N");
    grip = {};
  }
}

void VesselScene::feel(VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, std::vector<Vec3>& force,
                       std::vector<Vec3>& torque) const noexcept {
  contact_.feel(wall_, force, torque);
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (s.grips[i].n > 0) feel_wall(wall_, s.wall, {tools[i], states[i]}, s.grips[i], force[i], torque[i]);
}

void VesselScene::step(VesselState& s, const Pose& X_WN, bool held, const RodState& thread, const std::vector<RodTether>& on_needle,
                       const std::vector<RodTether>& on_thread, Observation& o) noexcept {
  std::array<TrackEvent, 8> events;
  const int n = tracks_.follow(wall_, s.wall, s.tracks, X_WN, &thread, model_.wall.dt, on_needle, on_thread, events.data(), static_cast<int>(events.size()));
  for (int k = 0; k < n; ++k) say(o, events[static_cast<std::size_t>(k)].name, -1, events[static_cast<std::size_t>(k)].value, "N");
  contact_.follow(wall_, s.wall, s.touches, s.tracks, thread, on_thread);
  wire_.follow(wall_, s.wall, s.wire, s.tracks, X_WN, held, on_needle);
  for (int part = 0; part < std::min(2, wall_.n_parts()); ++part) wall_.set_pressure(part, s.pressure[static_cast<std::size_t>(part)]);
  move_clamp(s);
  wall_.meet(s.wall);
  tracks_.mark_point(wall_, s.wall, s.tracks);
  const WallSummary summary = wall_.step(s.wall);
  if (!summary.sound) say(o, "solver-trouble", -1, summary.residual, "N");
  wall_.refit(s.wall);
  tracks_.carry_point(wall_, s.wall, s.tracks);
  wire_.feel(wall_, s.wire);
  contact_.overtake(wall_, s.wall, s.touches, s.tracks, thread);
  stray_.step(wall_, s.wall, s.tracks, thread, s.strays, s.touches);
  wire_.overtake(wall_, s.wall, s.wire, s.tracks, X_WN);
}

void VesselScene::observe(const VesselState& s, const RodState& thread, Observation& o) const noexcept {
  TissueObservation& t = o.tissue;
  t.positions = s.wall.x;
  t.n_passes = s.tracks.n;
  t.point_force = s.tracks.point.force;
  t.soundness = *std::min_element(s.wall.soundness.begin(), s.wall.soundness.end());
  for (std::size_t i = 0; i < s.grips.size(); ++i) {
    const WallGrip& grip = s.grips[i];
    t.grips[i] = {};
    if (grip.n > 0) t.grips[i] = {true, grip.through != 0, grip.pull, model_.mesh.part[static_cast<std::size_t>(grip.places[0].at[0].element)]};
  }
  if (blood_) blood_->observe(s, t.blood);
  const double whole = arc_of_end(thread);
  for (int k = 0; k < s.tracks.n; ++k) {
    const NeedleTrack& track = s.tracks.tracks[static_cast<std::size_t>(k)];
    PassObservation& p = t.passes[static_cast<std::size_t>(k)];
    p.state = state_of(track);
    p.out = track.out != 0;
    p.side = track.part;
    const WallPoint& in = track.n > 0 ? track.knots[0].at : track.entry;
    p.entry_W = wall_.position(s.wall, in);
    p.entry_rest = tracks_.walk().at_rest(wall_, track.entry);
    p.entry_angle = track.entry_angle;
    p.entry_depth = wall_.depth_at(track.entry);
    p.bite_entry = track.bite_entry;
    if (p.out) {
      p.exit_W = wall_.position(s.wall, track.n > 0 ? track.knots[static_cast<std::size_t>(track.n - 1)].at : track.exit);
      p.exit_rest = tracks_.walk().at_rest(wall_, track.exit);
      p.exit_angle = track.exit_angle;
      p.exit_depth = wall_.depth_at(track.exit);
      p.bite_exit = track.bite_exit;
    }
    p.depth_share = std::max(0.0, track.deep - track.shallow);
    p.shallow = track.shallow;
    p.deep = track.deep;
    p.arc = track.n > 0 && track.knots[0].strand < 0.0 ? whole + track.knots[0].strand : -1.0;
    p.tension = track.pull;
    p.peak_force = track.peak;
    p.hole = track.hole;
    p.torn = track.torn;
  }
}

std::uint64_t hash_vessel(const VesselState& s) noexcept {
  std::uint64_t h = hash_bytes(s.wall.x.data(), sizeof(double) * static_cast<std::size_t>(s.wall.x.size()));
  h = hash_bytes(s.wall.v.data(), sizeof(double) * static_cast<std::size_t>(s.wall.v.size()), h);
  h = hash_bytes(s.wall.soundness.data(), sizeof(double) * s.wall.soundness.size(), h);
  const TrackState& t = s.tracks;
  for (int i = 0; i < t.n; ++i) {
    const NeedleTrack& track = t.tracks[static_cast<std::size_t>(i)];
    const std::array<double, 9> row = {static_cast<double>(track.n), static_cast<double>(track.out), static_cast<double>(track.ended), track.hole,
                                       track.torn, track.peak, track.pull, track.shallow, track.deep};
    h = hash_bytes(row.data(), sizeof(row), h);
    for (int k = 0; k < track.n; ++k) {
      const TrackKnot& knot = track.knots[static_cast<std::size_t>(k)];
      const std::array<double, 3> values = {knot.strand, knot.span, knot.lateral};
      h = hash_bytes(values.data(), sizeof(values), hash_point(knot.at, h));
    }
  }
  for (const TouchState* touches : {&s.touches, &s.wire}) {
    for (int k = 0; k < touches->n; ++k) {
      const SurfaceTouch& touch = touches->touches[static_cast<std::size_t>(k)];
      const std::array<double, 5> row = {touch.arc, touch.load, touch.normal.x(), touch.normal.y(), touch.normal.z()};
      h = hash_bytes(row.data(), sizeof(row), hash_point(touch.at, h));
    }
  }
  const ClampState& c = s.clamp;
  const std::array<double, 5> clamp = {c.gap, c.turn, static_cast<double>(c.over), static_cast<double>(c.closing), static_cast<double>(c.down)};
  h = hash_bytes(clamp.data(), sizeof(clamp), h);
  if (s.blood.flowing()) h = hash_blood(s.blood, h);  // else as it was before there was any
  for (std::size_t i = 0; i < s.grips.size(); ++i)
    if (s.grips[i].n > 0) h = hash_grip(s.grips[i], h + i);  // likewise
  for (int k = 0; k < s.strays.n; ++k) {  // likewise; when they are looked for again goes by the number of steps
    const StrayPlace& place = s.strays.places[static_cast<std::size_t>(k)];
    const std::array<double, 4> row = {place.strand, place.x.x(), place.x.y(), place.x.z()};
    h = hash_bytes(row.data(), sizeof(row), h);
  }
  const std::array<double, 9> row = {static_cast<double>(t.open), static_cast<double>(t.point.kind), t.point.threshold, t.point.force,
                                     t.point_before.x(), t.point_before.y(), t.point_before.z(), s.pressure[0], s.pressure[1]};
  return hash_point(t.point.at, hash_bytes(row.data(), sizeof(row), h));
}

}  // namespace filum
