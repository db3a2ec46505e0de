#include "world/held_tools.h"

namespace filum {

HeldTools::HeldTools(std::size_t n_tools) {
  moved_.reserve(n_tools);
  held_.reserve(n_tools);
}

void HeldTools::find(const State& s, const std::vector<ObstacleBody>& from) noexcept {
  moved_ = held_ = s.instruments;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (armed_before_[i] != 0 && s.armed[i] == 0) continue;
    held_[i].X_WT = from[i].X_start;
    held_[i].v = held_[i].w = Vec3::Zero();
  }
}

void HeldTools::put(State& s, ImplicitRod& rod, bool held) const noexcept {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    s.instruments[i] = held ? held_[i] : moved_[i];
    rod.obstacles.bodies[i].X_end = rod.grasps.tools[i].X_now = s.instruments[i].X_WT;
  }
}

}  // namespace filum
