#include "physics/wall_load.h"

#include <algorithm>
#include <cmath>

#include "collision/point_triangle.h"

namespace filum {
namespace {

constexpr double kStick = 0.5;         // of the stiffness: friction before it slips
constexpr double kDeepPush = 20e-6;    // [m], overlap beyond which friction does not grow
constexpr double kOnSurface = 1e-9;    // [m], distance that is none

}  // namespace

WallLoad WallLoad::spring(const WallPlace& place, const Points& x, const Vec3& force, const Mat3& stiffness, const WallSlip& slip) noexcept {
  WallLoad l;
  l.place_ = l.first_ = place;
  l.at_ = place.at(x);
  l.given_ = force;
  l.stiffness_ = stiffness;
  l.slip_ = slip;
  return l;
}

void WallLoad::stand_against(const WallStand& stand) noexcept {
  stand_ = stand;
  stand_.carried -= stand.carried.dot(stand.normal) * stand.normal;
  way_ = stand.normal;
  limit_ = stand.friction * stand.stiffness * std::clamp(stand.depth, 0.0, kDeepPush);
  stick_ = limit_ > 0.0 ? kStick * stand.stiffness : 0.0;
}

WallLoad WallLoad::stop(const WallPlace& place, const Points& x, const WallStand& stand) noexcept {
  WallLoad l = spring(place, x, Vec3::Zero(), Mat3::Zero(), {});
  l.kind_ = Kind::stop;
  l.stand_against(stand);
  return l;
}

WallLoad WallLoad::ball(const Triangle& triangle, const Vec3& weights, const Points& x, const WallStand& stand, const Vec3& centre, double radius) noexcept {
  WallPlace place;
  place.node.fill(triangle[0]);  // those beyond the three weigh nothing
  for (int k = 0; k < 3; ++k) place.node[static_cast<std::size_t>(k)] = triangle[static_cast<std::size_t>(k)];
  place.weight.head<3>() = weights;
  WallLoad l = stop(place, x, stand);
  l.kind_ = Kind::ball;
  l.centre_ = centre;
  l.radius_ = radius;
  return l;
}

double WallLoad::answer(const Points& x) noexcept {
  switch (kind_) {
    case Kind::spring: return answer_spring(x);
    case Kind::stop: return answer_stop(x);
    case Kind::ball: return answer_ball(x);
  }
  return 0.0;
}

double WallLoad::answer_spring(const Points& x) noexcept {
  const Vec3 moved = place_.at(x) - at_, spring = stiffness_ * moved;
  double energy = -(given_ - 0.5 * spring).dot(moved);
  push_ = given_ - spring;
  if (slip_.stick <= 0.0) return energy;
  const double pull = slip_.force - slip_.stick * slip_.along.dot(moved), held = std::clamp(pull, slip_.low, slip_.high);
  sticks_ = pull > slip_.low && pull < slip_.high;
  energy += (pull - 0.5 * held) * held / slip_.stick;
  push_ += held * slip_.along;
  return energy;
}

double WallLoad::answer_stop(const Points& x) noexcept {
  const Vec3 moved = place_.at(x) - at_;
  return push(stand_.depth + stand_.normal.dot(moved), stand_.normal) + rub(moved);
}

double WallLoad::answer_ball(const Points& x) noexcept {
  const TrianglePoint foot = closest_on_triangle(centre_, x.col(place_.node[0]), x.col(place_.node[1]), x.col(place_.node[2]));
  const Vec3 apart = centre_ - foot.point;
  const double side = std::copysign(1.0, apart.dot(stand_.normal)), distance = side * apart.norm();  // negative: the face has gone past the centre
  place_.weight.head<3>() = foot.weights;
  return push(radius_ - distance, std::abs(distance) > kOnSurface ? Vec3(apart / distance) : stand_.normal) + rub(first_.at(x) - at_);
}

/// A thing overlaps the wall by this much [m] and pushes it against `way`.
double WallLoad::push(double overlap, const Vec3& way) noexcept {
  overlap = std::max(0.0, overlap);
  pushed_ = stand_.stiffness * overlap;
  way_ = way;
  push_ = -pushed_ * way;
  return 0.5 * pushed_ * overlap;
}

/// The place at the step's start has moved by this much [m].
double WallLoad::rub(const Vec3& moved) noexcept {
  if (limit_ <= 0.0) return 0.0;
  const Vec3 slip = moved - moved.dot(stand_.normal) * stand_.normal - stand_.carried;
  const double length = slip.norm(), give = limit_ / stick_;
  drag_ = -(length < give ? stick_ : limit_ / length) * slip;
  return length < give ? 0.5 * stick_ * length * length : limit_ * (length - 0.5 * give);
}

void WallLoad::add_to(Points& force) const noexcept {
  const int n = kind_ == Kind::ball ? 3 : 8;
  for (int a = 0; a < n; ++a) force.col(place_.node[static_cast<std::size_t>(a)]) += place_.weight[a] * push_ + first_.weight[a] * drag_;
}

Mat3 WallLoad::felt() const noexcept {
  if (kind_ == Kind::spring) return sticks_ ? Mat3(stiffness_ + slip_.stick * slip_.along * slip_.along.transpose()) : stiffness_;
  if (pushed_ <= 0.0) return Mat3::Zero();
  const Mat3 along = way_ * way_.transpose();
  return stand_.stiffness * along + stick_ * (Mat3::Identity() - along);
}

}  // namespace filum
