#pragma once
// A curved surgical needle: round wire bent to part of a circle, swaged to the thread at one end, pointed at the other.
//
// Frame N: origin at the centre of mass, the arc in the plane z = 0, its middle on +x. Arc length a runs from the swage (0) to the point (L):
//   p_N(a) = R (cos psi - c, sin psi, 0),  psi = a/R - A/2,  A = L/R,  c = sin(A/2)/(A/2)
// Inertia about the centre of mass of a thin uniform wire of mass m = rho pi r^2 L (integrals of sin^2, cos^2 over the arc):
//   I_x = m R^2 (1/2 - sin A/(2A)),  I_y = m R^2 (1/2 + sin A/(2A)) - m R^2 c^2,  I_z = m R^2 (1 - c^2)
// Neglects: the taper's missing mass, the wire's own thickness (r^2/R^2, below 1e-3), bending of the wire. Test: needle_shape_test.

#include <cmath>
#include <numbers>
#include <string>

#include "base/pose.h"

namespace filum {

struct NeedleShape {
  std::string name;
  double wire_radius = 37.5e-6;   // [m]
  double bend_radius = 1.6e-3;    // [m], R, of the wire's axis
  double circle = 0.375;          // share of a full circle: 3/8, 1/2
  double density = 7900.0;        // [kg/m3]
  double taper = 0.4e-3;          // [m], length of the point
  double flat_width = 0.0;        // [m], of a body flattened for the holder, 0: round
  double pad_friction = 0.3;      // [-], steel on the pads
  double sheet_friction = 0.3;    // [-], on the background sheet
  double grip_stiffness = 3000.0; // [N/m], of each of the three points held between pads: pads and fingers behind them

  double angle() const noexcept { return 2.0 * std::numbers::pi * circle; }    // [rad], A
  double length() const noexcept { return bend_radius * angle(); }             // [m], L
  double chord() const noexcept { return 2.0 * bend_radius * std::sin(0.5 * angle()); }
  double mass() const noexcept { return density * std::numbers::pi * wire_radius * wire_radius * length(); }  // [kg]
  double centroid() const noexcept { return std::sin(0.5 * angle()) / (0.5 * angle()); }                      // c
  Vec3 inertia() const noexcept {                                              // [kg m2], principal, frame N
    const double mr2 = mass() * bend_radius * bend_radius, s = std::sin(angle()) / (2.0 * angle()), c = centroid();
    return mr2 * Vec3(0.5 - s, 0.5 + s - c * c, 1.0 - c * c);
  }
  Vec3 point(double a) const noexcept {                                        // [m], frame N
    const double psi = a / bend_radius - 0.5 * angle();
    return bend_radius * Vec3(std::cos(psi) - centroid(), std::sin(psi), 0.0);
  }
  Vec3 tangent(double a) const noexcept {                                      // unit, towards the point
    const double psi = a / bend_radius - 0.5 * angle();
    return {-std::sin(psi), std::cos(psi), 0.0};
  }
  double radius_at(double a) const noexcept {                                  // [m], of the wire; the point is sharp
    return wire_radius * std::min(1.0, std::max(0.0, (length() - a) / taper));
  }
};

}  // namespace filum
