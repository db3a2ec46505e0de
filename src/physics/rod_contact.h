#pragma once
// Contact of the thread with itself: stiff repulsion of edges closer than one diameter, Coulomb friction, and a bound on each
// move so that no strand ever passes through another.
//
// Normal force: Hertz's law of two round bodies (Johnson, Contact Mechanics, 1985, eq. 4.23): with D the distance of two edges' axes and
// o = 2h - D > 0 the overlap,
//   F = k o sqrt(o / 0.6 h),  phi(D) = 2/5 F o   plus below D = h the logarithmic barrier  -k (D - h)^2 ln(D/h)
// (Li et al., "Incremental Potential Contact", ACM TOG 39(4):49, 2020, eq. 6). k is the secant stiffness at o = 0.6 h, where 0.12 N
// press a 10-0 nylon (crossed cylinders: k about 1.6e4 N/m). Light contacts are softer, as they are: 1 mN gives 0.3 um.
// Friction: friction.h, with the relative displacement of the axes' closest material points.
// No passage: a move of all nodes is allowed only up to the fraction that conservative advancement (Mirtich 1996) proves
// free of crossing: relative displacement of two edges, largest over their end points, bounds how far D can fall.
// Neglects: rolling of the strands about their own axes under friction; anisotropy. Tests: rod_contact_test.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/block_cholesky.h"
#include "base/pose.h"
#include "physics/elastic_rod.h"
#include "physics/friction.h"
#include "physics/rod_travel.h"

namespace filum {

struct ContactMaterial {
  double stiffness = 1e4;             // [N/m], normal, secant at an overlap of 0.6 radii, each pair of edges
  double wall_ratio = 0.15;           // [-], stiffness against bars and sheet, each edge, of that between strands
  double tangential_ratio = 0.7;      // [-], k_t / k (Mindlin: 2(1-nu)/(2-nu), about 0.75 at nu 0.4)
  double friction = 0.2;              // [-]
  double presliding = 0.6e-6;         // [m], give of a contact before it slips, at light load (friction.h)
  double stick(double mu, double N) const noexcept { return stick_stiffness(tangential_ratio * stiffness, mu, N, presliding); }
};

/// Memory of one touching pair between steps: what friction needs to stick. Part of the state.
struct ContactBristle {
  std::int32_t i = -1, j = -1;        // edges, i < j (or edge and obstacle)
  Vec3 xi = Vec3::Zero();             // [m]
  double force = 0.0;                 // [N], normal; for those who look, the step does not read it
};

/// One near pair of edges in the present configuration.
struct RodPair {
  int i = 0, j = 0;                   // edges, i < j
  double s = 0, t = 0;                // closest points
  Vec3 normal = Vec3::UnitX();        // unit, from edge j to edge i
  double distance = 1;                // [m], of the axes when they were last measured
  double measured_at = 0;             // [m], how far both edges had gone by then since the pairs were found
  double force = 0;                   // [N], normal
  double load = 0;                    // [N], normal force by which friction goes
  bool joined = false;                // gets blocks in the next pattern of the matrix: near enough to touch soon
  Vec3 xi_start = Vec3::Zero();       // [m], bristle at the start of the step
  Vec3 trial = Vec3::Zero();          // [m], bristle before return mapping
  FrictionPoint friction;
  BlockCholesky::Slot slots[4];       // blocks (i,j), (i,j+1), (i+1,j), (i+1,j+1)
  bool in_matrix() const noexcept { return slots[0].index >= 0; }  // all four are there
};

/// The normal force that friction goes by within a step: the one at the step's start, or the present one if that is less. (Solving for both
/// together has no convex sum to minimise, and going by the present force alone swings: a strand that presses deeper in one iteration is held harder
/// in the next. Li et al. 2020, section 5.4, keep it for the whole step.) What touches first in this step slides freely in it. Once it is kept
/// the sum to minimise no longer changes from iteration to iteration; what has parted has no friction even then.
enum class FrictionLoad { anew, falling, kept };
inline double friction_load(FrictionLoad which, double load, double force) noexcept {
  if (which == FrictionLoad::anew) return force;
  return which == FrictionLoad::falling || force <= 0.0 ? std::min(load, force) : load;
}

class RodContact {
 public:
  RodContact(int node_capacity, int pair_capacity);

  /// How far edges may go, have gone and would go. Its user says so of every move of the nodes since find_pairs(): most pairs are too far apart
  /// to have come into touch by then, and are not measured anew.
  RodTravel travel;

