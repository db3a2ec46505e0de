#include "training/knot_invariant.h"

#include <array>
#include <map>
#include <string>

#include "training/exact_predicates.h"

namespace filum {
namespace {

using Edges = std::array<int, 4>;  // counter-clockwise from the incoming lower edge

/// Edge k leads to visit k of the code; the last one leads back to the first.
std::vector<Edges> planar_code(const KnotDiagram& diagram) {
  const int n = static_cast<int>(diagram.code.size());
  std::vector<Edges> crossings(diagram.sign.size());
  for (int k = 0; k < n; ++k) {
    const KnotDiagram::Visit& visit = diagram.code[static_cast<std::size_t>(k)];
    Edges& edges = crossings[static_cast<std::size_t>(visit.crossing)];
    const int in = k, out = (k + 1) % n;
    const bool positive = diagram.sign[static_cast<std::size_t>(visit.crossing)] > 0;
    if (!visit.over) {
      edges[0] = in;
      edges[2] = out;
    } else {
      edges[positive ? 3 : 1] = in;
      edges[positive ? 1 : 3] = out;
    }
  }
  return crossings;
}

/// joined[e] is the open end at the far side of the arcs that end at e, or kClosed.
using Matching = std::string;
constexpr char kClosed = static_cast<char>(0xff);

/// Adds an arc between the ends a and b; true if that closes a loop.
bool join(Matching& joined, int a, int b) {
  const auto at = [&joined](int e) -> char& { return joined[static_cast<std::size_t>(e)]; };
  if (a == b) return true;
  const char far_a = at(a), far_b = at(b);
  if (far_a == kClosed && far_b == kClosed) {
    at(a) = static_cast<char>(b);
    at(b) = static_cast<char>(a);
    return false;
  }
  if (far_a == static_cast<char>(b)) {
    at(a) = at(b) = kClosed;
    return true;
  }
  const char end_a = far_a == kClosed ? static_cast<char>(a) : far_a;
  const char end_b = far_b == kClosed ? static_cast<char>(b) : far_b;
  at(a) = at(b) = kClosed;
  at(static_cast<unsigned char>(end_a)) = end_b;
  at(static_cast<unsigned char>(end_b)) = end_a;
  return false;
}

/// The crossing with most edges already open: keeps the diagram's cut narrow.
std::size_t next_crossing(const std::vector<Edges>& crossings, const std::vector<bool>& done,
                          const std::vector<bool>& open) {
  std::size_t best = 0;
  int best_open = -1;
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    if (done[k]) continue;
    int n_open = 0;
    for (int e : crossings[k]) n_open += open[static_cast<std::size_t>(e)] ? 1 : 0;
    if (n_open > best_open) {
      best = k;
      best_open = n_open;
    }
  }
  return best;
}

/// Kauffman bracket in A, the unknot's being -A^2 - A^-2 (one loop counted).
Laurent bracket(const KnotDiagram& diagram) {
  const std::vector<Edges> crossings = planar_code(diagram);
  const Laurent loop = Laurent(-2, {-1, 0, 0, 0, -1});
  std::vector<bool> done(crossings.size(), false), open(diagram.code.size(), false);
  std::map<Matching, Laurent> states;
  states[Matching(diagram.code.size(), kClosed)] = Laurent::monomial(1, 0);
  for (std::size_t count = 0; count < crossings.size(); ++count) {
    const std::size_t k = next_crossing(crossings, done, open);
    const Edges& x = crossings[k];
    done[k] = true;
    for (int e : x) open[static_cast<std::size_t>(e)] = !open[static_cast<std::size_t>(e)];
    std::map<Matching, Laurent> after;
    for (const auto& [matching, weight] : states) {
      for (const int smoothing : {1, -1}) {
        Matching joined = matching;
        int loops = join(joined, x[0], smoothing > 0 ? x[1] : x[3]) ? 1 : 0;
        loops += join(joined, x[2], smoothing > 0 ? x[3] : x[1]) ? 1 : 0;
        Laurent term = weight.shifted(smoothing);
        for (; loops > 0; --loops) term = term * loop;
        after[joined] += term;
      }
    }
    states = std::move(after);
  }
  return states.begin()->second;
}

constexpr std::int64_t kPrime = 2305843009213693951;  // 2^61 - 1

std::int64_t multiply_mod(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<Int128>(a) * b % kPrime);
}

std::int64_t power_mod(std::int64_t base, std::int64_t exponent) {
  std::int64_t result = 1;
  for (; exponent > 0; exponent >>= 1, base = multiply_mod(base, base)) {
    if ((exponent & 1) != 0) result = multiply_mod(result, base);
  }
  return result;
}

std::int64_t inverse_mod(std::int64_t a) {
  return power_mod(a, kPrime - 2);
}
std::int64_t reduce_mod(std::int64_t a) {
  return ((a % kPrime) + kPrime) % kPrime;
}

using Matrix = std::vector<std::vector<std::int64_t>>;

