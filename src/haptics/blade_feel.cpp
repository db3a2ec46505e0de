#include "haptics/blade_feel.h"

#include <algorithm>

namespace filum {

void BladeFeel::update(const Vec3& p_T, const Vec3& f_T, const Mat3& stiffness, const Vec3& p_D, std::int64_t now_us) noexcept {
  const Vec3 before = known_ ? force(p_D, now_us) : f_T;
  if (known_) fade_us_ = std::clamp<std::int64_t>(now_us - time_us_, 1000, kLongest);
  p_ = p_T;
  f_ = f_T;
  const double most = stiffness.cwiseAbs().maxCoeff();
  stiffness_ = most > kStiffest ? Mat3(stiffness * (kStiffest / most)) : stiffness;
  time_us_ = now_us;
  jump_ = before - predicted(p_D);
  known_ = true;
}

Vec3 BladeFeel::predicted(const Vec3& p_D) const noexcept {
  const Vec3 f = f_ - stiffness_ * (p_D - p_);
  return f.dot(f_) > 0.0 ? f : Vec3(Vec3::Zero());
}

Vec3 BladeFeel::force(const Vec3& p_D, std::int64_t now_us) const noexcept {
  const double left = 1.0 - static_cast<double>(now_us - time_us_) / static_cast<double>(fade_us_);
  return predicted(p_D) + std::clamp(left, 0.0, 1.0) * jump_;
}

}  // namespace filum
