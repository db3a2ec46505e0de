#pragma once
// A serial port or pty opened raw and nonblocking. When it goes away, a thread of its own closes and reopens
// it, because both can take long; the thread that reads never waits.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <thread>

namespace filum {

class SerialPort {
 public:
  /// Throws InputError when the port cannot be opened or is no terminal. `baud` is 9600 ... 4000000 of the
  /// usual rates.
  SerialPort(const std::string& path, int baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  enum class Read { data, nothing, gone, back };
  /// Reads what is there, at most into.size() bytes; `n` says how many. `gone` is reported once when the port
  /// is lost, `back` once when it is open again. Does not block.
  Read read(std::span<std::uint8_t> into, std::size_t& n) noexcept;
  /// Writes all or, when there is no room now, nothing or a part; returns the bytes written. Does not block.
  std::size_t write(std::span<const std::uint8_t> bytes) noexcept;
  bool open() const noexcept { return fd_ >= 0; }

 private:
  void reopen_loop(const std::stop_token& stop) noexcept;
  void lose() noexcept;
  void wake() noexcept;
  bool woken_within(int timeout_ms) noexcept;

  std::string path_;
  int baud_;
  int fd_;                          // owned by the reading thread, -1 while gone
  std::atomic<int> discarded_{-1};  // from the reading thread, to be closed
  std::atomic<int> reopened_{-1};   // to the reading thread
  int wake_ = -1;                   // eventfd: writing to it neither blocks nor locks
  std::jthread reopener_;           // last: starts when all else is there
};

}  // namespace filum
