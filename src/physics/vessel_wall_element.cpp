#include "physics/vessel_wall_element.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "physics/vessel_wall_forms.h"

namespace filum {
namespace {

constexpr double kGauss = 0.57735026918962576451;
constexpr double kInsideOut = 0.05;  // share of its volume below which an element or a point of it counts as turned inside out
constexpr std::size_t kMostStations = 8;

// ---- four elements at a time -------------------------------------------------------------------------------------------
struct Vec {
  Lanes x, y, z;
};
inline Vec operator+(const Vec& a, const Vec& b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(const Vec& a, const Vec& b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(const Lanes& s, const Vec& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
inline Vec operator*(double s, const Vec& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
inline void add(Vec& a, const Vec& b) noexcept { a = a + b; }
inline Lanes dot(const Vec& a, const Vec& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// The parts of C that are interpolated, as polynomials of xi and eta: C_13 = a0 + a1 eta, C_23 = b0 + b1 xi,
/// C_33 = r0 + r1 xi + r2 eta + r3 xi eta.
struct Assumed {
  Lanes a0, a1, b0, b1, r0, r1, r2, r3;
  explicit Assumed(const Vec* c) noexcept
      : a0(dot(c[1], c[4]) + dot(c[3], c[6])),
        a1(dot(c[1], c[6]) + dot(c[3], c[4])),
        b0(dot(c[2], c[4]) + dot(c[3], c[5])),
        b1(dot(c[2], c[5]) + dot(c[3], c[4])),
        r0(dot(c[4], c[4]) + dot(c[5], c[5]) + dot(c[6], c[6]) + dot(c[7], c[7])),
        r1(2.0 * (dot(c[4], c[5]) + dot(c[6], c[7]))),
        r2(2.0 * (dot(c[4], c[6]) + dot(c[5], c[7]))),
        r3(2.0 * (dot(c[4], c[7]) + dot(c[5], c[6]))) {}
};

/// Derivatives of the energy with respect to the coefficients of Assumed, summed over points.
struct AssumedForce {
  Lanes a0{}, a1{}, b0{}, b1{}, r0{}, r1{}, r2{}, r3{};
  void add_point(const Lanes* T, double xi, double eta) noexcept {
    a0 += T[5];
    a1 += eta * T[5];
    b0 += T[4];
    b1 += xi * T[4];
    r0 += T[2];
    r1 += xi * T[2];
    r2 += eta * T[2];
    r3 += (xi * eta) * T[2];
  }
  void spread(const Vec* c, Vec* f) const noexcept {
    const Lanes s0 = 2.0 * r0, s1 = 2.0 * r1, s2 = 2.0 * r2, s3 = 2.0 * r3;
    add(f[1], a0 * c[4] + a1 * c[6]);
    add(f[2], b0 * c[4] + b1 * c[5]);
    add(f[3], a0 * c[6] + a1 * c[4] + b0 * c[5] + b1 * c[4]);
    add(f[4], a0 * c[1] + a1 * c[3] + b0 * c[2] + b1 * c[3] + s0 * c[4] + s1 * c[5] + s2 * c[6] + s3 * c[7]);
    add(f[5], b0 * c[3] + b1 * c[2] + s0 * c[5] + s1 * c[4] + s2 * c[7] + s3 * c[6]);
    add(f[6], a0 * c[3] + a1 * c[1] + s0 * c[6] + s1 * c[7] + s2 * c[4] + s3 * c[5]);
    add(f[7], s0 * c[7] + s1 * c[6] + s2 * c[5] + s3 * c[4]);
  }
};

/// The four tangents at one zeta: around[eta], along[xi].
struct Tangents {
  Vec around[2], along[2];
  Tangents(const Vec* c, double zeta) noexcept {
    const Vec u = c[1] + zeta * c[5], du = kGauss * (c[3] + zeta * c[7]);
    const Vec v = c[2] + zeta * c[6];
    around[0] = u - du;
    around[1] = u + du;
    along[0] = v - du;
    along[1] = v + du;
  }
};

void spread_tangents(const Vec* around, const Vec* along, double zeta, Vec* f) noexcept {
  const Vec u = around[0] + around[1], v = along[0] + along[1];
  const Vec w = kGauss * ((around[1] - around[0]) + (along[1] - along[0]));
  add(f[1], u);
  add(f[2], v);
  add(f[3], w);
  add(f[5], zeta * u);
  add(f[6], zeta * v);
  add(f[7], zeta * w);
}

struct PointState {
  Lanes C[6], dJ[6], J;
};

void gather(const std::array<std::array<int, 8>, kLanes>& node, const Points& x, Vec* c) noexcept {
  const double* const p = x.data();
  for (std::size_t a = 0; a < 8; ++a) {
    const double *const q0 = p + 3 * static_cast<std::ptrdiff_t>(node[0][a]), *const q1 = p + 3 * static_cast<std::ptrdiff_t>(node[1][a]),
                 *const q2 = p + 3 * static_cast<std::ptrdiff_t>(node[2][a]), *const q3 = p + 3 * static_cast<std::ptrdiff_t>(node[3][a]);
    c[a] = {Lanes{q0[0], q1[0], q2[0], q3[0]}, Lanes{q0[1], q1[1], q2[1], q3[1]}, Lanes{q0[2], q1[2], q2[2], q3[2]}};
  }
  for (int bit = 1; bit < 8; bit <<= 1)
    for (int a = 0; a < 8; ++a)
      if (!(a & bit)) {
        const Vec low = c[a], high = c[a | bit];
        c[a] = 0.5 * (low + high);
        c[a | bit] = 0.5 * (high - low);
      }
}

}  // namespace

WallElements::WallElements(const VesselMesh& mesh, const std::vector<WallLayer>& layers)
    : n_nodes_(mesh.n_nodes()), layers_(layers), nodes_of_(mesh.elements), rest_(mesh.stress_free) {
  for (const WallLayer& l : layers_) constants_.emplace_back(l.law);
  row_of_.assign(nodes_of_.size(), -1);
  volume_.assign(nodes_of_.size(), 0.0);
  for (std::size_t e = 0; e < nodes_of_.size(); ++e) {
    const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.span == mesh.span[e]; });
    row_of_[e] = static_cast<int>(found - rows_.begin());
    if (found == rows_.end()) add_row(mesh.span[e]);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) pack_row(static_cast<int>(r), mesh);
}

// Gauss points of each layer that reaches into the span: two, or one where it fills less than a sixth of the element.
void WallElements::add_row(const std::array<double, 2>& span) {
  Row row;
  row.span = span;
  double total = 0.0, low = 0.0;
  for (const WallLayer& l : layers_) total += l.thickness;
  const double width = span[1] - span[0];
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const double high = low + layers_[k].thickness / total;
    const double a = std::max(low, span[0]), b = std::min(high, span[1]);
    low = high;
    if (b - a < 1e-9) continue;
    const double share = (b - a) / width, middle = ((a + b) - (span[0] + span[1])) / width;
    row.lambda_mean += share * (layers_[k].law.lambda - layers_[k].law.lambda_point());
    if (share < 1.0 / 6.0) {
      row.stations.push_back({middle, share, static_cast<int>(k)});
    } else {
      row.stations.push_back({middle - kGauss * share, 0.5 * share, static_cast<int>(k)});
      row.stations.push_back({middle + kGauss * share, 0.5 * share, static_cast<int>(k)});
    }
  }
  if (row.stations.size() > kMostStations || row.stations.empty())
    throw InputError("vessel wall", "layers", std::to_string(layers_.size()), "one to four layers in an element");
  rows_.push_back(row);
}

WallElements::Scalars WallElements::scalars(const Corners& rest, const Vec3& local, double share, const WallLaw& law) const {
  const Six G = covariant(covariant_forms(local), rest);
  const Mat3 metric = matrix_of(G).inverse();
  const double det = matrix_of(G).determinant();
  Scalars s;
  s.weight = 2.0 * share * std::sqrt(det);  // Gauss weights in the plane are 1, through the element 2 share
  s.geometry.inverse_root = 1.0 / std::sqrt(det);
  const double raised[6] = {metric(0, 0), metric(1, 1), metric(2, 2), metric(0, 1), metric(1, 2), metric(0, 2)};
  std::copy(raised, raised + 6, s.geometry.metric);
  const double across = std::sqrt(G[1] - G[3] * G[3] / G[0]);  // length of the part of G_2 square to G_1
  for (int f = 0; f < 2; ++f) {
    const double a2 = (f == 0 ? 1.0 : -1.0) * std::sin(law.beta) / across;
    const double a1 = std::cos(law.beta) / std::sqrt(G[0]) - a2 * G[3] / G[0];
    s.geometry.fibre[f][0] = a1 * a1;
    s.geometry.fibre[f][1] = a2 * a2;
    s.geometry.fibre[f][2] = 2.0 * a1 * a2;
  }
  return s;
}

void WallElements::pack_row(int row, const VesselMesh& mesh) {
  std::vector<int> members;
  for (int e = 0; e < mesh.n_elements(); ++e)
    if (row_of_[static_cast<std::size_t>(e)] == row) members.push_back(e);
  const Row& r = rows_[static_cast<std::size_t>(row)];
  for (std::size_t start = 0; start < members.size(); start += kLanes) {
    Pack p;
    p.row = row;
    p.first_point = points_.size();
    Lanes volume = all_lanes(1e-30);
    points_.resize(points_.size() + 4 * r.stations.size());
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const bool real = start + lane < members.size();
      const int e = members[real ? start + lane : start];
      p.element[lane] = real ? e : -1;
      p.node[lane] = nodes_of_[static_cast<std::size_t>(e)];
      Point* point = &points_[p.first_point];
      for (const Station& s : r.stations)
        for (const double eta : {-kGauss, kGauss})
          for (const double xi : {-kGauss, kGauss}) {
            const Scalars v = scalars(rest_[static_cast<std::size_t>(e)], Vec3(xi, eta, s.zeta), s.share, layers_[static_cast<std::size_t>(s.layer)].law);
            for (int m = 0; m < 6; ++m) point->geometry.metric[m][static_cast<int>(lane)] = v.geometry.metric[m];
            for (int f = 0; f < 2; ++f)
              for (int m = 0; m < 3; ++m) point->geometry.fibre[f][m][static_cast<int>(lane)] = v.geometry.fibre[f][m];
            point->geometry.inverse_root[static_cast<int>(lane)] = v.geometry.inverse_root;
            point->weight[static_cast<int>(lane)] = real ? v.weight : 0.0;
            if (real) volume_[static_cast<std::size_t>(e)] += v.weight;
            ++point;
          }
      volume[static_cast<int>(lane)] = volume_[static_cast<std::size_t>(e)];
    }
    pack_volume_.push_back(volume);
    packs_.push_back(p);
  }
}

double WallElements::pack_forces(const Pack& pack, const Points& x, const std::vector<double>& soundness, Points& force) const noexcept {
  const Row& row = rows_[static_cast<std::size_t>(pack.row)];
  const Point* const points = &points_[pack.first_point];
  Vec c[8], f[8];
  gather(pack.node, x, c);
  for (Vec& v : f) v = Vec{Lanes{}, Lanes{}, Lanes{}};
  const Assumed assumed(c);
  PointState states[4 * kMostStations];
  PointState* s = states;
  Lanes filled{};  // volume now
  Lanes least = all_lanes(1.0);
  for (const Station& station : row.stations) {
    const Tangents t(c, station.zeta);
    for (int q = 0; q < 4; ++q, ++s) {
      const int i = q & 1, j = q >> 1;
      const double xi = i ? kGauss : -kGauss, eta = j ? kGauss : -kGauss;
      s->C[0] = dot(t.around[j], t.around[j]);
      s->C[1] = dot(t.along[i], t.along[i]);
      s->C[2] = assumed.r0 + xi * assumed.r1 + eta * assumed.r2 + (xi * eta) * assumed.r3;
      s->C[3] = dot(t.around[j], t.along[i]);
      s->C[4] = assumed.b0 + xi * assumed.b1;
      s->C[5] = assumed.a0 + eta * assumed.a1;
      const Point& p = points[s - states];
      s->J = volume_ratio(p.geometry, s->C, s->dJ);
      filled += p.weight * s->J;
      least = least_of(least, s->J);
    }
  }
  const Lanes& volume = pack_volume_[static_cast<std::size_t>(&pack - packs_.data())];
  const Lanes change = filled / volume - 1.0;
  const Lanes pressure = row.lambda_mean * change;
  Lanes energy = 0.5 * pressure * change * volume;
  AssumedForce assumed_force;
  s = states;
  for (const Station& station : row.stations) {
    const LawConstants& law = constants_[static_cast<std::size_t>(station.layer)];
    const Tangents t(c, station.zeta);
    Vec around[2] = {}, along[2] = {};
    for (int q = 0; q < 4; ++q, ++s) {
      const int i = q & 1, j = q >> 1;
      const Point& p = points[s - states];
      Lanes T[6];
      energy += p.weight * law_energy(law, p.geometry, s->C, s->J, s->dJ, T);
      for (int m = 0; m < 6; ++m) T[m] = p.weight * (T[m] + pressure * s->dJ[m]);
      assumed_force.add_point(T, i ? kGauss : -kGauss, j ? kGauss : -kGauss);
      add(around[j], (2.0 * T[0]) * t.around[j] + T[3] * t.along[i]);
      add(along[i], (2.0 * T[1]) * t.along[i] + T[3] * t.around[j]);
    }
    spread_tangents(around, along, station.zeta, f);
  }
  assumed_force.spread(c, f);
  for (int bit = 1; bit < 8; bit <<= 1)
    for (int a = 0; a < 8; ++a)
      if (!(a & bit)) {
        const Vec low = f[a], high = f[a | bit];
        f[a] = 0.5 * (low - high);
        f[a | bit] = 0.5 * (low + high);
      }
  // signed volume at the middle: det of the tangents, against the stress-free volume of eight octants
  const Lanes signed_volume = 8.0 * (c[1].x * (c[2].y * c[4].z - c[2].z * c[4].y) + c[1].y * (c[2].z * c[4].x - c[2].x * c[4].z) +
                                     c[1].z * (c[2].x * c[4].y - c[2].y * c[4].x));
  double sum = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const int e = pack.element[lane], k = static_cast<int>(lane);
    if (e < 0) continue;
    const double sound = soundness[static_cast<std::size_t>(e)];
    if (sound == 0.0) continue;
    if (!(signed_volume[k] > kInsideOut * volume[k] && least[k] > kInsideOut)) sum = std::numeric_limits<double>::infinity();
    sum += sound * energy[k];
    for (int a = 0; a < 8; ++a) {
      double* const to = force.data() + 3 * static_cast<std::ptrdiff_t>(pack.node[lane][static_cast<std::size_t>(a)]);
      to[0] -= sound * f[a].x[k];
      to[1] -= sound * f[a].y[k];
      to[2] -= sound * f[a].z[k];
    }
  }
  return sum;
}

double WallElements::add_forces(const Points& x, const std::vector<double>& soundness, Points& force) const noexcept {
  double energy = 0.0;
  for (const Pack& p : packs_) energy += pack_forces(p, x, soundness, force);
  return energy;
}

}  // namespace filum
