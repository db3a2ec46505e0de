#include "physics/instrument.h"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "physics/instrument_contact.h"
#include "physics/ode_trouble.h"

namespace filum {
namespace {

constexpr double kLongestStep = 1e-3;   // [s]
constexpr double kJawMass = 5e-4;       // [kg]
constexpr double kJawInertia = 1e-8;    // [kg m2]
constexpr double kJawTime = 0.01;       // [s], the servo's time to reach the commanded angle
constexpr double kJawTorque = 0.05;     // [N m], of the fingers
constexpr double kFriction = 0.2;       // [-], of steel on steel and on what stands still, wet [P]
constexpr double kYield = 3e-4;         // [m/(N s)], what contacts give way by: those that say the same share the load
constexpr unsigned kWorkingMemory = 4u << 20;  // [B], of ODE's step
constexpr double kParting = 0.1;        // [m/s], at most, of what has come into each other

void start_ode() {
  static std::once_flag once;
  std::call_once(once, [] {
    dInitODE2(0);
    listen_to_ode();
  });
}

void place(dBodyID body, const Pose& X, const Vec3& v, const Vec3& w) noexcept {
  const dQuaternion q = {X.q.w(), X.q.x(), X.q.y(), X.q.z()};
  dBodySetPosition(body, X.p.x(), X.p.y(), X.p.z());
  dBodySetQuaternion(body, q);
  dBodySetLinearVel(body, v.x(), v.y(), v.z());
  dBodySetAngularVel(body, w.x(), w.y(), w.z());
}

dBodyID make_body(dWorldID world, double mass, double inertia) {
  dBodyID body = dBodyCreate(world);
  dMass m;
  dMassSetParameters(&m, mass, 0, 0, 0, inertia, inertia, inertia, 0, 0, 0);
  dBodySetMass(body, &m);
  dBodySetAutoDisableFlag(body, 0);
  dBodySetGyroscopicMode(body, 0);
  return body;
}

Vec3 rotation_vector(const Quat& q) noexcept {
  const Eigen::AngleAxisd a(q.w() < 0.0 ? Quat(-q.coeffs()) : q);
  return a.angle() * a.axis();
}

}  // namespace

struct Instruments::Ode {
  struct Tool {
    dBodyID handle, jaw[2];
    dJointID hinge[2];
  };
  dWorldID world;
  dJointGroupID touches;
  std::vector<Tool> tools;

  explicit Ode(const std::vector<InstrumentParameters>& parameters) {
    start_ode();
    world = dWorldCreate();
    dWorldSetContactMaxCorrectingVel(world, kParting);
    touches = dJointGroupCreate(0);
    for (const InstrumentParameters& p : parameters) {
      Tool t;
      t.handle = make_body(world, p.mass, p.inertia);
      for (int k = 0; k < 2; ++k) {
        t.jaw[k] = make_body(world, kJawMass, kJawInertia);
        place(t.jaw[k], jaw_pose(p, Pose(), 0.0, k), Vec3::Zero(), Vec3::Zero());
        t.hinge[k] = dJointCreateHinge(world, nullptr);
        dJointAttach(t.hinge[k], t.jaw[k], t.handle);
        dJointSetHingeAnchor(t.hinge[k], 0, 0, p.jaw_length);
        dJointSetHingeAxis(t.hinge[k], 0, 1, 0);
        dJointSetHingeParam(t.hinge[k], dParamFMax, kJawTorque);
      }
      tools.push_back(t);
    }
    take_memory();
  }
  /// As much as a step may need with all its touches: none is taken later.
  void take_memory() {
    const dWorldStepReserveInfo reserve = {sizeof(dWorldStepReserveInfo), 1.2f, kWorkingMemory};
    dWorldSetStepMemoryReservationPolicy(world, &reserve);
    const dContact none{};
    for (int k = 0; k < InstrumentContact::kMost; ++k) dJointCreateContact(world, touches, &none);
    dJointGroupEmpty(touches);
    dWorldStep(world, kLongestStep);
  }
  ~Ode() {
    dJointGroupDestroy(touches);
    dWorldDestroy(world);
  }

  static double side(int k) noexcept { return k == 0 ? -1.0 : 1.0; }  // jaw 0 turns towards +x: about -y

