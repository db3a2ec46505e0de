#pragma once
// Violent random hands: every tool of a scene is thrown from place to place around what there is to hit (thread, tissue, objects) at up to
// 0.5 m/s, turned at will, jaws opening and snapping shut, buttons pressed, the device silent now and then. Same seed, same hands.
// Whatever they do, the scene must stay sound: finite, no more motion than hands of that speed and a stretched thread can give, thread and
// needle joined, strands not through each other, thread and needle in the tissue only where a track leads (wall_watch.h). Test: wild_hands_test; `filum bench --wild`.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "base/rng.h"
#include "world/inputs.h"
#include "world/world.h"

namespace filum {

inline constexpr double kWildSpeed = 0.5;  // [m/s]

class WildHands {
 public:
  WildHands(std::uint64_t seed, const SceneDescription& scene);
  Inputs next(const Observation& o);

 private:
  struct Hand {
    Pose from, to;
    int left = 0, steps = 1, silent = 0;
    double grip = 0.2;
    std::uint32_t buttons = 0;
  };
  Vec3 somewhere(const Observation& o);
  void aim(Hand& hand, const Observation& o);

  Rng rng_;
  double dt_;
  int n_tools_;
  std::array<Hand, 3> hands_;
  bool started_ = false;
};

struct WildRun {
  std::uint64_t seed = 0;
  std::uint64_t steps = 0;
  std::string fault;          // empty: sound
  double fastest = 0.0;       // [m/s], node of the thread or needle
  double deepest = 0.0;       // share of the thread's diameter by which strands were pressed into each other
  double slowest_ms = 0.0;    // [ms], longest step
  std::uint64_t late = 0;     // steps that took longer than dt
  std::uint64_t trouble = 0;  // times that a solver reported trouble
  int apart = 0;              // most steps on end in which thread and needle stood apart; each of them reported trouble
  int buried = 0;             // most steps on end in which a place of thread or needle was deep in the tissue without a track
};

using WildProgress = std::function<void(const WildRun&)>;

/// One run from `first`, a state of this world; ends at the first fault. `progress` hears of it every kWildTold steps.
inline constexpr int kWildTold = 500;
WildRun run_wild(World& world, const State& first, std::uint64_t seed, int steps, const WildProgress& progress = {});

}  // namespace filum
