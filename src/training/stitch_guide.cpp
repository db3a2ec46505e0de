#include "training/stitch_guide.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "training/stitch_places.h"

namespace filum {
namespace {

constexpr int kPathPoints = 17;
constexpr double kAbove = 0.6;  // [rad], of the needle's circle, shown outside the tissue

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

/// Beside the edge of one side of a cut that runs round no one axis, at this share of its length from the heel.
GuidePlace beside_edge(const TissueDescription& t, const NeedleDescription& needle, std::size_t side, double share, double bite) {
  const CutEdge& e = t.edges[side];
  const auto outward = [&](const Vec3& p) { return Vec3((p - e.origin - (p - e.origin).dot(e.axis) * e.axis).normalized()); };
  double whole = 0.0;
  Vec3 middle = Vec3::Zero(), on_edge = e.rim.front();
  for (std::size_t k = 0; k < e.rim.size(); ++k) {
    whole += (e.rim[(k + 1) % e.rim.size()] - e.rim[k]).norm();
    middle += e.rim[k] / static_cast<double>(e.rim.size());
  }
  double left = share * whole;
  for (std::size_t k = 0; k < e.rim.size() && left >= 0.0; ++k) {
    const Vec3 run = e.rim[(k + 1) % e.rim.size()] - e.rim[k];
    on_edge = e.rim[k] + std::min(1.0, left / run.norm()) * run;
    left -= run.norm();
  }
  const Vec3 away = side == 0 ? Vec3(on_edge - middle) : Vec3(-e.axis), out = outward(on_edge);
  GuidePlace p;
  p.vertex = nearest(t.rest, on_edge + bite * (away - away.dot(out) * out).normalized() + t.thickness * out);
  p.at = t.rest.col(p.vertex);
  const Vec3 up = outward(p.at);
  p.path = needle_path(p.at, up, -(away - away.dot(up) * up).normalized(), needle.bend_radius, 2.0 * t.thickness);
  return p;
}

StitchGuide guide(const TissueDescription& t, const NeedleDescription& needle, const Vec3& on_cut, const Vec3& outward, const Vec3& across, double bite) {
  StitchGuide g{place(t, needle, on_cut, outward, -across, bite), place(t, needle, on_cut, outward, across, bite)};
  g.out.path = {g.out.path.rbegin(), g.out.path.rend()};
  return g;
}

}  // namespace

std::vector<StitchGuide> stitch_guides(const TissueDescription& t, const NeedleDescription& needle, const NeedleTask& task) {
  std::vector<StitchGuide> guides;
  if (t.triangles.empty() || !needle.present) return guides;
  const double bite = 2.0 / 3.0 * task.lapses.wide_bite * t.thickness;
  if (!t.lumen) {
    const Vec3 across = Vec3::UnitZ().cross(t.cut_along).normalized();
    for (const double along : stitches_along(task.goals, t)) {
      const Vec3 on_cut = t.middle + along * t.cut_along + 0.5 * t.thickness * Vec3::UnitZ();
      guides.push_back(guide(t, needle, on_cut, Vec3::UnitZ(), across, bite));
    }
    return guides;
  }
  for (const double angle : stitch_angles(task.goals, t)) {
    if (!t.edges[0].rim.empty()) {
      const double share = angle / kTurn - std::floor(angle / kTurn);
      guides.push_back({beside_edge(t, needle, 0, share, bite), beside_edge(t, needle, 1, share, bite)});
      std::reverse(guides.back().out.path.begin(), guides.back().out.path.end());
      continue;
    }
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
