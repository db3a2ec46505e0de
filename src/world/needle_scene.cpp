#include "world/needle_scene.h"

#include <algorithm>
#include <cmath>

#include "base/stage_clock.h"
#include "world/fixtures.h"
#include "world/needle_model.h"
#include "world/observe.h"

namespace filum {
namespace {

constexpr double kSwage = 2e4;         // [N/m], of the joint between needle and thread
constexpr double kTroubleForce = 1e-4;  // [N], imbalance worth reporting
constexpr double kApart = 20e-6;        // [m], between thread and needle: at kSwage 0.4 N, as much as a thread of 10-0 bears
constexpr double kSinks = 10e-6;        // [m], of thread or a loose needle into tissue in a step: 5 mm/s
constexpr double kHeldApart = 15e-6;    // [m]: a thread of 10-0 that is torn off by 0.2 N breaks before
constexpr double kClosing = 1e-3;       // [rad/s], of jaws that close
constexpr int kMostCatches = 4;         // times that a step is made again because it took thread through tissue
constexpr int kMostRepeats = 4;         // of a step that ends with them apart

}  // namespace

NeedleScene::NeedleScene(const Model& model) : model_(model), body_(model.needle->shape, static_cast<int>(model.instruments.size())), fresh_(model) {
  options_.dt = model.step.dt;
  options_.gravity = model.step.gravity;
  options_.sheet = model.description.floor_height;
  thread_between_.reserve(kGraspPointsPerTool);
  if (!model.description.has_post) body_.bars = surroundings(model).bars;  // a post it does not touch
  for (std::size_t i = 0; i < body_.tools.size(); ++i) body_.tools[i].pads = model.instruments[i].pads;
  if (model.vessel) tissue_ = std::make_unique<VesselScene>(*model.vessel, body_.shape(), model.description.capacity);
}

void NeedleScene::start(State& s) {
  s.has_needle = 1;
  s.needle.X_WN = model_.needle->start;
  if (tissue_) s.tissue = tissue_->start(s.needle.X_WN * body_.shape().point(body_.shape().length()));
  memory_before_.self.reserve(s.memory.self.capacity());
  memory_before_.obstacle.reserve(s.memory.obstacle.capacity());
  memory_before_.grasps.reserve(s.memory.grasps.capacity());
  keep(s);
}

void NeedleScene::size_observation(Observation& o) const {
  if (tissue_) tissue_->size_observation(o);
}

void NeedleScene::match(const State& s) noexcept {
  if (tissue_) tissue_->match(s.tissue);
}

void NeedleScene::handle_buttons(State& s, std::uint32_t buttons, Observation& o) const noexcept {
  fresh_.hear(s, buttons, o);
  if (tissue_) tissue_->handle_clamp(s.tissue, buttons, o);
}

double NeedleScene::stop_angle(const InstrumentParameters& tool) const noexcept {
  return 2.0 * body_.shape().wire_radius / tool.jaw_length;
}

double NeedleScene::squeeze(const InstrumentParameters& tool, double stop, double command) noexcept {
  return std::clamp(tool.grip_stiffness * (stop - command) / tool.jaw_length, 0.0, tool.max_grip_force);
}

void NeedleScene::limit_jaws(const State& s, std::vector<InstrumentCommand>& commands) const noexcept {
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const InstrumentParameters& tool = model_.instruments[i];
    if (tool.kind == "scissors") continue;
    const double reach = std::max(2.0 * body_.shape().wire_radius, 0.5 * tool.jaw_length * s.instruments[i].angle);
    const bool wire = s.needle.grips[i].held != 0 || body_.between(static_cast<int>(i), reach, s.needle);
    const double stop = wire ? stop_angle(tool) : tissue_ ? tissue_->stop_angle(s.tissue, static_cast<int>(i), {tool, s.instruments[i]}) : 0.0;
    InstrumentCommand& c = commands[i];
    const double command = c.follow ? c.grip_angle : s.instruments[i].grip_command;
    if (command >= stop || stop == 0.0) continue;
    c.grip_force = !c.follow ? s.instruments[i].grip_force : c.has_grip_force ? c.grip_force : squeeze(tool, stop, command);
    c.has_grip_force = true;
    c.grip_angle = stop;
  }
}

