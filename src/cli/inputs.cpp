#include "cli/inputs.h"

#include <charconv>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/file_kind.h"
#include "cli/setup.h"
#include "devices/haptic_link.h"
#include "devices/igtl_tracker.h"
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

std::unique_ptr<Device> open_forceps(const std::string& port, const std::string& calibration) {
  return std::make_unique<SerialForceps>(port, ForcepsCalibration::load(calibration));
}

/// The user's own calibration, else the one of the handle as built.
std::string calibration_file(const std::string& chosen, const std::string& root) { return chosen.empty() ? root + "/models/forceps/default.yaml" : chosen; }

struct HostPort {
  std::string address = "127.0.0.1";
  int port = 0;
};

/// "18930" or "192.168.1.5:18930"; loopback unless an address is given.
HostPort host_port(const std::string& text, const char* option) {
  HostPort at;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) at.address = text.substr(0, colon);
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  const auto end = port.data() + port.size();
  const auto read = std::from_chars(port.data(), end, at.port);
  if (read.ec != std::errc{} || read.ptr != end || at.port < 1 || at.port > 65535)
    throw InputError(option, "port", text, "a port, or ADDRESS:PORT");
  return at;
}

std::unique_ptr<Device> open_hand_device(const std::string& name, const std::string& calibration, const char* option) {
  const auto after = [&](const char* prefix) { return name.substr(std::string(prefix).size()); };
  if (name.starts_with("serial:")) return open_forceps(after("serial:"), calibration);
  if (name.starts_with("haptic:")) {
    const HostPort at = host_port(after("haptic:"), option);
    return std::make_unique<HapticLink>(at.address, at.port);
  }
  if (name.starts_with("igtl:")) {
    const HostPort at = host_port(after("igtl:"), option);
    return std::make_unique<IgtlTracker>(at.address, at.port);
  }
  return nullptr;
}

/// Devices that hands move, joined by "+": the first is believed where two measure the same. `option` named them.
InputDevices open_hands(const std::string& input, double motion_scale, const std::string& calibration, const char* option) {
  InputDevices result;
  for (std::size_t from = 0; from <= input.size();) {
    const std::size_t plus = std::min(input.find('+', from), input.size());
    auto device = open_hand_device(input.substr(from, plus - from), calibration, option);
    if (!device) throw InputError(option, "device", input.substr(from, plus - from), "serial:PATH, haptic:PORT or igtl:PORT");
    if (input.compare(from, 7, "serial:") == 0) result.calibration = calibration;
    result.description += (result.description.empty() ? "" : " and ") + device->name();
    result.devices.push_back(std::move(device));
    from = plus + 1;
  }
  result.scale.factor = motion_scale;
  if (motion_scale != 1.0) {
    char text[40];
    std::snprintf(text, sizeof text, ", motion scale %.6g", motion_scale);
    result.description += text;
  }
  return result;
}

void add_demonstrator(InputDevices& inputs, const std::string& script) {
  auto demonstrator = std::make_unique<Demonstrator>(script);
  inputs.demonstrator = demonstrator.get();
  inputs.devices.push_back(std::move(demonstrator));
}

bool names_hands(const std::string& input) {
  for (const char* prefix : {"serial:", "haptic:", "igtl:"})
    if (input.starts_with(prefix)) return true;
  return false;
}

}  // namespace

InputDevices open_inputs(const std::string& input, const std::string& root, const std::string& task, double motion_scale, const std::string& calibration) {
  if (!calibration.empty() && input.find("serial:") == std::string::npos) throw InputError("--forceps", "calibration", calibration, "--input serial:PATH beside it");
  if (motion_scale != 1.0 && !names_hands(input)) throw InputError("--motion-scale", "input", input, "one that hands move: serial:PATH, haptic:PORT or igtl:PORT");
  if (names_hands(input)) return open_hands(input, motion_scale, calibration_file(calibration, root), "--input");
  InputDevices result;
  result.scripted = true;
  if (input == "demo") {
    const std::string script = demonstration_file(root, task);
    if (!is_there(script)) throw InputError("--input", "demo", task, "a task with a demonstration (" + script + " is not there)");
    add_demonstrator(result, script);
    result.description = "demonstrator";
    return result;
  }
  if (!is_file(input)) {
    throw InputError("--input", "input", input, "demo, serial:PATH, haptic:PORT, igtl:PORT, a demonstration (*.yaml) or a recording");
  }
  const bool script = std::filesystem::path(input).extension() == ".yaml";
  if (script)
    add_demonstrator(result, input);
  else
    result.devices.push_back(open_recording(input));
  result.description = (script ? "demonstration " : "replay ") + std::filesystem::path(input).filename().string();
  return result;
}

InputDevices open_live_inputs(const LiveDevices& devices, const std::string& root) {
  const std::string calibration = calibration_file(devices.calibration, root);
  InputDevices result;
  if (!devices.hands.empty()) {
    result = open_hands(devices.hands, devices.motion_scale, calibration, "--hands");
    if (devices.serial_port.empty()) return result;
    result.devices.push_back(open_forceps(devices.serial_port, calibration));
    result.calibration = calibration;
    result.description += " and serial " + devices.serial_port;
    return result;
  }
  auto pointer = std::make_unique<PointerDevice>();
  result.pointer = pointer.get();
  result.description = "pointer";
  if (!devices.serial_port.empty()) {
    result.devices.push_back(open_forceps(devices.serial_port, calibration));
    result.calibration = calibration;
    result.description = "serial " + devices.serial_port + " and pointer";
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
