#include "physics/rod_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

#include "base/stage_clock.h"
#include "collision/segment_distance.h"

namespace filum {
namespace {

constexpr double kJoin = 2.5;  // [radii], distance of the axes below which a pair takes part in the matrix
constexpr int kChunk = 8;  // edges in one box of the broad phase

struct Weights {
  int node[4];
  double w[4];
};

Weights weights(const RodPair& p) noexcept {
  return {{p.i, p.i + 1, p.j, p.j + 1}, {1.0 - p.s, p.s, -(1.0 - p.t), -p.t}};
}

SegmentPair closest(const Points& x, int i, int j) noexcept { return closest_points(x.col(i), x.col(i + 1), x.col(j), x.col(j + 1)); }

SegmentPair pressed(const Points& x, int i, int j, double radius) noexcept {
  return pressed_points(x.col(i), x.col(i + 1), x.col(j), x.col(j + 1), push_spread(2.0 * radius, radius));
}

/// Bristle of the step so far: start value plus relative displacement, in the tangent plane.
Vec3 trial_bristle(const RodPair& p, const Points& x, const Points& x_start) noexcept {
  const Weights w = weights(p);
  Vec3 xi = p.xi_start;
  for (int k = 0; k < 4; ++k) xi += w.w[k] * (x.col(w.node[k]) - x_start.col(w.node[k]));
  return xi - xi.dot(p.normal) * p.normal;
}

/// Two boxes have no point in common.
template <class Corner>
bool apart(const Corner& low_a, const Corner& high_a, const Corner& low_b, const Corner& high_b) noexcept {
  using Quad = double __attribute__((vector_size(32)));
  using QuadBits = std::int64_t __attribute__((vector_size(32)));
  const auto load = [](const Corner& c) {
    Quad q;
    std::memcpy(&q, c.data(), sizeof q);
    return q;
  };
  const QuadBits beyond = (load(low_a) > load(high_b)) | (load(low_b) > load(high_a));
  return (beyond[0] | beyond[1] | beyond[2] | beyond[3]) != 0;
}

}  // namespace

PairPotential squeeze(double overlap, double radius, double stiffness) noexcept {
  if (overlap <= 0.0) return {0, 0, 0};
  const double force = stiffness * overlap * std::sqrt(overlap / (0.6 * radius));
  return {0.4 * force * overlap, -force, 1.5 * force / overlap};
}

PairPotential pair_potential(double distance, double radius, double stiffness) noexcept {
  PairPotential r = squeeze(2.0 * radius - distance, radius, stiffness);
  if (distance < radius) {
    const double q = distance / radius, c = distance - radius, log = std::log(q);
    r.energy -= stiffness * c * c * log;
    r.slope -= stiffness * (2.0 * c * log + c * c / distance);
    r.curvature -= stiffness * (2.0 * log + 4.0 * c / distance - c * c / (distance * distance));
  }
  return r;
}

double conservative_advance(const Vec3 ends[4], const Vec3 moves[4], double keep) noexcept {
  double speed = 0.0;  // no two points of the segments approach faster than their fastest pair of ends
  for (int a = 0; a < 2; ++a)
    for (int b = 2; b < 4; ++b) speed = std::max(speed, (moves[a] - moves[b]).norm());
  if (speed == 0.0) return 1.0;
  double fraction = 0.0, first_room = 0.0;
  for (int k = 0; k < 32; ++k) {
    Vec3 p[4];
    for (int e = 0; e < 4; ++e) p[e] = ends[e] + fraction * moves[e];
    const double room = closest_points(p[0], p[1], p[2], p[3]).distance - keep;
    if (k == 0) first_room = room;
    if (room < 0.05 * first_room) break;
    fraction += 0.98 * room / speed;
    if (fraction >= 1.0) return 1.0;
  }
  return fraction;
}

RodContact::RodContact(int node_capacity, int pair_capacity)
    : travel(node_capacity), edge_low_(Eigen::Matrix4Xd::Zero(4, node_capacity)), edge_high_(edge_low_),
      low_(Eigen::Matrix4Xd::Zero(4, node_capacity / kChunk + 1)), high_(low_) {
  pairs_.reserve(static_cast<std::size_t>(pair_capacity));
  known_.reserve(static_cast<std::size_t>(pair_capacity));
  arc_.reserve(static_cast<std::size_t>(node_capacity));
  near_chunks_.reserve(static_cast<std::size_t>(low_.cols()));
}

void RodContact::box_edges(const RodState& s, const Points& x, double radius) noexcept {
  const int edges = s.n - 1;
  arc_.assign(1, 0.0);
  for (int j = 0; j < edges; ++j) {
    arc_.push_back(arc_.back() + s.rest_length[j]);
    const double room = radius + travel.reach[j];
    edge_low_.col(j).head<3>() = x.col(j).cwiseMin(x.col(j + 1)).array() - room;
    edge_high_.col(j).head<3>() = x.col(j).cwiseMax(x.col(j + 1)).array() + room;
  }
  for (int begin = 0; begin < edges; begin += kChunk) {
    const int count = std::min(kChunk, edges - begin);
    low_.col(begin / kChunk) = edge_low_.middleCols(begin, count).rowwise().minCoeff();
    high_.col(begin / kChunk) = edge_high_.middleCols(begin, count).rowwise().maxCoeff();
  }
}

void RodContact::find_pairs(const RodState& s, const Points& x, double radius) noexcept {
  std::swap(pairs_, known_);
  pairs_.clear();
  travel.start(s.n);
  overflowed_ = false;
  box_edges(s, x, radius);
  const int edges = s.n - 1, chunks = (edges + kChunk - 1) / kChunk;
  for (int a = 0; a < chunks; ++a) {
    near_chunks_.clear();
    for (int b = a; b < chunks; ++b)
      if (!apart(low_.col(a), high_.col(a), low_.col(b), high_.col(b))) near_chunks_.push_back(b);
    for (int i = a * kChunk; i < std::min(edges, (a + 1) * kChunk); ++i) {
      if (s.alive[i] == 0) continue;
      for (const int b : near_chunks_)
        if (!apart(edge_low_.col(i), edge_high_.col(i), low_.col(b), high_.col(b))) find_partners(s, x, radius, i, b);
    }
  }
  keep_loads();
  pattern_stale_ = true;
}

/// Pairs of edge i with later ones of a chunk.
void RodContact::find_partners(const RodState& s, const Points& x, double radius, int i, int chunk) noexcept {
  for (int j = std::max(i + 2, chunk * kChunk); j < std::min(s.n - 1, (chunk + 1) * kChunk); ++j) {
    if (apart(edge_low_.col(i), edge_high_.col(i), edge_low_.col(j), edge_high_.col(j))) continue;
    if (arc_[j] - arc_[i + 1] < 4.0 * radius || s.alive[j] == 0) continue;
    const double distance = closest(x, i, j).distance;
    if (distance > 2.0 * radius + travel.reach[i] + travel.reach[j]) continue;
    if (pairs_.size() == pairs_.capacity()) {
      overflowed_ = true;
      return;
    }
    RodPair& p = pairs_.emplace_back();
    p.i = i;
    p.j = j;
    p.distance = distance;
    p.joined = distance < kJoin * radius;
  }
}

void RodContact::keep_loads() noexcept {
  auto q = known_.begin();  // both are sorted by (i, j)
  for (RodPair& p : pairs_) {
    while (q != known_.end() && std::tie(q->i, q->j) < std::tie(p.i, p.j)) ++q;
    p.load = q != known_.end() && q->i == p.i && q->j == p.j ? q->load : 0.0;
  }
}

void RodContact::connect(BlockCholesky& matrix) noexcept {
  connected_ = n_joined();
  for (const RodPair& p : pairs_) {
    if (!p.joined) continue;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) matrix.connect(p.i + a, p.j + b);
  }
}

