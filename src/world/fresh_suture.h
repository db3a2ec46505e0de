#pragma once
// A fresh suture, asked for by a button (world/inputs.h, 32), as an assistant hands it: the strand on the needle is taken away with its needle, and so are
// ends that were cut off and lie loose; needle and thread lie anew where the first ones lay at the start, at rest, in the same rod (rod_pieces.h). What is
// tied stays as it is. Refused, with an event that says why, while the needle or its strand is held, goes through tissue, or the new one would lie where
// something is; when there is no room for its nodes; and when none is left. Test: fresh_suture_test.

#include <array>

#include "physics/rod_pieces.h"
#include "world/model.h"
#include "world/observation.h"
#include "world/state.h"

namespace filum {

/// The thread of a scene at its start.
RodState first_thread(const Model& model);

class FreshSuture {
 public:
  explicit FreshSuture(const Model& model);

  /// Acts once at each press.
  void hear(State& s, std::uint32_t buttons, Observation& o) const noexcept;

 private:
  const char* refusal(const State& s) const noexcept;
  bool in_the_way(const State& s) const noexcept;
  bool touches_path(const Vec3& a, const Vec3& b, double room) const noexcept;
  void clear(State& s) const noexcept;
  void lay(State& s) const noexcept;

  const Model& model_;
  RodState thread_;
  std::array<Vec3, 7> wire_;  // [m], points along the needle
};

}  // namespace filum
