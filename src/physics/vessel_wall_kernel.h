#pragma once
// Energy and forces of packs of wall elements, in the number format S (Lanes: four elements at a time in double precision, eight or sixteen in
// single). What the lanes share, their stations through the wall and their laws, is in KernelRow; the rest is data of each element. Eight and
// sixteen at a time give the same bits: elements keep their order, and energies are summed by eights.
// Coordinates are taken relative to the element's first corner before they are rounded to N. Test: vessel_wall_element_test.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/pose.h"
#include "physics/hyperelastic.h"

namespace filum {

inline constexpr double kGauss = 0.57735026918962576451;
inline constexpr double kInsideOut = 0.02;  // share of its volume below which an element or a point of it counts as turned inside out
inline constexpr double kCrushed = 0.5;     // share of its signed volume below which an element pushes back, whatever its C says
inline constexpr std::size_t kMostStations = 8;

struct WallStation {     // Gauss points of one zeta
  double zeta, share;    // share: of the element's thickness
  int layer;
};
struct KernelRow {       // elements that fill the same span of the wall
  std::array<double, 2> span;
  std::vector<WallStation> stations;
  double lambda_mean = 0.0;  // [Pa]
};

/// Volume of a hexahedron: sum of weight c_i . (c_j x c_k), c the coefficients of the products (1, xi, eta, xi eta, zeta, ...).
struct VolumeTerm {
  int i, j, k;
  double weight;
};
inline constexpr std::array<VolumeTerm, 4> kVolumeTerms = {{{1, 2, 4, 8.0}, {1, 3, 5, 8.0 / 3.0}, {3, 2, 6, 8.0 / 3.0}, {5, 6, 4, 8.0 / 3.0}}};

template <class S>
class WallKernel {
 public:
  using N = typename S::Number;
  static constexpr int kWidth = S::kWidth;
  struct Point {
    LawGeometry<S> geometry;
    S weight;  // [m3]
  };
  struct Pack {
    int row = 0;
    std::size_t first_point = 0;
    std::array<int, kWidth> element;  // -1: empty lane
    std::array<std::array<int, 8>, kWidth> node;
    S volume;
  };
  std::vector<Pack> packs;
  std::vector<Point> points;

  /// Energy [J] of all packs; forces -dE/dx [N] are added to `force`.
  double add_forces(const std::vector<KernelRow>& rows, const std::vector<LawConstants>& laws, const Points& x, const std::vector<double>& soundness,
                    Points& force) const noexcept;

