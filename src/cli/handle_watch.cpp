#include "cli/handle_watch.h"

#include "devices/sample_faults.h"

namespace filum {
namespace {

struct Fault {
  std::uint32_t bit;
  const char *name, *level, *text;
};

constexpr std::array<Fault, HandleWatch::kFaults> kKnown = {{
    {kForeignCalibration, "foreign-calibration", "danger", "The calibration in use is not this handle's: openings and forces may be wrong. End the task, calibrate, or choose the handle's own file."},
    {kAngleBroken, "angle-wire-broken", "danger", "The handle's wire for the opening is broken or shorted: the opening is not measured."},
    {kForceBroken, "force-wire-broken", "danger", "The handle's wire for the squeeze is broken or shorted: the squeeze is not measured."},
    {kAngleSaturated, "angle-saturated", "warn", "The handle's opening is at the end of its amplifier's range."},
    {kForceSaturated, "force-saturated", "warn", "The handle's squeeze is at the end of its amplifier's range: the true force may be larger."},
    {kNotSeen, "demonstration-waits", "warn", "The demonstration waits: what the hand reaches for is not there."},
}};
constexpr std::size_t kMostEvents = 1000;  // a loose wire may flicker for hours

}  // namespace

std::array<std::array<double, HandleWatch::kFaults>, kMaxTools> HandleWatch::never() {
  std::array<std::array<double, kFaults>, kMaxTools> last;
  for (auto& of_tool : last) of_tool.fill(-1e9);
  return last;
}

void HandleWatch::take(const DeviceSample& sample, double time) {
  if (sample.tool < 0 || sample.tool >= kMaxTools || (sample.buttons & ~kButtonBits) == 0) return;
  for (std::size_t k = 0; k < kFaults; ++k) {
    const Fault& fault = kKnown[k];
    // A broken wire rests at a rail: that it is saturated, too, says nothing more.
    const bool hidden = (fault.bit == kAngleSaturated && (sample.buttons & kAngleBroken) != 0) || (fault.bit == kForceSaturated && (sample.buttons & kForceBroken) != 0);
    if ((sample.buttons & fault.bit) == 0 || hidden) continue;
    double& last = last_[static_cast<std::size_t>(sample.tool)][k];
    if (time - last > kGone && events_.size() < kMostEvents) events_.push_back({time, fault.name, sample.tool, 0.0, "-", fault.text});
    last = time;
  }
}

std::vector<TaskWarning> HandleWatch::warnings(double time) const {
  std::vector<TaskWarning> list;
  for (std::size_t k = 0; k < kFaults; ++k)
    for (const auto& of_tool : last_)
      if (time - of_tool[k] <= kGone) {
        list.push_back({kKnown[k].level, kKnown[k].name, kKnown[k].text});
        break;
      }
  return list;
}

}  // namespace filum
