#pragma once
// Blood in a vessel whose clamps have been taken off, and the milking (empty and refill) test of Acland.
//
//   Line     Rings of the lumen in the order that blood passes them: areas A from the walls as they are; Poiseuille resistance between two
//            rings 8 pi mu L / (A1 A2): the integral of dx/A^2 where A goes evenly from one to the other.
//   Balance  An artery of pressure P behind R_up, a join that lets Q(p) out of its gaps (vessel_leak.h), and what lies behind it at p_down
//            beyond R_down:  (P - p)/R_up = Q(p) + (p - p_down)/R_down. Q grows with p, so there is one p, found by halving. A clamp that
//            is on counts as no way at all.
//   Patent   Narrowed by less than half, and more than half of the flow of an open vessel goes on beyond the join. Half [P], after the cut flow index
//            (bypass flow over cut flow): 83 % of bypasses with 0.5 or more stay open, 46 % below (Stapleton et al., J. Neurosurg. 132:1396, 2020). A tight
//            join narrowed by half near the cut loses a few percent only, as the circulation's resistance is some thirty times the lumen's (the
//            critical stenosis of haemodynamics); what takes half of the flow is a leak, or a lumen all but closed.
//   Milking  Two forceps close on the vessel behind the join; the one further on strips away and empties what it passes, V = integral of A ds.
//            When the first lets go, blood comes back by the balance above with p_down the pressure that opens a flat vessel and R_down the line's
//            resistance up to the front: dV/dt = Q. In a uniform tube without a leak that is t = A/(P - p_down) (R_up L + r/2 L^2) with r the resistance per length (closed form of
//            the test).
// Neglects: pulsation, inertia of the blood, elastic recoil of the emptied stretch, collaterals between join and forceps.
// Test: vessel_flow_test.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/vessel_leak.h"

namespace filum {

/// The circulation on both sides of the vessel. All proposals [P] within what clinical.md collects.
struct Circulation {
  double pressure = 13332.0;        // [Pa], 100 mmHg, arterial
  double back = 3333.0;             // [Pa], 25 mmHg, of collaterals behind the vessel
  double opening = 667.0;           // [Pa], 5 mmHg, that it takes to fill a vessel that lies flat
  double cut_flow = 35.0 / 60e6;    // [m3/s], of the artery freely open (superficial temporal artery)
  double through = 5.0 / 60e6;      // [m3/s], through an open vessel
  double upstream() const noexcept { return pressure / cut_flow; }                            // [Pa s/m3]
  double downstream() const noexcept { return (pressure - back) / through - upstream(); }
};

/// Centre line, areas and resistance of the lumen of a join (vessel_leak.h, Passage), upstream clamp first. Measured anew when told; allocates at the start only.
class LumenLine {
 public:
  explicit LumenLine(const VesselMesh& mesh);

  void measure(const Points& x, double viscosity) noexcept;
  int n() const noexcept { return static_cast<int>(way_.rings.size()); }
  const Vec3& middle(int k) const noexcept { return middle_[static_cast<std::size_t>(k)]; }
  double along(int k) const noexcept { return along_[static_cast<std::size_t>(k)]; }  // [m], from the first ring
  double area(int k) const noexcept { return area_[static_cast<std::size_t>(k)]; }    // [m2]
  double join() const noexcept { return join_; }                                      // [m], along the line, midway between the cut edges
  double length() const noexcept { return along_.back(); }
  double least_area() const noexcept;
  double volume(double from, double to) const noexcept;      // [m3]
  double resistance(double from, double to) const noexcept;  // [Pa s/m3]

 private:
  /// Integral over [from, to] of what grows by `per` from ring to ring.
  double share(const std::vector<double>& sums, double from, double to) const noexcept;

  Passage way_;
  std::vector<Vec3> middle_;
  std::vector<double> along_, area_, volume_, resistance_;
  double join_ = 0.0;
};

struct Balance {
  double pressure = 0.0;  // [Pa], at the join
  double from = 0.0;      // [m3/s], out of the artery
  double leak = 0.0;
  double on = 0.0;        // further down
};
/// Resistances [Pa s/m3]; not positive or infinite: no way there.
Balance balance_blood(double source, double upstream, std::span<const EdgeGap> gaps, double downstream, double back, const BloodOptions& blood) noexcept;

/// With both clamps off: the lumen's resistances on either side of the cut in a row with those of the circulation. `on` is negative where so much leaks that
/// collaterals flow back to the join.
Balance balance_join(const LumenLine& line, std::span<const EdgeGap> gaps, const Circulation& circulation, const BloodOptions& blood) noexcept;

inline constexpr double kMostNarrowing = 0.5;  // [-], of a patent lumen
inline constexpr double kLeastShare = 0.5;     // [-], of Circulation::through, beyond a patent join [P]
inline bool is_patent(double narrowing, double on, const Circulation& c) noexcept { return narrowing < kMostNarrowing && on > kLeastShare * c.through; }

/// The milking test as it stands. Part of the state.
struct Milking {
  enum Stage : std::int32_t { idle, stripping, filling, over };
  std::int32_t stage = idle;
  std::int32_t up = -1, down = -1;   // tools
  double up_at = 0.0;                // [m], along the line
  double from = 0.0, to = 0.0;       // [m], the emptied stretch
  double volume = 0.0;               // [m3], emptied
  double missing = 0.0;              // [m3], of it still empty
  double time = 0.0;                 // [s], since the first forceps let go
  bool shut() const noexcept { return stage == stripping || stage == filling; }
  bool emptied() const noexcept { return shut() && volume > 0.0; }
};
enum class MilkingNews { none, let_go, refilled, stayed_empty, spoiled };

inline constexpr double kLongestRefill = 3.0;  // [s], after which a stretch counts as not refilled [P]

/// `closed`: where along the line [m] each tool holds the vessel shut, negative where it does not. `open`: no clamp keeps blood out.
MilkingNews milk(Milking& m, const LumenLine& line, std::span<const double> closed, bool open, const Circulation& circulation, std::span<const EdgeGap> gaps,
                 const BloodOptions& blood, double dt) noexcept;

}  // namespace filum
