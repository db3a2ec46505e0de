#pragma once
// Small soft objects to be picked up without breaking them: spheres that stick to the sheet below them.
//
// Squeeze. Between jaws of length L (hinge to tip) whose grip spring has stiffness k_g [N m/rad], a sphere of radius r
// and stiffness k stops the jaws; with the jaws commanded to angle c (below 2 r / L) both springs carry the same force:
//   N = k_g (2 r / L - c) / L / (1 + k_g / (L^2 k)),   theta = (2 r - N / k) / L      (small angles)
// or N as measured, where the device measures it. N above the strength breaks the object for good.
// Holding. The pads bear a tangential load up to 2 mu N (Coulomb, two pads). While the object sticks, the load is
// F = k_t |anchor - p|; above the adhesion it comes off, above 2 mu N it slips out of the jaws. Once off, the load is its
// weight and inertia, m |g + a|.
// Neglects: rolling, contact with the thread, with other objects and with the outside of the jaws, damage short of
// breaking. Let go, it falls and sticks where it lands. Test: pellet_test.

#include <cstdint>
#include <string>
#include <vector>

#include "base/pose.h"
#include "physics/instrument.h"

namespace filum {

struct PelletParameters {
  std::string name;
  double radius = 0.5e-3;     // [m]
  double mass = 1e-6;         // [kg]
  double stiffness = 500.0;   // [N/m], squeezed between two pads
  double friction = 0.3;      // [-], on the pads
  double adhesion = 30e-3;    // [N], pull that takes it off the sheet
  double strength = 0.4;      // [N], squeeze that breaks it
  double shear = 200.0;       // [N/m], k_t
  Vec3 start = Vec3::Zero();  // [m], frame W
  /// [N], least squeeze that takes it off the sheet.
  double slip_limit() const { return (adhesion + 9.81 * mass) / (2.0 * friction); }
};

/// Part of the state.
struct PelletState {
  Vec3 p = Vec3::Zero();         // [m], frame W
  Vec3 v = Vec3::Zero();         // [m/s]
  Vec3 anchor_T = Vec3::Zero();  // [m], where the jaws hold it, frame of the tool
  std::int32_t holder = -1;      // tool, -1 none
  std::int32_t stuck = 1;        // to the sheet
  std::int32_t broken = 0;
  std::int32_t escaped = -1;     // tool it slipped out of and that has not opened since
};

struct PelletEvent {
  const char* name = "";
  int tool = -1;
  double value = 0.0;  // [N]
};

class Pellets {
 public:
  Pellets(std::vector<PelletParameters> parameters, double sheet) : parameters_(std::move(parameters)), sheet_(sheet) {}

  bool empty() const noexcept { return parameters_.empty(); }
  const std::vector<PelletParameters>& parameters() const noexcept { return parameters_; }
  std::vector<PelletState> start() const;

  /// Jaws that close on an object stop at it and squeeze it. Call before the instruments move.
  void limit_jaws(const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states,
                  const std::vector<PelletState>& pellets, std::vector<InstrumentCommand>& commands) const noexcept;
  /// Takes, moves, breaks and drops after the instruments have moved; adds the pull on each tool to `force` [N].
  /// Returns how many events were written (at most `room`).
  int step(const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, double dt,
           std::vector<PelletState>& pellets, std::vector<Vec3>& force, PelletEvent* events, int room) const noexcept;

 private:
  struct Events {
    PelletEvent* list;
    int room, n;
    void say(const char* name, int tool, double value) noexcept {
      if (n < room) list[n++] = {name, tool, value};
    }
  };
  void hold(int tool, const InstrumentParameters& jaws, const InstrumentState& state, double dt, std::vector<PelletState>& pellets,
            Vec3& force, Events& events) const noexcept;
  void fall(const PelletParameters& p, double dt, PelletState& s) const noexcept;
  int between(const InstrumentParameters& tool, const InstrumentState& state, const std::vector<PelletState>& pellets,
              int holder) const noexcept;
  std::vector<PelletParameters> parameters_;
  double sheet_;  // [m], height of the sheet they lie on
};

}  // namespace filum
