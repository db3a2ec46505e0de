#pragma once
// A program of ours that runs beside this one and is spoken to by lines. It is told to quit by closing its input, and made to after two
// seconds. Test: tests/cli/camera_session_test.cpp.

#include <string>
#include <vector>

namespace filum {

class ChildProcess {
 public:
  /// `arguments[0]` is the program's path. Throws InputError when it cannot be started.
  explicit ChildProcess(const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends a line; false when it no longer listens.
  bool send(const std::string& line);
  enum class Read { line, nothing, ended };
  /// Waits up to `milliseconds` for the next line it writes; longer lines than 64 kB are the end of it.
  Read receive(std::string& line, int milliseconds);
  /// What it said of its troubles (the first 2 kB of its error output).
  const std::string& errors() const { return errors_; }

 private:
  void drain_errors();
  int pid_ = -1, in_ = -1, out_ = -1, error_ = -1;
  std::string text_, errors_;
};

}  // namespace filum
