// Ports that cannot be opened: serial_forceps_test.

#include "devices/serial_port.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>
#include <vector>

#include "tests/devices/pty.h"

namespace filum {
namespace serial_port_test {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

/// Asks until it is so, for 10 s at most.
bool until(const std::function<bool()>& so) {
  const auto end = std::chrono::steady_clock::now() + 10s;
  while (!so())
    if (std::chrono::steady_clock::now() > end) return false;
    else std::this_thread::sleep_for(100us);
  return true;
}

/// n bytes that come in at the port.
Bytes take(SerialPort& port, std::size_t n) {
  Bytes all, some(64);
  until([&] {
    std::size_t got = 0;
    port.read(some, got);
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(got));
    return all.size() >= n;
  });
  return all;
}

Bytes every_byte() {
  Bytes all(256);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<std::uint8_t>(k);
  return all;
}

/// No byte means anything to the terminal, neither end of line nor interrupt nor stop, and none is echoed.
TEST(SerialPort, BytesPassAsTheyAreBothWays) {
  Pty pty;
  SerialPort port(pty.path(), 115200);
  ASSERT_TRUE(pty.write(every_byte()));
  EXPECT_EQ(take(port, 256), every_byte());
  ASSERT_EQ(port.write(every_byte()), 256u);
  Bytes out, some(512);
  ASSERT_TRUE(until([&] {
    const ssize_t got = pty.read(some);
    if (got > 0) out.insert(out.end(), some.begin(), some.begin() + got);
    return out.size() >= 256;
  }));
  EXPECT_EQ(out, every_byte()) << "and no echo of what came in";
}

TEST(SerialPort, ReadsNoMoreThanThereIsRoomFor) {
  Pty pty;
  SerialPort port(pty.path(), 9600);
  Bytes room(3);
  std::size_t n = 7;
  EXPECT_EQ(port.read(room, n), SerialPort::Read::nothing);
  EXPECT_EQ(n, 0u);
  ASSERT_TRUE(pty.write(Bytes{1, 2, 3, 4}));
  ASSERT_TRUE(until([&] { return port.read(room, n) == SerialPort::Read::data; }));
  EXPECT_EQ(n, 3u);
  EXPECT_EQ(room, (Bytes{1, 2, 3}));
  EXPECT_EQ(port.read(room, n), SerialPort::Read::data);
  EXPECT_EQ(n, 1u);
  EXPECT_EQ(room[0], 4);
}

/// What has lain there since before is of no known time.
TEST(SerialPort, BeginsWithWhatComesAfterItIsOpened) {
  Pty pty;
  const int early = ::open(pty.path().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(early, 0);
  ASSERT_TRUE(pty.write(Bytes{'o', 'l', 'd', '\n'}));
  pollfd there{early, POLLIN, 0};
  ASSERT_EQ(::poll(&there, 1, 10000), 1);
  SerialPort port(pty.path(), 115200);
  ASSERT_TRUE(pty.write(Bytes{'n', 'e', 'w'}));
  EXPECT_EQ(take(port, 3), (Bytes{'n', 'e', 'w'}));
  ::close(early);
}

/// A peer that reads nothing does not hold the writer up; what was taken arrives once it reads.
TEST(SerialPort, WritesWhatThereIsRoomFor) {
  Pty pty;
  SerialPort port(pty.path(), 115200);
  const Bytes chunk(1024, 'x');
  std::size_t written = 0;
  for (int k = 0; k < 10000; ++k) {
    const std::size_t put = port.write(chunk);
    written += put;
    if (put == 0) break;
  }
  EXPECT_EQ(port.write(chunk), 0u);
  EXPECT_TRUE(port.open()) << "full is not gone";
  Bytes some(4096);
  std::size_t arrived = 0;
  EXPECT_TRUE(until([&] {
    const ssize_t got = pty.read(some);
    arrived += got > 0 ? static_cast<std::size_t>(got) : 0;
    return arrived >= written;
  }));
  EXPECT_EQ(arrived, written);
}

TEST(SerialPort, SaysOnceThatItIsGoneAndOnceThatItIsBack) {
  Pty pty((std::filesystem::temp_directory_path() / ("port-" + std::to_string(::getpid()))).string());
  SerialPort port(pty.path(), 115200);
  pty.unplug();
  pty.plug();  // another terminal behind the same name
  Bytes room(8);
  std::size_t n = 0;
  ASSERT_EQ(port.read(room, n), SerialPort::Read::gone);
  EXPECT_FALSE(port.open());
  EXPECT_EQ(port.write(Bytes{1}), 0u);
  SerialPort::Read answer = SerialPort::Read::nothing;
  ASSERT_TRUE(until([&] { return (answer = port.read(room, n)) != SerialPort::Read::nothing; }));
  EXPECT_EQ(answer, SerialPort::Read::back);
  EXPECT_TRUE(port.open());
  EXPECT_EQ(port.read(room, n), SerialPort::Read::nothing);
  ASSERT_TRUE(pty.write(Bytes{5, 6}));
  EXPECT_EQ(take(port, 2), (Bytes{5, 6}));
}

}  // namespace serial_port_test
}  // namespace filum
