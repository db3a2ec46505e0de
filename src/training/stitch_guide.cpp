#include "training/stitch_guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace filum {
namespace {

constexpr int kRound = 8, kOnCard = 5, kPathPoints = 17;
constexpr double kCardSpacing = 1e-3;                    // [m]
constexpr double kAbove = 0.6;                           // [rad], of the needle's circle, shown outside the tissue

int nearest(const Points& rest, const Vec3& at) {
  Eigen::Index k = -1;
  if (rest.cols() > 0) (rest.colwise() - at).colwise().squaredNorm().minCoeff(&k);
  return static_cast<int>(k);
}

/// Distance of the cut edge from the middle of the cut, along `across` (its sign tells the side).
double edge_at(const Points& rest, const Vec3& middle, const Vec3& across) {
  double least = -1.0;
  for (Eigen::Index k = 0; k < rest.cols(); ++k)
    if (const double d = (rest.col(k) - middle).dot(across); d >= 0.0 && (least < 0.0 || d < least)) least = d;
  return std::max(0.0, least);
}

/// From outside to `deep` below the surface; `towards`: unit, along the surface to the cut.
std::vector<Vec3> needle_path(const Vec3& at, const Vec3& outward, const Vec3& towards, double radius, double deep) {
  const double below = std::asin(std::min(1.0, deep / radius));
  const Vec3 centre = at + radius * towards;
  std::vector<Vec3> path;
  for (int k = 0; k < kPathPoints; ++k) {
    const double angle = kAbove - (kAbove + below) * k / (kPathPoints - 1);
    path.push_back(centre + radius * (-std::cos(angle) * towards + std::sin(angle) * outward));
  }
  return path;
}

GuidePlace place(const TissueDescription& t, const NeedleDescription& needle, const Vec3& on_cut, const Vec3& outward, const Vec3& across, double bite) {
  GuidePlace p;
  const Vec3 rough = on_cut + (edge_at(t.rest, t.middle, across) + bite) * across;
  p.vertex = nearest(t.rest, rough);
  const double lift = p.vertex < 0 ? 0.0 : (t.rest.col(p.vertex) - rough).dot(outward);  // onto the surface as it rests
  p.at = rough + lift * outward;
  p.path = needle_path(p.at, outward, -across, needle.bend_radius, 2.0 * t.thickness);
  return p;
}

StitchGuide guide(const TissueDescription& t, const NeedleDescription& needle, const Vec3& on_cut, const Vec3& outward, const Vec3& across, double bite) {
  StitchGuide g{place(t, needle, on_cut, outward, -across, bite), place(t, needle, on_cut, outward, across, bite)};
  g.out.path = {g.out.path.rbegin(), g.out.path.rend()};
  return g;
}

}  // namespace

std::vector<StitchGuide> stitch_guides(const TissueDescription& t, const NeedleDescription& needle, const LapseRules& rules) {
  std::vector<StitchGuide> guides;
  if (t.triangles.empty() || !needle.present) return guides;
  const double bite = 2.0 / 3.0 * rules.wide_bite * t.thickness;
  if (!t.lumen) {
    const Vec3 across = Vec3::UnitZ().cross(t.cut_along).normalized();
    const auto along = (t.cut_along.transpose() * t.rest).eval();
    const double spacing = std::min(kCardSpacing, (along.maxCoeff() - along.minCoeff()) / (kOnCard + 1));
    for (int k = 0; k < kOnCard; ++k) {
      const Vec3 on_cut = t.middle + spacing * (k - kOnCard / 2) * t.cut_along + 0.5 * t.thickness * Vec3::UnitZ();
      guides.push_back(guide(t, needle, on_cut, Vec3::UnitZ(), across, bite));
    }
    return guides;
  }
  for (const int k : {0, 4, 2, 6, 1, 3, 5, 7}) {  // stays at 180 degrees, then half way between
    const double angle = 2.0 * std::numbers::pi * k / kRound;
    const Vec3 outward = std::cos(angle) * t.cut_along + std::sin(angle) * t.axis.cross(t.cut_along);
    guides.push_back(guide(t, needle, t.middle + t.radius * outward, outward, t.axis, bite));
  }
  return guides;
}

std::vector<StitchGuide> eye_marks(const std::vector<NeedleGoal>& goals, const TissueDescription& t) {
  std::vector<StitchGuide> marks;
  const Vec3 up = 0.5 * t.thickness * Vec3::UnitZ();
  for (const NeedleGoal& g : goals)
    if (g.kind == NeedleGoal::Kind::eye) marks.push_back({{g.at + up, nearest(t.rest, g.at + up), {}}, {g.out + up, nearest(t.rest, g.out + up), {}}});
  return marks;
}

}  // namespace filum
