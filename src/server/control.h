#pragma once
// Who may move the instruments when several browsers are connected: the first one that starts a task, until it leaves or
// another one takes over openly. The others watch.

#include <set>

namespace filum {

class Control {
 public:
  void join(int client) { clients_.insert(client); }
  /// The one in control leaves control empty; whoever asks next may have it.
  void leave(int client);

  /// Asks for control; given if nobody else has it or if `take_over`. False: refused.
  bool acquire(int client, bool take_over);

  bool in_control(int client) const { return controller_ == client; }
  int controller() const { return controller_; }  // 0: nobody
  int clients() const { return static_cast<int>(clients_.size()); }

 private:
  std::set<int> clients_;
  int controller_ = 0;
};

/// Credit for frames: at most kFramesInFlight frames without an ack; the newest waits, older ones are dropped.
class FrameCredit {
 public:
  static constexpr int kFramesInFlight = 2;

  bool available() const { return sent_ - acked_ < kFramesInFlight; }
  /// Number of the frame that is sent now.
  unsigned long long take() { return ++sent_; }
  /// An ack frees all frames up to it; one for a frame that was never sent, or was acked before, changes nothing.
  void ack(unsigned long long frame);

 private:
  unsigned long long sent_ = 0;
  unsigned long long acked_ = 0;
};

}  // namespace filum
