#include "cli/inputs.h"

#include <filesystem>

#include "base/error.h"
#include "cli/setup.h"
#include "devices/demonstrator.h"
#include "devices/replay_device.h"
#include "devices/serial_forceps.h"
#include "session/recording_reader.h"

namespace filum {
namespace {

DeviceSample device_sample(const SampleRecord& r) {
  return {r.tool,           r.host_time_us,   r.device_time_us, r.sequence,   r.has_pose,  r.has_grip_angle,
          r.has_grip_force, r.X_WD,           r.grip_angle,     r.grip_force, r.raw_angle, r.raw_force,
          r.buttons};
}

std::unique_ptr<Device> open_recording(const std::string& file) {
  const RecordingReader recording(file);
  std::vector<DeviceSample> samples;
  SampleRecord record;
  for (auto cursor = recording.samples(); cursor.next(record);) samples.push_back(device_sample(record));
  if (samples.empty()) throw InputError(file, "samples", "none", "a recording with device samples");
  return std::make_unique<ReplayDevice>("replay " + std::filesystem::path(file).filename().string(), std::move(samples));
}

std::unique_ptr<Device> open_forceps(const std::string& port, const std::string& root) {
  return std::make_unique<SerialForceps>(port, ForcepsCalibration::load(root + "/models/forceps/default.yaml"));
}

}  // namespace

InputDevices open_inputs(const std::string& input, const std::string& root, const std::string& task) {
  InputDevices result;
  const std::string serial = "serial:";
  if (input.starts_with(serial)) {
    result.devices.push_back(open_forceps(input.substr(serial.size()), root));
    result.description = "serial " + input.substr(serial.size());
    return result;
  }
  result.scripted = true;
  if (input == "demo") {
    const std::string script = demonstration_file(root, task);
    if (!std::filesystem::exists(script)) throw InputError("--input", "demo", task, "a task with a demonstration (" + script + " is not there)");
    result.devices.push_back(std::make_unique<Demonstrator>(script));
    result.description = "demonstrator";
    return result;
  }
  if (!std::filesystem::is_regular_file(input)) {
    throw InputError("--input", "input", input, "demo, serial:PATH, a demonstration (*.yaml) or a recording");
  }
  const bool script = std::filesystem::path(input).extension() == ".yaml";
  result.devices.push_back(script ? std::make_unique<Demonstrator>(input) : open_recording(input));
  result.description = (script ? "demonstration " : "replay ") + std::filesystem::path(input).filename().string();
  return result;
}

InputDevices open_live_inputs(const std::string& serial_port, const std::string& root) {
  InputDevices result;
  auto pointer = std::make_unique<PointerDevice>();
  result.pointer = pointer.get();
  result.description = "pointer";
  if (!serial_port.empty()) {
    result.devices.push_back(open_forceps(serial_port, root));
    result.description = "serial " + serial_port + " and pointer";
  }
  result.devices.push_back(std::move(pointer));
  return result;
}

const char* name_of(DeviceState state) noexcept {
  switch (state) {
    case DeviceState::waiting: return "waiting";
    case DeviceState::live: return "live";
    case DeviceState::stale: return "stale";
    case DeviceState::lost: return "lost";
    case DeviceState::finished: return "finished";
  }
  return "lost";
}

}  // namespace filum
