#include "devices/demonstrator.h"

#include <utility>

#include "devices/sample_faults.h"

namespace filum {

Demonstrator::Demonstrator(const std::string& path) : Demonstrator(PoseScript::load(path)) {}

Demonstrator::Demonstrator(PoseScript script)
    : script_(std::move(script)), name_("demonstrator: " + script_.title()) {
  for (int tool = 0; tool < kMaxTools; ++tool) moved_ += script_.has_tool(tool) ? 1u : 0u;
}

bool Demonstrator::look(PoseTrack& track) {
  const PoseLook& look = *track.next_look();
  Pose X_WF, X_AT;
  if (eyes_ == nullptr || !eyes_->find(look.at, X_WF)) return false;
  if (look.bring) {
    Pose X_WA, X_WT;
    if (!eyes_->find({.kind = Look::Kind::needle, .length = *look.bring, .holder = track.tool()}, X_WA)) return false;
    if (!eyes_->find({.kind = Look::Kind::tool, .index = track.tool()}, X_WT)) return false;
    X_AT = X_WA.inverse() * X_WT;
  }
  track.set_out(X_WF, X_AT);
  return true;
}

/// What is lost from sight is expected where it was; a tool in whose grip the hand brings the needle is taken to hold it as it did.
void Demonstrator::go_on_looking(PoseTrack& track, double t) {
  const PoseLook* look = track.followed(t);
  Pose X_WF;
  if (look != nullptr && eyes_ != nullptr && eyes_->find(look->at, X_WF)) track.follow(X_WF, 1e-6 * kPeriod);
}

void Demonstrator::feel(PoseTrack& track, double t) {
  int& felt = felt_[static_cast<std::size_t>(track.tool())];
  const double enough = track.stops_at_pull(t);
  const bool pulls = enough > 0.0 && eyes_ != nullptr && eyes_->felt(track.tool()) >= enough;
  felt = pulls ? felt + 1 : 0;
  if (felt < kFelt) return;
  track.halt(t);
  felt = 0;
}

/// The first tool that looks in vain at time t [s] of the script, -1 if none does.
int Demonstrator::blocked_at(double t) {
  for (int tool = 0; tool < kMaxTools; ++tool) {
    if (!script_.has_tool(tool)) continue;
    PoseTrack& track = script_.track(tool);
    while (track.next_look() != nullptr && track.look_time() <= t + 1e-9)
      if (!look(track)) return tool;
  }
  return -1;
}

void Demonstrator::poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  if (now_us < next_us_) return;
  const auto room = static_cast<std::int64_t>(kMaxSamplesPerPoll / kMaxTools);
  const std::int64_t due = (now_us - next_us_) / kPeriod + 1;
  if (due > room) {
    health_.lost += static_cast<std::uint64_t>(due - room) * moved_;
    next_us_ += (due - room) * kPeriod;
  }
  for (; next_us_ <= now_us; next_us_ += kPeriod) {
    const double t = static_cast<double>(next_us_ - waited_us_) * 1e-6;
    const int blocked = blocked_at(t);
    for (int tool = 0; tool < kMaxTools; ++tool) {
      if (!script_.has_tool(tool)) continue;
      if (blocked < 0) {
        go_on_looking(script_.track(tool), t);
        feel(script_.track(tool), t);
      }
      DeviceSample sample = script_.at(tool, t);
      sample.host_time_us = sample.device_time_us = next_us_;
      sample.sequence = static_cast<std::uint32_t>(next_us_ / kPeriod);
      if (tool == blocked) sample.buttons |= kNotSeen;
      out.push_back(sample);
      ++health_.received;
    }
    waiting_us_ = blocked < 0 ? 0 : waiting_us_ + kPeriod;
    if (blocked >= 0) waited_us_ += kPeriod;
  }
  const bool over = static_cast<double>(now_us - waited_us_) * 1e-6 > script_.duration() || waiting_us_ > kPatience;
  health_.state = over ? DeviceState::finished : DeviceState::live;
}

}  // namespace filum