 private:
  struct Vec {
    S x, y, z;
    friend Vec operator+(const Vec& a, const Vec& b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec operator-(const Vec& a, const Vec& b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec operator*(const S& s, const Vec& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
    void add(const Vec& b) noexcept { *this = *this + b; }
  };
  static S dot(const Vec& a, const Vec& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static Vec cross(const Vec& a, const Vec& b) noexcept { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

  /// The parts of C that are interpolated, as polynomials of xi and eta: C_13 = a0 + a1 eta, C_23 = b0 + b1 xi,
  /// C_33 = r0 + r1 xi + r2 eta + r3 xi eta; or the derivatives of the energy with respect to these coefficients.
  struct Assumed {
    S a0, a1, b0, b1, r0, r1, r2, r3;
    void measure(const Vec* c) noexcept;
    void add_point(const S* T, double xi, double eta) noexcept;
    void spread(const Vec* c, Vec* f) const noexcept;
  };
  /// The four tangents at one zeta: around[eta], along[xi]; or the forces on them.
  struct Tangents {
    Vec around[2], along[2];
    void measure(const Vec* c, double zeta) noexcept;
    void spread(double zeta, Vec* f) const noexcept;
  };

  static void gather(const Pack& pack, const Points& x, Vec* c) noexcept;
  /// Volume of the element by its eight coefficients, and its gradient times `scale` added to f.
  static S volume_of(const Vec* c) noexcept;
  static void press(const Vec* c, const S& scale, Vec* f) noexcept;
  struct PointState {
    S C[6], dJ[6], J;
  };
  /// Volume by the points' J; lowers `least` to the least J.
  static S measure(const Point* point, const KernelRow& row, const Vec* c, PointState* s, S& least) noexcept;
  /// Adds the points' forces, with `pressure` on their J; returns their energy.
  static S stretch(const Point* point, const KernelRow& row, const std::vector<LawConstants>& laws, const Vec* c, const PointState* s, const S& pressure,
                   Vec* f) noexcept;
  static void scatter(const Pack& pack, Vec* f, const S& energy, const S& upright, const std::vector<double>& soundness, Points& force, double& total) noexcept;
  void pack_forces(const Pack& pack, const KernelRow& row, const std::vector<LawConstants>& laws, const Points& x, const std::vector<double>& soundness,
                   Points& force, double& total) const noexcept;
};

template <class S>
void WallKernel<S>::Assumed::measure(const Vec* c) noexcept {
  a0 = dot(c[1], c[4]) + dot(c[3], c[6]);
  a1 = dot(c[1], c[6]) + dot(c[3], c[4]);
  b0 = dot(c[2], c[4]) + dot(c[3], c[5]);
  b1 = dot(c[2], c[5]) + dot(c[3], c[4]);
  r0 = dot(c[4], c[4]);
  r1 = 2.0 * dot(c[4], c[5]);
  r2 = 2.0 * dot(c[4], c[6]);
  r3 = 2.0 * dot(c[4], c[7]);
}

template <class S>
void WallKernel<S>::Assumed::add_point(const S* T, double xi, double eta) noexcept {
  a0 += T[5];
  a1 += eta * T[5];
  b0 += T[4];
  b1 += xi * T[4];
  r0 += T[2];
  r1 += xi * T[2];
  r2 += eta * T[2];
  r3 += (xi * eta) * T[2];
}

template <class S>
void WallKernel<S>::Assumed::spread(const Vec* c, Vec* f) const noexcept {
  const S s0 = 2.0 * r0, s1 = 2.0 * r1, s2 = 2.0 * r2, s3 = 2.0 * r3;
  f[1].add(a0 * c[4] + a1 * c[6]);
  f[2].add(b0 * c[4] + b1 * c[5]);
  f[3].add(a0 * c[6] + a1 * c[4] + b0 * c[5] + b1 * c[4]);
  f[4].add(a0 * c[1] + a1 * c[3] + b0 * c[2] + b1 * c[3] + s0 * c[4] + s1 * c[5] + s2 * c[6] + s3 * c[7]);
  f[5].add(b0 * c[3] + b1 * c[2] + s1 * c[4]);
  f[6].add(a0 * c[3] + a1 * c[1] + s2 * c[4]);
  f[7].add(s3 * c[4]);
}

template <class S>
void WallKernel<S>::Tangents::measure(const Vec* c, double zeta) noexcept {
  const S z(zeta), gauss(kGauss);
  const Vec u = c[1] + z * c[5], v = c[2] + z * c[6], d = gauss * (c[3] + z * c[7]);
  around[0] = u - d;
  around[1] = u + d;
  along[0] = v - d;
  along[1] = v + d;
}

template <class S>
void WallKernel<S>::Tangents::spread(double zeta, Vec* f) const noexcept {
  const S z(zeta);
  const Vec u = around[0] + around[1], v = along[0] + along[1];
  const Vec w = S(kGauss) * ((around[1] - around[0]) + (along[1] - along[0]));
  f[1].add(u);
  f[2].add(v);
  f[3].add(w);
  f[5].add(z * u);
  f[6].add(z * v);
  f[7].add(z * w);
}

/// Coefficients of the eight products of local coordinates (Walsh-Hadamard transform of the corners).
template <class S>
void WallKernel<S>::gather(const Pack& pack, const Points& x, Vec* c) noexcept {
  const double* base[kWidth];
  for (std::size_t l = 0; l < kWidth; ++l) base[l] = x.data() + 3 * static_cast<std::ptrdiff_t>(pack.node[l][0]);
  c[0] = Vec{};
  for (std::size_t a = 1; a < 8; ++a)
    for (std::size_t l = 0; l < kWidth; ++l) {
      const double* const q = x.data() + 3 * static_cast<std::ptrdiff_t>(pack.node[l][a]);
      c[a].x.set(static_cast<int>(l), q[0] - base[l][0]);
      c[a].y.set(static_cast<int>(l), q[1] - base[l][1]);
      c[a].z.set(static_cast<int>(l), q[2] - base[l][2]);
    }
  const S half(0.5);
  for (int bit = 1; bit < 8; bit <<= 1)
    for (int a = 0; a < 8; ++a)
      if (!(a & bit)) {
        const Vec low = c[a], high = c[a | bit];
        c[a] = half * (low + high);
        c[a | bit] = half * (high - low);
      }
}

template <class S>
S WallKernel<S>::volume_of(const Vec* c) noexcept {
  S v = S(0.0);
  for (const VolumeTerm& t : kVolumeTerms) v += t.weight * dot(c[t.i], cross(c[t.j], c[t.k]));
  return v;
}

template <class S>
void WallKernel<S>::press(const Vec* c, const S& scale, Vec* f) noexcept {
  for (const VolumeTerm& t : kVolumeTerms) {
    const S s = t.weight * scale;
    f[t.i].add(s * cross(c[t.j], c[t.k]));
    f[t.j].add(s * cross(c[t.k], c[t.i]));
    f[t.k].add(s * cross(c[t.i], c[t.j]));
  }
}

template <class S>
S WallKernel<S>::measure(const Point* point, const KernelRow& row, const Vec* c, PointState* s, S& least) noexcept {
  Assumed assumed;
  assumed.measure(c);
  S filled(0.0);
  Tangents t;
  for (const WallStation& station : row.stations) {
    t.measure(c, station.zeta);
    for (int q = 0; q < 4; ++q, ++s, ++point) {
      const int i = q & 1, j = q >> 1;
      const double xi = i ? kGauss : -kGauss, eta = j ? kGauss : -kGauss;
      s->C[0] = dot(t.around[j], t.around[j]);
      s->C[1] = dot(t.along[i], t.along[i]);
      s->C[2] = assumed.r0 + xi * assumed.r1 + eta * assumed.r2 + (xi * eta) * assumed.r3;
      s->C[3] = dot(t.around[j], t.along[i]);
      s->C[4] = assumed.b0 + xi * assumed.b1;
      s->C[5] = assumed.a0 + eta * assumed.a1;
      s->J = volume_ratio(point->geometry, s->C, s->dJ);
      filled += point->weight * s->J;
      least = least_of(least, s->J);
    }
  }
  return filled;
}

template <class S>
S WallKernel<S>::stretch(const Point* point, const KernelRow& row, const std::vector<LawConstants>& laws, const Vec* c,
                                                 const PointState* s, const S& pressure, Vec* f) noexcept {
  Assumed on_assumed = {};
  S energy(0.0);
  Tangents t;
  for (const WallStation& station : row.stations) {
    const LawConstants& law = laws[static_cast<std::size_t>(station.layer)];
    t.measure(c, station.zeta);
    Tangents on = {};
    for (int q = 0; q < 4; ++q, ++s, ++point) {
      const int i = q & 1, j = q >> 1;
      S T[6];
      energy += point->weight * law_energy(law, point->geometry, s->C, s->J, s->dJ, T);
      for (int m = 0; m < 6; ++m) T[m] = point->weight * (T[m] + pressure * s->dJ[m]);
      on_assumed.add_point(T, i ? kGauss : -kGauss, j ? kGauss : -kGauss);
      on.around[j].add((2.0 * T[0]) * t.around[j] + T[3] * t.along[i]);
      on.along[i].add((2.0 * T[1]) * t.along[i] + T[3] * t.around[j]);
    }
    on.spread(station.zeta, f);
  }
  on_assumed.spread(c, f);
  return energy;
}

template <class S>
void WallKernel<S>::scatter(const Pack& pack, Vec* f, const S& energy, const S& upright, const std::vector<double>& soundness, Points& force,
                            double& total) noexcept {
  const S half(0.5);
  for (int bit = 1; bit < 8; bit <<= 1)
    for (int a = 0; a < 8; ++a)
      if (!(a & bit)) {
        const Vec low = f[a], high = f[a | bit];
        f[a] = half * (low - high);
        f[a | bit] = half * (low + high);
      }
  constexpr std::size_t kSummed = std::min(kWidth, 8);
  for (std::size_t first = 0; first < kWidth; first += kSummed) {
    double sum = 0.0;
    for (std::size_t l = first; l < first + kSummed; ++l) {
      const int e = pack.element[l], k = static_cast<int>(l);
      if (e < 0) continue;
      const double sound = soundness[static_cast<std::size_t>(e)];
      if (sound == 0.0) continue;
      if (!(upright[k] > static_cast<N>(kInsideOut))) sum = std::numeric_limits<double>::infinity();
      sum += sound * static_cast<double>(energy[k]);
      for (std::size_t a = 0; a < 8; ++a) {
        double* const to = force.data() + 3 * static_cast<std::ptrdiff_t>(pack.node[l][a]);
        to[0] -= sound * static_cast<double>(f[a].x[k]);
        to[1] -= sound * static_cast<double>(f[a].y[k]);
        to[2] -= sound * static_cast<double>(f[a].z[k]);
      }
    }
    total += sum;
  }
}

template <class S>
void WallKernel<S>::pack_forces(const Pack& pack, const KernelRow& row, const std::vector<LawConstants>& laws, const Points& x,
                                const std::vector<double>& soundness, Points& force, double& total) const noexcept {
  Vec c[8], f[8] = {};
  gather(pack, x, c);
  const Point* const first = &points[pack.first_point];
  PointState states[4 * kMostStations];
  const S signed_volume = volume_of(c) / pack.volume;
  S least = signed_volume;
  const S change = measure(first, row, c, states, least) / pack.volume - 1.0;
  const S pressure = row.lambda_mean * change, crushed = positive_part(S(kCrushed) - signed_volume);
  press(c, S(-row.lambda_mean) * crushed, f);
  const S energy = 0.5 * row.lambda_mean * pack.volume * (change * change + crushed * crushed) + stretch(first, row, laws, c, states, pressure, f);
  scatter(pack, f, energy, least, soundness, force, total);
}

template <class S>
double WallKernel<S>::add_forces(const std::vector<KernelRow>& rows, const std::vector<LawConstants>& laws, const Points& x,
                                 const std::vector<double>& soundness, Points& force) const noexcept {
  double energy = 0.0;
  for (const Pack& p : packs) pack_forces(p, rows[static_cast<std::size_t>(p.row)], laws, x, soundness, force, energy);
  return energy;
}

}  // namespace filum
