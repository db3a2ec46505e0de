#include "world/observe.h"

#include <algorithm>

#include "world/inputs.h"

namespace filum {
namespace {

void observe_thread(const Model& model, const State& s, Observation& o) noexcept {
  const RodState& t = s.thread;
  o.n_nodes = t.n;
  o.positions.leftCols(t.n) = t.x.leftCols(t.n);
  double arc = t.arc_start;
  for (int i = 0; i < t.n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    o.arc[k] = arc;
    o.contact[k] = 0.0;
    if (i + 1 < t.n) {
      o.tension[k] = edge_tension(model.thread, t, i);
      arc += t.rest_length[i];
    }
  }
  for (const ContactBristle& b : s.memory.self) {
    o.contact[static_cast<std::size_t>(std::min(b.i, t.n - 1))] += b.force;
    o.contact[static_cast<std::size_t>(std::min(b.j, t.n - 1))] += b.force;
  }
  o.n_contacts = static_cast<int>(s.memory.self.size());
}

void observe_parted(const RodState& t, Observation& o) noexcept {
  o.n_parted = 0;
  for (int j = 0; j + 1 < t.n && o.n_parted < kMaxParted; ++j)
    if (t.alive[j] == 0) o.parted[static_cast<std::size_t>(o.n_parted++)] = j;
}

int edge_at(const RodState& t, double arc) noexcept { return arc < 0.0 ? -1 : locate_arc(t, arc).first; }

void observe_tools(const State& s, Observation& o) noexcept {
  o.n_tools = static_cast<int>(s.instruments.size());
  for (std::size_t i = 0; i < s.instruments.size(); ++i) {
    const InstrumentState& in = s.instruments[i];
    ToolObservation& tool = o.tools[i];
    tool.X_WT = in.X_WT;
    tool.X_WD = in.X_WD;
    tool.v_W = in.v;
    tool.f_T_W = s.force[i];
    tool.grip_angle = in.angle;
    tool.grip_force = in.grip_force;
    tool.input_valid = s.valid[i] == kInputLive;
    tool.grasped_edge = -1;
    for (const GraspPoint& g : s.memory.grasps)
      if (g.tool == static_cast<int>(i)) tool.grasped_edge = locate_arc(s.thread, g.arc).first;
    tool.thread_force = s.thread_pull[i];
  }
}

void observe_pellets(const State& s, Observation& o) noexcept {
  o.n_pellets = static_cast<int>(s.pellets.size());
  for (std::size_t k = 0; k < s.pellets.size(); ++k)
    o.pellets[k] = {s.pellets[k].p, s.pellets[k].holder, s.pellets[k].broken != 0};
}

}  // namespace

void size_observation(const Model& model, Observation& o) {
  const auto capacity = static_cast<std::size_t>(model.description.capacity);
  o.positions = Points::Zero(3, model.description.capacity);
  o.arc.assign(capacity, 0.0);
  o.tension.assign(capacity, 0.0);
  o.contact.assign(capacity, 0.0);
  o.radius = model.thread.radius;
}

void fill_observation(const Model& model, const State& s, const RodStepSummary& solver, Observation& o) noexcept {
  o.step = s.step;
  o.time = static_cast<double>(s.step) * model.step.dt;
  observe_thread(model, s, o);
  observe_parted(s.thread, o);
  observe_tools(s, o);
  observe_pellets(s, o);
  o.broken = s.break_arc >= 0.0;
  o.break_edge = edge_at(s.thread, s.break_arc);
  o.cut_edge_low = edge_at(s.thread, s.cut_low);
  o.cut_edge_high = edge_at(s.thread, s.cut_high);
  o.newton_iterations = solver.iterations;
  o.residual = solver.residual;
}

}  // namespace filum
