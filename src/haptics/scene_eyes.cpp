#include "haptics/scene_eyes.h"

#include <cmath>

namespace filum {
namespace {

/// x along `x`, z as near to upright as may be.
Quat upright(const Vec3& x) noexcept {
  const Vec3 up = std::abs(x.z()) < 0.999 ? Vec3::UnitZ() : Vec3::UnitX();
  Mat3 R;
  R.col(0) = x;
  R.col(2) = (up - up.dot(x) * x).normalized();
  R.col(1) = R.col(2).cross(x);
  return Quat(R).normalized();
}

}  // namespace

bool SceneEyes::find_needle(const Look& look, Pose& X_WF) const noexcept {
  const NeedleObservation& n = observation_.needle;
  const NeedleDescription& d = scene_.needle;
  if (!n.present || look.length > d.bend_radius * d.angle) return false;
  if (look.holder >= 0 && !n.held[static_cast<std::size_t>(look.holder)]) return false;
  const double psi = look.length / d.bend_radius - 0.5 * d.angle, c = std::sin(0.5 * d.angle) / (0.5 * d.angle);
  X_WF.p = n.X_WN * (d.bend_radius * Vec3(std::cos(psi) - c, std::sin(psi), 0.0));
  X_WF.q = n.X_WN.q * Quat(Eigen::AngleAxisd(psi, Vec3::UnitZ()));
  return true;
}

bool SceneEyes::find_thread(const Look& look, Pose& X_WF) const noexcept {
  const Observation& o = observation_;
  const bool on_needle = o.needle.present && o.n_parted > 0;  // of a thread that was cut the piece on the needle is meant
  const int first = on_needle ? o.parted[static_cast<std::size_t>(o.n_parted - 1)] + 1 : o.cut_edge_low + 1, last = o.n_nodes - 1;
  const auto arc = [&](int k) { return o.arc[static_cast<std::size_t>(k)]; };
  if (last <= first) return false;
  const double a = look.from_end ? arc(first) + look.length : arc(last) - look.length;
  if (a < arc(first) || a > arc(last)) return false;
  int k = first;
  while (k + 2 <= last && arc(k + 1) < a) ++k;
  const Vec3 run = o.positions.col(k + 1) - o.positions.col(k);
  if (!(run.norm() > 0.0)) return false;
  X_WF.p = o.positions.col(k) + (a - arc(k)) / (arc(k + 1) - arc(k)) * run;
  X_WF.q = upright(run.normalized());
  return true;
}

bool SceneEyes::find_pass(const Look& look, Pose& X_WF) const noexcept {
  const TissueObservation& t = observation_.tissue;
  if (look.index >= t.n_passes) return false;
  const PassObservation& p = t.passes[static_cast<std::size_t>(look.index)];
  if (look.kind == Look::Kind::exit && !p.out) return false;
  X_WF = {look.kind == Look::Kind::entry ? p.entry_W : p.exit_W, Quat::Identity()};
  return true;
}

double SceneEyes::felt(int tool) const noexcept {
  return tool >= 0 && tool < observation_.n_tools ? observation_.tools[static_cast<std::size_t>(tool)].f_T_W.norm() : 0.0;
}

bool SceneEyes::find(const Look& look, Pose& X_WF) const noexcept {
  bool found = true;
  switch (look.kind) {
    case Look::Kind::scene: X_WF = {}; break;
    case Look::Kind::needle: found = find_needle(look, X_WF); break;
    case Look::Kind::thread: found = find_thread(look, X_WF); break;
    case Look::Kind::entry:
    case Look::Kind::exit: found = find_pass(look, X_WF); break;
    case Look::Kind::tool:
      found = look.index < observation_.n_tools;
      if (found) X_WF = observation_.tools[static_cast<std::size_t>(look.index)].X_WT;
      break;
  }
  if (found && look.scene_axes) X_WF.q = Quat::Identity();
  return found;
}

}  // namespace filum
