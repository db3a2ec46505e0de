#include "devices/igtl_stream.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "base/error.h"
#include "devices/igtl_message.h"

namespace filum {

IgtlStream::IgtlStream(const std::string& address, int port) {
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(static_cast<std::uint16_t>(port));
  if (port < 0 || port > 65535 || inet_pton(AF_INET, address.c_str(), &here.sin_addr) != 1)
    throw InputError("OpenIGTLink stream", "address", address + ":" + std::to_string(port), "an IPv4 address of this machine and a port");
  listen_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  ::setsockopt(listen_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(listen_, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0 || ::listen(listen_, 1) != 0) {
    ::close(listen_);
    throw InputError("OpenIGTLink stream", "address", address + ":" + std::to_string(port), "an address of this machine and a port that is free");
  }
  socklen_t size = sizeof here;
  ::getsockname(listen_, reinterpret_cast<sockaddr*>(&here), &size);
  port_ = ntohs(here.sin_port);
}

IgtlStream::~IgtlStream() {
  lose();
  ::close(listen_);
}

void IgtlStream::lose() noexcept {
  if (peer_ >= 0) ::close(peer_);
  peer_ = -1;
}

/// While there is a peer, others are turned away. Whether it has left is looked at first: the next may wait already.
void IgtlStream::accept_one() noexcept {
  std::array<std::uint8_t, 512> unwanted;  // what a peer says is read and not used
  const ssize_t got = peer_ < 0 ? 1 : ::recv(peer_, unwanted.data(), unwanted.size(), 0);
  if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) lose();
  for (int fd; (fd = ::accept4(listen_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)) >= 0;) {
    if (peer_ < 0) {
      peer_ = fd;
    } else {
      ::close(fd);
    }
  }
}

void IgtlStream::send(int tool, const Pose& X_WT, std::int64_t time_us) noexcept {
  accept_one();
  if (peer_ < 0) return;
  const char name[] = {'T', 'o', 'o', 'l', static_cast<char>('0' + tool % 10), 0};
  std::array<std::uint8_t, kIgtlTransform> bytes;
  const std::size_t size = igtl_transform(name, X_WT, time_us, bytes);
  const ssize_t put = ::send(peer_, bytes.data(), size, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (put == static_cast<ssize_t>(size)) {
    ++sent_;
    return;
  }
  ++dropped_;
  if (put >= 0 || (errno != EAGAIN && errno != EINTR)) lose();  // half a message cannot be taken back
}

}  // namespace filum
