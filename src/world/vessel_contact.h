#pragma once
// Thread and jaws against the surface of the tissue, staggered with its step: forces push back what has come through or into the
// surface, and the tissue gets the opposite loads.
//
// Thread: a sample (nodes, and places 0.1 mm apart between them) that crosses the surface inwards by its motion relative to the wall is remembered with the place
// where it crossed and is pushed back out (surface_touch.h). Thread and wall move in turn: first the thread past the wall as it stands, then the wall past the thread.
// In the wall's turn a sample has been passed that is no longer seen from the place of the wall that was nearest to it before. Where a track holds the thread nothing is looked for.
// What has gone far in is drawn back the way it came, and the faces that it meets on its way are not held against it.
// Jaws: spheres along them that push the faces they touch along their normals and drag them by friction, within the tissue's own step.
// Neglects: thickness of the thread, rims thinner than 0.1 mm between two samples, jaws beyond 1.2 mm from their tips.
// Test: vessel_contact_test.

#include <vector>

#include "physics/implicit_rod.h"
#include "physics/instrument.h"
#include "physics/needle_track.h"
#include "world/surface_touch.h"

namespace filum {

class VesselContact {
 public:
  explicit VesselContact(int thread_capacity);

  TouchLaw law;                // of the thread; its stiffness is the jaws' as well
  double jaw_friction = 0.15;  // [-], steel on wet tissue

  void hold(const VesselWall& wall, const WallState& w, const TouchState& s, const RodState& thread, std::vector<RodTether>& on_thread) noexcept;
  /// Of a step that the thread has just made and that can be made again: a sample that went far past the surface gets a touch, to hold it back then. True if one did.
  bool catches(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread, std::vector<RodTether>& on_thread) const noexcept;
  /// [m], by which that step has taken thread on where it is too deep for the wall to push back any harder; at most.
  double sinks(const VesselWall& wall, const WallState& w, const TouchState& s, const RodState& thread) const noexcept;
  void follow(VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread,
              const std::vector<RodTether>& on_thread) noexcept;
  /// After the wall's step: thread, at rest or not, that the wall has moved over.
  void overtake(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread) noexcept;
  /// Share of the way of a tool in this step that it can go without a jaw being carried past the wall: one that is faster than 50 mm/s goes 0.1 mm into what it meets and is
  /// held back there (a proxy that surfaces stop: Ruspini, Kolarov & Khatib, SIGGRAPH 1997), to push it along in the steps to come.
  double free_way(const VesselWall& wall, const WallState& w, const InstrumentParameters& tool, const Pose& from, const InstrumentState& to) const noexcept;
  /// Jaws at their present poses stand against the wall in its coming step.
  void press(VesselWall& wall, const WallState& w, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states) noexcept;
  /// After that step: adds to `force` [N] and `torque` [N m] on the tools.
  void feel(const VesselWall& wall, std::vector<Vec3>& force, std::vector<Vec3>& torque) const noexcept;

 private:
  /// Each sample of the thread near the wall that no track and no touch has: its arc, where it was [m] and where it is. `beside` [m]: what counts as near.
  template <class Look>
  void for_free_samples(const VesselWall& wall, const TouchState& s, const TrackState& tracks, const RodState& thread, double beside, const Look& look) const noexcept;
  void sweep(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread, double least) const noexcept;
  static WallCrossing passed(const VesselWall& wall, const WallState& w, const Vec3& x, double farthest) noexcept;
  void touch(TouchState& s, double arc, const WallCrossing& c) const noexcept;
  bool spoken_for(const TouchState& s, double arc) const noexcept;
  void note_deep(const VesselWall& wall, const WallState& w, const TouchState& s, const RodState& thread) noexcept;
  bool goes_back(double arc, const Vec3& normal) const noexcept;
  Vec3 was_at(const RodState& thread, double arc) const noexcept;  // [m], at the start of the step

  struct Push {
    int number, tool;
    Vec3 lever;                // [m], from the tool's tip
  };

  static constexpr int kMostPlaces = 24;            // of a ball: triangles that meet where it rests on them
  std::array<Push, 18 * kMostPlaces> pushes_{};     // three balls on each jaw of three tools
  int n_pushes_ = 0;
  std::array<double, kMostTouches> come_out_{};  // [m], arcs of touches that end in this step: on their way out they pass the wall from within
  int n_come_out_ = 0;
  struct Deep {
    double arc;                  // [m]
    Vec3 way;                    // unit, back out
  };
  std::array<Deep, 3 * kMostTouches> deep_;
  int n_deep_ = 0;             // at the start of the step, after the thread's turn and after the wall's: what comes out in it has been in deep
  Points before_;              // [m], nodes at the start of the step
  int first_ = 0;              // of its tethers
};

}  // namespace filum
