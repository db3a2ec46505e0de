// A needle through tissue: forces and work of a puncture, tearing.

#include <cmath>
#include <string>

#include "evidence/problem_list.h"
#include "base/numbers.h"
#include "physics/track_rig.h"

namespace filum {
namespace {

constexpr double kMove = 1e-6;  // [m], of the vice in a step of 2 ms: 0.5 mm/s

/// Drives on until the event, at most `most` [m].
bool drive_until(TrackRig& rig, const std::string& event, double most) {
  for (double s = 0.0; s < most; s += kMove) {
    rig.step(kMove);
    if (event == rig.last_event()) return true;
  }
  return false;
}

/// Force of the vice along the needle when the point goes in, over the threshold.
double puncture_ratio(double angle) {
  RigOptions o;
  o.angle = angle;
  o.track = plain_track(20e-3, 0.0, 0.0);
  TrackRig rig(o);
  double before = 0.0;
  for (int k = 0; k < 400; ++k) {
    const RigSample s = rig.step(kMove);
    if (std::string(rig.last_event()) == "puncture") return std::max(before, s.force) / 20e-3;
    before = s.force;
  }
  return kNaN;
}

/// Least-squares slope of force against length inside, between 0.2 and 0.8 mm. `speed` [m/s].
double insertion_slope(double friction, double drag, double speed) {
  RigOptions o;
  o.track = plain_track(5e-3, 2e-3, friction, drag);
  TrackRig rig(o);
  const double move = speed * o.dt;
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (double s = 0.0; s < 1.5e-3; s += move) {
    const RigSample r = rig.step(move);
    const double d = rig.inserted();
    if (d < 0.2e-3 || d > 0.8e-3) continue;
    n += 1;
    sx += d;
    sy += r.force;
    sxx += d * d;
    sxy += d * r.force;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Work of the vice for a whole passage over what was dissipated and is stored.
double passage_balance() {
  RigOptions o;
  o.track = plain_track(5e-3, 2e-3, 10.0);
  TrackRig rig(o);
  if (!drive_until(rig, "needle-out", 2e-3)) return kNaN;
  for (int k = 0; k < 100; ++k) rig.step(kMove);
  return rig.work() / (rig.tracks().dissipated + rig.stored());
}

/// Sideways pull towards the edge at which a track begins to tear, over tear x bite.
double tear_ratio(double bite) {
  RigOptions o;
  o.bite = bite;
  o.thickness = 0.3e-3;
  o.track = plain_track(5e-3, 1e-3, 1.0);
  o.track.tear = 100.0;
  TrackRig rig(o);
  if (!drive_until(rig, "needle-out", 2e-3)) return kNaN;
  for (int k = 0; k < 600; ++k) {
    rig.step(0.0, kMove);
    if (std::string(rig.last_event()) == "tear") return rig.event_force() / (o.track.tear * bite);
  }
  return kNaN;
}

void list_puncture(ProblemList& list) {
  ValidationProblem p;
  p.note = "no order: one point, no mesh; the force is seen once a step of 1 um, up to 7 % of F0 late";
  p.source = "puncture when the normal part of the point's force is F0: along the needle F0 / sin(angle) (needle_track.h)";
  for (const double degrees : {90.0, 60.0, 45.0}) {
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    p.name = "track-puncture-" + std::to_string(static_cast<int>(degrees));
    p.quantity = "force along the needle at puncture over F0 = 20 mN, needle at " + std::to_string(static_cast<int>(degrees)) + " degrees to the surface";
    p.expected = 1.0 / std::sin(angle);
    p.tolerance = 0.05;  // a step of 1 um under a point of 1.5 N/mm is up to 7 % of F0, less what the vice gives
    list.push_back({p, [angle](ValidationProblem& r) { r.got = puncture_ratio(angle); }});
  }
}

void list_insertion(ProblemList& list) {
  ValidationProblem p;
  p.note = "no order: no mesh; a straight line fitted through steps of 1 or 2 um";
  p.name = "track-friction-slope";
  p.source = "F = F_cut + f d, linear in the depth d (Okamura, Simone & O'Leary, IEEE TBME 51:1707, 2004)";
  p.quantity = "slope of force against depth, f = 10 N/m";
  p.unit = "N/m";
  p.expected = 10.0;
  p.tolerance = 2e-2;
  list.push_back({p, [](ValidationProblem& r) { r.got = insertion_slope(10.0, 0.0, 0.5e-3); }});
  p.name = "track-speed-slope";
  p.source = "F = F_cut + (f + c v) d";
  p.quantity = "slope of force against depth, f = 5 N/m, c v = 5 N/m";
  list.push_back({p, [](ValidationProblem& r) { r.got = insertion_slope(5.0, 5e3, 1e-3); }});
}

void list_energy(ProblemList& list) {
  ValidationProblem p;
  p.note = "no order: no mesh; steps of 1 um";
  p.name = "track-energy";
  p.source = "work of the hand = friction + cutting + what snaps free at the punctures + what is stored";
  p.quantity = "work over dissipated and stored energy, one passage through 1 mm";
  p.expected = 1.0;
  p.tolerance = 3e-2;
  list.push_back({p, [](ValidationProblem& r) { r.got = passage_balance(); }});
}

void list_tearing(ProblemList& list) {
  ValidationProblem p;
  p.note = "no order: no mesh; the load is seen once a step of 1 um";
  p.source = "a stitch bears tear x bite (orders of magnitude: clinical.md 4)";
  for (const double bite : {0.2e-3, 0.6e-3}) {
    p.name = bite < 0.4e-3 ? "track-tear-small" : "track-tear-large";
    p.quantity = "load of the track when it begins to tear over tear x bite, bite " + std::to_string(static_cast<int>(bite * 1e6 + 0.5)) + " um";
    p.expected = 1.0;
    p.tolerance = 5e-2;
    list.push_back({p, [bite](ValidationProblem& r) { r.got = tear_ratio(bite); }});
  }
}

}  // namespace

void list_needle_track(ProblemList& list) {
  list_puncture(list);
  list_insertion(list);
  list_energy(list);
  list_tearing(list);
}

}  // namespace filum
