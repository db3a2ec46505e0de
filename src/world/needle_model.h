#pragma once
// The constant part of a needle in a scene.

#include "physics/needle.h"

namespace filum {

struct NeedleModel {
  NeedleShape shape;
  Pose start;             // X_WN
};

}  // namespace filum
