#pragma once
// A trainer that runs in a thread of its own, on a free port, with a store that goes away with the test.

#include <stdexcept>
#include <thread>

#include "cli/trainer.h"
#include "tests/server/client.h"
#include "tests/session/synthetic.h"

namespace filum {

class StartedTrainer {
 public:
  explicit StartedTrainer(TrainerOptions options = {}) : trainer_(filled(std::move(options))), thread_([this] { trainer_.run(quit_); }) {}
  ~StartedTrainer() {
    quit_ = true;
    thread_.join();
  }
  Trainer& operator*() { return trainer_; }
  Trainer* operator->() { return &trainer_; }
  std::uint16_t port() const {
    const std::string url = trainer_.url();
    return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  }
  nlohmann::json get(const std::string& path) const { return nlohmann::json::parse(fetch(port(), path).body()); }
  const synthetic::Folder& folder() const { return folder_; }

 private:
  TrainerOptions filled(TrainerOptions o) const {
    o.root = FILUM_SOURCE_DIR;
    o.port = 0;
    if (o.store_folder.empty()) o.store_folder = folder_.file("store");
    return o;
  }
  synthetic::Folder folder_;
  std::atomic<bool> quit_ = false;
  Trainer trainer_;
  std::thread thread_;
};

/// What the browser is told next of the trainer's state, until it is `state`. Throws where it is told of an error instead.
inline nlohmann::json hear_state(Client& client, const std::string& state) {
  for (;;) {
    const nlohmann::json message = client.hear();
    if (message.at("type") == "error") throw std::runtime_error(message.dump());
    if (message.at("type") == "session_state" && message.at("state") == state) return message;
  }
}

/// Plays frames until the scene is this far. [s]
inline void run_until(Client& client, double time) {
  for (;;) {
    const nlohmann::json frame = client.hear("frame");
    if (frame.at("time") >= time) return;
    client.say(R"({"type":"ack","frame":)" + frame.at("id").dump() + "}");
  }
}

}  // namespace filum
