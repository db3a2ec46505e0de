#pragma once
// From what the user named as input to the devices that drive the tools.

#include <memory>
#include <string>
#include <vector>

#include "devices/device.h"
#include "devices/pointer_device.h"

namespace filum {

struct InputDevices {
  std::vector<std::unique_ptr<Device>> devices;
  bool scripted = false;             // they follow the scene's clock, whatever the speed
  std::string description;           // for the recording: "demonstrator", "serial /dev/ttyACM0"
  PointerDevice* pointer = nullptr;  // one of `devices`, if there is one
};

/// "demo", "serial:PATH", a demonstration (*.yaml) or a recording. Throws InputError.
InputDevices open_inputs(const std::string& input, const std::string& root, const std::string& task);

/// The pointer of the browser alone, or the forceps on `serial_port` with the pointer for what they do not measure.
InputDevices open_live_inputs(const std::string& serial_port, const std::string& root);

const char* name_of(DeviceState state) noexcept;

}  // namespace filum
