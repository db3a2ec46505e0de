#include "physics/pellet.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

double stop_angle(const InstrumentParameters& tool, const PelletParameters& p, double squeeze) noexcept {
  return std::max(0.0, (2.0 * p.radius - squeeze / p.stiffness) / tool.jaw_length);
}

double squeeze_of(const InstrumentParameters& tool, const PelletParameters& p, double command) noexcept {
  const double l = tool.jaw_length, open = 2.0 * p.radius / l - command;
  return std::max(0.0, tool.grip_stiffness * open / l / (1.0 + tool.grip_stiffness / (l * l * p.stiffness)));
}

}  // namespace

std::vector<PelletState> Pellets::start() const {
  std::vector<PelletState> states;
  for (const PelletParameters& p : parameters_) {
    PelletState s;
    s.p = p.start;
    s.p.z() = sheet_ + p.radius;
    states.push_back(s);
  }
  return states;
}

/// The object that a tool holds, or that lies between its pads; -1 none.
int Pellets::between(const InstrumentParameters& tool, const InstrumentState& state, const std::vector<PelletState>& pellets,
                     int holder) const noexcept {
  for (std::size_t k = 0; k < pellets.size(); ++k)
    if (pellets[k].holder == holder) return static_cast<int>(k);
  const Pose X_TW = state.X_WT.inverse();
  for (std::size_t k = 0; k < pellets.size(); ++k) {
    if (pellets[k].holder >= 0 || pellets[k].broken != 0 || pellets[k].escaped == holder) continue;
    const double r = parameters_[k].radius;
    const Vec3 p = X_TW * pellets[k].p;
    const bool on_pads = std::abs(p.y()) < tool.pads.half_width + 0.5 * r && p.z() > -0.5 * r && p.z() < tool.pads.length;
    if (on_pads && std::abs(p.x()) < r) return static_cast<int>(k);
  }
  return -1;
}

void Pellets::limit_jaws(const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states,
                         const std::vector<PelletState>& pellets, std::vector<InstrumentCommand>& commands) const noexcept {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (tools[i].kind == "scissors") continue;
    const int k = between(tools[i], states[i], pellets, static_cast<int>(i));
    if (k < 0) continue;
    const PelletParameters& p = parameters_[static_cast<std::size_t>(k)];
    InstrumentCommand& c = commands[i];
    const double open = c.follow ? c.grip_angle : states[i].grip_command;
    if (open >= 2.0 * p.radius / tools[i].jaw_length) continue;
    // Whether the command comes from a live device or is the last one kept: the squeeze goes on.
    const double squeeze = c.follow && c.has_grip_force ? c.grip_force
                           : c.follow                   ? squeeze_of(tools[i], p, open)
                                                        : states[i].grip_force;
    c.grip_angle = stop_angle(tools[i], p, squeeze);
    c.grip_force = squeeze;
    c.has_grip_force = true;
  }
}

/// What one tool does to the object in its jaws: take, break, pull off, carry, lose.
void Pellets::hold(int tool, const InstrumentParameters& jaws, const InstrumentState& state, double dt,
                   std::vector<PelletState>& pellets, Vec3& force, Events& events) const noexcept {
  const int k = between(jaws, state, pellets, tool);
  if (k < 0) return;
  const PelletParameters& p = parameters_[static_cast<std::size_t>(k)];
  PelletState& s = pellets[static_cast<std::size_t>(k)];
  const bool closed = state.angle < 1.02 * 2.0 * p.radius / jaws.jaw_length;
  const double squeeze = state.grip_force;
  const bool pressed = closed && squeeze > 0.0;
  if (s.holder < 0 && !pressed) return;
  if (s.holder < 0) {
    s.holder = tool;
    s.anchor_T = state.X_WT.inverse() * s.p;
    events.say("object-taken", tool, p.slip_limit());
  }
  if (!pressed) {
    events.say("object-released", tool, squeeze);
    s.holder = -1;
    return;
  }
  if (squeeze > p.strength && s.broken == 0) {
    s.broken = 1;
    events.say("object-broken", tool, squeeze);
  }
  const Vec3 anchor = state.X_WT * s.anchor_T, v = (anchor - s.p) / dt;
  const Vec3 load = s.stuck != 0 ? Vec3(p.shear * (anchor - s.p)) : Vec3(p.mass * ((v - s.v) / dt + kGravity * Vec3::UnitZ()));
  if (s.stuck != 0 && load.norm() > p.adhesion) s.stuck = 0;
  if (load.norm() > 2.0 * p.friction * squeeze || s.broken != 0) {
    events.say(s.broken != 0 ? "object-released" : "object-slipped", tool, squeeze);
    s.escaped = tool;
    s.holder = -1;
    return;
  }
  force -= load;
  if (s.stuck != 0) return;
  s.v = v;
  s.p = anchor;
}

/// An object that nobody holds falls and sticks where it lands.
void Pellets::fall(const PelletParameters& p, double dt, PelletState& s) const noexcept {
  if (s.holder >= 0 || s.stuck != 0) return;
  s.v.z() -= kGravity * dt;
  s.p += dt * s.v;
  if (s.p.z() > sheet_ + p.radius) return;
  s.p.z() = sheet_ + p.radius;
  s.v.setZero();
  s.stuck = 1;
}

int Pellets::step(const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, double dt,
                  std::vector<PelletState>& pellets, std::vector<Vec3>& force, PelletEvent* events, int room) const noexcept {
  Events said{events, room, 0};
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (tools[i].kind != "scissors") hold(static_cast<int>(i), tools[i], states[i], dt, pellets, force[i], said);
  for (std::size_t k = 0; k < pellets.size(); ++k) {
    PelletState& s = pellets[k];
    if (s.escaped >= 0) {
      const auto tool = static_cast<std::size_t>(s.escaped);
      if (states[tool].angle > 2.0 * parameters_[k].radius / tools[tool].jaw_length) s.escaped = -1;
    }
    fall(parameters_[k], dt, s);
  }
  return said.n;
}

}  // namespace filum
