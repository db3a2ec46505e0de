#include "devices/igtl_tracker.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>

#include "base/error.h"

namespace filum {
namespace {

constexpr std::int64_t kTryEvery = 1'000'000;  // [us]
constexpr std::int64_t kStale = 100'000;       // [us]
constexpr int kMostRepeated = 200;             // in a row, before the peer is dropped

/// 0 ... 2, -1 for a name that is no tool's.
int tool_of(std::string_view name) noexcept {
  constexpr std::string_view kTool = "tool";
  if (name.size() < 5) return -1;
  for (std::size_t i = 0; i < 4; ++i)
    if (std::tolower(static_cast<unsigned char>(name[i])) != kTool[i]) return -1;
  const int tool = name[4] - '0';
  const bool one_digit = name.size() == 5 || !std::isdigit(static_cast<unsigned char>(name[5]));
  return one_digit && tool >= 0 && tool < kMaxTools ? tool : -1;
}

}  // namespace

IgtlTracker::IgtlTracker(const std::string& address, int port) : name_("OpenIGTLink " + address + ":" + std::to_string(port)) {
  in_addr at{};
  if (inet_pton(AF_INET, address.c_str(), &at) != 1) throw InputError("OpenIGTLink", "address", address, "an IPv4 address");
  if (port < 1 || port > 65535) throw InputError("OpenIGTLink", "port", std::to_string(port), "1 to 65535");
  address_ = at.s_addr;
  port_ = htons(static_cast<std::uint16_t>(port));
  buffer_.reserve(kIgtlHeader + kIgtlLongest);
}

IgtlTracker::~IgtlTracker() { drop(); }

void IgtlTracker::drop() noexcept {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  connecting_ = false;
  buffer_.clear();
  skip_ = 0;
  newest_us_ = {};
  repeated_in_row_ = 0;
}

void IgtlTracker::connect(std::int64_t now_us) noexcept {
  if (now_us < next_try_us_) return;
  next_try_us_ = now_us + kTryEvery;
  fd_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd_ < 0) return;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = address_;
  to.sin_port = port_;
  connecting_ = ::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0;
  if (connecting_ && errno != EINPROGRESS) drop();
}

void IgtlTracker::poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  now_us_ = now_us;
  if (fd_ < 0) connect(now_us);
  if (fd_ < 0) return;
  if (connecting_) {
    pollfd ready{fd_, POLLOUT, 0};
    if (::poll(&ready, 1, 0) <= 0) return;
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) return drop();
    connecting_ = false;
  }
  std::array<std::uint8_t, 4096> bytes;  // at 106 bytes for the shortest pose, below kMaxSamplesPerPoll
  const ssize_t got = ::recv(fd_, bytes.data(), bytes.size(), 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0 || !feed(std::span(bytes).first(static_cast<std::size_t>(got)), now_us, out)) drop();
}

bool IgtlTracker::feed(std::span<const std::uint8_t> bytes, std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  while (!bytes.empty()) {
    if (skip_ > 0) {
      const std::size_t n = static_cast<std::size_t>(std::min<std::uint64_t>(skip_, bytes.size()));
      skip_ -= n;
      bytes = bytes.subspan(n);
      continue;
    }
    std::size_t wanted = kIgtlHeader;
    IgtlHeader header;
    if (buffer_.size() >= kIgtlHeader) {
      igtl_header(buffer_, header);
      wanted += header.body_size;
    }
    const std::size_t n = std::min(bytes.size(), wanted - buffer_.size());
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    bytes = bytes.subspan(n);
    if (buffer_.size() == kIgtlHeader && wanted == kIgtlHeader) {
      if (!igtl_header(buffer_, header) || header.body_size > (1ull << 32)) {
        ++damaged_;  // the place in the stream is lost: there is no mark to find it by
        return false;
      }
      if (header.body_size > kIgtlLongest) {
        ++other_;  // an image, or a lie
        skip_ = header.body_size;
        buffer_.clear();
      } else if (header.body_size == 0) {
        ++other_;
        buffer_.clear();
      }
    } else if (buffer_.size() == wanted && wanted > kIgtlHeader) {
      if (!message(now_us, out)) return false;
      buffer_.clear();
    }
  }
  return true;
}

bool IgtlTracker::message(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  IgtlHeader header;
  igtl_header(buffer_, header);
  const auto body = std::span<const std::uint8_t>(buffer_).subspan(kIgtlHeader);
  switch (igtl_body(header, body, [&](const IgtlPose& pose) { take(pose, header.time_us, now_us, out); })) {
    case IgtlBody::damaged:
      ++damaged_;
      break;
    case IgtlBody::other:
      ++other_;
      break;
    case IgtlBody::poses:
      break;
  }
  return repeated_in_row_ < kMostRepeated;
}

void IgtlTracker::take(const IgtlPose& pose, std::int64_t time_us, std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  const int tool = tool_of(pose.name);
  if (tool < 0) {
    ++other_;
    return;
  }
  if (!pose.sound || out.size() >= kMaxSamplesPerPoll) {
    ++refused_;
    return;
  }
  std::int64_t& newest = newest_us_[static_cast<std::size_t>(tool)];
  if (time_us > 0 && time_us <= newest) {
    ++repeated_;
    ++repeated_in_row_;
    return;
  }
  newest = time_us;
  repeated_in_row_ = 0;
  DeviceSample sample;
  sample.tool = tool;
  sample.sequence = sequence_++;
  sample.host_time_us = now_us;
  sample.device_time_us = time_us > 0 ? time_us : now_us;
  sample.has_pose = true;
  sample.X_WD = pose.X;
  out.push_back(sample);
  ++received_;
  heard_us_ = now_us;
  ever_ = true;
}

DeviceHealth IgtlTracker::health() const noexcept {
  DeviceState state = DeviceState::waiting;
  if (ever_) state = fd_ < 0 || connecting_ ? DeviceState::lost : now_us_ - heard_us_ > kStale ? DeviceState::stale : DeviceState::live;
  return {state, received_, 0, damaged_, refused_ + repeated_};
}

}  // namespace filum
