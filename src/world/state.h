#pragma once
// Everything that changes from step to step: copyable, complete, without pointers. Same State, same Inputs, same next State.

#include <array>
#include <cstdint>
#include <vector>

#include "physics/implicit_rod.h"
#include "physics/instrument.h"
#include "physics/needle.h"
#include "world/brain_model.h"
#include "world/vessel_state.h"
#include "physics/pellet.h"

namespace filum {

/// Fresh sutures (world/fresh_suture.h).
struct SutureState {
  std::int32_t taken = 1;                   // so far, the first one among them
  std::int32_t down = 0;                    // their button is pressed
};

struct State {
  std::uint64_t step = 0;
  RodState thread;
  RodMemory memory;
  std::vector<InstrumentState> instruments;
  std::vector<Vec3> force, torque;          // [N], [N m], of the scene on each tool in the last step, about its tip
  std::array<double, 3> thread_pull{};      // [N], of the thread alone; told, not carried on
  std::array<std::int32_t, 3> armed{};      // jaws have been open since they last closed: they may take the thread
  std::array<std::int32_t, 3> valid{};      // what came from each tool's device, an InputState
  std::vector<PelletState> pellets;
  NeedleState needle;                       // of scenes with one
  std::int32_t has_needle = 0;
  SutureState sutures;
  VesselState tissue;                       // of scenes with some
  double overloaded = 0.0;                  // [N], highest tension since the last overload event, 0 when below
  double cut_low = -1.0, cut_high = -1.0;   // [m], arc of the cuts below and above the post, -1 none
  BrainState brain;                         // empty in scenes without one
  double break_arc = -1.0;                  // [m], where the thread parted under tension, -1 none
};

}  // namespace filum
