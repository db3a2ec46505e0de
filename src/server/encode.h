#pragma once
// The messages of the trainer as JSON text, as messages.schema.json has them. Numbers that are not finite become 0 in a frame
// (JSON has no word for them) and null elsewhere.

#include <string>
#include <vector>

#include "server/client_message.h"
#include "server/views.h"
#include "training/stitch_guide.h"
#include "world/observation.h"

namespace filum {

inline constexpr int kProtocol = 1;

struct HelloView {
  std::string version;
  std::vector<TaskInfoView> tasks;
  std::vector<DeviceView> devices;
  std::vector<std::string> inputs;  // "pointer" | "demo" | "device"
};

std::string hello_message(const HelloView& hello, int client);
std::string scene_message(const SceneDescription& scene, const std::vector<StitchGuide>& guides = {});
std::string event_message(const EventView& event);
std::string session_state_message(const TrainerView& trainer, int controller, bool in_control, int clients);
std::string replay_state_message(const ReplayView& replay);
std::string error_message(const Refusal& refusal);

/// A frame without its opening `{"type":"frame","id":N`, which differs from browser to browser; see frame_message.
std::string frame_body(const Observation& o, const TaskView* task, const std::vector<DeviceView>& devices, const OverlayView& overlay = {});
std::string frame_message(unsigned long long id, const std::string& body);

std::string task_list_json(const std::vector<TaskInfoView>& tasks);
std::string health_json(const std::string& version, const TrainerView& trainer, int clients, double real_time_factor,
                        std::uint64_t overruns);

}  // namespace filum
