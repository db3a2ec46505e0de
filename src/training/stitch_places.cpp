#include "training/stitch_places.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "base/numbers.h"
#include "training/stitch_order.h"

namespace filum {
namespace {

constexpr double kCardSpacing = 1e-3;  // [m]

/// Whole stitches that the needle's ways make.
int stitches_of_passes(const std::vector<NeedleGoal>& goals) {
  int passes = 0;
  for (const NeedleGoal& g : goals)
    if (g.kind == NeedleGoal::Kind::pass) passes = std::max(passes, g.passes);
  return passes / 2;
}

/// [rad], of what lies on top of two stumps on one axis as the clamp is; there is none where the edges have a shape of their own.
std::optional<double> on_top(const TissueDescription& t) {
  if (!t.edges[0].rim.empty()) return {};
  return std::atan2(t.axis.cross(t.cut_along).z(), t.cut_along.z());
}

std::optional<double> first_angle(const StitchRule& rule, const TissueDescription& t) {
  return rule.span < kTurn ? rule.from + 0.5 * rule.span : on_top(t);
}

/// The one that is farthest from those before.
double farthest(const std::vector<double>& from, const std::vector<double>& before) {
  const auto clear = [&](double angle) {
    double least = kTurn;
    for (const double other : before) least = std::min(least, std::abs(std::remainder(other - angle, kTurn)));
    return least;
  };
  const auto nearer = [&](double a, double b) { return clear(a) < clear(b) - 1e-9; };
  return *std::max_element(from.begin(), from.end(), nearer);
}

}  // namespace

std::vector<double> stitch_angles(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue) {
  const StitchRule* first = nullptr;
  int n = 0;
  for (const NeedleGoal& g : goals) {
    if (g.kind != NeedleGoal::Kind::stitch) continue;
    if (first == nullptr) first = &g.stitch;
    n += g.stitch.count;
  }
  const std::optional<double> start = first != nullptr ? first_angle(*first, tissue) : on_top(tissue);
  if (!start) return {};
  if (first == nullptr) return stitches_of_passes(goals) == 1 ? std::vector<double>{*start} : std::vector<double>();
  StitchOrder order(goals, tissue);
  std::vector<double> left, placed;
  for (int k = 0; k < n; ++k) left.push_back(*start + kTurn * k / n);
  while (!left.empty()) {
    std::vector<double> asked;
    std::copy_if(left.begin(), left.end(), std::back_inserter(asked), [&](double angle) { return order.asks_for(angle); });
    if (asked.empty()) return {};
    placed.push_back(placed.empty() ? asked.front() : farthest(asked, placed));
    order.make(placed.back());
    left.erase(std::find(left.begin(), left.end(), placed.back()));
  }
  return placed;
}

std::vector<double> stitches_along(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue) {
  const int n = stitches_of_passes(goals);
  if (n == 0 || tissue.rest.cols() == 0) return {};
  const auto along = (tissue.cut_along.transpose() * tissue.rest).eval();
  const double spacing = std::min(kCardSpacing, (along.maxCoeff() - along.minCoeff()) / (n + 1));
  std::vector<double> places;
  for (int k = 0; k < n; ++k) places.push_back(spacing * (k - 0.5 * (n - 1)));
  return places;
}

}  // namespace filum
