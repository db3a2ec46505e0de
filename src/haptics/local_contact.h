#pragma once
// What a tool touches, as one plane between two steps of the world: position, normal and stiffness, so that the force on the
// hand follows the hand at 1 kHz although the world answers at 500 Hz (local model: Y. Adachi, T. Kumano, K. Ogino, VRAIS
// 1995; W. R. Mark et al., SIGGRAPH 1996).
//
// The scene pushes the tool with f_k at tip p_k (frame W). The normal is n = f_k / |f_k|; the scene's stiffness along it is
// estimated from successive steps, K = -df_n / dp_n, kept within 0 ... K_max and smoothed. The tool hangs on the hand by the
// coupling stiffness k_c, so when the hand moves by d along n, the tip moves by k_c / (k_c + K) n.d: the two springs are in
// series. Across n the tip follows the hand. Without contact the tip goes on as it went, p_k + t v_k.
// A new step never makes the tip jump: what the last prediction was wrong by fades out over one step of the world.
// Neglects: damping of the scene, turning of the plane within a step. Test: local_contact_test.

#include <cstdint>

#include "base/pose.h"

namespace filum {

struct LocalContactOptions {
  double coupling = 500.0;         // [N/m], k_c
  double stiffest = 5000.0;        // [N/m], K_max
  double touch = 1e-3;             // [N], below it there is no contact
  double smoothing = 0.3;          // share of the newest estimate of K
  std::int64_t period_us = 2000;   // [us], of the world
};

class LocalContact {
 public:
  explicit LocalContact(const LocalContactOptions& options = {}) : options_(options) {}

  /// A new state of the tool: tip [m], velocity [m/s], force of the scene on it [N]; the hand [m] now.
  void update(const Vec3& p_T, const Vec3& v_T, const Vec3& f_T, const Vec3& p_D, std::int64_t now_us) noexcept;
  /// Where the tip is now, with the hand at p_D. [m]
  Vec3 tip(const Vec3& p_D, std::int64_t now_us) const noexcept;
  void release() noexcept { known_ = false; }

  bool known() const noexcept { return known_; }
  bool touching() const noexcept { return touching_; }
  double stiffness() const noexcept { return stiffness_; }  // [N/m]
  const Vec3& normal() const noexcept { return normal_; }

 private:
  Vec3 predicted(const Vec3& p_D, std::int64_t now_us) const noexcept;

  LocalContactOptions options_;
  bool known_ = false, touching_ = false;
  Vec3 p_T_ = Vec3::Zero(), v_T_ = Vec3::Zero(), p_D_ = Vec3::Zero();
  Vec3 normal_ = Vec3::UnitZ();
  Vec3 jump_ = Vec3::Zero();   // [m], prediction less truth at the last update
  double force_ = 0.0;         // [N], along the normal
  double stiffness_ = 0.0;     // [N/m]
  std::int64_t time_us_ = 0;   // [us], of the last update
};

}  // namespace filum
