#include "devices/demonstrator.h"

#include <utility>

namespace filum {

Demonstrator::Demonstrator(const std::string& path) : Demonstrator(PoseScript::load(path)) {}

Demonstrator::Demonstrator(PoseScript script)
    : script_(std::move(script)), name_("demonstrator: " + script_.title()) {
  for (int tool = 0; tool < kMaxTools; ++tool) moved_ += script_.has_tool(tool) ? 1u : 0u;
}

void Demonstrator::poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  if (now_us < next_us_) return;
  const auto room = static_cast<std::int64_t>(kMaxSamplesPerPoll / kMaxTools);
  const std::int64_t due = (now_us - next_us_) / kPeriod + 1;
  if (due > room) {
    health_.lost += static_cast<std::uint64_t>(due - room) * moved_;
    next_us_ += (due - room) * kPeriod;
  }
  for (; next_us_ <= now_us; next_us_ += kPeriod) {
    for (int tool = 0; tool < kMaxTools; ++tool) {
      if (!script_.has_tool(tool)) continue;
      DeviceSample sample = script_.at(tool, static_cast<double>(next_us_) * 1e-6);
      sample.host_time_us = sample.device_time_us = next_us_;
      sample.sequence = static_cast<std::uint32_t>(next_us_ / kPeriod);
      out.push_back(sample);
      ++health_.received;
    }
  }
  const bool over = static_cast<double>(now_us) * 1e-6 > script_.duration();
  health_.state = over ? DeviceState::finished : DeviceState::live;
}

}  // namespace filum
