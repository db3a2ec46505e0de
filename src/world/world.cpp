#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stage_clock.h"
#include "physics/ode_trouble.h"
#include "world/brain_scene.h"
#include "world/clamp_bars.h"
#include "world/fixtures.h"
#include "world/fresh_suture.h"
#include "world/held_tools.h"
#include "world/model.h"
#include "world/needle_scene.h"
#include "world/observe.h"
#include "world/state.h"
#include "world/state_hash.h"
#include "world/vessel_model.h"

namespace filum {
namespace {

constexpr double kFarthestHand = 10.0;  // [m], beyond which a pose is no hand's but a fault
constexpr double kTrouble = 1e-4;      // [N], imbalance left by the solver that is worth reporting
constexpr double kTakeGap = 0.10e-3;   // [m], tip gap below which closing jaws take what lies between them
constexpr double kLeaveGap = 0.16e-3;  // [m], tip gap above which they have let go
constexpr double kMostStrands = 8.0;   // at their strength: more than these an instrument does not feel of the thread
constexpr double kIgnore = 0.45e-3;    // [m], thread on either side of the pads that does not touch the jaws that hold it

/// Points where the thread has parted are held no longer.
void let_go_of_gaps(const RodState& s, std::vector<GraspPoint>& points) noexcept {
  constexpr double kAtNode = 1e-9;
  std::erase_if(points, [&](const GraspPoint& p) {
    const auto [edge, f] = locate_arc(s, p.arc);
    return s.alive[edge] == 0 && f > kAtNode && f < 1.0 - kAtNode;
  });
}

}  // namespace

struct World::Impl {
  std::shared_ptr<const Model> model;
  State state;
  ImplicitRod rod;
  Instruments instruments;
  Pellets pellets;
  std::vector<InstrumentCommand> commands;
  RodStepSummary solver;
  std::unique_ptr<BrainScene> brain;  // in scenes of brain retraction: then it takes the whole step
  std::unique_ptr<NeedleScene> needle;  // in scenes with one
  HeldTools held_tools;
  RodState thread_before;               // of the present step of a thread without needle, for when it is made again
  RodMemory memory_before;
  std::unique_ptr<ClampBars> clamp;     // that holds two vessels
  std::vector<RoundBar> still, around;  // bars that instruments touch: those that stand still, and the clamp's besides
  Observation observation;

  explicit Impl(std::shared_ptr<const Model> m);
  void read_inputs(const Inputs& inputs) noexcept;
  void move_clamp() noexcept;
  void move_instruments() noexcept;
  void open_and_close_jaws() noexcept;
  void take_or_cut(int tool) noexcept;
  void note_cut(double arc) noexcept;
  void ignore_held_thread() noexcept;
  void step_thread() noexcept;
  RodStepSummary step_bare_thread() noexcept;
  void feel_thread() noexcept;
  void stop_at_thread() noexcept;
  void step_pellets() noexcept;
  void part_overloaded_thread() noexcept;
  void start_brain();
  void step_brain(const Inputs& inputs) noexcept;
  double smallest_gap() const noexcept;
  void observe() noexcept;

