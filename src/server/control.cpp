#include "server/control.h"

namespace filum {

void Control::leave(int client) {
  clients_.erase(client);
  if (controller_ == client) controller_ = 0;
}

bool Control::acquire(int client, bool take_over) {
  if (!clients_.contains(client)) return false;
  if (controller_ != 0 && controller_ != client && !take_over) return false;
  controller_ = client;
  return true;
}

void FrameCredit::ack(unsigned long long frame) {
  if (frame > acked_ && frame <= sent_) acked_ = frame;
}

}  // namespace filum