  /// Pose of jaw k's centre of mass, half way between tip and hinge.
  static Pose jaw_pose(const InstrumentParameters& p, const Pose& X, double angle, int k) noexcept {
    const Quat turn(Eigen::AngleAxisd(side(k) * 0.5 * angle, Vec3::UnitY()));
    const Pose in_tool{Vec3(0, 0, p.jaw_length) + turn * Vec3(0, 0, -0.5 * p.jaw_length), turn};
    return X * in_tool;
  }

  void write(std::size_t i, const InstrumentParameters& p, const InstrumentState& s) noexcept {
    place(tools[i].handle, s.X_WT, s.v, s.w);
    for (int k = 0; k < 2; ++k) {
      const Pose jaw = jaw_pose(p, s.X_WT, s.angle, k);
      const Vec3 spin = s.w + s.X_WT.q * Vec3(0, side(k) * 0.5 * s.angle_rate, 0);
      const Vec3 hinge = s.X_WT * Vec3(0, 0, p.jaw_length);
      place(tools[i].jaw[k], jaw, s.v + s.w.cross(hinge - s.X_WT.p) + spin.cross(jaw.p - hinge), spin);
    }
  }

  dBodyID body(int tool, int bar) const noexcept {
    if (tool < 0) return nullptr;
    const Tool& t = tools[static_cast<std::size_t>(tool)];
    return bar < 2 ? t.jaw[bar] : t.handle;
  }

  /// For this step: the surfaces do not come into each other, or part when they have.
  void touch(const InstrumentTouch& t, double h) noexcept {
    dContact c{};
    c.surface.mode = dContactApprox1 | dContactMotionN | dContactSoftCFM;
    c.surface.soft_cfm = kYield;
    c.surface.mu = kFriction;
    c.surface.motionN = -std::max(0.0, t.gap) / h;
    c.geom.depth = std::max(0.0, -t.gap);
    for (int k = 0; k < 3; ++k) {
      c.geom.pos[k] = t.p[k];
      c.geom.normal[k] = t.normal[k];
    }
    dJointAttach(dJointCreateContact(world, touches, &c), body(t.tool, t.bar), body(t.other, t.other_bar));
  }

  void read(std::size_t i, const InstrumentParameters& p, InstrumentState& s) noexcept {
    const dReal *x = dBodyGetPosition(tools[i].handle), *q = dBodyGetQuaternion(tools[i].handle);
    const dReal *v = dBodyGetLinearVel(tools[i].handle), *w = dBodyGetAngularVel(tools[i].handle);
    s.X_WT = {Vec3(x[0], x[1], x[2]), Quat(q[0], q[1], q[2], q[3]).normalized()};
    s.v = Vec3(v[0], v[1], v[2]);
    s.w = Vec3(w[0], w[1], w[2]);
    double angle = 0.0, rate = 0.0;  // each jaw's turn against the handle, from its body
    for (int k = 0; k < 2; ++k) {
      const dReal* jq = dBodyGetQuaternion(tools[i].jaw[k]);
      const dReal* jw = dBodyGetAngularVel(tools[i].jaw[k]);
      const Vec3 turn = rotation_vector(s.X_WT.q.conjugate() * Quat(jq[0], jq[1], jq[2], jq[3]));
      angle += side(k) * turn.y();
      rate += side(k) * (s.X_WT.q.conjugate() * (Vec3(jw[0], jw[1], jw[2]) - s.w)).y();
    }
    s.angle = std::clamp(angle, 0.0, p.max_angle);
    s.angle_rate = rate;
  }

