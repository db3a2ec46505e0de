#include "physics/rod_pieces.h"

#include <algorithm>

namespace filum {
namespace {

/// Column `from` of everything that a node and the edge behind it have becomes column `to` of `t`.
void copy_column(const RodState& s, int from, RodState& t, int to) noexcept {
  t.x.col(to) = s.x.col(from);
  t.v.col(to) = s.v.col(from);
  t.d1.col(to) = s.d1.col(from);
  t.rest_kappa.col(to) = s.rest_kappa.col(from);
  t.theta[to] = s.theta[from];
  t.theta_dot[to] = s.theta_dot[from];
  t.ref_twist[to] = s.ref_twist[from];
  t.rest_length[to] = s.rest_length[from];
  t.rest_twist[to] = s.rest_twist[from];
  t.alive[to] = s.alive[from];
}

/// A parted edge lies between other nodes than before: its directors are carried on from there. It bears nothing.
void lay_parted(RodState& s, int edge) noexcept {
  const Vec3 t = (s.x.col(edge + 1) - s.x.col(edge)).normalized(), d = s.d1.col(edge) - s.d1.col(edge).dot(t) * t;
  s.d1.col(edge) = d.norm() > 0.1 ? Vec3(d.normalized()) : t.unitOrthogonal();
  s.theta_dot[edge] = 0.0;
  s.ref_twist[edge] = s.ref_twist[edge + 1] = 0.0;
  s.alive[edge] = 0;
}

/// `both`: the other edge is of the thread, too.
void forget_edges(std::vector<ContactBristle>& bristles, int first, int n, bool both) noexcept {
  const auto in = [&](int edge) { return edge >= first && edge < first + n; };
  std::erase_if(bristles, [&](const ContactBristle& b) { return in(b.i) || (both && in(b.j)); });
  for (ContactBristle& b : bristles) {
    if (b.i >= first) b.i -= n;
    if (both && b.j >= first) b.j -= n;
  }
}

}  // namespace

RodPiece piece_from(const RodState& s, int first) noexcept {
  RodPiece p{first, first};
  while (p.last + 1 < s.n && s.alive[p.last] != 0) ++p.last;
  return p;
}

RodPiece piece_to(const RodState& s, int last) noexcept {
  RodPiece p{last, last};
  while (p.first > 0 && s.alive[p.first - 1] != 0) --p.first;
  return p;
}

double arc_of_node(const RodState& s, int node) noexcept { return s.arc_start + s.rest_length.head(node).sum(); }

double arc_of_end(const RodState& s) noexcept { return s.n > 0 ? arc_of_node(s, s.n - 1) : 0.0; }

ArcChange take_out(const RodPiece& p, RodState& s, RodMemory& memory) noexcept {
  const int n = p.last + 1 - p.first;
  const bool last = p.last + 1 == s.n;
  ArcChange c;
  c.low = arc_of_node(s, p.first);
  c.high = arc_of_node(s, last ? p.last : p.last + 1);
  if (p.first == 0) s.arc_start = c.high;
  else c.by = c.high - c.low;
  for (int k = p.last + 1; k < s.n; ++k) copy_column(s, k, s, k - n);
  s.n -= n;
  forget_edges(memory.self, p.first, n, true);
  forget_edges(memory.obstacle, p.first, n, false);
  if (p.first > 0 && !last) lay_parted(s, p.first - 1);
  return c;
}

void join_on(const RodState& piece, RodState& s) noexcept {
  const int first = s.n;
  for (int k = 0; k < piece.n; ++k) copy_column(piece, k, s, first + k);
  s.n += piece.n;
  if (first > 0) lay_parted(s, first - 1);
  else s.arc_start = piece.arc_start;
}

}  // namespace filum
