#include "training/cut_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.h"

namespace filum {
namespace {

}  // namespace

CutLine::CutLine(const TissueDescription& d) : d_(d), radius_(d.radius) {
  if (!edges()) return;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::vector<Vec3>& rim = d.edges[side].rim;
    for (std::size_t k = 0; k < rim.size(); ++k) length_[side] += (rim[(k + 1) % rim.size()] - rim[k]).norm();
  }
  radius_ = 0.5 * (length_[0] + length_[1]) / kTurn;
}

CutLine::Foot CutLine::foot(const CutPlace& a) const {
  const std::vector<Vec3>& rim = d_.edges[a.side != 0 ? 1 : 0].rim;
  Foot best;
  best.distance = std::numeric_limits<double>::infinity();
  double arc = 0.0;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const Vec3 run = rim[(k + 1) % rim.size()] - rim[k];
    const double f = std::clamp((a.p - rim[k]).dot(run) / run.squaredNorm(), 0.0, 1.0), distance = (a.p - rim[k] - f * run).norm();
    if (distance < best.distance) best = {arc + f * run.norm(), distance, rim[k] + f * run};
    arc += run.norm();
  }
  return best;
}

double CutLine::angle(const CutPlace& a) const {
  if (edges()) return std::remainder(kTurn * foot(a).arc / length_[a.side != 0 ? 1 : 0], kTurn);
  const Vec3 r = a.p - d_.middle;
  return std::atan2(r.dot(d_.axis.cross(d_.cut_along)), r.dot(d_.cut_along));
}

double CutLine::turn(const CutPlace& a, const CutPlace& b) const { return std::remainder(angle(b) - angle(a), kTurn); }

double CutLine::along(const CutPlace& a, const CutPlace& b) const { return d_.lumen ? radius_ * turn(a, b) : (b.p - a.p).dot(d_.cut_along); }

double CutLine::across(const CutPlace& a, const CutPlace& b) const {
  if (edges()) return a.side == b.side ? std::abs(foot(a).distance - foot(b).distance) : foot(a).distance + foot(b).distance;
  const Vec3 span = b.p - a.p;
  if (d_.lumen) return std::abs(span.dot(d_.axis));
  const Vec3 flat(span.x(), span.y(), 0.0);
  return std::sqrt(std::max(0.0, flat.squaredNorm() - flat.dot(d_.cut_along) * flat.dot(d_.cut_along)));
}

double CutLine::position(const CutPlace& a, const CutPlace& b) const {
  return d_.lumen ? radius_ * (angle(a) + 0.5 * turn(a, b)) : 0.5 * (a.p + b.p).dot(d_.cut_along);
}

double CutLine::own_turn(const CutPlace& a) const {
  const CutEdge& edge = d_.edges[a.side != 0 ? 1 : 0];
  const auto outward = [&](const Vec3& p) {
    const Vec3 r = p - edge.origin;
    return Vec3(r - r.dot(edge.axis) * edge.axis);
  };
  const Vec3 at = outward(a.p), from = outward(foot(a).at);
  return std::atan2(at.cross(from).norm(), at.dot(from));
}

double CutLine::round_lumen(const CutPlace& a, const CutPlace& b) const {
  const double turned = std::abs(turn(a, b));
  return edges() ? std::max({turned, own_turn(a), own_turn(b)}) : turned;
}

}  // namespace filum
