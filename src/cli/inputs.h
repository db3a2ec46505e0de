#pragma once
// From what the user named as input to the devices that drive the tools.

#include <memory>
#include <string>
#include <vector>

#include "devices/demonstrator.h"
#include "devices/device.h"
#include "devices/pointer_device.h"
#include "haptics/input_merge.h"

namespace filum {

struct InputDevices {
  std::vector<std::unique_ptr<Device>> devices;
  bool scripted = false;             // they follow the scene's clock, whatever the speed
  std::string description;           // for the recording: "demonstrator", "serial /dev/ttyACM0"
  std::string calibration;           // file of the forceps, empty: none are read
  MotionScale scale;                 // from the hand's space to the scene's
  PointerDevice* pointer = nullptr;  // one of `devices`, if there is one
  Demonstrator* demonstrator = nullptr;  // likewise; it sees by whoever runs the scene
};

/// "demo", "serial:PATH", "haptic:[ADDRESS:]PORT", "igtl:[ADDRESS:]PORT", several of them joined by "+", a demonstration (*.yaml) or a recording. Throws InputError.
/// `calibration`: file of the forceps, empty: models/forceps/default.yaml; refused where no forceps is read.
InputDevices open_inputs(const std::string& input, const std::string& root, const std::string& task, double motion_scale = 1.0, const std::string& calibration = "");

/// What the hands of a trainee in the browser move.
struct LiveDevices {
  std::string serial_port;    // of the forceps, empty: none
  std::string calibration;    // of the forceps, empty: as built
  std::string hands;          // "haptic:PORT", "igtl:PORT", joined by "+", empty: none
  double motion_scale = 1.0;  // of `hands`
  bool any() const { return !serial_port.empty() || !hands.empty(); }
};

/// The pointer of the browser alone (no device at all), the forceps with the pointer for what they do not measure, or `hands`, which know
/// where they are, with the forceps beside them. Throws InputError.
InputDevices open_live_inputs(const LiveDevices& devices, const std::string& root);

const char* name_of(DeviceState state) noexcept;

}  // namespace filum
