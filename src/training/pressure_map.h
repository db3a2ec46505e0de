#pragma once
// Where pressure was, over time, as the result page draws it: along each blade (distance from the tip against time) and on the
// cortex (largest pressure and dose of each place). Test: retraction_test.

#include <nlohmann/json_fwd.hpp>

#include "training/retraction.h"

namespace filum {

inline constexpr std::size_t kMapColumns = 600;

/// Pressures in mmHg, dose in mmHg min, lengths in mm. At most kMapColumns moments; each shows the largest since the one before.
nlohmann::ordered_json pressure_map_json(const PressureReport& p);

}  // namespace filum