std::int64_t determinant_mod(Matrix m) {
  const std::size_t n = m.size();
  std::int64_t det = 1;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    while (pivot < n && m[pivot][c] == 0) ++pivot;
    if (pivot == n) return 0;
    if (pivot != c) {
      std::swap(m[pivot], m[c]);
      det = reduce_mod(-det);
    }
    det = multiply_mod(det, m[c][c]);
    const std::int64_t inverse = inverse_mod(m[c][c]);
    for (std::size_t r = c + 1; r < n; ++r) {
      const std::int64_t factor = multiply_mod(m[r][c], inverse);
      if (factor == 0) continue;
      for (std::size_t k = c; k < n; ++k) m[r][k] = reduce_mod(m[r][k] - multiply_mod(factor, m[c][k]));
    }
  }
  return det;
}

/// Arc (from one under-visit to the next) to which each visit belongs or leads.
struct ArcRelation {
  std::size_t over = 0, left = 0, right = 0;  // under-arcs left and right of the over-strand
};

std::vector<ArcRelation> arc_relations(const KnotDiagram& diagram) {
  const std::size_t n = diagram.sign.size();
  std::vector<ArcRelation> relations(n);
  std::size_t arc = 0;  // the arc that holds the start of the code also ends it
  for (const KnotDiagram::Visit& visit : diagram.code) {
    const auto k = static_cast<std::size_t>(visit.crossing);
    if (visit.over) {
      relations[k].over = arc;
      continue;
    }
    const std::size_t next = (arc + 1) % n;
    // A right-handed crossing: the lower strand passes from the right of the upper one to its left.
    relations[k].right = diagram.sign[k] > 0 ? arc : next;
    relations[k].left = diagram.sign[k] > 0 ? next : arc;
    arc = next;
  }
  return relations;
}

/// Minor of the Alexander matrix at the number t.
std::int64_t alexander_value(const std::vector<ArcRelation>& relations, std::int64_t t) {
  const std::size_t n = relations.size();
  Matrix m(n, std::vector<std::int64_t>(n, 0));
  for (std::size_t k = 0; k < n; ++k) {
    const ArcRelation& r = relations[k];
    m[k][r.over] = reduce_mod(m[k][r.over] + 1 - t);
    m[k][r.left] = reduce_mod(m[k][r.left] + t);
    m[k][r.right] = reduce_mod(m[k][r.right] - 1);
  }
  m.pop_back();
  for (auto& row : m) row.pop_back();
  return determinant_mod(std::move(m));
}

/// Coefficients of the polynomial of degree < values.size() with the given values at 0, 1, 2, ... (Newton).
std::vector<std::int64_t> interpolate(std::vector<std::int64_t> values) {
  const std::size_t n = values.size();
  for (std::size_t level = 1; level < n; ++level) {
    const std::int64_t inverse = inverse_mod(static_cast<std::int64_t>(level));
    for (std::size_t k = n - 1; k >= level; --k) {
      values[k] = multiply_mod(reduce_mod(values[k] - values[k - 1]), inverse);
    }
  }
  std::vector<std::int64_t> poly(n, 0);
  for (std::size_t level = n; level-- > 0;) {
    for (std::size_t k = n - 1; k > 0; --k) {
      poly[k] = reduce_mod(poly[k - 1] - multiply_mod(poly[k], static_cast<std::int64_t>(level)));
    }
    poly[0] = reduce_mod(values[level] - multiply_mod(poly[0], static_cast<std::int64_t>(level)));
  }
  return poly;
}

}  // namespace

Laurent jones_polynomial(const KnotDiagram& diagram) {
  if (diagram.crossings() == 0) return Laurent::monomial(1, 0);
  if (diagram.crossings() > kMaxCrossings) return {};
  const Laurent one_loop_less = bracket(diagram).divided(Laurent(-2, {-1, 0, 0, 0, -1}));
  const int writhe = diagram.writhe();
  const Laurent in_a = one_loop_less.shifted(-3 * writhe) * Laurent::monomial(writhe % 2 == 0 ? 1 : -1, 0);
  Laurent result;
  for (int power = in_a.low(); power <= in_a.high(); ++power) {
    if (in_a.at(power) != 0) result += Laurent::monomial(in_a.at(power), -power / 4);
  }
  return result;
}

Laurent alexander_polynomial(const KnotDiagram& diagram) {
  if (diagram.crossings() < 2) return Laurent::monomial(1, 0);
  if (diagram.crossings() > kMaxCrossings) return {};
  const std::vector<ArcRelation> relations = arc_relations(diagram);
  std::vector<std::int64_t> values;
  for (int t = 0; t <= diagram.crossings(); ++t) values.push_back(alexander_value(relations, t));
  std::vector<std::int64_t> coefficients = interpolate(std::move(values));
  std::int64_t sum = 0;
  for (std::int64_t& c : coefficients) {
    if (c > kPrime / 2) c -= kPrime;
    sum += c;
  }
  const Laurent raw(0, std::move(coefficients));
  return raw.shifted(-raw.low()) * Laurent::monomial(sum < 0 ? -1 : 1, 0);
}

Laurent jones_torus(int k) {
  const int size = k < 0 ? -k : k;
  // t^((k-1)/2) (1 - t^3 - t^(k+1) + t^(k+2)) / (1 - t^2)
  Laurent numerator = Laurent::monomial(1, 0);
  numerator += Laurent::monomial(-1, 3);
  numerator += Laurent::monomial(-1, size + 1);
  numerator += Laurent::monomial(1, size + 2);
  const Laurent right = numerator.divided(Laurent(0, {1, 0, -1})).shifted((size - 1) / 2);
  return k > 0 ? right : right.mirrored();
}

}  // namespace filum