  double tip_gap(int tool) const noexcept {
    const InstrumentState& s = state.instruments[static_cast<std::size_t>(tool)];
    return 2.0 * model->instruments[static_cast<std::size_t>(tool)].jaw_length * std::sin(0.5 * s.angle);
  }
  int held_by(int tool) const noexcept {
    return static_cast<int>(std::count_if(state.memory.grasps.begin(), state.memory.grasps.end(),
                                          [&](const GraspPoint& p) { return p.tool == tool; }));
  }
  void event(const char* name, int tool, double value, const char* unit) noexcept {
    say(observation, name, tool, value, unit);
  }
};

World::Impl::Impl(std::shared_ptr<const Model> m)
    : model(std::move(m)),
      rod(model->thread, model->contact, model->description.capacity, model->description.n_tools),
      instruments(model->instruments_touch ? Instruments(model->instruments, surroundings(*model)) : Instruments(model->instruments)),
      pellets(model->pellets, model->description.floor_height),
      held_tools(model->instruments.size()) {
  if (model->brain) {
    start_brain();
    return;
  }
  const auto n_tools = model->instruments.size();
  state.thread = first_thread(*model);
  state.memory = rod.make_memory();
  memory_before = rod.make_memory();  // a copy would not keep its room
  thread_before = state.thread;
  commands.resize(n_tools);
  for (std::size_t i = 0; i < n_tools; ++i) {
    InstrumentState s;
    s.X_WT = s.X_WD = model->instrument_start[i];
    s.angle = s.grip_command = 0.5 * model->instruments[i].max_angle;
    state.instruments.push_back(s);
    rod.grasps.tools[i].pads = model->instruments[i].pads;
    rod.obstacles.bodies.emplace_back();
    for (int k = 0; k < 3; ++k) {
      Obstacle bar;
      bar.body = static_cast<int>(i);
      bar.friction = model->jaw_friction;
      rod.obstacles.obstacles.push_back(bar);
    }
  }
  if (model->needle) {
    needle = std::make_unique<NeedleScene>(*model);
    needle->start(state);
    needle->size_observation(observation);
  }
  state.pellets = pellets.start();
  state.force.assign(n_tools, Vec3::Zero());
  state.torque.assign(n_tools, Vec3::Zero());
  add_fixtures(*model, rod.obstacles);
  if (model->vessel && model->vessel->lumen) {
    clamp = std::make_unique<ClampBars>(*model->vessel);
    clamp->add(state.tissue.clamp, model->jaw_friction, rod.obstacles);
    still = surroundings(*model).bars;
    around.reserve(InstrumentContact::kMostBars);
  }
  size_observation(*model, observation);
  observe();
}

World::World(std::shared_ptr<const Model> model) : impl_(std::make_unique<Impl>(std::move(model))) {}
World::~World() = default;
World::World(World&&) noexcept = default;

void World::Impl::start_brain() {
  brain = std::make_unique<BrainScene>(model->brain);
  state.brain = brain->start();
  size_observation(*model, observation);
  brain->size_observation(observation);
  observe();
}

void World::Impl::step_brain(const Inputs& inputs) noexcept {
  const StageScope stage("brain");
  brain->step(inputs, state.brain, state.valid, observation);
  ++state.step;
  observe();
}

void World::step(const Inputs& inputs) noexcept {
  impl_->observation.n_events = 0;
  if (impl_->brain) {
    impl_->step_brain(inputs);
    return;
  }
  impl_->read_inputs(inputs);
  impl_->move_clamp();
  impl_->move_instruments();
  impl_->open_and_close_jaws();
  impl_->step_thread();
  impl_->step_pellets();
  impl_->part_overloaded_thread();
  impl_->observation.min_gap = impl_->smallest_gap();
  adapt_resolution(impl_->model->resolution, impl_->model->description.capacity,
                   impl_->model->thread.radius, impl_->rod.contact(), impl_->rod.obstacles,
                   impl_->state.thread, impl_->state.memory);
  ++impl_->state.step;
  impl_->observe();
}

void World::Impl::read_inputs(const Inputs& inputs) noexcept {
  std::uint32_t buttons = 0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const ToolInput& in = inputs.tools[i];
    const bool sound = in.valid && in.X_WD.finite() && in.X_WD.p.cwiseAbs().maxCoeff() < kFarthestHand && std::abs(in.X_WD.q.norm() - 1.0) < 1e-3 && std::isfinite(in.grip_angle) &&
                       std::isfinite(in.grip_force);
    InstrumentCommand& c = commands[i];
    c.follow = sound;
    const InputState now = input_state(sound, state.valid[i]);
    if (const char* name = input_event(state.valid[i], now)) event(name, static_cast<int>(i), 0.0, "-");
    state.valid[i] = now;
    if (!sound) continue;
    c = {in.X_WD, in.grip_angle, in.grip_force, in.has_grip_force, true};
    c.X_WD.q.normalize();
    buttons |= in.buttons;
  }
  if (needle) needle->handle_buttons(state, buttons, observation);
}

void World::Impl::move_clamp() noexcept {
  if (!clamp) return;
  clamp->move(state.tissue, rod.obstacles);
  around = still;
  around.insert(around.end(), clamp->solid().begin(), clamp->solid().end());
  instruments.surround(around);
  needle->surround(clamp->solid());
}

void World::Impl::move_instruments() noexcept {
  const StageScope stage("instruments");
  for (std::size_t i = 0; i < commands.size(); ++i) rod.obstacles.bodies[i].X_start = state.instruments[i].X_WT;
  if (!pellets.empty()) pellets.limit_jaws(model->instruments, state.instruments, state.pellets, commands);
  if (needle) needle->limit_jaws(state, commands);
  const long troubles = ode_troubles();
  instruments.step(state.instruments, commands, state.force, state.torque, model->step.dt);
  if (ode_troubles() != troubles) event("solver-trouble", -1, 0.0, "N");
  held_tools.note(state);
  if (needle) needle->hold_back(state, rod.obstacles.bodies);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    ObstacleBody& body = rod.obstacles.bodies[i];
    body.X_end = state.instruments[i].X_WT;
    const InstrumentBars bars =
        instrument_bars(model->instruments[i], state.instruments[i].angle, 2.0 * model->thread.radius);
    for (std::size_t k = 0; k < 3; ++k) {
      Obstacle& bar = rod.obstacles.obstacles[3 * i + k];
      bar.a_B = bars.a_T[k];
      bar.b_B = bars.b_T[k];
      bar.r_a = bars.r_a[k];
      bar.r_b = bars.r_b[k];
    }
    rod.grasps.tools[i].X_now = state.instruments[i].X_WT;
    rod.grasps.tools[i].grip_force = state.instruments[i].grip_force;
  }
}

