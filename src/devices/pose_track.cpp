#include "devices/pose_track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/monotone_cubic.h"

namespace filum {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kFollowing = 0.1;  // [s], a hand lags what its eyes follow by about as much [P]

double minimum_jerk(double u) noexcept {
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}
double smoothstep(double u) noexcept {
  return u * u * (3.0 - 2.0 * u);
}

Vec3 radial_part(const PoseArc& arc, const Vec3& p) noexcept {
  const Vec3 d = p - arc.centre_W;
  return d - d.dot(arc.axis_W) * arc.axis_W;
}

}  // namespace

double axis_distance(const PoseArc& arc, const Vec3& p) noexcept {
  return radial_part(arc, p).norm();
}

double fitting_turns(const PoseArc& arc, const Vec3& p0, const Vec3& p1) noexcept {
  const Vec3 r0 = radial_part(arc, p0), r1 = radial_part(arc, p1);
  const double remainder = std::atan2(r0.cross(r1).dot(arc.axis_W), r0.dot(r1)) / kTurn;
  return remainder + std::round(arc.turns - remainder);
}

Vec3 arc_end(const PoseArc& arc, const Vec3& p0, double radius, double rise) noexcept {
  const Vec3 r0 = radial_part(arc, p0);
  const double height = (p0 - arc.centre_W).dot(arc.axis_W) + rise;
  const Vec3 direction = Eigen::AngleAxisd(kTurn * arc.turns, arc.axis_W) * r0.normalized();
  return arc.centre_W + height * arc.axis_W + radius * direction;
}

Vec3 arc_point(const PoseArc& arc, const Vec3& p0, const Vec3& p1, double s) noexcept {
  const Vec3 r0 = radial_part(arc, p0);
  const double radius = (1.0 - s) * r0.norm() + s * axis_distance(arc, p1);
  const double h0 = (p0 - arc.centre_W).dot(arc.axis_W), h1 = (p1 - arc.centre_W).dot(arc.axis_W);
  const double angle = kTurn * fitting_turns(arc, p0, p1) * s;
  const Vec3 direction = Eigen::AngleAxisd(angle, arc.axis_W) * r0.normalized();
  return arc.centre_W + ((1.0 - s) * h0 + s * h1) * arc.axis_W + radius * direction;
}

PoseTrack::PoseTrack(int tool, std::vector<PoseKey> keys, bool has_grip_force, std::vector<PoseLook> looks)
    : tool_(tool), keys_(std::move(keys)), looks_(std::move(looks)), has_grip_force_(has_grip_force) {
  // The hand looks at rest, so that what it did before does not depend on what it will see; the same where it may stop.
  for (std::size_t i = 0; i + 1 < keys_.size(); ++i) {
    const bool may_stop = keys_[i].until_pull > 0.0 || keys_[i + 1].until_pull > 0.0;
    keys_[i].stop = keys_[i].stop || may_stop || keys_[i + 1].look != keys_[i].look;
  }
  written_ = keys_;
  for (std::size_t i = 1; i < keys_.size(); ++i) {
    if (keys_[i].look < 0) continue;
    keys_[i].p_W = keys_[i - 1].p_W;
    keys_[i].q = keys_[i - 1].q;
    keys_[i].arc.reset();
  }
  tip_slopes_.assign(keys_.size(), Vec3::Zero());
  angle_slopes_.assign(keys_.size(), 0.0);
  force_slopes_.assign(keys_.size(), 0.0);
  smooth();
}

/// An arc starts and ends at rest, so the cubics of the tip beside it must too.
bool PoseTrack::at_rest(std::size_t i, bool tip) const noexcept {
  return keys_[i].stop || (tip && (keys_[i].arc.has_value() || (i + 1 < keys_.size() && keys_[i + 1].arc.has_value())));
}

void PoseTrack::smooth() noexcept {
  for (std::size_t i = 1; i + 1 < keys_.size(); ++i) {
    const PoseKey &a = keys_[i - 1], &k = keys_[i], &b = keys_[i + 1];
    const double h0 = k.t - a.t, h1 = b.t - k.t;
    const auto slope = [&](double y0, double y1, double y2) { return monotone_slope(h0, h1, (y1 - y0) / h0, (y2 - y1) / h1); };
    const bool rest = at_rest(i, false), tip_rest = at_rest(i, true);
    for (int c = 0; c < 3; ++c) tip_slopes_[i][c] = tip_rest ? 0.0 : slope(a.p_W[c], k.p_W[c], b.p_W[c]);
    angle_slopes_[i] = rest ? 0.0 : slope(a.grip_angle, k.grip_angle, b.grip_angle);
    force_slopes_[i] = rest ? 0.0 : slope(a.grip_force, k.grip_force, b.grip_force);
  }
}

std::size_t PoseTrack::first_of(std::size_t look) const noexcept {
  std::size_t i = 0;
  while (i < keys_.size() && keys_[i].look != static_cast<int>(look)) ++i;
  return i;
}

double PoseTrack::look_time() const noexcept { return keys_[first_of(taken_) - 1].t; }

