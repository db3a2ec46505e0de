#pragma once
// The eyes of scripted hands (devices/sight.h): finds in the newest observation what a key of a demonstration is given relative to.

#include <array>
#include <vector>

#include "devices/sight.h"
#include "world/observation.h"

namespace filum {

class SceneEyes final : public Eyes {
 public:
  /// Both must outlive it; they are read whenever find() is called, by the thread that calls it.
  SceneEyes(const Observation& observation, const SceneDescription& scene);

  bool find(const Look& look, Pose& X_WF) const noexcept override;
  double felt(int tool) const noexcept override;

 private:
  struct Piece {
    int first = 0, last = -1;  // nodes
  };
  Piece piece() const noexcept;
  bool find_arc(const Piece& piece, double a, Pose& X_WF) const noexcept;
  bool find_needle(const Look& look, Pose& X_WF) const noexcept;
  bool find_thread(const Look& look, Pose& X_WF) const noexcept;
  bool find_knot(const Look& look, Pose& X_WF) const noexcept;
  bool find_pass(const Look& look, Pose& X_WF) const noexcept;
  bool find_edge(const Look& look, Pose& X_WF) const noexcept;

  const Observation& observation_;
  const SceneDescription& scene_;
  std::array<std::vector<int>, 2> rims_;  // vertices of the outer rim of either stump's cut, in turn
};

}  // namespace filum
