#pragma once
// How often closed curves wind round each other and round themselves, by Gauss's integral over polygons.
//
//   Lk = 1/(4 pi) sum_ij Omega_ij ,   Wr = 1/(2 pi) sum_{i<j} Omega_ij
// Omega_ij is the solid angle, with its sign, of all directions in which edge i is seen to cross edge j: that of a quadrilateral on the
// sphere, as two triangles by Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30:125, 1983 (Arai, arXiv 1303.3020; Klenin &
// Langowski, Biopolymers 54:307, 2000). Lk of two closed polygons is a whole number to rounding, whatever their shape, and changes
// only where one passes through the other. With the twist Tw of a closed ribbon, Tw + Wr does not change either (Calugareanu, White).
// Test: linking_test.

#include "base/pose.h"

namespace filum {

/// Linking number of two polygons (columns are corners), each closed from its last corner to its first.
double linking_number(const Points& a, const Points& b);

/// Writhe of an open polygon (columns are corners).
double writhe(const Points& curve);

}  // namespace filum
