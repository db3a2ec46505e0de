#include "world/blade_arm.h"

#include <algorithm>
#include <cmath>

#include "world/observe.h"

namespace filum {
namespace {

constexpr std::uint32_t kClutch = 1u, kForm = 2u, kNext = 4u;

/// The pose on the way from a to b that is no further than the limits allow.
Pose towards(const Pose& a, const Pose& b, double far, double turn) noexcept {
  Pose X;
  const Vec3 step = b.p - a.p;
  const double length = step.norm(), angle = a.q.angularDistance(b.q);
  X.p = length > far ? Vec3(a.p + step * (far / length)) : b.p;
  X.q = angle > turn ? a.q.slerp(turn / angle, b.q) : b.q;
  X.q.normalize();
  return X;
}

/// Locks and frees as the buttons say.
void take_buttons(std::uint32_t buttons, std::size_t i, BladeState& blade, Observation& o) noexcept {
  const std::int32_t before = blade.parked, down = (buttons & kNext) != 0 ? 1 : 0;
  if (down != 0 && blade.toggling == 0) blade.parked = blade.parked == 2 ? 0 : 2;
  blade.toggling = down;
  if (blade.parked != 2) blade.parked = (buttons & kClutch) != 0 ? 1 : 0;
  if ((before != 0) == (blade.parked != 0)) return;
  say(o, blade.parked != 0 ? "arm-locked" : "arm-freed", static_cast<int>(i), 0.0, "-");
  if (blade.parked != 0) blade.kept_force = blade.force;
  else blade.X_DB = blade.X_WD.inverse() * blade.X_W;
}

/// A step of the arm that keeps its force.
void yield(double dt, BladeState& blade) noexcept {
  const double kept = blade.kept_force.norm();
  if (kept < kArmLeast) return;
  const Vec3 along = blade.kept_force / kept;
  const double speed = std::clamp((kept - blade.force.dot(along)) / kArmYield, -kArmFastest, kArmFastest);
  blade.X_W.p -= dt * speed * along;
}

}  // namespace

Pose placed_at(const std::vector<PlacedKey>& keys, double time) noexcept {
  if (time <= keys.front().t) return keys.front().X_W;
  for (std::size_t k = 1; k < keys.size(); ++k) {
    if (time >= keys[k].t) continue;
    const double u = (time - keys[k - 1].t) / (keys[k].t - keys[k - 1].t), s = u * u * (3.0 - 2.0 * u);
    Pose X{keys[k - 1].X_W.p + s * (keys[k].X_W.p - keys[k - 1].X_W.p), keys[k - 1].X_W.q.slerp(s, keys[k].X_W.q)};
    X.q.normalize();
    return X;
  }
  return keys.back().X_W;
}

bool asks_for_form(const BrainModel& model, std::size_t i, const ToolInput& in, double time, BladeState& blade) noexcept {
  const bool placing = !model.placed[i].empty() && time < model.placed[i].back().t;
  const std::int32_t before = blade.choosing;
  blade.choosing = in.valid && !placing && (in.buttons & kForm) != 0 ? 1 : 0;
  return before == 0 && blade.choosing != 0 && model.blades[i].size() > 1;
}

void move_blade(const BrainModel& model, std::size_t i, const ToolInput& in, double time, double dt, BladeState& blade, std::int32_t& valid, Observation& o) noexcept {
  const bool sound = in.valid && in.X_WD.finite() && std::abs(in.X_WD.q.norm() - 1.0) < 1e-3;
  const InputState now = input_state(sound, valid);
  if (const char* name = input_event(valid, now)) say(o, name, static_cast<int>(i), 0.0, "-");
  valid = now;
  const bool placing = !model.placed[i].empty() && time < model.placed[i].back().t;
  if (sound) {
    blade.X_WD = in.X_WD;
    blade.X_WD.q.normalize();
    if (!placing) take_buttons(in.buttons, i, blade, o);
  }
  if (placing) blade.X_W = placed_at(model.placed[i], time + dt);
  else if (blade.parked != 0 && model.arm_keeps_force[i]) yield(dt, blade);
  else if (blade.parked == 0 && sound) blade.X_W = towards(blade.X_W, blade.X_WD * blade.X_DB, model.fastest * dt, kBladeTurnRate * dt);
}

}  // namespace filum