void RodContact::join(RodPair& p, bool touches) noexcept {
  if (!touches || p.in_matrix()) return;
  p.joined = pattern_stale_ = true;
}

bool RodContact::find_slots(const BlockCholesky& matrix) noexcept {
  bool all = true;
  for (RodPair& p : pairs_) {
    if (!p.joined) continue;
    bool there = true;
    for (int k = 0; k < 4 && there; ++k) {
      p.slots[k] = matrix.find(p.i + k / 2, p.j + k % 2);
      there = p.slots[k].index >= 0;
    }
    if (!there) p.slots[0] = {};
    all = all && (there || p.force <= 0.0);
  }
  pattern_stale_ = !all;
  return all && connected_ <= 2 * n_joined() + 16;  // what left again costs fill
}

void RodContact::recall(const std::vector<ContactBristle>& memory) noexcept {
  auto b = memory.begin();  // both are sorted by (i, j)
  for (RodPair& p : pairs_) {
    while (b != memory.end() && std::tie(b->i, b->j) < std::tie(p.i, p.j)) ++b;
    p.xi_start = b != memory.end() && b->i == p.i && b->j == p.j ? b->xi : Vec3(Vec3::Zero());
  }
}

void RodContact::remember(std::vector<ContactBristle>& memory) const noexcept {
  memory.clear();
  for (const RodPair& p : pairs_) {
    if (p.force <= 0.0 || memory.size() == memory.capacity()) continue;
    memory.push_back({p.i, p.j, p.friction.xi, p.force});
  }
}

