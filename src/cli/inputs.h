#pragma once
// From what the user named as input to the devices that drive the tools.

#include <memory>
#include <string>
#include <vector>

#include "devices/device.h"
#include "devices/pointer_device.h"
#include "haptics/input_merge.h"

namespace filum {

struct InputDevices {
  std::vector<std::unique_ptr<Device>> devices;
  bool scripted = false;             // they follow the scene's clock, whatever the speed
  std::string description;           // for the recording: "demonstrator", "serial /dev/ttyACM0"
  MotionScale scale;                 // from the hand's space to the scene's
  PointerDevice* pointer = nullptr;  // one of `devices`, if there is one
};

/// "demo", "serial:PATH", "haptic:[ADDRESS:]PORT", "igtl:[ADDRESS:]PORT", several of them joined by "+", a demonstration (*.yaml) or a recording. Throws InputError.
/// `calibration`: file of the forceps, empty: models/forceps/default.yaml; refused where no forceps is read.
InputDevices open_inputs(const std::string& input, const std::string& root, const std::string& task, double motion_scale = 1.0, const std::string& calibration = "");

/// The pointer of the browser alone, or the forceps on `serial_port` with the pointer for what they do not measure.
InputDevices open_live_inputs(const std::string& serial_port, const std::string& root, const std::string& calibration = "");

const char* name_of(DeviceState state) noexcept;

}  // namespace filum
