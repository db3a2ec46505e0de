#include <algorithm>
#include <numbers>

#include "training/needle_task.h"

#include "base/numbers.h"

namespace filum {

/// Angles are those of the stitches' table: from where the vessel's angle is zero.
StitchRule parse_stitch_rule(const YamlNode& node) {
  StitchRule r;
  r.count = node.integer_or("stitches", 1, 1, kMaxPasses / 2);
  if (node.has("from")) {
    r.from = node.quantity("from", "deg", Range::between(-kTurn, kTurn));
    r.span = node.quantity("to", "deg", Range::between(r.from, r.from + kTurn)) - r.from;
  }
  if (node.has("apart")) {
    r.apart = node.quantity("apart", "deg", Range::between(1e-3, std::numbers::pi));
    r.within = node.quantity("within", "deg", Range::positive());
  }
  r.clear = node.quantity_or("clear", "deg", 0.0, Range::between(0.0, std::numbers::pi));
  r.running = node.flag_or("running", false);
  if (r.running && r.apart == 0.0) node.refuse("apart", "how far a running thread goes from stitch to stitch");
  return r;
}

std::vector<std::string> parse_knots(const YamlNode& node) {
  const std::vector<std::string> known = {"overhand", "square", "surgeons", "granny", "triple"}, knots = node.texts("knot");
  for (const std::string& name : knots)
    if (std::find(known.begin(), known.end(), name) == known.end()) node.refuse("knot", "overhand, square, surgeons, granny or triple");
  if (knots.empty()) node.refuse("knot", "at least one class of knot");
  return knots;
}

JoinGate parse_join_gate(const YamlNode& node) {
  JoinGate g;
  g.leak = node.quantity_or("most_leak", "ml/min", g.leak, Range::positive());
  g.narrowing = node.number_or("most_narrowing", g.narrowing, Range::between(0.0, 1.0));
  g.patent = node.flag_or("patent", false);
  g.source = node.text("source");
  return g;
}

NeedleGoal parse_needle_goal(const YamlNode& node) {
  NeedleGoal g;
  const std::string kind = node.choice("kind", {"pick", "load", "present", "pass", "draw", "eye", "tie", "cut", "stitch", "grasp"});
  g.tool = node.integer_or("tool", 0, 0, 2);
  if (kind == "load") {
    g.kind = NeedleGoal::Kind::load;
    g.low = node.number("from", Range::between(0.0, 1.0));
    g.high = node.number("to", Range::between(g.low, 1.0));
    g.angle = node.quantity("square_within", "deg", Range::positive());
    g.seconds = node.quantity("for", "s", Range::between(0.0, 60.0));
  } else if (kind == "present") {
    g.kind = NeedleGoal::Kind::present;
    g.at = node.vec3("at", "mm");
    g.within = node.quantity("within", "mm", Range::positive());
    g.seconds = node.quantity("for", "s", Range::between(0.0, 60.0));
  } else if (kind == "eye") {
    g.kind = NeedleGoal::Kind::eye;
    g.at = node.vec3("in", "mm");
    g.out = node.vec3("out", "mm");
    g.within = node.quantity("within", "mm", Range::positive());
  } else if (kind == "grasp") {
    g.kind = NeedleGoal::Kind::grasp;
    g.side = node.integer("side", 0, 1);
    g.low = node.quantity("pull_from", "mN", Range::between(0.0, 1.0));
    g.high = node.quantity("pull_to", "mN", Range::between(g.low, 1.0));
    g.seconds = node.quantity("for", "s", Range::between(0.0, 60.0));
  } else if (kind == "stitch") {
    g.kind = NeedleGoal::Kind::stitch;
    g.stitch = parse_stitch_rule(node);
  } else if (kind == "cut") {
    g.kind = NeedleGoal::Kind::cut;
    g.passes = node.integer_or("passes", 2, 1, kMaxPasses);
  } else if (kind == "tie") {
    g.kind = NeedleGoal::Kind::tie;
    g.passes = node.integer("passes", 1, kMaxPasses);
    g.throws = node.integer("throws", 1, 10);
    if (node.has("knot")) g.knots = parse_knots(node);
    g.loop = node.quantity("loop", "mm", Range::positive());
    g.seconds = node.quantity("for", "s", Range::between(0.0, 60.0));
  } else if (kind == "pass" || kind == "draw") {
    g.kind = kind == "pass" ? NeedleGoal::Kind::pass : NeedleGoal::Kind::draw;
    g.passes = node.integer("passes", 1, kMaxPasses);
    if (kind == "draw") g.tail = node.quantity("tail", "mm", Range::positive());
  }
  return g;
}

}  // namespace filum
