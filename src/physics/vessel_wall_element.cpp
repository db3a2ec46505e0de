#include "physics/vessel_wall_element.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "physics/vessel_wall_forms.h"

namespace filum {

bool has_wide_lanes() noexcept {
#ifdef FILUM_WIDE_LANES
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

WallElements::WallElements(const VesselMesh& mesh, const std::vector<WallLayer>& layers, bool single_precision, bool wide)
    : n_nodes_(mesh.n_nodes()), layers_(layers), nodes_of_(mesh.elements), rest_(mesh.stress_free) {
  for (const WallLayer& l : layers_) constants_.emplace_back(l.law);
  row_of_.assign(nodes_of_.size(), -1);
  volume_.assign(nodes_of_.size(), 0.0);
  for (std::size_t e = 0; e < nodes_of_.size(); ++e) {
    const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const KernelRow& r) { return r.span == mesh.span[e]; });
    row_of_[e] = static_cast<int>(found - rows_.begin());
    if (found == rows_.end()) add_row(mesh.span[e]);
  }
  if (!single_precision)
    pack_rows(double_);
  else if (wide)
    pack_rows(wide_);
  else
    pack_rows(single_);
}

// Gauss points of each layer that reaches into the span: two, or one where it fills less than a sixth of the element.
void WallElements::add_row(const std::array<double, 2>& span) {
  KernelRow row;
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

template <class S>
void WallElements::fill_lane(WallKernel<S>& kernel, typename WallKernel<S>::Pack& pack, int lane, int element, bool real) {
  const auto e = static_cast<std::size_t>(element);
  const auto l = static_cast<std::size_t>(lane);
  pack.element[l] = real ? element : -1;
  pack.node[l] = nodes_of_[e];
  auto* point = &kernel.points[pack.first_point];
  for (const WallStation& s : rows_[static_cast<std::size_t>(pack.row)].stations)
    for (const double eta : {-kGauss, kGauss})
      for (const double xi : {-kGauss, kGauss}) {
        const Scalars v = scalars(rest_[e], Vec3(xi, eta, s.zeta), s.share, layers_[static_cast<std::size_t>(s.layer)].law);
        for (int m = 0; m < 6; ++m) point->geometry.metric[m].set(lane, v.geometry.metric[m]);
        for (int f = 0; f < 2; ++f)
          for (int m = 0; m < 3; ++m) point->geometry.fibre[f][m].set(lane, v.geometry.fibre[f][m]);
        point->geometry.inverse_root.set(lane, v.geometry.inverse_root);
        point->weight.set(lane, real ? v.weight : 0.0);
        if (real) volume_[e] += v.weight;
        ++point;
      }
  pack.volume.set(lane, volume_[e]);
}

template <class S>
void WallElements::pack_rows(WallKernel<S>& kernel) {
  for (std::size_t r = 0; r < rows_.size(); ++r) pack_row(static_cast<int>(r), kernel);
}

template <class S>
void WallElements::pack_row(int row, WallKernel<S>& kernel) {
  constexpr int kWidth = WallKernel<S>::kWidth;
  std::vector<int> members;
  for (std::size_t e = 0; e < row_of_.size(); ++e)
    if (row_of_[e] == row) members.push_back(static_cast<int>(e));
  for (std::size_t start = 0; start < members.size(); start += kWidth) {
    typename WallKernel<S>::Pack p;
    p.row = row;
    p.first_point = kernel.points.size();
    kernel.points.resize(p.first_point + 4 * rows_[static_cast<std::size_t>(row)].stations.size());
    for (int lane = 0; lane < kWidth; ++lane) {
      const bool real = start + static_cast<std::size_t>(lane) < members.size();
      fill_lane(kernel, p, lane, members[real ? start + static_cast<std::size_t>(lane) : start], real);
    }
    kernel.packs.push_back(p);
  }
}

double WallElements::add_forces(const Points& x, const std::vector<double>& soundness, Points& force) const noexcept {
  if (!wide_.packs.empty()) return add_wide_forces(wide_, rows_, constants_, x, soundness, force);
  if (!single_.packs.empty()) return single_.add_forces(rows_, constants_, x, soundness, force);
  return double_.add_forces(rows_, constants_, x, soundness, force);
}

}  // namespace filum
