#pragma once
// Where instruments touch each other and what stands in the scene: round bars that may taper (jaws and shafts, a post), and the
// sheet below. These contacts are hard: Instruments solves them in the step of its bodies, at the level of velocities,
//   v_n >= -gap/h,  |f_t| <= mu f_n
// (D. E. Stewart, J. C. Trinkle, Int. J. Numer. Meth. Eng. 39 (1996) 2673-2691; friction as a pyramid), v_n the speed of parting, h the
// step: a contact is there before the surfaces meet, so that nothing is jumped over at the speed of hands.
// Neglects: the tilt of the normal on a tapered bar; that a jaw is no round bar where it grips. Test: instrument_contact_test.

#include <limits>
#include <vector>

#include "physics/instrument.h"

namespace filum {

struct RoundBar {
  Vec3 a = Vec3::Zero(), b = Vec3::UnitZ();  // [m], ends of the axis, frame W
  double r_a = 0, r_b = 0;                   // [m]
};

struct InstrumentTouch {
  int tool = 0, bar = 0;             // bar: as in instrument_bars()
  int other = -1, other_bar = -1;    // another tool and its bar; -1: what stands still
  Vec3 p = Vec3::Zero();             // [m], frame W, half way between the surfaces
  Vec3 normal = Vec3::UnitZ();       // unit, towards `tool`
  double gap = 0.0;                  // [m], below zero: into each other
};

/// What stands in the scene.
struct Surroundings {
  std::vector<RoundBar> bars;
  double sheet = -std::numeric_limits<double>::infinity();  // [m], its height
};

class InstrumentContact {
 public:
  InstrumentContact(int n_tools, Surroundings surroundings);

  /// What stands in the scene from now on, slowly moved: at most kMostBars.
  void surround(const std::vector<RoundBar>& bars) noexcept { surroundings_.bars = bars; }
  static constexpr std::size_t kMostBars = 10;  // a post's two, a clamp's seven

  /// Most touches at a time: of more, those that are nearest.
  static constexpr int kMost = 48;

  /// Collects what could touch within h [s]. Allocates nothing.
  void find(const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, double h) noexcept;
  const std::vector<InstrumentTouch>& touches() const noexcept { return touches_; }

 private:
  struct Moving {
    RoundBar bars[3];
    Vec3 p, v, w;  // [m], [m/s], [rad/s], of the tip
  };
  void place(const InstrumentParameters& p, const InstrumentState& s, Moving& tool) const noexcept;
  void meet(int tool, int bar, int other, int other_bar, const RoundBar& against, double h) noexcept;
  void meet_at(int tool, int bar, int other, int other_bar, const RoundBar& against, double s, double t, double h) noexcept;
  void meet_sheet(int tool, int bar, double h) noexcept;
  Vec3 velocity(int tool, const Vec3& p) const noexcept;

  Surroundings surroundings_;
  std::vector<Moving> tools_;
  std::vector<InstrumentTouch> touches_;
};

}  // namespace filum
