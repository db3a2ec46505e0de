#include "cli/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

#include "base/error.h"

extern char** environ;

namespace filum {
namespace {

constexpr std::size_t kLongestLine = 65536, kMostErrors = 2048;

/// Two ends: [0] ours, [1] the child's. A socket pair rather than a pipe: writing to one nobody reads raises no signal.
std::array<int, 2> channel() {
  std::array<int, 2> ends{-1, -1};
  ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data());
  return ends;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
  const std::array<int, 2> in = channel(), out = channel(), error = channel();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[1], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, error[1], STDERR_FILENO);
  std::vector<char*> argv;
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const int failed = ::posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  for (const int fd : {in[1], out[1], error[1]}) ::close(fd);
  in_ = in[0];
  out_ = out[0];
  error_ = error[0];
  ::fcntl(out_, F_SETFL, O_NONBLOCK);
  ::fcntl(error_, F_SETFL, O_NONBLOCK);
  if (failed == 0) return;
  for (const int fd : {in_, out_, error_}) ::close(fd);
  throw InputError("program", "path", arguments[0], "a program that can be started");
}

ChildProcess::~ChildProcess() {
  for (const int fd : {in_, out_, error_}) ::close(fd);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  while (::waitpid(pid_, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

bool ChildProcess::send(const std::string& line) {
  const std::string text = line + "\n";
  return ::send(in_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(text.size());
}

void ChildProcess::drain_errors() {
  std::array<char, 512> bytes;
  for (ssize_t n; (n = ::read(error_, bytes.data(), bytes.size())) > 0;)
    if (errors_.size() < kMostErrors) errors_.append(bytes.data(), static_cast<std::size_t>(n));
}

ChildProcess::Read ChildProcess::receive(std::string& line, int milliseconds) {
  for (;;) {
    if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
      line = text_.substr(0, end);
      text_.erase(0, end + 1);
      return Read::line;
    }
    pollfd ready{out_, POLLIN, 0};
    const int n = ::poll(&ready, 1, milliseconds);
    drain_errors();
    if (n <= 0) return Read::nothing;
    std::array<char, 4096> bytes;
    const ssize_t got = ::read(out_, bytes.data(), bytes.size());
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return Read::nothing;
    if (got <= 0 || text_.size() > kLongestLine) return Read::ended;
    text_.append(bytes.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace filum
