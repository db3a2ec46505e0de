// Reference master: a simulated haptic device with a hand on it (simulated_master.h) that talks to the trainer by UDP at
// 1 kHz, as a master for a real device does. Where SimulatedMaster is, a real one calls its maker's library.
//
//   filum_haptic_client [--to 127.0.0.1] [--port 18930] [--tool 0] [--seconds 10]
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "hardware/haptic-link/simulated_master.h"

namespace {

using filum::Vec3;

struct Options {
  std::string to = "127.0.0.1";
  int port = FILUM_LINK_PORT, tool = 0;
  double seconds = 10.0;
};

Options read_options(int argc, char** argv) {
  Options o;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i], value = argv[i + 1];
    if (name == "--to") o.to = value;
    else if (name == "--port") o.port = std::atoi(value.c_str());
    else if (name == "--tool") o.tool = std::atoi(value.c_str());
    else if (name == "--seconds") o.seconds = std::atof(value.c_str());
  }
  return o;
}

std::int64_t now_us() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000 + t.tv_nsec / 1000;
}

class Link {
 public:
  explicit Link(const Options& o) : tool_(o.tool), fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)), session_(std::random_device{}()) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(o.port));
    good_ = inet_pton(AF_INET, o.to.c_str(), &to.sin_addr) == 1 && ::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  ~Link() { ::close(fd_); }
  bool good() const { return good_; }

  void send(const Vec3& p, std::uint32_t time_us) {
    filum_link_pose pose{};
    pose.session = session_;
    pose.sequence = ++sequence_;
    pose.time_us = time_us;
    pose.tool = static_cast<std::uint8_t>(tool_);
    pose.flags = FILUM_LINK_TRACKED;
    for (int i = 0; i < 3; ++i) pose.position[i] = static_cast<std::int32_t>(std::lround(p[i] * 1e7));
    pose.quaternion[0] = 1 << 30;
    pose.grip_angle = 100'000;
    std::uint8_t data[FILUM_LINK_POSE_SIZE];
    ::send(fd_, data, filum_link_put_pose(&pose, data), MSG_NOSIGNAL);
  }
  /// True if a newer, valid force came; then `force` [N] is that and `trip_us` its round trip.
  bool receive(Vec3& force, std::uint32_t& trip_us, std::uint32_t time_us) {
    bool fresh = false;
    std::uint8_t data[256];
    for (ssize_t n; (n = ::recv(fd_, data, sizeof data, 0)) > 0;) {
      filum_link_force f;
      if (!filum_link_get_force(data, static_cast<std::size_t>(n), &f) || f.session != session_ || f.tool != tool_) continue;
      if (heard_ && !filum_link_newer(f.sequence, last_)) continue;
      heard_ = true;
      last_ = f.sequence;
      if (!(f.flags & FILUM_LINK_VALID)) continue;
      for (int i = 0; i < 3; ++i) force[i] = 1e-6 * f.force[i];
      trip_us = time_us - f.time_us;
      fresh = true;
    }
    return fresh;
  }

 private:
  int tool_, fd_;
  std::uint32_t session_, sequence_ = 0, last_ = 0;
  bool heard_ = false, good_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  const Options o = read_options(argc, argv);
  Link link(o);
  if (!link.good()) {
    std::fprintf(stderr, "cannot reach %s:%d\n", o.to.c_str(), o.port);
    return 2;
  }
  filum::SimulatedMaster master({});
  Vec3 wanted = Vec3::Zero();
  std::uint32_t trip = 0, longest = 0;
  std::uint64_t fresh_count = 0, ticks = 0;
  double peak = 0.0;
  const std::int64_t start = now_us();
  for (std::int64_t due = start; now_us() - start < static_cast<std::int64_t>(o.seconds * 1e6); due += 1000, ++ticks) {
    const timespec until{static_cast<time_t>(due / 1'000'000), static_cast<long>(due % 1'000'000) * 1000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {}
    const auto time = static_cast<std::uint32_t>(now_us());
    const bool fresh = link.receive(wanted, trip, time);
    if (fresh) ++fresh_count, longest = std::max(longest, trip);
    const double t = 1e-6 * static_cast<double>(now_us() - start);
    // The hand draws a slow circle of 4 mm about the middle of the field.
    master.step(Vec3(4e-3 * std::cos(t), 4e-3 * std::sin(t), 5e-3), wanted, fresh, 1e-3);
    link.send(master.measured(), time);
    peak = std::max(peak, master.force().norm());
  }
  std::printf("%llu periods, %llu with a new force; last round trip %u us, longest %u us; largest force %.3f N; given to the hand %.2e J\n",
              static_cast<unsigned long long>(ticks), static_cast<unsigned long long>(fresh_count), trip, longest, peak, master.given());
  return fresh_count > 0 ? 0 : 1;
}
