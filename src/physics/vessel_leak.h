#pragma once
// What a finished join lets out, and how wide its lumen is, from the geometry of the walls as they are.
//
//   Leak     Between the cut edges of two stumps stands a gap g (distance from the edge of one to the nearest wall of the other), as deep
//            as the wall is thick, d. Mean speed v in it: p = rho/2 (v/C)^2 + 12 mu d v / g^2, the orifice law for wide gaps and
//            plane Poiseuille flow for narrow ones (White, Viscous Fluid Flow, 2006, sec. 3-2); Q = sum of v g ds around the edge.
//            Gaps below `seal` are closed: films and platelets fill them. Sectors are equal shares of the edge's length as first made.
//   Lumen    Area of each ring of inner nodes (length of its vector area; a ring that runs past an opening in the side is closed by a chord) times the
//            cosine by which it stood aslant to the way of the blood as first made (bevelled ends); narrowing 1 - least/usual.
// What goes on through it: vessel_flow.h. Neglects: pulsation, clotting, the thread's own hole. Test: vessel_leak_test.

#include <span>
#include <vector>

#include "physics/vessel_mesh.h"

namespace filum {

struct BloodOptions {
  double pressure = 13332.0;   // [Pa], 100 mmHg
  double density = 1055.0;     // [kg/m3]
  double viscosity = 3.5e-3;   // [Pa s]
  double discharge = 0.6;      // [-], C of a sharp-edged orifice
  double seal = 3e-6;          // [m]
};

/// Mean speed [m/s] in a slit of this gap and depth [m].
double slit_speed(double gap, double depth, const BloodOptions& blood) noexcept;

struct LeakSector {
  double length = 0.0;         // [m], of edge
  double gap = 0.0;            // [m], mean
  double area = 0.0;           // [m2], of what is not sealed
  double flow = 0.0;           // [m3/s]
  Vec3 place = Vec3::Zero();   // [m], middle of its widest gap: where drops appear
};

struct JoinLeak {
  std::vector<LeakSector> sectors;  // from the first node of the edge, as its nodes run, by equal shares of its length as first made
  double area = 0.0;           // [m2]
  double flow = 0.0;           // [m3/s]
};

/// The gap at one node of a cut edge, and what of the edge it stands for.
struct EdgeGap {
  double gap = 0.0, depth = 0.0, length = 0.0;  // [m]; length: to the next node
  Vec3 place = Vec3::Zero();   // [m], middle of the gap
  double share = 0.0;          // where on the edge (VesselMesh::edge_share)
};

/// The outer end of the line through the wall that starts at an inner rim node.
int outer_of(const VesselMesh& mesh, int inner) noexcept;

/// At node `k` of the cut edge of part `a` against the wall of part `b`. Allocates nothing.
EdgeGap edge_gap(const VesselMesh& mesh, const Points& x, int a, int b, std::size_t k) noexcept;
/// Flow [m3/s] through gaps in the order of the edge's nodes; fills as many sectors as it is given. Allocates nothing.
double leak_through(std::span<const EdgeGap> gaps, std::span<LeakSector> sectors, const BloodOptions& blood) noexcept;

/// The join of the cut edge of part `a` with the wall of part `b`, in so many sectors.
JoinLeak find_leak(const VesselMesh& mesh, const Points& x, int a, int b, int sectors, const BloodOptions& blood);

/// Nodes of the inner surface of a part, ring by ring from its clamp to the cut edge (to its other clamp where it has an opening in its side).
std::vector<std::vector<int>> inner_rings(const VesselMesh& mesh, int part);
struct LumenRing {
  double area = 0.0;           // [m2]
  Vec3 middle = Vec3::Zero();  // [m]
};
/// Rings of a part, as inner_rings().
std::vector<LumenRing> lumen_rings(const VesselMesh& mesh, const Points& x, int part);

/// The way of the blood through a join: from the (first) clamp of part 0 to its cut edge or the middle of its opening, on to the clamp of part 1.
/// What lies beyond an opening is left out.
struct Passage {
  std::vector<std::vector<int>> rings;
  std::vector<double> across;    // of each: cosine between the way and the ring's normal as first made
  std::size_t second = 0;        // the first of part 1
};
Passage passage_of(const VesselMesh& mesh);
std::vector<LumenRing> lumen_rings(const Passage& way, const Points& x);

/// Share [-] of the usual area that the narrowest ring lacks: 0 open to 1 closed.
double narrowing_of(const std::vector<LumenRing>& rings, double usual_area) noexcept;

}  // namespace filum