/// The keys of a look where its frame is now.
void PoseTrack::place_keys(std::size_t look) noexcept {
  for (std::size_t i = first_of(look); i < keys_.size() && keys_[i].look == static_cast<int>(look); ++i) {
    const Pose X_WT = X_WF_ * Pose{written_[i].p_W, written_[i].q} * X_AT_;
    keys_[i].p_W = X_WT.p;
    keys_[i].q = X_WT.q.normalized();
    keys_[i].arc = written_[i].arc;
    if (!keys_[i].arc) continue;
    keys_[i].arc->centre_W = X_WF_ * written_[i].arc->centre_W;
    keys_[i].arc->axis_W = X_WF_.q * written_[i].arc->axis_W;
  }
}

/// Keys after i that give no place or direction of their own, or that look for what is not seen yet, have those of the key before.
void PoseTrack::keep_from(std::size_t i) noexcept {
  bool place = true, turn = true;
  for (++i; i < keys_.size(); ++i) {
    const bool unseen = keys_[i].look >= static_cast<int>(taken_);
    place = unseen || (place && keys_[i].keeps_place);
    turn = unseen || (turn && keys_[i].keeps_turn);
    if (place) keys_[i].p_W = keys_[i - 1].p_W;
    if (turn) keys_[i].q = keys_[i - 1].q;
  }
}

void PoseTrack::set_out(const Pose& X_WF, const Pose& X_AT) {
  const std::size_t look = taken_++;
  X_WF_ = X_WF;
  X_AT_ = X_AT;
  place_keys(look);
  std::size_t last = first_of(look);
  while (last + 1 < keys_.size() && keys_[last + 1].look == static_cast<int>(look)) ++last;
  keep_from(last);
  smooth();
}

const PoseLook* PoseTrack::followed(double t) const noexcept {
  if (taken_ == 0 || !looks_[taken_ - 1].follow) return nullptr;
  const std::size_t i = key_at(t) + 1;
  if (i >= keys_.size() || keys_[i].look != static_cast<int>(taken_ - 1)) return nullptr;
  return halted_ < first_of(taken_ - 1) ? &looks_[taken_ - 1] : nullptr;
}

void PoseTrack::follow(const Pose& X_WF, double dt) noexcept {
  const double share = 1.0 - std::exp(-dt / kFollowing);
  X_WF_.p += share * (X_WF.p - X_WF_.p);
  X_WF_.q = X_WF_.q.slerp(share, X_WF.q).normalized();
  place_keys(taken_ - 1);
  smooth();
}

double PoseTrack::stops_at_pull(double t) const noexcept {
  const std::size_t i = key_at(t) + 1;
  return i < keys_.size() && t > keys_[i - 1].t && halted_ != i ? keys_[i].until_pull : 0.0;
}

void PoseTrack::halt(double t) noexcept {
  const DeviceSample now = steady_at(t);
  const std::size_t i = key_at(t);
  keys_[i].t = t;
  keys_[i].p_W = keys_[i + 1].p_W = now.X_WD.p;
  keys_[i].q = keys_[i + 1].q = now.X_WD.q;
  keys_[i].grip_angle = now.grip_angle;
  keys_[i].grip_force = now.grip_force;
  keys_[i + 1].arc.reset();
  halted_ = i + 1;
  keep_from(i + 1);
  smooth();
}

std::size_t PoseTrack::key_at(double t) const noexcept {
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), t,
                                      [](double time, const PoseKey& key) { return time < key.t; });
  return after == keys_.begin() ? 0 : static_cast<std::size_t>(after - keys_.begin()) - 1;
}

Vec3 PoseTrack::tip_in_segment(std::size_t i, double u) const noexcept {
  const PoseKey& a = keys_[i];
  const PoseKey& b = keys_[i + 1];
  if (b.arc) return arc_point(*b.arc, a.p_W, b.p_W, minimum_jerk(u));
  Vec3 p;
  for (int c = 0; c < 3; ++c)
    p[c] = hermite(a.p_W[c], b.p_W[c], tip_slopes_[i][c], tip_slopes_[i + 1][c], b.t - a.t, u);
  return p;
}

DeviceSample PoseTrack::at(double t) const noexcept {
  DeviceSample sample = steady_at(t);
  if (tremor_) sample.X_WD.p += tremor_->at(t);
  return sample;
}

DeviceSample PoseTrack::steady_at(double t) const noexcept {
  const std::size_t i = key_at(t);
  const PoseKey& a = keys_[i];
  DeviceSample sample;
  sample.tool = tool_;
  sample.host_time_us = sample.device_time_us = static_cast<std::int64_t>(std::llround(t * 1e6));
  sample.has_pose = sample.has_grip_angle = true;
  sample.has_grip_force = has_grip_force_;
  sample.X_WD = {a.p_W, a.q};
  sample.grip_angle = a.grip_angle;
  sample.grip_force = a.grip_force;
  if (t < a.t) return sample;  // before the first key: nothing is pressed yet
  sample.buttons = a.buttons;
  if (i + 1 == keys_.size() || t == a.t) return sample;
  const PoseKey& b = keys_[i + 1];
  const double h = b.t - a.t, u = (t - a.t) / h;
  sample.X_WD.p = tip_in_segment(i, u);
  sample.X_WD.q = a.q.slerp(smoothstep(u), b.q).normalized();
  sample.grip_angle = hermite(a.grip_angle, b.grip_angle, angle_slopes_[i], angle_slopes_[i + 1], h, u);
  sample.grip_force = hermite(a.grip_force, b.grip_force, force_slopes_[i], force_slopes_[i + 1], h, u);
  return sample;
}

}  // namespace filum
