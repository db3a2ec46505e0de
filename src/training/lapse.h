#pragma once
// Stitches from the ways of the needle through the tissue, and what is wrong with them, by rules from a file
// (curricula/lapses/*.yaml, format filum-lapses/1). The lapses are those of the Anastomosis Lapse Index that geometry and force can tell;
// all marks are simulator-derived estimates. A stitch is two bites that belong together (training/stitch_pairs.h), or a lone pass.
// Test: lapse_test.

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/yaml_file.h"
#include "training/join.h"
#include "world/observation.h"

namespace filum {

struct LapseRules {
  std::string title, source;
  double oblique = 0.35;          // [rad], bite against the normal of the cut
  double wide_bite = 3.0;         // thicknesses
  double least_depth = 1.0;       // share of the thickness
  double spacing_variation = 0.25;  // coefficient of variation
  double spacing_ratio = 2.0;     // largest over smallest
  double tear = 20e-6;            // [m], torn length that counts
  double back_wall = 1.05;        // [rad], around a vessel, between the two bites of one way through its lumen
  double thread_inside = 0.5e-3;  // [m], thread left in the lumen
  double overlap = 1.0;           // thicknesses, of the cut edges past each other
  double tight = 100.0;           // [N/m], pull of the thread left in a stitch, for each length of bite
  double slack = std::numeric_limits<double>::infinity();      // [m], thread in a stitch's knot and loop beyond the way round its bites; infinite: not looked for
  // of joins whose stitches are to be tied, under pressure; infinite: not looked for
  double loose_gap = std::numeric_limits<double>::infinity();  // thicknesses, between the edges at a stitch
  double line_gap = std::numeric_limits<double>::infinity();   // thicknesses, between two neighbouring stitches
  double neighbours = 1.75;       // [rad], around the vessel: while stitches are still to come, those further apart have no line between them yet
  std::vector<std::string> critical;  // lapses with which a task is not passed, whatever its points
};

LapseRules load_lapse_rules(const std::string& path);

struct Stitch {
  int first = 0, second = -1;     // passes
  double time = 0.0;              // [s], of the last puncture
  double tear_time = std::numeric_limits<double>::quiet_NaN();  // [s], when it had torn as far as counts
  double bite[2] = {0, 0};        // [m], distance from the cut on either side; the second NaN for half a stitch
  double entry_angle = 0.0, exit_angle = 0.0;  // [rad], of the needle against the surface; NaN where it did not come out
  double obliquity = 0.0;         // [rad], of the line from entry to exit against the normal of the cut, seen from above; NaN for half a stitch
  double depth = 0.0;             // share of the thickness, the least of both sides
  double position = 0.0;          // [m], along the cut
  double tension = 0.0;           // [N], in the thread that is left in it
  double peak_force = 0.0, torn = 0.0;  // [N], [m]
  std::string knot;               // its class (knot_classifier.h), empty: the stitch is not tied
  int throws = 0;
  double tail = std::numeric_limits<double>::quiet_NaN(), short_tail = tail;  // [m], the longer and the shorter end
  double slack = std::numeric_limits<double>::quiet_NaN();  // [m], thread in its knot and loop beyond the shortest way round the bites that the loop holds
  bool joins = false;             // thread is in both sides of the cut: not a lone pass, not torn out
  bool lost = false;              // torn or pulled out on one side at least
  double inner[2] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};  // [m], as bite: where the needle left the first side and came into the second
  double next = std::numeric_limits<double>::quiet_NaN();  // [m], along the cut to the next stitch, see ways_to_next
  std::vector<std::string> layers;  // that were gone into on the side with the lesser depth, outermost first
};

struct Lapse {
  const char* name = "";          // as in the command line's contract: "oblique", "wide-bite", ...
  int stitch = -1;                // index from 0, -1 the whole line
  double time = 0.0;              // [s]
  double value = 0.0;
  const char* unit = "-";
  bool critical = false;
};

/// How many there are of this name.
double count_of(const std::vector<Lapse>& lapses, std::string_view name);
/// `pairs`: passes of the stitches. All other passes that came out, or have torn the wall as far as counts without, stand alone, except the needle's way on through the back wall: it is part of the stitch
/// with which the needle came into the lumen, and that lapse, but no bite that was meant.
std::vector<Stitch> stitches_of(const LapseRules& rules, const TissueObservation& tissue, const std::vector<std::array<int, 2>>& pairs, const std::vector<double>& pass_time,
                                const TissueDescription& scene);
/// [m], from each stitch along the cut to the next, round a vessel from the last to the first; NaN of one that was lost or has none.
std::vector<double> ways_to_next(const std::vector<Stitch>& stitches, const TissueDescription& scene);
/// [m], between neighbours along the cut. Round a vessel that is not yet `complete` the widest space is left out: there it is still open.
std::vector<double> spacings_of(const std::vector<Stitch>& stitches, const TissueDescription& scene, bool complete);
/// Standard deviation over mean; NaN of less than two.
double variation(const std::vector<double>& spacings);
/// Of the stitches one by one, and of their spacing. `end` [s]: the moment that knots and tension were looked at.
std::vector<Lapse> lapses_of(const LapseRules& rules, const std::vector<Stitch>& stitches, const std::vector<double>& spacings, double thickness, double end);
/// "back-wall": the needle came into the lumen at one place of the vessel and left it more than rules.back_wall around it (CutLine::round_lumen).
void find_back_walls(const LapseRules& rules, const TissueObservation& tissue, const std::vector<double>& pass_time, const TissueDescription& scene,
                     const std::vector<Stitch>& stitches, std::vector<Lapse>& found);
/// "thread-in-lumen", "edge-overlap".
void find_join_lapses(const LapseRules& rules, const JoinReport& join, double time, std::vector<Lapse>& found);
/// "loose-knot": the edges stand apart at a stitch that was to be tied (told once a stitch, whether by this or by its slack); "disrupted-line": they
/// do between two neighbours. From the gaps of the edge's nodes under pressure: at a stitch between the two beside it, in a line the widest. Of stitches that join both edges only: a lone pass ties nothing.
/// `complete`: no more stitches are to come.
void find_gap_lapses(const LapseRules& rules, const JoinReport& join, const TissueDescription& scene, const std::vector<Stitch>& stitches, bool complete,
                     double time, std::vector<Lapse>& found);
/// Marks those that the rules call critical.
void mark_critical(const LapseRules& rules, std::vector<Lapse>& found);

}  // namespace filum
