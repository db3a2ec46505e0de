#pragma once

#include <nlohmann/json.hpp>

#include "base/pose.h"

namespace filum {

inline nlohmann::json vector_json(const Vec3& v) { return nlohmann::json::array({v.x(), v.y(), v.z()}); }

}  // namespace filum
