#pragma once
// A long rod whose clamped ends came closer by D and were turned against each other by R: it buckles into a helix in its middle whose
// amplitude fades along the rod. For an infinite rod of stiffness B and C under the tension T and the twisting moment M, m = M/sqrt(B T)
// (van der Heijden & Thompson, Nonlinear Dyn. 21:71, 2000; van der Heijden, Neukirch, Goss & Thompson, Int. J. Mech. Sci. 45:161, 2003),
//   D = 4 sqrt(B/T) sqrt(1 - m^2/4) ,  R = M L/C + 4 arccos(m/2) ,  cos phi_0 = m^2/2 - 1 ,
//   (cos phi - cos phi_0)/(1 - cos phi_0) = tanh^2(s/s*) ,  s* = (2 B/M) sqrt((1 + cos phi_0)/(1 - cos phi_0)) ,
// phi the angle between tangent and axis at the distance s from the middle, phi_0 its largest value.

#include "evidence/rod_probe.h"

namespace filum {

struct HelixRod {
  double B, C;       // [N m2]
  double length;     // [m], between the clamps
  double turns;      // [1], of one end against the other
  double shortening; // [m], D
};

struct LocalizedHelix {
  double moment = 0.0;   // [N m], twisting, M
  double tension = 0.0;  // [N], T
  double angle = 0.0;    // [rad], phi_0
  double width = 0.0;    // [m], s*
};

/// The equations above solved for the branch with phi_0 < 90 degrees, by bisection in m.
LocalizedHelix localized_helix_theory(const HelixRod& rod);

struct HelixFound {
  LocalizedHelix helix;     // NaN throughout where the rod did not come to rest
  double envelope_error = 0.0;  // [1], root mean square, of (cos phi - cos phi_0)/(1 - cos phi_0) with the theory's phi_0 from the theory's tanh^2(s/s*)
};

/// The same from a discrete rod of `edges` between its clamps.
HelixFound localized_helix_found(const HelixRod& rod, int edges);

}  // namespace filum