  void drive(std::size_t i, const InstrumentParameters& p, const InstrumentState& s, const InstrumentCommand& c, const Vec3& v_D,
             const Vec3& w_D, const Vec3& force, const Vec3& torque, double h) noexcept {
    const Vec3 v = s.v + h / p.mass * force, w = s.w + h / p.inertia * torque;  // as the scene alone would have it
    const Vec3 f = (p.coupling_stiffness * (c.X_WD.p - s.X_WT.p - h * v) + p.coupling_damping * (v_D - v)) /
                   (1.0 + h * p.coupling_damping / p.mass + h * h * p.coupling_stiffness / p.mass);
    const Vec3 turn = rotation_vector(c.X_WD.q * s.X_WT.q.conjugate());
    const Vec3 t = (p.turning_stiffness * (turn - h * w) + p.turning_damping * (w_D - w)) /
                   (1.0 + h * p.turning_damping / p.inertia + h * h * p.turning_stiffness / p.inertia);
    dBodyAddForce(tools[i].handle, f.x() + force.x(), f.y() + force.y(), f.z() + force.z());
    dBodyAddTorque(tools[i].handle, t.x() + torque.x(), t.y() + torque.y(), t.z() + torque.z());
    const double wanted = std::clamp(c.grip_angle, 0.0, p.max_angle);
    for (int k = 0; k < 2; ++k) dJointSetHingeParam(tools[i].hinge[k], dParamVel, side(k) * 0.5 * (wanted - s.angle) / kJawTime);
  }
};

Instruments::Instruments(std::vector<InstrumentParameters> parameters)
    : parameters_(std::move(parameters)), ode_(std::make_unique<Ode>(parameters_)) {}
Instruments::Instruments(std::vector<InstrumentParameters> parameters, Surroundings surroundings) : Instruments(std::move(parameters)) {
  contact_ = std::make_unique<InstrumentContact>(static_cast<int>(parameters_.size()), std::move(surroundings));
}
Instruments::~Instruments() = default;
Instruments::Instruments(Instruments&&) noexcept = default;

void Instruments::surround(const std::vector<RoundBar>& bars) noexcept {
  if (contact_) contact_->surround(bars);
}

void Instruments::step(std::vector<InstrumentState>& states, const std::vector<InstrumentCommand>& commands,
                       const std::vector<Vec3>& force, const std::vector<Vec3>& torque, double dt) noexcept {
  const int n = std::max(1, static_cast<int>(std::ceil(dt / kLongestStep - 1e-9)));
  const double h = dt / n;
  for (int sub = 0; sub < n; ++sub) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      InstrumentCommand c = commands[i];
      if (!c.follow) {
        c.X_WD = states[i].X_WD;
        c.grip_angle = states[i].grip_command;
      }
      const Vec3 v_D = (c.X_WD.p - states[i].X_WD.p) / dt;
      const Vec3 w_D = rotation_vector(c.X_WD.q * states[i].X_WD.q.conjugate()) / dt;
      ode_->write(i, parameters_[i], states[i]);
      ode_->drive(i, parameters_[i], states[i], c, v_D, w_D, force[i], torque[i], h);
    }
    if (contact_) {
      contact_->find(parameters_, states, h);
      for (const InstrumentTouch& t : contact_->touches()) ode_->touch(t, h);
    }
    dWorldStep(ode_->world, h);
    dJointGroupEmpty(ode_->touches);
    for (std::size_t i = 0; i < states.size(); ++i) ode_->read(i, parameters_[i], states[i]);
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    const InstrumentParameters& p = parameters_[i];
    if (!commands[i].follow) continue;
    states[i].X_WD = commands[i].X_WD;
    states[i].grip_command = commands[i].grip_angle;
    const double squeeze = p.grip_stiffness * std::max(0.0, states[i].angle - commands[i].grip_angle) / p.jaw_length;
    const bool closed = states[i].angle < 0.25 * p.tip_radius / p.jaw_length;
    const double grip = commands[i].has_grip_force ? commands[i].grip_force : (closed ? squeeze : 0.0);
    states[i].grip_force = std::clamp(grip, 0.0, p.max_grip_force);
  }
}

InstrumentBars instrument_bars(const InstrumentParameters& p, double angle, double clearance) noexcept {
  InstrumentBars bars;
  const Vec3 hinge(0, 0, p.jaw_length);
  for (int k = 0; k < 2; ++k) {
    const double sign = k == 0 ? 1.0 : -1.0;
    const Quat turn(Eigen::AngleAxisd(-sign * 0.5 * angle, Vec3::UnitY()));
    bars.a_T[k] = hinge + turn * (Vec3(sign * (p.tip_radius + 0.5 * clearance), 0, 0) - hinge);
    bars.b_T[k] = hinge + turn * Vec3(sign * p.base_radius, 0, 0);
    bars.r_a[k] = p.tip_radius;
    bars.r_b[k] = p.base_radius;
  }
  bars.a_T[2] = hinge;
  bars.b_T[2] = hinge + Vec3(0, 0, p.shaft_length);
  bars.r_a[2] = 1.6 * p.base_radius;
  bars.r_b[2] = 3.0 * p.base_radius;
  return bars;
}

}  // namespace filum
