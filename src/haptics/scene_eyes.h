#pragma once
// The eyes of scripted hands (devices/sight.h): finds in the newest observation what a key of a demonstration is given relative to.

#include "devices/sight.h"
#include "world/observation.h"

namespace filum {

class SceneEyes final : public Eyes {
 public:
  /// Both must outlive it; they are read whenever find() is called, by the thread that calls it.
  SceneEyes(const Observation& observation, const SceneDescription& scene) : observation_(observation), scene_(scene) {}

  bool find(const Look& look, Pose& X_WF) const noexcept override;
  double felt(int tool) const noexcept override;

 private:
  bool find_needle(const Look& look, Pose& X_WF) const noexcept;
  bool find_thread(const Look& look, Pose& X_WF) const noexcept;
  bool find_pass(const Look& look, Pose& X_WF) const noexcept;

  const Observation& observation_;
  const SceneDescription& scene_;
};

}  // namespace filum
