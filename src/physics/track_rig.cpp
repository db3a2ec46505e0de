#include "physics/track_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace filum {
namespace {

constexpr double kHeld = 0.3;  // share of the needle from the swage where the vice holds it

VesselMesh block(const RigOptions& o) {
  CardShape shape;
  shape.width = 4e-3;
  shape.depth = 2e-3;
  shape.thickness = o.thickness;
  shape.across = 8;
  shape.deep = 6;
  return make_card(shape);
}

}  // namespace

TrackMaterial plain_track(double puncture, double cutting, double friction, double drag) {
  TrackMaterial m;
  m.layers = {{puncture, cutting, friction, drag}};
  m.bend_friction = 0.0;
  m.wear = 0.0;
  m.tear = 1e9;
  return m;
}

TrackRig::TrackRig(const RigOptions& o) : options_(o) {
  WallOptions w;
  w.dt = o.dt;
  wall_ = std::make_unique<VesselWall>(block(o), o.layers.empty() ? std::vector<WallLayer>{{"block", o.thickness, WallLaw::hooke(o.young, 0.3)}} : o.layers, w);
  wall_state_ = wall_->first_state();
  wall_->refit(wall_state_);
  shape_.bend_radius = o.bend_radius;
  shape_.circle = 3.8e-3 / (2.0 * std::numbers::pi * o.bend_radius);
  body_ = std::make_unique<NeedleBody>(shape_, 1);
  tracks_ = std::make_unique<NeedleTracks>(o.track, shape_, *wall_);
  needle_options_.dt = o.dt;
  needle_options_.gravity.setZero();
  // The point 20 um above the surface; the needle in the plane across the cut.
  const double L = shape_.length();
  along_ = Vec3(0.0, std::cos(o.angle), -std::sin(o.angle));
  const Vec3 across = Vec3::UnitX().cross(along_);
  Mat3 to, own;
  to << along_.cross(across), across, along_;
  const Vec3 t = shape_.tangent(L);
  own << t.cross(Vec3::UnitZ()), Vec3::UnitZ(), t;
  needle_.X_WN.q = Quat(Mat3(to * own.transpose())).normalized();
  const Vec3 point(0.0, -o.bite, 0.5 * o.thickness);
  needle_.X_WN.p = point - 20e-6 / std::sin(o.angle) * along_ - needle_.X_WN.q * shape_.point(L);
  state_.point_before = needle_.X_WN * shape_.point(L);
  const Vec3 wire = needle_.X_WN.q * shape_.tangent(kHeld * L), out = Vec3::UnitX();
  Mat3 vice;
  vice << wire.cross(out), wire, out;
  vice_ = {needle_.X_WN * shape_.point(kHeld * L) - 0.5e-3 * out, Quat(vice).normalized()};
  NeedleTool& tool = body_->tools[0];
  tool.pads.half_width = 0.5e-3;
  tool.bars_touch = false;
  tool.X_start = tool.X_end = vice_;
  tool.grip_force = o.grip;
  body_->take(0, 1e-4, needle_);
}

RigSample TrackRig::step(double move, double sideways) {
  NeedleTool& tool = body_->tools[0];
  const Vec3 moved = move * along_ + sideways * Vec3::UnitY();
  tool.X_start = vice_;
  vice_.p += moved;
  tool.X_end = vice_;
  body_->tethers.clear();
  none_.clear();
  tracks_->hold(*wall_, wall_state_, state_, needle_.X_WN, nullptr, body_->tethers, none_);
  body_->step(needle_, needle_options_);
  std::array<TrackEvent, 8> events;
  wall_->clear_loads();
  const int n = tracks_->follow(*wall_, wall_state_, state_, needle_.X_WN, nullptr, options_.dt, body_->tethers, none_, events.data(), 8);
  for (int k = 0; k < n; ++k) {
    last_event_ = events[static_cast<std::size_t>(k)].name;
    event_force_ = events[static_cast<std::size_t>(k)].value;
  }
  tracks_->mark_point(*wall_, wall_state_, state_);
  wall_->step(wall_state_);
  wall_->refit(wall_state_);
  tracks_->carry_point(*wall_, wall_state_, state_);
  const Vec3 force = -tool.force;  // of the vice on the needle
  work_ += 0.5 * (force + last_force_).dot(moved);
  last_force_ = force;
  travel_ += move;
  return {travel_, force.dot(along_)};
}

double TrackRig::inserted() const {
  if (state_.n == 0 || state_.tracks[0].n == 0) return 0.0;
  return shape_.length() - state_.tracks[0].knots[0].strand;
}

double TrackRig::ahead() const {
  if (state_.n == 0 || state_.tracks[0].n == 0) return 0.0;
  return std::max(0.0, shape_.length() - state_.tracks[0].knots[static_cast<std::size_t>(state_.tracks[0].n - 1)].strand);
}

double TrackRig::stored() const {
  double u = last_force_.squaredNorm() / (2.0 * 3.0 * shape_.grip_stiffness);
  for (const RodTether& t : body_->tethers) {
    const double k = t.stick > 0.0 ? t.stick : t.stiffness.norm();
    if (k > 0.0) u += t.force.squaredNorm() / (2.0 * k);
  }
  return u;
}

}  // namespace filum
