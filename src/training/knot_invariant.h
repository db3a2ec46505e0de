#pragma once
// Knot polynomials of a diagram.
//
// Which invariant can tell what: square (3_1 # mirror 3_1) and granny (3_1 # 3_1) have the same determinant,
// 9, and the same Alexander polynomial, (t^2 - t + 1)^2, as a mirror image never changes either. So neither
// can separate them. The Jones polynomial can: V(square) = V(3_1)(t) V(3_1)(1/t) is symmetric in t, V(granny)
// = V(3_1)^2 is not. All classes rest on Jones; Alexander, computed by a different road, is a cross-check
// (|V(-1)| = |Delta(-1)|).
//
// Jones: Kauffman bracket (Kauffman 1987, Topology 26:395) as a state sum over planar arcs (Temperley-Lieb):
// crossings are taken in one by one and only the ways in which the open ends are joined are kept, so the cost
// grows with the width of the diagram, not as 2^crossings. V(t) = (-A^3)^(-writhe) <D>, t = A^-4;
// right-handed trefoil: t + t^3 - t^4. Valid up to kMaxCrossings, where the coefficients are sure to fit 64
// bits.

#include <cstdint>

#include "training/knot_diagram.h"
#include "training/laurent.h"

namespace filum {

inline constexpr int kMaxCrossings = 64;

/// Jones polynomial in t; 1 for the unknot. At most kMaxCrossings crossings (else returns the zero
/// polynomial).
Laurent jones_polynomial(const KnotDiagram& diagram);

/// Alexander polynomial, lowest power 0, normalised to Delta(1) = 1 and positive lowest coefficient sign by
/// that. Same limit and same refusal.
Laurent alexander_polynomial(const KnotDiagram& diagram);

/// Jones polynomial of the torus knot T(2, k), k odd; right-handed for k > 0, left-handed for k < 0.
Laurent jones_torus(int k);

}  // namespace filum