void RodContact::update(const Points& x, double radius, const ContactMaterial& m, FrictionLoad load) noexcept {
  const StageScope stage("contact laws");
  for (RodPair& p : pairs_) {
    if (at_least(p) > 2.0 * radius) {
      p.force = p.load = 0.0;
      continue;
    }
    const SegmentPair c = pressed(x, p.i, p.j, radius);
    p.s = c.s;
    p.t = c.t;
    p.distance = c.distance;
    p.measured_at = gone(p);
    const double length = c.d.norm();
    p.normal = c.d / length;
    p.force = -pair_potential(c.distance, radius, m.stiffness).slope * length / c.distance;
    p.load = friction_load(load, p.load, p.force);
    join(p, p.force > 0.0);
  }
}

double RodContact::energy(const Points& x, const Points& x_start, double radius, const ContactMaterial& m, double fraction) const noexcept {
  double u = 0.0;
  for (const RodPair& p : pairs_) {
    if (at_least(p) - fraction * stride(p) > 2.0 * radius) continue;
    u += pair_potential(pressed(x, p.i, p.j, radius).distance, radius, m.stiffness).energy;
    if (p.force > 0.0) u += coulomb(trial_bristle(p, x, x_start), p.normal, p.load, m.friction, m.stick(m.friction, p.load)).energy;
  }
  return u;
}

void RodContact::add_gradient(const Points& x, const Points& x_start, const ContactMaterial& m,
                              Eigen::Matrix4Xd& gradient) noexcept {
  for (RodPair& p : pairs_) {
    if (p.force <= 0.0) continue;
    p.trial = trial_bristle(p, x, x_start);
    p.friction = coulomb(p.trial, p.normal, p.load, m.friction, m.stick(m.friction, p.load));
    const Vec3 force = p.force * p.normal + p.friction.force;  // on the first edge
    const Weights w = weights(p);
    for (int a = 0; a < 4; ++a) gradient.col(w.node[a]).head<3>() -= w.w[a] * force;
  }
}

void RodContact::add_stiffness(const Points& x, double radius, const ContactMaterial& m, const ChainSlots& chain,
                               BlockCholesky& matrix) const noexcept {
  for (const RodPair& p : pairs_) {
    if (p.force <= 0.0) continue;
    const double curvature = pair_potential(p.distance, radius, m.stiffness).curvature;
    const Mat3 k = curvature * p.normal * p.normal.transpose() + p.friction.stiffness;
    add_block(p, k, chain, matrix);
    add_turn(p, x, radius, chain, matrix);
  }
}

