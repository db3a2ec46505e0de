#pragma once
// The needle of a scene: what jaws do to it, and how it moves with the thread that is swaged to it.
//
// A step of thread and needle together: the needle is moved as if it had no thread, which tells how firmly its swage is held there;
// the thread is stepped with its end held just so (rod_tether.h); then the needle follows the thread's end. Where the needle cannot follow, because
// what was seen ahead held for another pull only (a wire that turns between the pads gives way without end), the step is taken back and made again.
// So is one in which instruments press thread harder than it bears, tear it off its needle or through tissue, with the instruments held where they were (held_tools.h).

#include <memory>

#include "physics/implicit_rod.h"
#include "physics/needle.h"
#include "world/fresh_suture.h"
#include "world/held_tools.h"
#include "world/model.h"
#include "world/observation.h"
#include "world/state.h"
#include "world/vessel_scene.h"

namespace filum {

class NeedleScene {
 public:
  explicit NeedleScene(const Model& model);

  void start(State& s);
  void size_observation(Observation& o) const;
  /// After a state was restored.
  void match(const State& s) noexcept;

  /// Buttons of all tools together; the clamp of a vessel hears them, and who hands fresh sutures.
  void handle_buttons(State& s, std::uint32_t buttons, Observation& o) const noexcept;
  /// Jaws that close on the wire, or on the vessel, stop at it and squeeze it. Call before the instruments move.
  void limit_jaws(const State& s, std::vector<InstrumentCommand>& commands) const noexcept;
  /// After the instruments have moved from `from`: none has gone through tissue.
  void hold_back(State& s, const std::vector<ObstacleBody>& from) noexcept {
    if (tissue_) tissue_->hold_back(s.tissue, model_.instruments, from, s.instruments);
  }
  /// After the instruments have moved from `from`: tells the needle where they are, takes it, lets it go.
  void meet_tools(State& s, const std::vector<ObstacleBody>& from, Observation& o) noexcept;
  /// Thread and needle, joined; what they did to each other is in `s` and `rod`.
  RodStepSummary step_thread(State& s, ImplicitRod& rod, const RodStepOptions& o, HeldTools& tools) noexcept;
  /// The tissue's turn. Adds the needle's pull to the forces on the tools.
  void after_thread(State& s, ImplicitRod& rod, Observation& o) noexcept;
  void observe(const State& s, Observation& o) const noexcept;
  /// Bars that stand in the scene.
  void surround(const std::vector<RoundBar>& bars) noexcept { body_.bars = bars; }
  static bool held_by(const State& s, int tool) noexcept { return s.needle.grips[static_cast<std::size_t>(tool)].held != 0; }

 private:
  double stop_angle(const InstrumentParameters& tool) const noexcept;
  static double squeeze(const InstrumentParameters& tool, double stop, double command) noexcept;
  void before_thread(const State& s, ImplicitRod& rod) noexcept;
  void hold_swage(const State& s, ImplicitRod& rod, const Vec3& load) noexcept;
  void follow(State& s) noexcept;
  double apart(const State& s) const noexcept;
  bool may_take_tissue(const State& s, int tool) noexcept;
  bool misled(const State& s, const ImplicitRod& rod) const noexcept;
  RodStepSummary attempt(State& s, ImplicitRod& rod, const RodStepOptions& o) noexcept;
  double overload(const State& s, const RodStepSummary& thread) const noexcept;
  void keep(const State& s) noexcept;
  void take_back(State& s) const noexcept;

  const Model& model_;
  NeedleBody body_;
  NeedleOptions options_;
  FreshSuture fresh_;
  std::unique_ptr<VesselScene> tissue_;  // in scenes with some
  double thread_pull_ = 0.0;
  NeedleSummary summary_;                // of the last step
  RodState thread_before_;               // of the present step, for when it is made again
  RodMemory memory_before_;
  NeedleState needle_before_;
  std::vector<GraspPoint> thread_between_;  // jaws, at most so many as they hold
};

}  // namespace filum
