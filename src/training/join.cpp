#include "training/join.h"

#include <algorithm>
#include <string_view>

namespace filum {

void BloodWatch::observe(const Observation& o) noexcept {
  const BloodObservation& b = o.tissue.blood;
  if (!b.present) return;
  for (int k = 0; k < o.n_events; ++k) {
    const WorldEvent& e = o.events[static_cast<std::size_t>(k)];
    const std::string_view name = e.name;
    if (name == "clamp-off") (e.value == 0.0 ? clamps_.upstream : clamps_.downstream) = o.time;
    if (name == "milking-let-go") milking_.volume = 1e-9 * e.value;  // ul
    if (name == "milking-refilled") {
      ++milking_.refilled;
      milking_.seconds = e.value;
    }
    milking_.stayed_empty += name == "milking-stayed-empty" ? 1 : 0;
    milking_.spoiled += name == "milking-spoiled" ? 1 : 0;
  }
  clamps_.area = b.least_area;
  if (!clamps_.any()) {
    clamps_.area_before = b.least_area;
    return;
  }
  clamps_.wrong_order = b.wrong_order;
  std::copy(b.pressure.begin(), b.pressure.end(), clamps_.pressure);
  clamps_.leak = b.leaks;
  clamps_.most_leak = std::max(clamps_.most_leak, b.leaks);
  clamps_.through = b.through;
  clamps_.lost = b.lost;
}

}  // namespace filum