void World::Impl::open_and_close_jaws() noexcept {
  const StageScope stage("jaws");
  if (needle) needle->meet_tools(state, rod.obstacles.bodies, observation);
  for (int i = 0; i < static_cast<int>(commands.size()); ++i) {
    if (needle && NeedleScene::held_by(state, i)) continue;
    const double gap = tip_gap(i);
    auto& armed = state.armed[static_cast<std::size_t>(i)];
    if (gap > kLeaveGap) {
      if (held_by(i) > 0) event("release", i, state.instruments[static_cast<std::size_t>(i)].grip_force, "N");
      std::erase_if(state.memory.grasps, [&](const GraspPoint& p) { return p.tool == i; });
      armed = 1;
    } else if (armed != 0 && gap < kTakeGap && held_by(i) == 0) {
      take_or_cut(i);
      if (gap < model->thread.radius) armed = 0;
    }
  }
  ignore_held_thread();
}

void World::Impl::take_or_cut(int i) noexcept {
  const InstrumentParameters& p = model->instruments[static_cast<std::size_t>(i)];
  const Pose& X = state.instruments[static_cast<std::size_t>(i)].X_WT;
  std::vector<GraspPoint>& points = state.memory.grasps;
  const double reach = 0.5 * tip_gap(i) + 4.0 * model->thread.radius;
  const int taken = grasp_between(p.pads, X, i, state.thread, reach, points);
  if (taken == 0) return;
  if (p.kind != "scissors") {
    state.armed[static_cast<std::size_t>(i)] = 0;
    event("grasp", i, points.back().arc, "m");
    return;
  }
  const double arc = points[points.size() - static_cast<std::size_t>(taken)].arc;
  points.resize(points.size() - static_cast<std::size_t>(taken));
  const int edge = locate_arc(state.thread, arc).first;
  if (state.thread.alive[edge] == 0) return;
  state.thread.alive[edge] = 0;
  state.armed[static_cast<std::size_t>(i)] = 0;
  note_cut(arc);
  event("cut", i, arc, "m");
}

/// About a post the piece with the knot ends at the nearest cut on either side: what was cut off may be cut again.
void World::Impl::note_cut(double arc) noexcept {
  const bool low = arc < arc_on_post(*model, state.thread);
  double& cut = low ? state.cut_low : state.cut_high;
  const bool beyond = cut >= 0.0 && (low ? arc < cut : arc > cut);
  if (!model->description.has_post || !beyond) cut = arc;
}

void World::Impl::ignore_held_thread() noexcept {
  for (std::size_t i = 0; i < commands.size(); ++i) {
    double low = 1.0, high = 0.0;
    for (const GraspPoint& p : state.memory.grasps) {
      if (p.tool != static_cast<int>(i)) continue;
      low = std::min(low, p.arc - kIgnore);
      high = std::max(high, p.arc + kIgnore);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      rod.obstacles.obstacles[3 * i + k].ignore_from = low;
      rod.obstacles.obstacles[3 * i + k].ignore_to = high;
    }
  }
}

void World::Impl::step_thread() noexcept {
  let_go_of_gaps(state.thread, state.memory.grasps);
  std::array<int, 3> before{};
  for (std::size_t i = 0; i < commands.size(); ++i) before[i] = held_by(static_cast<int>(i));
  solver = needle ? needle->step_thread(state, rod, model->step, held_tools) : step_bare_thread();
  if (!solver.sound || solver.crowded || (!solver.converged && solver.residual > kTrouble)) event("solver-trouble", -1, solver.residual, "N");
  feel_thread();
  stop_at_thread();
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (before[i] > 0 && held_by(static_cast<int>(i)) == 0)
      event("drop", static_cast<int>(i), state.instruments[i].grip_force, "N");
  }
  if (needle) needle->after_thread(state, rod, observation);
}

