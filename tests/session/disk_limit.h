#pragma once

#include <sys/resource.h>

#include <csignal>

namespace filum {

/// Files of this process may not grow past `bytes` while in scope: what a full disk does, without a disk.
class DiskLimit {
 public:
  explicit DiskLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~DiskLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace filum
