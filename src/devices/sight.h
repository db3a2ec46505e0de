#pragma once
// What a scripted hand may look for before it sets out, and what it feels: a key of a demonstration can be given in the frame of something
// seen, and can end where a pull is felt (pose_script.h). Devices know nothing of the world; whoever runs both lends the hand eyes.

#include "base/pose.h"

namespace filum {

/// A frame to be found. Axes:
///   needle  at `length` [m] along its wire from the swage: x outwards, y towards the point, z along the needle's normal
///   thread  at `length` [m] from the swage or, `from_end`, from the free end: x towards the swage, z as near to upright as may be
///   knot    at `length` [m] along the strand that runs from the thread's own knot to the swage or, `from_end`, to the free end; axes as of thread
///   entry, exit  of way number `index` (from 0) through the tissue: x, y, z of the scene
///   edge    of stump number `index` (0 or 1) of a vessel that is cut across: the highest place where its outer rim passes over the vessel's axis; x, y, z of the scene
///   tool    number `index`, as it is (not as commanded): z towards the handle, x the way the jaws open
///   scene   the scene itself
struct Look {
  enum class Kind { scene, needle, thread, knot, entry, exit, edge, tool } kind = Kind::scene;
  int index = 0;
  double length = 0.0;       // [m]
  bool from_end = false;
  bool scene_axes = false;   // the place is seen, directions are the scene's
  int holder = -1;           // needle: only if this tool holds it, -1 whoever does
};

class Eyes {
 public:
  virtual ~Eyes() = default;
  /// False if there is no such thing now.
  virtual bool find(const Look& look, Pose& X_WF) const noexcept = 0;
  /// [N], magnitude of what the scene pulls or pushes at a tool now; 0 if there is no such tool.
  virtual double felt(int /*tool*/) const noexcept { return 0.0; }
};

}  // namespace filum
