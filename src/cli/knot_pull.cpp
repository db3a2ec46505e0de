#include "cli/knot_pull.h"

namespace filum {

KnotPull::KnotPull(std::unique_ptr<LiveSession> session, std::unique_ptr<Recorder> recorder, std::string id)
    : id_(std::move(id)), recorder_(std::move(recorder)), session_(std::move(session)), thread_([this] {
        try {
          result_ = session_->settle([this](double done) {
            progress_.store(done);
            return !abandoned_.load();
          });
        } catch (...) {
          failure_ = std::current_exception();
        }
        over_.store(true);
      }) {}

KnotPull::~KnotPull() {
  abandon();
  if (thread_.joinable()) thread_.join();
}

Result KnotPull::finish() {
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  return result_;
}

}  // namespace filum