  /// Collects all pairs of edges, sorted, that can come within one diameter while each edge moves at most travel.reach [m], and starts the
  /// travel. Edges of the same strand closer than two diameters along it are left out. Only pairs that may touch soon are joined, that is, take
  /// part in the matrix's pattern: most are there only to bound the move. Pairs known before keep their load of friction, others have none.
  void find_pairs(const RodState& s, const Points& x, double radius) noexcept;
  const std::vector<RodPair>& pairs() const noexcept { return pairs_; }
  /// [m], the axes are not closer than this.
  double at_least(const RodPair& p) const noexcept { return p.distance - (gone(p) - p.measured_at); }
  bool overflowed() const noexcept { return overflowed_; }

  /// True if pairs were found, or touched without blocks in the matrix, since find_slots().
  bool pattern_stale() const noexcept { return pattern_stale_; }
  /// Declares the blocks of the joined pairs in the pattern.
  void connect(BlockCholesky& matrix) noexcept;
  /// Looks up where the joined pairs' blocks are, be it among those that elimination fills. False if those of a pair that touches are not there,
  /// or if many more are there than are needed: then the pattern should be made anew. Pairs that do not touch yet can wait.
  bool find_slots(const BlockCholesky& matrix) noexcept;

  /// Attaches the bristles remembered from the last step to the present pairs.
  void recall(const std::vector<ContactBristle>& memory) noexcept;
  /// Writes the bristles of touching pairs for the next step (capacity reserved by the caller).
  void remember(std::vector<ContactBristle>& memory) const noexcept;

  /// Distances, normals, normal forces and loads of friction at x; the loads then stay fixed in energy() until the next call.
  void update(const Points& x, double radius, const ContactMaterial& m, FrictionLoad load) noexcept;
  /// Potential [J] at x, `fraction` of the move in question from where the nodes were at the last update (friction with the normal forces of
  /// that).
  double energy(const Points& x, const Points& x_start, double radius, const ContactMaterial& m, double fraction) const noexcept;
  /// Adds the gradient, then the stiffness, at the configuration of the last update.
  void add_gradient(const Points& x, const Points& x_start, const ContactMaterial& m, Eigen::Matrix4Xd& gradient) noexcept;
  void add_stiffness(const Points& x, double radius, const ContactMaterial& m, const ChainSlots& chain,
                     BlockCholesky& matrix) const noexcept;

  /// Largest fraction of `move` (4 x n, only the first three rows count; the travel looks along it) that provably crosses nothing.
  double free_fraction(const Points& x, const Eigen::Matrix4Xd& move, double radius) const noexcept;

  double smallest_distance(const Points& x) const noexcept;  // [m], of the axes at x, among the pairs; infinity if there is none
  int n_touching(double radius) const noexcept;

 private:
  void box_edges(const RodState& s, const Points& x, double radius) noexcept;
  void find_partners(const RodState& s, const Points& x, double radius, int i, int chunk) noexcept;
  void keep_loads() noexcept;
  int n_joined() const noexcept;
  double gone(const RodPair& p) const noexcept { return travel.gone(p.i) + travel.gone(p.j); }
  double stride(const RodPair& p) const noexcept { return travel.stride(p.i) + travel.stride(p.j); }
  void join(RodPair& p, bool touches) noexcept;
  void add_turn(const RodPair& p, const Points& x, double radius, const ChainSlots& chain, BlockCholesky& matrix) const noexcept;
  void add_block(const RodPair& p, const Mat3& k, const ChainSlots& chain, BlockCholesky& matrix) const noexcept;

  std::vector<RodPair> pairs_, known_;
  Eigen::Matrix4Xd edge_low_, edge_high_, low_, high_;  // [m], of all that edges, and chunks of them, can reach; the fourth row is 0
  std::vector<double> arc_;
  std::vector<int> near_chunks_;
  int connected_ = 0;  // pairs of the last connect()
  bool overflowed_ = false;
  bool pattern_stale_ = false;
};

/// [m2], of pressed_points for a thread of `radius` and a body whose axis is at `touching` from the thread's when they touch: the push goes over
/// from one end of an edge to the other while the edge turns by a hundredth of a radius, end against end. For that an edge that touches
/// with its end is felt up to a four hundredth of a radius later.
inline double push_spread(double touching, double radius) noexcept { return 0.01 * radius * touching; }

/// phi(D), its first and second derivative.
struct PairPotential {
  double energy, slope, curvature;  // [J], [N], [N/m]
};
/// Hertz contact of a round thread: F = k o sqrt(o / 0.6 h), o the overlap, h the radius; k is the secant stiffness where o = 0.6 h.
PairPotential squeeze(double overlap, double radius, double stiffness) noexcept;
PairPotential pair_potential(double distance, double radius, double stiffness) noexcept;

/// Fraction of a move for two segments (ends a0, a1, b0, b1 with displacements da0 ...) that keeps them apart, by
/// conservative advancement. `keep` [m]: distance of the axes at which the advance stops (0 < keep < present distance).
double conservative_advance(const Vec3 ends[4], const Vec3 moves[4], double keep) noexcept;

}  // namespace filum
