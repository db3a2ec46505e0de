#include "devices/haptic_link.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "devices/sample_check.h"

namespace filum {
namespace {

constexpr double kLengthUnit = 1e-7;  // [m]
constexpr double kQuaternionUnit = 1.0 / (1 << 30);
constexpr int kPerPoll = 64;          // packets; three tools at 1 kHz are three

std::int32_t whole(double value) noexcept {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -2.1e9, 2.1e9)));
}

/// -1 if the address or the port cannot be had.
int bound_socket(const sockaddr_in& here) noexcept {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0) return fd;
  if (fd >= 0) ::close(fd);
  return -1;
}

}  // namespace

filum_link_pose link_pose(int tool, const Pose& X, double grip_angle, double grip_force, std::uint8_t flags) noexcept {
  filum_link_pose pose{};
  pose.tool = static_cast<std::uint8_t>(tool);
  pose.flags = flags;
  for (int i = 0; i < 3; ++i) pose.position[i] = whole(X.p[i] / kLengthUnit);
  const double q[4] = {X.q.w(), X.q.x(), X.q.y(), X.q.z()};
  for (int i = 0; i < 4; ++i) pose.quaternion[i] = whole(q[i] / kQuaternionUnit);
  pose.grip_angle = whole(1e6 * grip_angle);
  pose.grip_force = whole(1e6 * grip_force);
  return pose;
}

bool sample_of(const filum_link_pose& pose, DeviceSample& sample) noexcept {
  sample.tool = pose.tool;
  sample.sequence = pose.sequence;
  sample.buttons = ((pose.flags & FILUM_LINK_CLUTCH) ? 1u : 0u) | ((pose.flags & FILUM_LINK_CUT) ? 2u : 0u) |
                   ((pose.flags & FILUM_LINK_NEXT) ? 4u : 0u);
  if (!(pose.flags & FILUM_LINK_TRACKED)) return false;
  for (int i = 0; i < 3; ++i) sample.X_WD.p[i] = pose.position[i] * kLengthUnit;
  const std::int32_t* w = pose.quaternion;
  sample.X_WD.q = Quat(w[0] * kQuaternionUnit, w[1] * kQuaternionUnit, w[2] * kQuaternionUnit, w[3] * kQuaternionUnit);
  sample.grip_angle = 1e-6 * pose.grip_angle;
  sample.has_grip_force = (pose.flags & FILUM_LINK_HAS_FORCE) != 0;
  sample.grip_force = sample.has_grip_force ? 1e-6 * pose.grip_force : 0.0;
  if (sample.X_WD.p.cwiseAbs().maxCoeff() > kHandReach || std::abs(sample.X_WD.q.norm() - 1.0) > 0.01) return false;
  if (std::abs(sample.grip_angle) > std::numbers::pi / 2 || sample.grip_force < 0.0 || sample.grip_force > 50.0) return false;
  sample.X_WD.q.normalize();
  sample.has_pose = sample.has_grip_angle = true;
  return true;
}

HapticLink::HapticLink(const std::string& address, int port) {
  sockaddr_in here{};
  here.sin_family = AF_INET;
  if (port < 0 || port > 65535) throw InputError("haptic link", "port", std::to_string(port), "0 to 65535");
  here.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &here.sin_addr) != 1)
    throw InputError("haptic link", "address", address, "an IPv4 address of this machine, e.g. 127.0.0.1");
  fd_ = bound_socket(here);
  if (fd_ >= 0 && port == 0) {  // a port that was not asked for by its number is lost when a peer is let go: ask for it
    socklen_t size = sizeof here;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&here), &size);
    ::close(fd_);
    fd_ = bound_socket(here);
  }
  if (fd_ < 0)
    throw InputError("haptic link", "address", address + ":" + std::to_string(port), "an address of this machine and a port that is free");
  port_ = ntohs(here.sin_port);
  name_ = "haptic link " + address + ":" + std::to_string(port_);
}

HapticLink::~HapticLink() { ::close(fd_); }

