#pragma once
// A rod whose clamped ends came closer and are then turned against each other until it winds round itself: a plectoneme. Two straight tails
// carry its tension F and its twisting moment M into a ply of two helices in contact, an end loop closes it (Clauvelin, Audoly & Neukirch,
// J. Mech. Phys. Solids 57:1565, 2009). Without friction, a ply of radius R (of the axes) and angle a has
//   F R^2/B = sin^3 a (cos a tan 2a - sin(a)/2) ,   M = 2/sin(2a) (B sin^4 a/(2 R) + R F) .

#include "evidence/rod_probe.h"

namespace filum {

struct Ply {
  double radius = 0.0;   // [m], of the axes about that of the ply
  double angle = 0.0;    // [rad], between the rods and the axis of the ply
  int contacts = 0;
};

class Plectoneme {
 public:
  explicit Plectoneme(int edges);

  /// Brings the ends together, turns the last one by `turns`, and lets the rod come to rest. False if it did not.
  bool wind(double turns);

  Ply ply() const;                // medians over the middle half of the contacts
  double tension() const;         // [N], along the line of the ends
  double moment() const;          // [N m], twisting
  double linking() const;         // turns: twist and writhe of the rod
  double farthest() const { return farthest_; }  // turns: largest difference of that from the turns given so far, looked at every 50 steps

  RodProbe probe;

 private:
  bool run(int steps, double come, double turn);
  double turned_ = 0.0, farthest_ = 0.0;  // turns
};

/// F R^2/B and M R/B of a ply of angle a [rad].
double ply_tension(double a);
double ply_moment(double a);

}  // namespace filum