/// Jaws that close, hold nothing and have neither wire nor thread between them: these they take.
bool NeedleScene::may_take_tissue(const State& s, int tool) noexcept {
  const auto i = static_cast<std::size_t>(tool);
  const InstrumentState& in = s.instruments[i];
  const double half_gap = 0.5 * model_.instruments[i].jaw_length * in.angle;
  if (s.armed[i] == 0 || s.needle.grips[i].held != 0 || in.angle_rate > -kClosing) return false;
  if (std::any_of(s.memory.grasps.begin(), s.memory.grasps.end(), [&](const GraspPoint& p) { return p.tool == tool; })) return false;
  if (body_.between(tool, std::max(2.0 * body_.shape().wire_radius, half_gap), s.needle)) return false;
  thread_between_.clear();
  return grasp_between(model_.instruments[i].pads, in.X_WT, tool, s.thread, half_gap + 4.0 * model_.thread.radius, thread_between_) == 0;
}

void NeedleScene::meet_tools(State& s, const std::vector<ObstacleBody>& from, Observation& o) noexcept {
  for (std::size_t i = 0; i < body_.tools.size(); ++i) {
    const InstrumentParameters& p = model_.instruments[i];
    const InstrumentState& in = s.instruments[i];
    NeedleTool& t = body_.tools[i];
    NeedleGrip& grip = s.needle.grips[i];
    const int tool = static_cast<int>(i);
    t.X_start = from[i].X_start;
    t.X_end = in.X_WT;
    t.grip_force = in.grip_force;
    t.bars = instrument_bars(p, in.angle, 2.0 * body_.shape().wire_radius);
    const bool meet = in.angle < 1.15 * stop_angle(p) && p.kind != "scissors";
    if (tissue_ && p.kind != "scissors" && grip.held == 0 && s.armed[i] != 0 && tissue_->open_clamp(s.tissue, tool, {p, in}, o)) s.armed[i] = 0;
    const bool closed = meet && in.grip_force > 0.0;
    if (grip.held != 0 && !closed) {
      say(o, "needle-released", tool, grip.arc / body_.shape().length(), "-");
      grip = {};
    } else if (grip.held == 0 && closed && s.armed[i] != 0 && body_.take(tool, 2.0 * body_.shape().wire_radius, s.needle)) {
      s.armed[i] = 0;
      say(o, "needle-taken", tool, grip.arc / body_.shape().length(), "-");
    }
    t.bars_touch = grip.held == 0;
    if (tissue_ && p.kind != "scissors") tissue_->meet_jaws(s.tissue, tool, {p, in}, may_take_tissue(s, tool), o);
  }
}

void NeedleScene::before_thread(const State& s, ImplicitRod& rod) noexcept {
  const StageScope stage("needle and tissue");
  body_.tethers.clear();
  std::vector<RodTether>& on_thread = rod.tethers.list;
  on_thread.clear();
  RodTether& swage = on_thread.emplace_back();
  swage.at_end = true;
  if (tissue_) tissue_->hold(s.tissue, s.needle.X_WN, s.needle.in_hand(), s.thread, body_.tethers, on_thread);
  hold_swage(s, rod, s.needle.in_hand() ? s.needle.pull : Vec3::Zero());  // loose, it would fly off
}

/// Where the thread's end is held, and how firmly, by a needle that `load` [N] pulls at.
void NeedleScene::hold_swage(const State& s, ImplicitRod& rod, const Vec3& load) noexcept {
  RodTether& swage = rod.tethers.list.front();
  swage.stiffness = body_.look_ahead(s.needle, options_, 0.0, swage.anchor, load);
}

/// The needle goes where the thread's end went, as far as what holds it lets it.
void NeedleScene::follow(State& s) noexcept {
  const StageScope stage("needle and tissue");
  RodTether swage;
  swage.stiffness = kSwage * Mat3::Identity();
  swage.anchor = s.thread.x.col(s.thread.n - 1);
  body_.tethers.push_back(swage);
  summary_ = body_.step(s.needle, options_);
  s.needle.pull = body_.tethers.back().force;
  body_.tethers.pop_back();
}

double NeedleScene::apart(const State& s) const noexcept { return (s.needle.X_WN * body_.shape().point(0.0) - s.thread.x.col(s.thread.n - 1)).norm(); }

void NeedleScene::keep(const State& s) noexcept {
  thread_before_ = s.thread;
  memory_before_ = s.memory;
  needle_before_ = s.needle;
}

void NeedleScene::take_back(State& s) const noexcept {
  s.thread = thread_before_;
  s.memory = memory_before_;
  s.needle = needle_before_;
}

/// Thread and needle stand apart, and by another force than the thread's: what was seen ahead was wrong. (A thread drawn to its strength, or whose own step
/// found no balance, tells nothing of that.)
bool NeedleScene::misled(const State& s, const ImplicitRod& rod) const noexcept {
  const Vec3 differ = s.needle.pull + rod.tethers.list.front().force;
  return apart(s) > kApart && differ.norm() > 0.5 * s.needle.pull.norm();
}

