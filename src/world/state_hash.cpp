#include "world/state_hash.h"

#include <algorithm>
#include <array>

#include "base/hash.h"
#include "world/brain_scene.h"
#include "world/vessel_scene.h"

namespace filum {
namespace {

template <class Matrix>
std::uint64_t hash_columns(const Matrix& m, int n) noexcept {
  return hash_bytes(m.data(), sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(m.rows() * n));
}

std::uint64_t hash_values(const Eigen::VectorXd& v, int n) noexcept {
  return hash_bytes(v.data(), sizeof(double) * static_cast<std::size_t>(n));
}

std::uint64_t hash_bristles(const std::vector<ContactBristle>& bristles) noexcept {
  std::uint64_t h = bristles.size();
  for (const ContactBristle& b : bristles) {
    const std::array<double, 5> row = {static_cast<double>(b.i), static_cast<double>(b.j), b.xi.x(), b.xi.y(), b.xi.z()};
    h = hash_bytes(row.data(), sizeof(row), h);
  }
  return h;
}

std::uint64_t hash_grasps(const std::vector<GraspPoint>& grasps) noexcept {
  std::uint64_t h = grasps.size();
  for (const GraspPoint& g : grasps) {
    const std::array<double, 5> row = {static_cast<double>(g.tool), g.arc, g.anchor_T.x(), g.anchor_T.y(), g.anchor_T.z()};
    h = hash_bytes(row.data(), sizeof(row), h);
  }
  return h;
}

std::uint64_t hash_pose(const Pose& X, std::uint64_t h) noexcept {
  h = hash_bytes(X.p.data(), 3 * sizeof(double), h);
  return hash_bytes(X.q.coeffs().data(), 4 * sizeof(double), h);
}

std::uint64_t hash_instruments(const State& s) noexcept {
  std::uint64_t h = 0;
  for (const InstrumentState& i : s.instruments) {
    h = hash_pose(i.X_WD, hash_pose(i.X_WT, h));
    h = hash_bytes(i.w.data(), 3 * sizeof(double), hash_bytes(i.v.data(), 3 * sizeof(double), h));
    const std::array<double, 4> row = {i.angle, i.angle_rate, i.grip_force, i.grip_command};
    h = hash_bytes(row.data(), sizeof(row), h);
  }
  return h;
}

std::uint64_t hash_wrenches(const State& s) noexcept {
  std::uint64_t h = 0;
  for (std::size_t i = 0; i < s.force.size(); ++i)
    h = hash_bytes(s.torque[i].data(), 3 * sizeof(double), hash_bytes(s.force[i].data(), 3 * sizeof(double), h));
  return h;
}

/// Scenes without objects keep the hash of their instruments.
std::uint64_t hash_pellets(const State& s, std::uint64_t h) noexcept {
  for (const PelletState& p : s.pellets) {
    for (const Vec3* v : {&p.p, &p.v, &p.anchor_T}) h = hash_bytes(v->data(), 3 * sizeof(double), h);
    const std::array<std::int32_t, 4> row = {p.holder, p.stuck, p.broken, p.escaped};
    h = hash_bytes(row.data(), sizeof(row), h);
  }
  return h;
}

std::uint64_t hash_needle(const NeedleState& n) noexcept {
  std::uint64_t h = hash_pose(n.X_WN, 0);
  for (const Vec3* v : {&n.v, &n.w, &n.pull}) h = hash_bytes(v->data(), 3 * sizeof(double), h);
  for (const NeedleGrip& g : n.grips) {
    const std::array<double, 4> row = {static_cast<double>(g.held), g.arc, g.half, g.roll};
    h = hash_bytes(row.data(), sizeof(row), h);
    for (const Vec3& a : g.anchor_T) h = hash_bytes(a.data(), 3 * sizeof(double), h);
  }
  return hash_bytes(n.sheet_bristle.data(), sizeof(double) * static_cast<std::size_t>(n.sheet_bristle.size()), h);
}

std::uint64_t hash_flags(const State& s) noexcept {
  const std::array<double, 5> row = {s.thread.arc_start, s.overloaded, s.cut_low, s.cut_high, s.break_arc};
  std::uint64_t h = hash_bytes(row.data(), sizeof(row), s.step);
  h = hash_bytes(s.armed.data(), sizeof(s.armed), h);
  return hash_bytes(s.valid.data(), sizeof(s.valid), h);
}

constexpr int kArrays = 15;
constexpr std::array<const char*, kArrays> kNames = {
    "positions",  "velocities", "theta",  "theta_dot",    "directors",        "ref_twist", "rest_length", "rest_kappa",
    "rest_twist", "alive",      "grasps", "self_bristles", "obstacle_bristles", "instruments", "flags"};

std::array<std::uint64_t, kArrays> hashes(const State& s) noexcept {
  const RodState& r = s.thread;
  const int edges = std::max(0, r.n - 1);
  return {hash_columns(r.x, r.n),
          hash_columns(r.v, r.n),
          hash_values(r.theta, r.n),
          hash_values(r.theta_dot, r.n),
          hash_columns(r.d1, edges),
          hash_values(r.ref_twist, r.n),
          hash_values(r.rest_length, edges),
          hash_columns(r.rest_kappa, r.n),
          hash_values(r.rest_twist, r.n),
          hash_bytes(r.alive.data(), sizeof(int) * static_cast<std::size_t>(edges)),
          hash_grasps(s.memory.grasps),
          hash_bristles(s.memory.self),
          hash_bristles(s.memory.obstacle),
          hash_pellets(s, hash_wrenches(s) ^ hash_instruments(s)),
          hash_flags(s)};
}

}  // namespace

std::uint64_t hash_state(const State& s) noexcept {
  const auto all = hashes(s);
  std::uint64_t h = hash_bytes(all.data(), sizeof(all));
  if (s.has_needle != 0) {
    const std::uint64_t needle = hash_needle(s.needle);
    h = hash_bytes(&needle, sizeof needle, h);
    const std::uint64_t tissue = hash_vessel(s.tissue);
    h = hash_bytes(&tissue, sizeof tissue, h);
  }
  if (s.sutures.taken != 1 || s.sutures.down != 0) h = hash_bytes(&s.sutures, sizeof s.sutures, h);  // else as it was before there were any
  if (s.brain.blades.empty()) return h;
  for (const auto& [name, hash] : brain_hashes(s.brain)) h = hash_bytes(&hash, sizeof hash, h);
  return h;
}

std::vector<std::pair<std::string, std::uint64_t>> array_hashes(const State& s) {
  const auto all = hashes(s);
  std::vector<std::pair<std::string, std::uint64_t>> named;
  for (std::size_t k = 0; k < kArrays; ++k) named.emplace_back(kNames[k], all[k]);
  if (s.has_needle != 0) {
    named.emplace_back("needle", hash_needle(s.needle));
    named.emplace_back("tissue", hash_vessel(s.tissue));
  }
  if (s.sutures.taken != 1 || s.sutures.down != 0) named.emplace_back("sutures", hash_bytes(&s.sutures, sizeof s.sutures));
  if (!s.brain.blades.empty())
    for (const auto& [name, hash] : brain_hashes(s.brain)) named.emplace_back(name, hash);
  return named;
}

}  // namespace filum
