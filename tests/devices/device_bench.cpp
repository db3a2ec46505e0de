// What devices cost: processor time of the thread that polls them, as a share of one core, at 1 kHz each, and what was lost.
//   filum_device_bench [SECONDS]
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include "devices/haptic_link.h"
#include "devices/serial_forceps.h"
#include "tests/devices/pty.h"

namespace {

using namespace filum;
using Clock = std::chrono::steady_clock;

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

/// Calls `tick` every millisecond for `seconds`; late ones are skipped.
template <class Tick>
void each_millisecond(double seconds, Tick&& tick) {
  const auto start = Clock::now();
  for (int ms = 0; ms < static_cast<int>(1000 * seconds); ++ms) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(ms));
    tick();
  }
}

struct Share {
  double all = 0.0;       // of one core, with sleeping and waking
  double devices = 0.0;   // of one core, in the devices alone
};

template <class Poll>
Share poll_for(double seconds, Poll&& poll) {
  double inside = 0.0;
  const double before = cpu_seconds();
  const auto start = Clock::now();
  each_millisecond(seconds, [&] {
    const double at = cpu_seconds();
    poll();
    inside += cpu_seconds() - at;
  });
  const double wall = std::chrono::duration<double>(Clock::now() - start).count();
  return {(cpu_seconds() - before) / wall, inside / wall};
}

ForcepsCalibration calibration() {
  ForcepsCalibration c;
  c.angle_gain = 1e-4;
  c.force_gain = 1e-3;
  c.angle_limit = c.force_limit = 10.0;
  return c;
}

void bench_forceps(int n, double seconds) {
  std::vector<std::unique_ptr<Pty>> ptys;
  std::vector<std::unique_ptr<SerialForceps>> forceps;
  for (int i = 0; i < n; ++i) {
    ptys.push_back(std::make_unique<Pty>());
    forceps.push_back(std::make_unique<SerialForceps>(ptys.back()->path(), calibration()));
  }
  std::uint64_t sent = 0;
  std::jthread hands([&] {
    std::uint16_t sequence = 0;
    const std::uint8_t zero = 0;
    for (auto& pty : ptys) pty->write(std::span(&zero, 1));
    each_millisecond(seconds, [&] {
      filum_frame frame{};
      const filum_grip grip{0, 0, static_cast<std::uint16_t>(1000 + sequence % 2000), 600};
      filum_put_grip(&frame, &grip);
      frame.device = 1;
      frame.sequence = sequence++;
      frame.time_us = static_cast<std::uint32_t>(now_us());
      std::uint8_t wire[FILUM_MAX_WIRE];
      const std::size_t size = filum_frame_encode(&frame, wire);
      for (auto& pty : ptys) pty->write(std::span(wire, size));
      ++sent;
    });
  });
  std::vector<DeviceSample> out;
  out.reserve(kMaxSamplesPerPoll);
  const Share share = poll_for(seconds + 0.2, [&] {
    for (auto& f : forceps) {
      out.clear();
      f->poll(now_us(), out);
    }
  });
  hands.join();
  std::uint64_t received = 0, lost = 0, corrupt = 0;
  for (auto& f : forceps) received += f->health().received, lost += f->health().lost, corrupt += f->health().corrupt;
  std::printf("forceps x%d: %.2f %% of a core each in the device, %.2f %% with the 1 kHz thread; %llu of %llu samples, %llu lost, %llu corrupt\n", n,
              100.0 * share.devices / n, 100.0 * share.all, static_cast<unsigned long long>(received),
              static_cast<unsigned long long>(sent * static_cast<unsigned>(n)), static_cast<unsigned long long>(lost),
              static_cast<unsigned long long>(corrupt));
}

void bench_link(double seconds) {
  HapticLink link("127.0.0.1", 0);
  std::uint32_t sent = 0;
  std::jthread master([&] {
    const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(link.port()));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    each_millisecond(seconds, [&] {
      for (int tool = 0; tool < 2; ++tool) {
        filum_link_pose pose = link_pose(tool, {}, 0.1, 0.0, FILUM_LINK_TRACKED);
        pose.sequence = sent;
        pose.time_us = static_cast<std::uint32_t>(now_us());
        std::uint8_t data[FILUM_LINK_POSE_SIZE];
        ::sendto(fd, data, filum_link_put_pose(&pose, data), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
      }
      ++sent;
    });
    ::close(fd);
  });
  std::vector<DeviceSample> out;
  out.reserve(kMaxSamplesPerPoll);
  HandForces forces;
  forces.valid.fill(true);
  const Share share = poll_for(seconds + 0.2, [&] {
    out.clear();
    link.poll(now_us(), out);
    link.render(now_us(), forces);
  });
  master.join();
  std::printf("haptic link, 2 tools: %.2f %% of a core in the device, %.2f %% with the 1 kHz thread; %llu of %u samples, %llu lost\n",
              100.0 * share.devices, 100.0 * share.all, static_cast<unsigned long long>(link.health().received), 2 * sent,
              static_cast<unsigned long long>(link.health().lost));
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10.0;
  bench_forceps(1, seconds);
  bench_forceps(4, seconds);
  bench_link(seconds);
}
