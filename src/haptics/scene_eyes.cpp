#include "haptics/scene_eyes.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

double distance_to_edge(const Vec3& p, const Vec3& a, const Vec3& b) noexcept {
  const double square = (b - a).squaredNorm();
  const double share = square > 0.0 ? std::clamp((p - a).dot(b - a) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * (b - a)).norm();
}

/// Vertices of the outer rim of the cut of the stump on one side (-1, 1) of a vessel that is cut across, in turn; empty where there is none.
std::vector<int> outer_rim(const TissueDescription& t, double side) {
  std::vector<int> rim;
  if (!t.lumen || !t.edges[0].rim.empty()) return rim;
  const Vec3 across = t.axis.unitOrthogonal(), third = t.axis.cross(across);
  const auto from_cut = [&](int k) { return side * t.axis.dot(t.rest.col(k) - t.middle); };
  const auto off_axis = [&](int k) -> Vec3 { return t.rest.col(k) - t.middle - t.axis.dot(t.rest.col(k) - t.middle) * t.axis; };
  const auto turn = [&](int k) { return std::atan2(off_axis(k).dot(third), off_axis(k).dot(across)); };
  double nearest = std::numeric_limits<double>::infinity(), widest = 0.0;
  for (int k = 0; k < t.rest.cols(); ++k)
    if (from_cut(k) > 0.0) nearest = std::min(nearest, from_cut(k));
  const auto on_cut = [&](int k) { return from_cut(k) > 0.0 && from_cut(k) < nearest + 1e-6; };
  for (int k = 0; k < t.rest.cols(); ++k)
    if (on_cut(k)) widest = std::max(widest, off_axis(k).norm());
  for (int k = 0; k < t.rest.cols(); ++k)
    if (on_cut(k) && off_axis(k).norm() > widest - 0.2 * t.thickness) rim.push_back(k);
  std::sort(rim.begin(), rim.end(), [&](int a, int b) { return turn(a) < turn(b); });
  return rim;
}

}  // namespace

SceneEyes::SceneEyes(const Observation& observation, const SceneDescription& scene) : observation_(observation), scene_(scene) {
  for (std::size_t side = 0; side < rims_.size(); ++side) rims_[side] = outer_rim(scene.tissue, side == 0 ? -1.0 : 1.0);
}

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

/// Nodes of the thread that is being worked with: of one that was cut the piece on the needle.
SceneEyes::Piece SceneEyes::piece() const noexcept {
  const Observation& o = observation_;
  const bool on_needle = o.needle.present && o.n_parted > 0;
  return {on_needle ? o.parted[static_cast<std::size_t>(o.n_parted - 1)] + 1 : o.cut_edge_low + 1, o.n_nodes - 1};
}

/// At material coordinate `a` [m] of the piece.
bool SceneEyes::find_arc(const Piece& piece, double a, Pose& X_WF) const noexcept {
  const Observation& o = observation_;
  const auto [first, last] = piece;
  const auto arc = [&](int k) { return o.arc[static_cast<std::size_t>(k)]; };
  if (last <= first || a < arc(first) || a > arc(last)) return false;
  int k = first;
  while (k + 2 <= last && arc(k + 1) < a) ++k;
  const Vec3 run = o.positions.col(k + 1) - o.positions.col(k);
  if (!(run.norm() > 0.0)) return false;
  X_WF.p = o.positions.col(k) + (a - arc(k)) / (arc(k + 1) - arc(k)) * run;
  X_WF.q = upright(run.normalized());
  return true;
}

bool SceneEyes::find_thread(const Look& look, Pose& X_WF) const noexcept {
  const Piece p = piece();
  if (p.last <= p.first) return false;
  const auto arc = [&](int k) { return observation_.arc[static_cast<std::size_t>(k)]; };
  return find_arc(p, look.from_end ? arc(p.first) + look.length : arc(p.last) - look.length, X_WF);
}

/// The knot begins where the strand first comes near another part of the same thread; seen from the end that is asked for.
bool SceneEyes::find_knot(const Look& look, Pose& X_WF) const noexcept {
  const Observation& o = observation_;
  const Piece p = piece();
  const auto arc = [&](int k) { return o.arc[static_cast<std::size_t>(k)]; };
  const double near = 3.0 * o.radius, apart = 20.0 * o.radius;  // 1.5 diameters; 10 diameters along the thread
  const auto meets = [&](int k) {
    for (int j = p.first; j < p.last; ++j)
      if ((arc(j) > arc(k) + apart || arc(j + 1) < arc(k) - apart) && distance_to_edge(o.positions.col(k), o.positions.col(j), o.positions.col(j + 1)) < near) return true;
    return false;
  };
  for (int i = 0; i <= p.last - p.first; ++i) {
    const int k = look.from_end ? p.first + i : p.last - i;
    if (meets(k)) return find_arc(p, arc(k) + (look.from_end ? -look.length : look.length), X_WF);
  }
  return false;
}

bool SceneEyes::find_pass(const Look& look, Pose& X_WF) const noexcept {
  const TissueObservation& t = observation_.tissue;
  if (look.index >= t.n_passes) return false;
  const PassObservation& p = t.passes[static_cast<std::size_t>(look.index)];
  if (look.kind == Look::Kind::exit && !p.out) return false;
  X_WF = {look.kind == Look::Kind::entry ? p.entry_W : p.exit_W, Quat::Identity()};
  return true;
}

/// The rim as a closed line of straight pieces, cut by the upright plane through the vessel's axis.
bool SceneEyes::find_edge(const Look& look, Pose& X_WF) const noexcept {
  const std::vector<int>& rim = rims_[static_cast<std::size_t>(look.index)];
  const TissueDescription& t = scene_.tissue;
  const Points& x = observation_.tissue.positions;
  const Vec3 normal = t.axis.cross(Vec3::UnitZ());
  bool found = false;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const Vec3 a = x.col(rim[k]), b = x.col(rim[(k + 1) % rim.size()]);
    const double da = normal.dot(a - t.middle), db = normal.dot(b - t.middle);
    if ((da < 0.0) == (db < 0.0)) continue;
    const Vec3 p = a + da / (da - db) * (b - a);
    if (found && p.z() <= X_WF.p.z()) continue;
    found = true;
    X_WF = {p, Quat::Identity()};
  }
  return found;
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
    case Look::Kind::knot: found = find_knot(look, X_WF); break;
    case Look::Kind::entry:
    case Look::Kind::exit: found = find_pass(look, X_WF); break;
    case Look::Kind::edge: found = find_edge(look, X_WF); break;
    case Look::Kind::tool:
      found = look.index < observation_.n_tools;
      if (found) X_WF = observation_.tools[static_cast<std::size_t>(look.index)].X_WT;
      break;
  }
  if (found && look.scene_axes) X_WF.q = Quat::Identity();
  return found;
}

}  // namespace filum
