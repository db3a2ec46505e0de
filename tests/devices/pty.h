#pragma once
// The far end of a serial link for tests: a pty whose name can be kept behind a link while it is pulled out
// and put back.

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace filum {

class Pty {
 public:
  Pty() { plug(); }
  /// With a symbolic link that always leads to the pty of the moment.
  explicit Pty(std::string link) : link_(std::move(link)) { plug(); }
  ~Pty() {
    unplug();
    if (!link_.empty()) ::unlink(link_.c_str());
  }
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  void plug() {
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0)
      throw std::runtime_error("no pty");
    char name[128];
    if (::ptsname_r(master_, name, sizeof name) != 0) throw std::runtime_error("pty without a name");
    path_ = name;
    if (link_.empty()) return;
    ::unlink(link_.c_str());
    if (::symlink(name, link_.c_str()) != 0) throw std::runtime_error("cannot make " + link_);
  }
  void unplug() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }

  const std::string& path() const { return link_.empty() ? path_ : link_; }

  /// Writes all, waiting for room up to a second at a time; false when nobody listens or makes room.
  bool write(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t put = ::write(master_, bytes.data(), bytes.size());
      if (put > 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(put));
        continue;
      }
      if (errno != EAGAIN) return false;
      pollfd room{master_, POLLOUT, 0};
      if (::poll(&room, 1, 1000) <= 0 || (room.revents & POLLHUP)) return false;
    }
    return true;
  }
  /// Bytes the other side has sent, -1 when nobody has the port open.
  ssize_t read(std::span<std::uint8_t> into) {
    const ssize_t got = ::read(master_, into.data(), into.size());
    if (got >= 0) return got;
    return errno == EAGAIN ? 0 : -1;
  }

 private:
  int master_ = -1;
  std::string path_, link_;
};

}  // namespace filum
