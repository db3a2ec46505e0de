// Any text either is refused or gives finite, unit, in-range poses at every time.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "base/error.h"
#include "devices/pose_script.h"
#include "devices/sample_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto script = filum::PoseScript::parse({reinterpret_cast<const char*>(data), size}, "fuzz.yaml");
    if (!(script.duration() >= 0.0 && script.duration() <= 3600.0)) std::abort();
    for (int tool = -1; tool <= filum::kMaxTools; ++tool) {
      for (int i = -1; i <= 41; ++i) {
        const filum::DeviceSample sample = script.at(tool, script.duration() * i / 40.0);
        script.say(tool, script.duration() * i / 40.0);
        if (sample.has_pose != script.has_tool(tool)) std::abort();
        // An arc may swing out of reach between its ends; the consumer of the samples checks that.
        if (sample.has_pose && filum::fault_of(sample) == filum::SampleFault::not_finite) std::abort();
        if (sample.has_pose && std::abs(sample.X_WD.q.norm() - 1.0) > 1e-9) std::abort();
      }
    }
  } catch (const filum::InputError&) {
  }
  return 0;
}