/// A step that takes thread through tissue is made again, held back where it went in. The pull of the last step, under which the swage is seen ahead, is not the thread's where
/// jaws have just snapped shut on the wire: then the step is made again under the pull that the thread turned out to have.
RodStepSummary NeedleScene::attempt(State& s, ImplicitRod& rod, const RodStepOptions& o) noexcept {
  RodStepSummary thread = rod.step(s.thread, s.memory, o);
  follow(s);
  for (int k = 0; k < kMostCatches && tissue_ && tissue_->catches(s.tissue, s.thread, rod.tethers.list); ++k) {
    take_back(s);
    thread = rod.step(s.thread, s.memory, o);
    follow(s);
  }
  for (int k = 0; k < kMostRepeats && thread.residual < kTroubleForce && misled(s, rod); ++k) {
    take_back(s);
    hold_swage(s, rod, -rod.tethers.list.front().force);
    thread = rod.step(s.thread, s.memory, o);
    follow(s);
  }
  return thread;
}

/// Above one: no thread bears what the step left unbalanced or what tears it off its needle, or it or a loose needle goes through tissue at more than kSinks, deeper than that pushes back.
double NeedleScene::overload(const State& s, const RodStepSummary& thread) const noexcept {
  const double through = tissue_ ? tissue_->sinks(s.tissue, s.thread, s.needle.X_WN, s.needle.in_hand()) : 0.0;
  return std::max({thread.residual / model_.thread.strength, apart(s) / kHeldApart, through / kSinks});
}

/// Where the instruments' ways overload thread or tissue they stand still, unless that is no better.
RodStepSummary NeedleScene::step_thread(State& s, ImplicitRod& rod, const RodStepOptions& o, HeldTools& tools) noexcept {
  keep(s);
  before_thread(s, rod);
  RodStepSummary thread = attempt(s, rod, o);
  const double moved = overload(s, thread);
  if (moved <= 1.0) return thread;
  const auto again = [&](bool held) {
    take_back(s);
    tools.put(s, rod, held);
    for (std::size_t i = 0; i < body_.tools.size(); ++i) body_.tools[i].X_end = s.instruments[i].X_WT;
    hold_swage(s, rod, s.needle.in_hand() ? s.needle.pull : Vec3::Zero());
    return attempt(s, rod, o);
  };
  tools.find(s, rod.obstacles.bodies);
  thread = again(true);
  return overload(s, thread) < moved ? thread : again(false);
}

void NeedleScene::after_thread(State& s, ImplicitRod& rod, Observation& o) noexcept {
  const StageScope stage("needle and tissue");
  thread_pull_ = rod.tethers.list.front().force.norm();
  if (!summary_.sound || summary_.residual > kTroubleForce || apart(s) > kApart) say(o, "solver-trouble", -1, summary_.residual, "N");
  if (tissue_) tissue_->press(s.tissue, model_.instruments, s.instruments, o);
  if (tissue_) tissue_->step(s.tissue, s.needle.X_WN, s.needle.in_hand(), s.thread, body_.tethers, rod.tethers.list, o);
  if (tissue_) tissue_->feel(s.tissue, model_.instruments, s.instruments, s.force, s.torque);
  for (std::size_t i = 0; i < body_.tools.size(); ++i) {
    s.force[i] += body_.tools[i].force;
    s.torque[i] += body_.tools[i].torque;
    if (needle_before_.grips[i].held != 0 && s.needle.grips[i].held == 0) say(o, "needle-dropped", static_cast<int>(i), s.instruments[i].grip_force, "N");
  }
}

void NeedleScene::observe(const State& s, Observation& o) const noexcept {
  const NeedleShape& shape = body_.shape();
  NeedleObservation& n = o.needle;
  n.present = true;
  n.X_WN = s.needle.X_WN;
  n.point_W = s.needle.X_WN * shape.point(shape.length());
  n.point_direction_W = s.needle.X_WN.q * shape.tangent(shape.length());
  n.swage_W = s.needle.X_WN * shape.point(0.0);
  n.sutures_left = model_.sutures - s.sutures.taken;
  n.thread_pull = thread_pull_;
  if (tissue_) tissue_->observe(s.tissue, s.thread, o);
  for (std::size_t i = 0; i < body_.tools.size(); ++i) {
    const NeedleGrip& g = s.needle.grips[i];
    n.held[i] = g.held != 0;
    n.grip_share[i] = g.arc / shape.length();
    const Vec3 wire = s.needle.X_WN.q * shape.tangent(g.arc), handle = s.instruments[i].X_WT.q * Vec3::UnitZ();
    n.grip_angle[i] = n.held[i] ? std::acos(std::min(1.0, std::abs(wire.dot(handle)))) : 0.0;
  }
}

}  // namespace filum
