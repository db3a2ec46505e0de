#include "physics/rod_resolution.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>

#include "base/stage_clock.h"

namespace filum {
namespace {

/// Makes room for (shift = +1) or closes up over (shift = -1) column `at` of a per-node or per-edge array.
template <class Array>
void shift_columns(Array& a, int at, int n, int shift) noexcept {
  if (shift > 0)
    for (int k = n; k > at; --k) a.col(k) = a.col(k - 1);
  else
    for (int k = at; k + 1 < n; ++k) a.col(k) = a.col(k + 1);
}

void shift_entries(Eigen::VectorXd& a, int at, int n, int shift) noexcept {
  auto row = a.transpose();
  shift_columns(row, at, n, shift);
}

void shift_all(RodState& s, int node, int edge, int shift) noexcept {
  for (Points* p : {&s.x, &s.v}) shift_columns(*p, node, s.n, shift);
  shift_columns(s.rest_kappa, node, s.n, shift);
  for (Eigen::VectorXd* p : {&s.ref_twist, &s.rest_twist}) shift_entries(*p, node, s.n, shift);
  shift_columns(s.d1, edge, s.n, shift);
  for (Eigen::VectorXd* p : {&s.theta, &s.theta_dot, &s.rest_length}) shift_entries(*p, edge, s.n, shift);
  auto alive = s.alive.transpose();
  shift_columns(alive, edge, s.n, shift);
}

double turn_at(const RodState& s, int i) noexcept {
  if (i <= 0 || i + 1 >= s.n) return 0.0;
  const Vec3 a = s.x.col(i) - s.x.col(i - 1), b = s.x.col(i + 1) - s.x.col(i);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void renumber(std::vector<ContactBristle>& bristles, int edge, int shift, bool both) noexcept {
  for (ContactBristle& b : bristles) {
    if (b.i > edge) b.i += shift;
    if (both && b.j > edge) b.j += shift;
  }
}

/// What is near each edge, by the pairs and touches of the last step: their lists are gone through once for a stretch of edges, not once an edge.
class Near {
 public:
  /// `room` [m]: how near another strand or a body must be to an edge's surface to count.
  Near(const RodContact& contact, const RodObstacles& obstacles, double radius, double room) noexcept
      : contact_(contact), obstacles_(obstacles), radius_(radius), room_(room) {}

  bool touched(int j) noexcept { return mark(j), touched_[static_cast<std::size_t>(j - low_)]; }
  bool any(int j) noexcept { return mark(j), any_[static_cast<std::size_t>(j - low_)]; }

 private:
  static constexpr int kStretch = 512;  // edges

  /// Makes j and the edge behind it part of the stretch, the rest of which lies before: edges are asked about from the far end.
  void mark(int j) noexcept {
    if (j >= low_ && j < low_ + kStretch) return;
    low_ = std::max(0, j + 2 - kStretch);
    touched_.reset();
    any_.reset();
    for (const RodPair& p : contact_.pairs()) {
      const bool presses = p.force > 0.0, near = contact_.at_least(p) < 2.0 * radius_ + room_;
      for (const int edge : {p.i, p.j}) {
        const auto k = static_cast<std::size_t>(edge - low_);
        if (edge < low_ || k >= kStretch) continue;
        if (presses) touched_.set(k);
        if (near) any_.set(k);
      }
    }
    for (const ObstacleTouch& t : obstacles_.touches())
      if (t.edge >= low_ && t.edge < low_ + kStretch && obstacles_.at_least(t, contact_.travel) < room_) any_.set(static_cast<std::size_t>(t.edge - low_));
  }

  const RodContact& contact_;
  const RodObstacles& obstacles_;
  double radius_, room_;
  int low_ = std::numeric_limits<int>::max() - kStretch;
  std::bitset<kStretch> touched_, any_;
};

bool wants_halving(const ResolutionOptions& o, const RodState& s, Near& near, int j) noexcept {
  if (s.alive[j] == 0 || s.rest_length[j] < 2.0 * o.shortest) return false;
  if (std::max(turn_at(s, j), turn_at(s, j + 1)) > o.sharp_turn) return true;
  if (s.rest_length[j] > o.longest * 1.5) return true;
  return s.rest_length[j] > (near.touched(j) ? o.touching_edge : o.longest * 2.0);
}

/// Height [m] of node i above the chord of its neighbours: how far the thread jumps if the node goes.
double height_at(const RodState& s, int i) noexcept {
  const Vec3 chord = s.x.col(i + 1) - s.x.col(i - 1);
  return chord.cross(Vec3(s.x.col(i) - s.x.col(i - 1))).norm() / chord.norm();
}

// With a diameter's room, a jump of less than a radius passes nothing.
bool may_go(const ResolutionOptions& o, const RodState& s, Near& near, double radius, int i) noexcept {
  if (s.alive[i - 1] == 0 || s.alive[i] == 0) return false;
  if (s.rest_length[i - 1] + s.rest_length[i] > o.longest) return false;
  if (turn_at(s, i) > o.slight_turn || turn_at(s, i - 1) + turn_at(s, i) + turn_at(s, i + 1) > 3.0 * o.slight_turn) return false;
  return height_at(s, i) < radius && !near.any(i - 1) && !near.any(i);
}

}  // namespace

void halve_edge(RodState& s, int j) noexcept {
  const Vec3 middle = 0.5 * (s.x.col(j) + s.x.col(j + 1)), velocity = 0.5 * (s.v.col(j) + s.v.col(j + 1));
  const double l = s.rest_length[j];
  const double before = j > 0 ? s.rest_length[j - 1] : 0.0;
  const double after = j + 2 < s.n ? s.rest_length[j + 1] : 0.0;
  // Rest curvature per length at both ends of the edge; the new node takes their mean, the ends what is left of their length.
  const double span_a = 0.5 * (before + l), span_b = 0.5 * (l + after);
  const Eigen::Vector4d density_a = s.rest_kappa.col(j) / span_a, density_b = s.rest_kappa.col(j + 1) / span_b;
  const double twist_a = s.rest_twist[j] / span_a, twist_b = s.rest_twist[j + 1] / span_b;
  shift_all(s, j + 1, j + 1, +1);
  ++s.n;
  s.x.col(j + 1) = middle;
  s.v.col(j + 1) = velocity;
  s.ref_twist[j + 1] = 0.0;
  s.d1.col(j + 1) = s.d1.col(j);
  s.theta[j + 1] = s.theta[j];
  s.theta_dot[j + 1] = s.theta_dot[j];
  s.alive[j + 1] = s.alive[j];
  s.rest_length[j] = s.rest_length[j + 1] = 0.5 * l;
  s.rest_kappa.col(j + 1) = 0.25 * l * (density_a + density_b);
  s.rest_twist[j + 1] = 0.25 * l * (twist_a + twist_b);
  s.rest_kappa.col(j) = density_a * (span_a - 0.25 * l);
  s.rest_kappa.col(j + 2) = density_b * (span_b - 0.25 * l);
  s.rest_twist[j] = twist_a * (span_a - 0.25 * l);
  s.rest_twist[j + 2] = twist_b * (span_b - 0.25 * l);
}

void remove_node(RodState& s, int i) noexcept {
  const double la = s.rest_length[i - 1], lb = s.rest_length[i], share = lb / (la + lb);
  const double twist = s.theta[i] - s.theta[i - 1] + s.ref_twist[i];
  const auto tangent = [&](int a, int b) { return Vec3((s.x.col(b) - s.x.col(a)).normalized()); };
  const Vec3 t = tangent(i - 1, i + 1);
  Vec3 d = parallel_transport(s.d1.col(i - 1), tangent(i - 1, i), t);
  d = (d - d.dot(t) * t).normalized();
  if (i >= 2) s.ref_twist[i - 1] = reference_twist(s.d1.col(i - 2), tangent(i - 2, i - 1), d, t, s.ref_twist[i - 1]);
  if (i + 2 < s.n)
    s.ref_twist[i + 1] = reference_twist(d, t, s.d1.col(i + 1), tangent(i + 1, i + 2), s.ref_twist[i] + s.ref_twist[i + 1]);
  s.rest_kappa.col(i - 1) += (1.0 - share) * s.rest_kappa.col(i);
  s.rest_kappa.col(i + 1) += share * s.rest_kappa.col(i);
  s.rest_twist[i - 1] += (1.0 - share) * s.rest_twist[i];
  s.rest_twist[i + 1] += share * s.rest_twist[i];
  s.d1.col(i - 1) = d;
  s.theta[i - 1] += share * twist;  // the edges' twist stays, shared out by length
  s.theta_dot[i - 1] = (1.0 - share) * s.theta_dot[i - 1] + share * s.theta_dot[i];
  s.rest_length[i - 1] = la + lb;
  shift_all(s, i, i, -1);
  --s.n;
}

int adapt_resolution(const ResolutionOptions& o, int capacity, double radius, const RodContact& contact, const RodObstacles& obstacles,
                     RodState& s, RodMemory& memory) noexcept {
  const StageScope stage("resolution");
  Near near(contact, obstacles, radius, 2.0 * radius);
  int changes = 0;
  // From the far end: a change renumbers only what lies behind it, so the pairs of what is still ahead stay valid.
  for (int j = s.n - 2; j >= 0 && changes < o.most_changes; --j) {
    if (s.n < capacity && wants_halving(o, s, near, j)) {
      halve_edge(s, j);
      renumber(memory.self, j, +1, true);
      renumber(memory.obstacle, j, +1, false);
      ++changes;
    } else if (j >= 1 && s.n > 8 && may_go(o, s, near, radius, j)) {
      remove_node(s, j);
      renumber(memory.self, j - 1, -1, true);
      renumber(memory.obstacle, j - 1, -1, false);
      ++changes;
      --j;  // a neighbour must not go in the same step: two jumps would add up
    }
  }
  return changes;
}

}  // namespace filum