/// Where the instruments' ways press it harder than it bears they stand still, unless that is no better.
RodStepSummary World::Impl::step_bare_thread() noexcept {
  thread_before = state.thread;
  memory_before = state.memory;
  const RodStepSummary moved = rod.step(state.thread, state.memory, model->step);
  if (moved.residual <= model->thread.strength) return moved;
  const auto again = [&](bool held) {
    state.thread = thread_before;
    state.memory = memory_before;
    held_tools.put(state, rod, held);
    return rod.step(state.thread, state.memory, model->step);
  };
  held_tools.find(state, rod.obstacles.bodies);
  const RodStepSummary held = again(true);
  return held.residual < moved.residual ? held : again(false);
}

/// A force that no thread could bear is that of a step which found no balance: given in full it would throw the tool.
void World::Impl::feel_thread() noexcept {
  const double most = kMostStrands * model->thread.strength;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    state.force[i] = rod.obstacles.bodies[i].force + rod.grasps.tools[i].force;
    state.torque[i] = rod.obstacles.bodies[i].torque + rod.grasps.tools[i].torque;
    const double force = state.force[i].norm();
    state.thread_pull[i] = std::min(force, most);
    if (force <= most) continue;
    state.force[i] *= most / force;
    state.torque[i] *= most / force;
  }
}

/// An instrument that thread did not let arrive is where it came to: put at the end of its way it would have jumped over strands.
void World::Impl::stop_at_thread() noexcept {
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const ObstacleBody& body = rod.obstacles.bodies[i];
    if (body.X_now.p == body.X_end.p && body.X_now.q.coeffs() == body.X_end.q.coeffs()) continue;
    InstrumentState& tool = state.instruments[i];
    const Eigen::AngleAxisd turn(body.X_now.q * body.X_start.q.conjugate());
    tool.X_WT = body.X_now;
    tool.v = (body.X_now.p - body.X_start.p) / model->step.dt;
    tool.w = turn.angle() / model->step.dt * turn.axis();
  }
}

void World::Impl::step_pellets() noexcept {
  if (pellets.empty()) return;
  std::array<PelletEvent, 8> events;
  const int n = pellets.step(model->instruments, state.instruments, model->step.dt, state.pellets, state.force, events.data(),
                             static_cast<int>(events.size()));
  for (int k = 0; k < n; ++k) {
    const PelletEvent& e = events[static_cast<std::size_t>(k)];
    event(e.name, e.tool, e.value, "N");
  }
}

void World::Impl::part_overloaded_thread() noexcept {
  double highest = 0.0, arc = state.thread.arc_start, arc_highest = 0.0;
  int edge = -1;
  for (int j = 0; j + 1 < state.thread.n; arc += state.thread.rest_length[j++]) {
    const double tension = edge_tension(model->thread, state.thread, j);
    if (tension <= highest) continue;
    highest = tension;
    edge = j;
    arc_highest = arc;
  }
  if (highest > model->thread.strength) {
    state.thread.alive[edge] = 0;
    state.break_arc = arc_highest + 0.5 * state.thread.rest_length[edge];
    event("thread-break", -1, highest, "N");
  }
  constexpr double kOverload = 0.6;  // of the strength; below kOverload/2 the next one counts anew
  if (highest > kOverload * model->thread.strength) {
    if (state.overloaded == 0.0) event("thread-overload", -1, highest, "N");
    state.overloaded = std::max(state.overloaded, highest);
  } else if (highest < 0.5 * kOverload * model->thread.strength) {
    state.overloaded = 0.0;
  }
}

/// As long as the contacts' pairs name its edges: before their number changes. [m]
double World::Impl::smallest_gap() const noexcept { return rod.contact().smallest_distance(state.thread.x) - 2.0 * model->thread.radius; }

void World::Impl::observe() noexcept {
  const StageScope stage("observation");
  fill_observation(*model, state, solver, observation);
  if (needle) needle->observe(state, observation);
  if (brain) brain->observe(state.brain, state.valid, observation);
  observation.state_hash = hash_state(state);
}

const Observation& World::observation() const noexcept { return impl_->observation; }
const SceneDescription& World::description() const noexcept { return impl_->model->description; }
const Model& World::model() const noexcept { return *impl_->model; }
const State& World::state() const noexcept { return impl_->state; }

void World::restore(const State& state) {
  impl_->state = state;
  if (impl_->brain) impl_->brain->match(state.brain);
  if (impl_->needle) impl_->needle->match(state);
  if (impl_->clamp) impl_->clamp->match(state.tissue, impl_->rod.obstacles);
  impl_->observation.n_events = 0;
  impl_->observation.min_gap = std::numeric_limits<double>::infinity();
  impl_->observe();
}

std::uint64_t World::state_hash() const noexcept { return impl_->observation.state_hash; }
std::vector<std::pair<std::string, std::uint64_t>> World::array_hashes() const { return filum::array_hashes(impl_->state); }

}  // namespace filum
