#pragma once
// What a task with a needle asks for (training/needle_watch.h), and by which rules lapses are found (training/lapse.h).

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/yaml_file.h"
#include "training/lapse.h"

namespace filum {

/// Where the next stitches of a technique belong (training/stitch_order.h).
struct StitchRule {
  int count = 1;                  // so many
  double from = 0.0, span = 7.0;  // [rad], sector of the vessel; a whole turn: anywhere
  double apart = 0.0, within = 0.0;  // [rad], from every goal of one stitch before; running: from the stitch before, the way it has gone; 0: any
  double clear = 0.0;             // [rad], at least, from every stitch before
  bool running = false;           // on one thread without a cut or knot
};

struct NeedleGoal {
  enum class Kind { pick, load, present, pass, draw, eye, tie, cut, stitch, grasp } kind = Kind::pick;
  int tool = 0;
  double low = 0.0, high = 1.0;   // load: where on the needle, share of its length from the swage; grasp: pull [N]
  double angle = 0.0;             // [rad], load: largest deviation from a right angle between wire and handle
  Vec3 at = Vec3::Zero();         // [m], present, frame W; eye: mark where the needle goes into the card at rest
  Vec3 out = Vec3::Zero();        // [m], eye: mark where it comes out
  double within = 0.0;            // [m], present; eye: of both marks, seen from above
  double seconds = 0.0;           // [s], load, present, tie and grasp: kept so long
  int side = 0;                   // grasp: of the cut, 0 or 1
  int passes = 0;                 // pass, draw, tie, cut: ways through the tissue
  int throws = 0;                 // tie: of this knot, at least (not of another one in the same thread)
  std::vector<std::string> knots; // tie: classes that count, none: any
  double loop = 0.0;              // [m], tie: thread in bites and knot at most
  double tail = 0.0;              // [m], draw: thread left before the first entry
  StitchRule stitch;              // stitch
};

/// What the join has to be when its clamps come off at the end, for the task to be passed; infinite: not asked for.
struct JoinGate {
  double leak = std::numeric_limits<double>::infinity();       // [m3/s], at most
  double narrowing = std::numeric_limits<double>::infinity();  // [-], at most
  bool patent = false;
  std::string source;             // empty: nothing is asked for
};

struct RatingScale;  // training/rating_scale.h

struct NeedleTask {
  std::vector<NeedleGoal> goals;
  LapseRules lapses;
  JoinGate join;
  bool has_tissue = false;
  std::vector<std::shared_ptr<const RatingScale>> scales;  // of raters
};

/// A step of a task file. Throws InputError.
NeedleGoal parse_needle_goal(const YamlNode& node);
/// Of the key `join` of a task file. Throws InputError.
JoinGate parse_join_gate(const YamlNode& node);

}  // namespace filum
