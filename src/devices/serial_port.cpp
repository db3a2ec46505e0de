#include "devices/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace filum {
namespace {

constexpr int kRetry = 500;  // [ms]

/// The speed constant of a rate, B0 where there is none.
speed_t speed_of(int baud) noexcept {
  static constexpr std::pair<int, speed_t> kRates[] = {
      {9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},
      {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
      {576000, B576000},   {921600, B921600},   {1000000, B1000000}, {1500000, B1500000},
      {2000000, B2000000}, {3000000, B3000000}, {4000000, B4000000}};
  for (const auto& [rate, speed] : kRates)
    if (rate == baud) return speed;
  return B0;
}

/// Open, raw, nonblocking file descriptor, or -1 with errno set.
int open_raw(const std::string& path, int baud) noexcept {
  const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return -1;
  termios settings{};
  if (tcgetattr(fd, &settings) == 0) {
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cc[VMIN] = 1;  // so that read() tells "nothing yet" (EAGAIN) from "hung up" (0)
    settings.c_cc[VTIME] = 0;
    cfsetispeed(&settings, speed_of(baud));
    cfsetospeed(&settings, speed_of(baud));
    if (tcsetattr(fd, TCSANOW, &settings) == 0) {
      tcflush(fd, TCIFLUSH);  // what came before we listened has no time stamp
      return fd;
    }
  }
  const int error = errno;
  ::close(fd);
  errno = error;
  return -1;
}

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud) : path_(path), baud_(baud), fd_(-1) {
  if (speed_of(baud) == B0)
    throw InputError(path, "baud", std::to_string(baud), "a usual rate from 9600 to 4000000");
  fd_ = open_raw(path, baud);
  if (fd_ < 0)
    throw InputError(path, "serial port", std::strerror(errno), "a serial port or pty that can be opened");
  wake_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (wake_ < 0) {
    ::close(fd_);
    throw InputError(path, "serial port", std::strerror(errno), "a free file descriptor");
  }
  reopener_ = std::jthread([this](const std::stop_token& stop) { reopen_loop(stop); });
}

SerialPort::~SerialPort() {
  reopener_.request_stop();
  wake();
  reopener_.join();
  for (const int fd : {fd_, discarded_.load(), reopened_.load(), wake_})
    if (fd >= 0) ::close(fd);
}

void SerialPort::wake() noexcept {
  const std::uint64_t one = 1;
  // Fails only when 2^64 - 2 wake-ups are waiting.
  [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof one);
}

bool SerialPort::woken_within(int timeout_ms) noexcept {
  pollfd waiting{wake_, POLLIN, 0};
  if (::poll(&waiting, 1, timeout_ms) <= 0) return false;
  std::uint64_t count = 0;
  return ::read(wake_, &count, sizeof count) > 0;
}

void SerialPort::reopen_loop(const std::stop_token& stop) noexcept {
  while (!stop.stop_requested()) {
    if (!woken_within(-1)) continue;
    const int old = discarded_.exchange(-1);
    if (old < 0) continue;
    ::close(old);
    int fd = -1;
    // Only the destructor wakes us while the port is gone.
    while (!stop.stop_requested() && (fd = open_raw(path_, baud_)) < 0) woken_within(kRetry);
    reopened_.store(fd);
  }
}

void SerialPort::lose() noexcept {
  discarded_.store(fd_);
  fd_ = -1;
  wake();
}

SerialPort::Read SerialPort::read(std::span<std::uint8_t> into, std::size_t& n) noexcept {
  n = 0;
  if (fd_ < 0) {
    fd_ = reopened_.exchange(-1);
    return fd_ >= 0 ? Read::back : Read::nothing;
  }
  const ssize_t got = ::read(fd_, into.data(), into.size());
  if (got > 0) {
    n = static_cast<std::size_t>(got);
    return Read::data;
  }
  if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return Read::nothing;
  lose();
  return Read::gone;
}

std::size_t SerialPort::write(std::span<const std::uint8_t> bytes) noexcept {
  if (fd_ < 0) return 0;
  const ssize_t put = ::write(fd_, bytes.data(), bytes.size());
  return put > 0 ? static_cast<std::size_t>(put) : 0;  // a port that is gone is noticed by read()
}

}  // namespace filum
