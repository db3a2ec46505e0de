#pragma once
// An open overhand knot drawn tight by its ends, which move apart along the line between them.

#include "evidence/drawn_knot.h"

namespace filum {

/// Nodes [m] of an open trefoil curve (Shastri, Tohoku Math. J. 44:11, 1992: polynomials of degree 3, 4 and
/// 5) of the given length, evenly spaced along it.
Points overhand_curve(int n, double length);

/// The rod of Tong et al. (imc-der, arXiv 2205.10309): 1 m, radius 1.6 mm, 0.18 MPa, Poisson 0.5, 1180 kg/m3.
struct PulledKnot : DrawnKnot {
  PulledKnot(int n, double friction, double dt);
};

}  // namespace filum
