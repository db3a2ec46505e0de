#include "haptics/local_contact.h"

#include <algorithm>
#include <cmath>

namespace filum {

void LocalContact::update(const Vec3& p_T, const Vec3& v_T, const Vec3& f_T, const Vec3& p_D, std::int64_t now_us) noexcept {
  const Vec3 before = known_ ? tip(p_D, now_us) : p_T;
  const double size = f_T.norm();
  const bool touching = size > options_.touch;
  if (touching) {
    const Vec3 n = f_T / size;
    if (touching_ && known_) {
      const double moved = n.dot(p_T - p_T_), change = f_T.dot(n) - force_ * normal_.dot(n);
      if (std::abs(moved) > 1e-9) {
        const double k = std::clamp(-change / moved, 0.0, options_.stiffest);
        stiffness_ += options_.smoothing * (k - stiffness_);
      }
    } else {
      stiffness_ = options_.coupling;  // nothing known yet: as stiff as the hand's own spring
    }
    normal_ = n;
    force_ = size;
  }
  touching_ = touching;
  p_T_ = p_T;
  v_T_ = v_T;
  p_D_ = p_D;
  time_us_ = now_us;
  jump_ = before - p_T;
  known_ = true;
}

Vec3 LocalContact::predicted(const Vec3& p_D, std::int64_t now_us) const noexcept {
  const double t = 1e-6 * static_cast<double>(std::clamp<std::int64_t>(now_us - time_us_, 0, 2 * options_.period_us));
  if (!touching_) return p_T_ + t * v_T_;
  const Vec3 moved = p_D - p_D_;
  const double along = normal_.dot(moved);
  const double share = options_.coupling / (options_.coupling + stiffness_);
  return p_T_ + moved - along * normal_ + share * along * normal_;
}

Vec3 LocalContact::tip(const Vec3& p_D, std::int64_t now_us) const noexcept {
  const double left = 1.0 - static_cast<double>(now_us - time_us_) / static_cast<double>(options_.period_us);
  return predicted(p_D, now_us) + std::clamp(left, 0.0, 1.0) * jump_;
}

}  // namespace filum
