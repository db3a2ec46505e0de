#include "training/knot_shape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

#include "training/knot_table.h"

namespace filum {
namespace {

bool same_knot(const Points& nodes, int begin, int end, const Laurent& jones, std::uint64_t seed) {
  if (end - begin < 3) return false;
  return jones_of_thread(nodes.middleCols(begin, end - begin + 1), seed) == jones;
}

/// Run of nodes of one strand, first and last inclusive.
using Run = std::pair<int, int>;

/// For each node of the core the distance to the nearest node that is more than `skip` of arc away. [m]
std::vector<double> strand_gaps(const Points& nodes, int begin, int end, double skip) {
  const auto n = static_cast<std::size_t>(end - begin + 1);
  std::vector<double> arc(n, 0.0), gap(n, 1e300);
  for (std::size_t k = 1; k < n; ++k) {
    const auto c = begin + static_cast<Eigen::Index>(k);
    arc[k] = arc[k - 1] + (nodes.col(c) - nodes.col(c - 1)).norm();
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (arc[j] - arc[i] < skip) continue;
      const double d =
          (nodes.col(begin + static_cast<Eigen::Index>(i)) - nodes.col(begin + static_cast<Eigen::Index>(j)))
              .norm();
      gap[i] = std::min(gap[i], d);
      gap[j] = std::min(gap[j], d);
    }
  }
  return gap;
}

/// The longest run of the core that no other strand is near: the loop. Empty (first > second) if there is
/// none.
Run longest_free_run(const std::vector<double>& gap, double near) {
  Run best{0, -1};
  for (std::size_t i = 0; i < gap.size();) {
    if (gap[i] <= near) {
      ++i;
      continue;
    }
    std::size_t j = i;
    while (j + 1 < gap.size() && gap[j + 1] > near) ++j;
    const bool inside = i > 0 && j + 1 < gap.size();
    if (inside && static_cast<int>(j - i) > best.second - best.first)
      best = {static_cast<int>(i), static_cast<int>(j)};
    i = j + 1;
  }
  return best;
}

/// Total turning of a run, from chords at least `chord` long. [rad]
double turning(const Points& nodes, const Run& run, double chord) {
  double sum = 0.0;
  Vec3 corner = nodes.col(run.first), direction = Vec3::Zero();
  for (int k = run.first + 1; k <= run.second; ++k) {
    const Vec3 step = nodes.col(k) - corner;
    if (step.norm() < chord) continue;
    const Vec3 next = step.normalized();
    if (direction.squaredNorm() > 0.0) sum += std::acos(std::clamp(direction.dot(next), -1.0, 1.0));
    direction = next;
    corner = nodes.col(k);
  }
  return sum;
}

/// Sets of throws (each sorted) that are left as a tail is drawn back further and further.
using Undoing = std::vector<std::vector<int>>;

Undoing draw_back(const Points& nodes, int begin, int end, bool first_tail, std::uint64_t seed) {
  constexpr int kSamples = 32;
  Undoing left;
  const int span = end - begin;
  for (int k = 1, last = 0; k < kSamples; ++k) {
    const int cut = static_cast<int>(std::lround(0.55 * span * k / kSamples));
    if (cut == last || span - cut < 4) continue;
    last = cut;
    const int from = first_tail ? begin + cut : begin;
    left.push_back(throws_of(jones_of_thread(nodes.middleCols(from, span - cut + 1), seed)));
    std::sort(left.back().begin(), left.back().end());
    if (left.back().empty()) break;
  }
  return left;
}

/// The throw by which `more` exceeds `less`; 0 if it does so by anything else than one. Both sorted.
int one_more(const std::vector<int>& more, const std::vector<int>& less) {
  std::vector<int> difference;
  std::set_difference(more.begin(), more.end(), less.begin(), less.end(), std::back_inserter(difference));
  return difference.size() == 1 && more.size() == less.size() + 1 ? difference.front() : 0;
}

/// From the post outwards: which throw went each time one went, each state seen `looks` times running; empty
/// if some state was not. The first state that fits counts: a double throw that is half undone looks like a
/// single one later on.
std::vector<int> order_undone(std::vector<int> members, const Undoing& left, std::size_t looks) {
  std::vector<int> outside_in;
  for (std::size_t k = 0; members.size() > 1 && k + looks <= left.size(); ++k) {
    const int undone = one_more(members, left[k]);
    const auto same = [&](const std::vector<int>& set) { return set == left[k]; };
    const auto begin = left.begin() + static_cast<std::ptrdiff_t>(k);
    if (undone == 0 || !std::all_of(begin, begin + static_cast<std::ptrdiff_t>(looks), same)) continue;
    outside_in.push_back(undone);
    members = left[k];
  }
  if (members.size() > 1) return {};
  outside_in.insert(outside_in.end(), members.begin(), members.end());
  return {outside_in.rbegin(), outside_in.rend()};
}

}  // namespace