/// Turning an edge about the point where it touches brings the axes closer by distance (1 - cos), and moves that point; a pushing force opposes it.
/// That is the positive part of the second derivative of the distance: -phi'/D K A^-1 K^T, with A that of the (s, t) which are free to move
/// in pressed_points, K how d turns with each edge.
void RodContact::add_turn(const RodPair& p, const Points& x, double radius, const ChainSlots& chain, BlockCholesky& matrix) const noexcept {
  const bool free_s = p.s > 0.0 && p.s < 1.0, free_t = p.t > 0.0 && p.t < 1.0;
  if (!free_s && !free_t) return;
  const Vec3 u = x.col(p.i + 1) - x.col(p.i), v = x.col(p.j + 1) - x.col(p.j);
  const double spread2 = push_spread(2.0 * radius, radius), a = u.squaredNorm() + spread2, e = v.squaredNorm() + spread2;
  const double b = free_s && free_t ? u.dot(v) : 0.0;
  const Mat3 scale = p.force * p.distance / (a * e - b * b) * p.normal * p.normal.transpose();
  const auto turn = [&](int edge, const Mat3& stiffness) {
    matrix.add_diagonal(edge, pad(stiffness));
    matrix.add_diagonal(edge + 1, pad(stiffness));
    matrix.add(chain.next[edge], pad(-stiffness));
  };
  if (free_s) turn(p.i, e * scale);
  if (free_t) turn(p.j, a * scale);
  if (b == 0.0) return;
  for (int k = 0; k < 4; ++k) matrix.add(p.slots[k], pad((k == 1 || k == 2 ? b : -b) * scale));
}

void RodContact::add_block(const RodPair& p, const Mat3& k, const ChainSlots& chain, BlockCholesky& matrix) const noexcept {
  const Weights w = weights(p);
  for (int a = 0; a < 4; ++a) matrix.add_diagonal(w.node[a], pad(w.w[a] * w.w[a] * k));
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) matrix.add(p.slots[2 * a + b], pad(w.w[a] * w.w[2 + b] * k));
  matrix.add(chain.next[p.i], pad(w.w[0] * w.w[1] * k));
  matrix.add(chain.next[p.j], pad(w.w[2] * w.w[3] * k));
}

double RodContact::free_fraction(const Points& x, const Eigen::Matrix4Xd& move, double radius) const noexcept {
  double fraction = 1.0;
  const auto keep = [&](double distance) { return std::min(1.7 * radius, 0.8 * distance); };
  for (const RodPair& p : pairs_) {
    const auto too_slow = [&](double distance, double approach) {  // to come nearer than allowed
      return approach <= distance - keep(distance);
    };
    if (too_slow(at_least(p), fraction * stride(p))) continue;
    const int node[4] = {p.i, p.i + 1, p.j, p.j + 1};
    Vec3 ends[4], moves[4];
    for (int k = 0; k < 4; ++k) {
      ends[k] = x.col(node[k]);
      moves[k] = fraction * move.col(node[k]).head<3>();
    }
    const double distance = closest_points(ends[0], ends[1], ends[2], ends[3]).distance;
    double fastest = 0.0;
    for (int a = 0; a < 2; ++a)
      for (int b = 2; b < 4; ++b) fastest = std::max(fastest, (moves[a] - moves[b]).norm());
    if (too_slow(distance, fastest)) continue;
    fraction *= conservative_advance(ends, moves, keep(distance));
  }
  return fraction;
}

double RodContact::smallest_distance(const Points& x) const noexcept {
  double d = std::numeric_limits<double>::infinity();
  for (const RodPair& p : pairs_)
    if (at_least(p) < d) d = std::min(d, closest(x, p.i, p.j).distance);
  return d;
}

int RodContact::n_joined() const noexcept {
  return static_cast<int>(std::count_if(pairs_.begin(), pairs_.end(), [](const RodPair& p) { return p.joined; }));
}

int RodContact::n_touching(double radius) const noexcept {
  return static_cast<int>(std::count_if(pairs_.begin(), pairs_.end(), [&](const RodPair& p) { return p.distance < 2.0 * radius; }));
}

}  // namespace filum
