#pragma once
// A hand is no vise: a step in which instruments would press thread harder than it bears is made again with the instruments held where they were, and taken if that is less
// of an overload (a proxy of the hand that what it meets stops: Ruspini, Kolarov & Khatib, SIGGRAPH 1997). A hand may always let go of what it presses.
// Tests: needle_scene_test, wild_hands_test.

#include <vector>

#include "physics/implicit_rod.h"
#include "world/state.h"

namespace filum {

class HeldTools {
 public:
  explicit HeldTools(std::size_t n_tools);

  /// Before jaws take anything in a step.
  void note(const State& s) noexcept { armed_before_ = s.armed; }
  /// At the end of their ways, where they are now, and where they began. Those whose jaws have just taken something stay where they are.
  void find(const State& s, const std::vector<ObstacleBody>& from) noexcept;
  /// Puts them there for a step of the thread, held or not.
  void put(State& s, ImplicitRod& rod, bool held) const noexcept;

 private:
  decltype(State::armed) armed_before_{};  // jaws that could take hold when the step began
  std::vector<InstrumentState> moved_, held_;
};

}  // namespace filum