std::vector<int> unravel(const Points& nodes, std::vector<int> members, std::uint64_t seed,
                         const KnotReport& report) {
  std::sort(members.begin(), members.end());
  const Undoing first = draw_back(nodes, report.core_begin, report.core_end, true, seed);
  const std::vector<int> order = order_undone(members, first, 2);
  if (!order.empty()) return order;
  const Undoing last = draw_back(nodes, report.core_begin, report.core_end, false, seed);
  for (const std::size_t looks : {2u, 1u}) {
    for (const Undoing* left : {&last, &first}) {
      const std::vector<int> found = order_undone(members, *left, looks);
      if (!found.empty()) return found;
    }
  }
  return {};
}

void find_core(const Points& nodes, const Laurent& jones, std::uint64_t seed, KnotReport& report) {
  int begin = 0, end = static_cast<int>(nodes.cols()) - 1;
  report.core_begin = begin;
  report.core_end = end;
  // Where the freest closure gives another knot than the vote did, the whole thread is the best that can be
  // said.
  if (!same_knot(nodes, begin, end, jones, seed)) return;
  for (int low = begin, high = end; high - low > 1;) {
    const int middle = (low + high) / 2;
    (same_knot(nodes, middle, end, jones, seed) ? low : high) = middle;
    begin = low;
  }
  for (int low = begin, high = end; high - low > 1;) {
    const int middle = (low + high) / 2;
    (same_knot(nodes, begin, middle, jones, seed) ? high : low) = middle;
    end = high;
  }
  report.core_begin = begin;
  report.core_end = end;
}

void measure_post(const Points& nodes, const PostShape& post, KnotReport& report) {
  const Vec3 e1 = post.axis_W.unitOrthogonal(), e2 = post.axis_W.cross(e1);
  const auto angle = [&](int k) {
    const Vec3 r = nodes.col(k) - post.p_W;
    return std::atan2(r.dot(e2), r.dot(e1));
  };
  double sum = 0.0;
  for (int k = report.core_begin; k <= report.core_end; ++k) {
    const int next = k < report.core_end ? k + 1 : report.core_begin;
    sum += std::remainder(angle(next) - angle(k), 2.0 * std::numbers::pi);
  }
  report.post_winding = static_cast<int>(std::lround(sum / (2.0 * std::numbers::pi)));
  report.encloses_post = report.post_winding != 0;
  if (!report.encloses_post) report.note += "the knot does not enclose the post; ";
}

void judge_lay(const Points& nodes, double radius, KnotReport& report) {
  const bool stack = report.knot_class == "square" || report.knot_class == "granny" ||
                     report.knot_class == "surgeons" || report.knot_class == "triple";
  if (!stack || radius <= 0.0) return;
  const double diameter = 2.0 * radius, near = kNearDiameters * diameter;
  const std::vector<double> gap = strand_gaps(nodes, report.core_begin, report.core_end, 2.5 * near);
  const Run loop = longest_free_run(gap, near);
  if (loop.second < loop.first) {
    report.note += "loose: the lay of the strands is not judged; ";
    return;
  }
  const Run before{report.core_begin, report.core_begin + loop.first - 1};
  const Run after{report.core_begin + loop.second + 1, report.core_end};
  const double chord = kChordDiameters * diameter;
  report.strand_turning = {turning(nodes, before, chord), turning(nodes, after, chord)};
  const auto [straight, winding] = std::minmax(report.strand_turning[0], report.strand_turning[1]);
  if (straight < kStraightTurn && straight < 0.25 * winding && winding > kHitchTurn * report.n_throws) {
    report.note += "one strand runs straight through a " + report.knot_class + " knot; ";
    report.knot_class = "half-hitches";
  }
}

}  // namespace filum
