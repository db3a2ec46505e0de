#include "training/knot_classifier.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "training/knot_closure.h"
#include "training/knot_invariant.h"
#include "training/knot_shape.h"
#include "training/knot_simplify.h"
#include "training/knot_table.h"

namespace filum {
namespace {

KnotDiagram smallest_diagram(const Points& nodes, const Closure& closure, std::uint64_t seed,
                             int directions) {
  GridPolygon polygon = to_grid(close_curve(nodes, closure), seed);
  shrink(polygon);
  return project_best(polygon, seed, directions);
}

struct Vote {
  KnotDiagram diagram;
  Laurent jones;
  int count = 0;
};

/// The knot most closures agree on; the freest closure wins ties.
Vote elect(const Points& nodes, const KnotOptions& options, int& n_votes) {
  std::vector<Vote> votes;
  const std::vector<Closure> closures = free_closures(nodes, options.closures);
  n_votes = static_cast<int>(closures.size());
  for (const Closure& closure : closures) {
    KnotDiagram diagram = smallest_diagram(nodes, closure, options.seed, 12);
    const Laurent jones = jones_polynomial(diagram);
    auto same = std::find_if(votes.begin(), votes.end(), [&](const Vote& v) { return v.jones == jones; });
    if (same == votes.end()) same = votes.insert(votes.end(), Vote{diagram, jones, 0});
    if (diagram.crossings() < same->diagram.crossings()) same->diagram = diagram;
    ++same->count;
  }
  return *std::max_element(votes.begin(), votes.end(),
                           [](const Vote& a, const Vote& b) { return a.count < b.count; });
}

/// Throws in order if the shrunk diagram shows them as a nest that adds up to `members`; else empty.
std::vector<int> stack_in_diagram(const KnotDiagram& diagram, const std::vector<int>& members) {
  std::vector<int> stack = stacked_throws(diagram);
  return std::is_permutation(stack.begin(), stack.end(), members.begin(), members.end()) ? stack
                                                                                         : std::vector<int>{};
}

/// Names a knot made of `members`, in the order `stack` (empty if not known).
void name_knot(const std::vector<int>& members, const std::vector<int>& stack, KnotReport& report) {
  const bool ordered = stack.size() == members.size();
  report.throws = stack;
  report.members = members;
  report.n_throws = static_cast<int>(members.size());
  report.composition = composition_of(stack);
  report.knot_class = class_of(ordered ? stack : members, ordered);
  if (!ordered) report.note += "order of the throws not readable from the shape; ";
  if (report.knot_class == "other") {
    report.note += "throws ";
    report.note += composition_of(ordered ? stack : members);
    report.note += " are none of the knots taught; ";
  }
}

void cross_check(const Vote& vote, KnotReport& report) {
  const Laurent alexander = alexander_polynomial(vote.diagram);
  report.alexander = alexander.text("t");
  report.determinant = std::abs(alexander.at_minus_one());
  if (std::abs(vote.jones.at_minus_one()) != report.determinant) {
    report.note += "Jones and Alexander disagree on the determinant; ";
    report.confidence = 0.0;
  }
}

}  // namespace

KnotReport classify_knot(const Points& nodes, double radius, const PostShape* post,
                         const KnotOptions& options) {
  KnotReport report;
  if (nodes.cols() < 4 || !nodes.allFinite()) {
    report.note = "no usable thread";
    return report;
  }
  int n_votes = 1;
  const Vote vote = elect(nodes, options, n_votes);
  report.confidence = static_cast<double>(vote.count) / n_votes;
  report.jones = vote.jones.text("t");
  report.n_crossings = vote.diagram.crossings();
  if (vote.jones.zero()) {
    report.knot_class = "other";
    report.confidence = 0.0;
    report.note = "too tangled: more than " + std::to_string(kMaxCrossings) + " crossings; ";
    return report;
  }
  cross_check(vote, report);
  if (report.confidence < 1.0) report.note += "the class depends on how the tails are led out; ";
  if (vote.jones == Laurent::monomial(1, 0)) return report;
  if (options.shape) find_core(nodes, vote.jones, options.seed, report);
  const std::vector<int> members = throws_of(vote.jones);
  if (members.empty()) {
    report.knot_class = "other";
    report.note += "not a stack of throws; ";
  } else {
    std::vector<int> stack = stack_in_diagram(vote.diagram, members);
    if (stack.empty() && options.shape) stack = unravel(nodes, members, options.seed, report);
    name_knot(members, stack, report);
  }
  if (!options.shape) return report;
  if (post != nullptr) measure_post(nodes, *post, report);
  judge_lay(nodes, radius, report);
  return report;
}

std::optional<KnotReport> rest_of_sum(const KnotReport& sum, const KnotReport& part) {
  std::vector<int> all = sum.members, inner = part.members, rest;
  std::sort(all.begin(), all.end());
  std::sort(inner.begin(), inner.end());
  std::set_difference(all.begin(), all.end(), inner.begin(), inner.end(), std::back_inserter(rest));
  if (inner.empty() || rest.empty() || rest.size() + inner.size() != all.size()) return {};
  std::vector<int> stack;
  if (sum.throws.size() == all.size()) {  // read from the post outwards: the inner knot's throws come first
    const auto first_outer = sum.throws.begin() + static_cast<std::ptrdiff_t>(inner.size());
    if (std::is_permutation(sum.throws.begin(), first_outer, inner.begin())) stack.assign(first_outer, sum.throws.end());
  }
  KnotReport outer = sum;
  outer.note.clear();
  name_knot(rest, stack, outer);
  return outer;
}

Laurent jones_of_thread(const Points& nodes, std::uint64_t seed) {
  return jones_polynomial(smallest_diagram(nodes, free_closures(nodes, 1).front(), seed, 3));
}

}  // namespace filum