/// While there is a peer the system itself throws away what others send: a flood of strangers costs the loop nothing.
void HapticLink::listen_to(const sockaddr_in* peer) noexcept {
  sockaddr_in nobody{};
  nobody.sin_family = AF_UNSPEC;
  ::connect(fd_, reinterpret_cast<const sockaddr*>(peer ? peer : &nobody), sizeof nobody);
}

void HapticLink::release() noexcept {
  has_peer_ = false;
  listen_to(nullptr);
  for (Hand& hand : hands_) hand = Hand{};
}

/// The first good packet makes its sender the peer; packets of others are refused while the peer is heard.
bool HapticLink::is_peer(const sockaddr_in& from, const filum_link_pose& pose, std::int64_t now_us) noexcept {
  if (!has_peer_) {
    has_peer_ = ever_ = true;
    peer_address_ = from.sin_addr.s_addr;
    peer_port_ = from.sin_port;
    session_ = pose.session;
    heard_us_ = now_us;
    listen_to(&from);
    return true;
  }
  return from.sin_addr.s_addr == peer_address_ && from.sin_port == peer_port_ && pose.session == session_;
}

void HapticLink::poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  now_us_ = now_us;
  if (has_peer_ && now_us - heard_us_ > kRelease) release();
  for (int n = 0; n < kPerPoll; ++n) {
    std::uint8_t data[FILUM_LINK_MAX_SIZE + 1];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got = ::recvfrom(fd_, data, sizeof data, 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0 && errno == ECONNREFUSED) continue;  // a force came back: nobody is there any more
    if (got < 0) return;                             // nothing more
    filum_link_pose pose;
    if (!filum_link_get_pose(data, static_cast<std::size_t>(got), &pose)) {
      ++counts_.malformed;
    } else if (!is_peer(from, pose, now_us)) {
      ++counts_.strangers;
    } else {
      take(pose, now_us, out);
    }
  }
  ++counts_.floods;
}

void HapticLink::take(const filum_link_pose& pose, std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  Hand& hand = hands_[pose.tool];
  if (hand.used && !filum_link_newer(pose.sequence, hand.newest.sequence)) {
    ++counts_.late;
    return;
  }
  if (hand.used) lost_ += pose.sequence - hand.newest.sequence - 1u;
  hand.device_us = hand.used ? hand.device_us + static_cast<std::int32_t>(pose.time_us - hand.newest.time_us) : pose.time_us;
  hand.used = true;
  hand.newest = pose;
  heard_us_ = now_us;
  DeviceSample sample;
  if (!sample_of(pose, sample)) {
    if (pose.flags & FILUM_LINK_TRACKED) ++counts_.impossible;
    return;
  }
  hand.heard_us = now_us;
  sample.host_time_us = now_us;
  sample.device_time_us = hand.device_us;
  out.push_back(sample);
  ++received_;
}

void HapticLink::render(std::int64_t now_us, const HandForces& forces) noexcept {
  if (!has_peer_) return;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = peer_address_;
  to.sin_port = peer_port_;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    if (!hand.used) continue;
    const bool valid = forces.valid[i] && now_us - hand.heard_us <= kStale;
    filum_link_force packet{};
    packet.session = session_;
    packet.sequence = hand.force_sequence++;
    packet.answers = hand.newest.sequence;
    packet.time_us = hand.newest.time_us;
    packet.tool = static_cast<std::uint8_t>(i);
    packet.flags = valid ? FILUM_LINK_VALID : 0;
    for (int k = 0; k < 3; ++k) packet.force[k] = valid ? whole(1e6 * forces.force[i][k]) : 0;
    std::uint8_t data[FILUM_LINK_FORCE_SIZE];
    filum_link_put_force(&packet, data);
    // Lost when the line is full: the master's guard lets go after 2 ms of silence.
    ::sendto(fd_, data, sizeof data, MSG_DONTWAIT | MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
}

DeviceHealth HapticLink::health() const noexcept {
  DeviceState state = DeviceState::waiting;
  if (ever_) state = !has_peer_ ? DeviceState::lost : now_us_ - heard_us_ > kStale ? DeviceState::stale : DeviceState::live;
  return {state, received_, lost_, counts_.malformed, counts_.strangers + counts_.late + counts_.impossible};
}

}  // namespace filum
