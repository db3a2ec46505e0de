#include "cli/driven_task.h"

#include <optional>

#include "cli/inputs.h"
#include "cli/setup.h"
#include "haptics/haptic_loop.h"
#include "haptics/scene_eyes.h"

namespace filum {
namespace {

constexpr std::int64_t kTick = 1000;  // [us], of the hands

}  // namespace

DrivenTask driven_task(const std::string& root, const std::string& task) {
  struct Hands {
    explicit Hands(InputDevices inputs) : demonstrator(inputs.demonstrator), loop(std::move(inputs.devices)) {}
    Demonstrator* demonstrator;
    std::optional<SceneEyes> eyes;
    HapticLoop loop;
    std::int64_t next_us = 0;
  };
  DrivenTask driven;
  driven.model = load_setup(root, task).model;  // first: it knows which tasks there are
  auto hands = std::make_shared<Hands>(open_inputs("demo", root, task));
  driven.inputs = [hands](const World& world) {
    if (!hands->eyes && hands->demonstrator != nullptr) {
      hands->eyes.emplace(world.observation(), world.description());
      hands->demonstrator->look_through(&*hands->eyes);
    }
    const auto now_us =
        static_cast<std::int64_t>((world.observation().time + 0.5 * world.description().dt) * 1e6);
    for (; hands->next_us <= now_us; hands->next_us += kTick) hands->loop.tick(hands->next_us);
    return hands->loop.inputs().read();
  };
  driven.over = [hands] {
    for (std::size_t i = 0; i < hands->loop.n_devices(); ++i)
      if (hands->loop.device(i).health().state != DeviceState::finished) return false;
    return true;
  };
  return driven;
}

}  // namespace filum
