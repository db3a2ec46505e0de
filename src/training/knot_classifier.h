#pragma once
// Which knot the thread is in, from its shape alone.
//
// The open thread is closed at infinity (knot_closure.h), shrunk (knot_simplify.h) and named by its Jones
// polynomial (knot_invariant.h). Two ends tied round a post by stacked throws close to a connected sum of
// torus knots: a single throw (half knot) is a T(2,3), a double throw a T(2,5), right- or left-handed. So
//   overhand   one T(2,3)                        square     T(2,3) # mirror T(2,3)
//   granny     T(2,3) # T(2,3), or mirrored      surgeons   T(2,5) # mirror T(2,3), double throw first
//   triple     three T(2,3), each opposite to the last (1=1=1)
//   unknot     V = 1                             other      everything else, said in `note`
// A sum does not know its order, so the order of the throws (`throws`, from the post outwards) is read from
// the shrunk diagram: a stack is met as throw n ... 1, post, 1 ... n along the thread. Where it cannot be
// read, `throws` is empty and the note says so. `composition` is in the notation of Tera and Aberg (1976,
// Acta Chir Scand 142:1): 1=1 parallel (square) throws, 1x1 crossed (granny) throws, 2 a double throw.
//
// Half-hitches: a slipped or capsized knot is the same closed curve as the square or granny that it came
// from; it differs in shape only. Rule: along each strand's part within the knot (within kNearDiameters
// diameters of the other strand) the total turning is summed from chords of kChordDiameters diameters. If the
// straighter strand turns less than kStraightTurn and less than a quarter of what the other one turns, and
// the other turns more than kHitchTurn per throw, the knot is "half-hitches". Judged only when the strands
// are that near to each other.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/pose.h"
#include "world/observation.h"

namespace filum {

inline constexpr double kNearDiameters = 3.0;
inline constexpr double kChordDiameters = 1.5;
inline constexpr double kStraightTurn = 2.0;  // [rad]
inline constexpr double kHitchTurn = 3.0;     // [rad] per throw

struct KnotReport {
  std::string knot_class = "unknot";
  std::string composition;  // "1=1", "2=1", "1x1"; empty if unknown
  std::vector<int>
      throws;        // half-twists, from the post outwards: 3 single, 5 double; + right-, - left-handed
  int n_throws = 0;  // number of throws in the knot, known even where their order is not
  std::vector<int> members;  // half-twists of the throws in no order
  std::string jones = "1";      // polynomial in t
  std::string alexander = "1";  // polynomial in t
  std::int64_t determinant = 1;
  int n_crossings = 0;  // of the shrunk diagram
  bool encloses_post = false;
  int post_winding = 0;     // turns of the knotted part's loop round the post's axis
  double confidence = 1.0;  // share of closures that give this knot, 0..1
  int core_begin = -1;  // first and last node of the shortest part that holds the whole knot, -1 if unknotted
  int core_end = -1;
  std::array<double, 2> strand_turning = {
      0.0, 0.0};     // [rad], turning of each strand within the knot; 0 if not judged
  std::string note;  // doubts and reasons in words
};

struct KnotOptions {
  int closures = 5;        // ways of closing that vote; 1 for a live signal
  bool shape = true;       // also find the core, the post and half-hitches
  std::uint64_t seed = 1;  // of projections and jitter
};

/// Classifies the thread with centreline `nodes` [m, 3 x n, frame W] and radius [m]; `post` may be null.
/// Nodes that are not finite, or fewer than four, give "unknot" with a note.
KnotReport classify_knot(const Points& nodes, double radius, const PostShape* post,
                         const KnotOptions& options = {});

/// What the knot `sum` has beside another one, `part`, that lies nearer to the post in the same thread, named by itself; none if `part` is not a
/// knot within it or all of it. Half-hitches are not told: the lay of the strands was not judged.
std::optional<KnotReport> rest_of_sum(const KnotReport& sum, const KnotReport& part);

}  // namespace filum
