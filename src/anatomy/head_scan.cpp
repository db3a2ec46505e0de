#include "anatomy/head_scan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace filum {
namespace {

using Mask = std::vector<char>;

double voxel_volume(const Volume& v) { return std::abs(v.step.determinant()); }

/// One voxel worn off (or, of the outside, on): a voxel stays if its six neighbours are `kept`.
Mask worn(const Volume& v, const Mask& mask, char kept) {
  Mask out = mask;
  const std::array<std::ptrdiff_t, 3> stride = {1, v.size[0], static_cast<std::ptrdiff_t>(v.size[0]) * v.size[1]};
  for (int k = 0; k < v.size[2]; ++k)
    for (int j = 0; j < v.size[1]; ++j)
      for (int i = 0; i < v.size[0]; ++i) {
        const std::size_t at = v.index(i, j, k);
        const std::array<int, 3> x = {i, j, k};
        for (std::size_t c = 0; c < 3; ++c) {
          const bool low = x[c] > 0 ? mask[at - static_cast<std::size_t>(stride[c])] == kept : kept == 0;
          const bool high = x[c] + 1 < v.size[c] ? mask[at + static_cast<std::size_t>(stride[c])] == kept : kept == 0;
          if (!low || !high) out[at] = static_cast<char>(1 - kept);
        }
      }
  return out;
}

/// The largest connected piece of what equals `wanted`.
Mask largest_piece(const Volume& v, const Mask& mask, char wanted) {
  Mask best(mask.size(), 0), seen(mask.size(), 0);
  std::size_t most = 0;
  std::vector<std::array<int, 3>> piece;
  for (int k = 0; k < v.size[2]; ++k)
    for (int j = 0; j < v.size[1]; ++j)
      for (int i = 0; i < v.size[0]; ++i) {
        if (seen[v.index(i, j, k)] || mask[v.index(i, j, k)] != wanted) continue;
        piece.assign(1, {i, j, k});
        seen[v.index(i, j, k)] = 1;
        for (std::size_t next = 0; next < piece.size(); ++next)
          for (std::size_t c = 0; c < 3; ++c)
            for (const int d : {-1, 1}) {
              std::array<int, 3> x = piece[next];
              x[c] += d;
              if (x[c] < 0 || x[c] >= v.size[c]) continue;
              const std::size_t at = v.index(x[0], x[1], x[2]);
              if (seen[at] || mask[at] != wanted) continue;
              seen[at] = 1;
              piece.push_back(x);
            }
        if (piece.size() <= most) continue;
        most = piece.size();
        std::fill(best.begin(), best.end(), char(0));
        for (const auto& x : piece) best[v.index(x[0], x[1], x[2])] = 1;
      }
  return best;
}

Mask brain_of(const Volume& v, double threshold, const ScanOptions& o) {
  Mask bright(v.value.size());
  for (std::size_t k = 0; k < bright.size(); ++k) bright[k] = static_cast<double>(v.value[k]) > (o.extracted ? 0.0 : threshold) ? 1 : 0;
  Mask mask = bright;
  const int rounds = o.extracted ? 0 : static_cast<int>(std::lround(o.wear / std::cbrt(voxel_volume(v))));
  for (int r = 0; r < rounds; ++r) mask = worn(v, mask, 1);
  mask = largest_piece(v, mask, 1);
  for (int r = 0; r < rounds; ++r) {
    mask = worn(v, mask, 0);
    for (std::size_t k = 0; k < mask.size(); ++k) mask[k] = static_cast<char>(mask[k] & bright[k]);
  }
  const Mask outside = largest_piece(v, mask, 0);
  for (std::size_t k = 0; k < mask.size(); ++k) mask[k] = outside[k] ? 0 : 1;  // ventricles and holes belong to it
  return mask;
}

std::array<double, 3> three_means(const Volume& v, const Mask& mask) {
  double low = 1e300, high = -1e300;
  for (std::size_t k = 0; k < mask.size(); ++k)
    if (mask[k]) {
      low = std::min(low, static_cast<double>(v.value[k]));
      high = std::max(high, static_cast<double>(v.value[k]));
    }
  std::array<double, 3> mean = {low + 0.2 * (high - low), low + 0.5 * (high - low), low + 0.8 * (high - low)};
  for (int round = 0; round < 30; ++round) {
    std::array<double, 3> sum{}, count{};
    for (std::size_t k = 0; k < mask.size(); ++k) {
      if (!mask[k]) continue;
      const double x = static_cast<double>(v.value[k]);
      const std::size_t c = x < 0.5 * (mean[0] + mean[1]) ? 0 : x < 0.5 * (mean[1] + mean[2]) ? 1 : 2;
      sum[c] += x;
      count[c] += 1.0;
    }
    for (std::size_t c = 0; c < 3; ++c)
      if (count[c] > 0.0) mean[c] = sum[c] / count[c];
  }
  return mean;
}

/// Gauss along each direction in turn; beyond the border there is nothing.
void smooth(const Volume& v, std::vector<float>& share, double sigma) {
  std::vector<float> line;
  for (std::size_t c = 0; c < 3; ++c) {
    const double width = sigma / v.step.col(static_cast<Eigen::Index>(c)).norm();
    const int reach = static_cast<int>(std::ceil(3.0 * width));
    if (reach == 0) continue;
    std::vector<float> weight;
    float whole = 0.0f;
    for (int d = -reach; d <= reach; ++d) weight.push_back(static_cast<float>(std::exp(-0.5 * d * d / (width * width))));
    for (const float w : weight) whole += w;
    const std::size_t stride = c == 0 ? 1 : c == 1 ? static_cast<std::size_t>(v.size[0]) : static_cast<std::size_t>(v.size[0]) * static_cast<std::size_t>(v.size[1]);
    line.assign(static_cast<std::size_t>(v.size[c]), 0.0f);
    for (std::size_t from = 0; from < share.size(); ++from) {
      if (from / stride % static_cast<std::size_t>(v.size[c]) != 0) continue;
      for (std::size_t k = 0; k < line.size(); ++k) line[k] = share[from + k * stride];
      for (int k = 0; k < v.size[c]; ++k) {
        float sum = 0.0f;
        for (int d = std::max(-reach, -k); d <= std::min(reach, v.size[c] - 1 - k); ++d) sum += weight[static_cast<std::size_t>(d + reach)] * line[static_cast<std::size_t>(k + d)];
        share[from + static_cast<std::size_t>(k) * stride] = sum / whole;
      }
    }
  }
}

}  // namespace

double otsu(const std::vector<float>& value) {
  constexpr int kBins = 256;
  const auto [least, most] = std::minmax_element(value.begin(), value.end());
  const double low = static_cast<double>(*least), width = (static_cast<double>(*most) - low) / kBins;
  if (!(width > 0.0)) return low;
  std::array<double, kBins> count{};
  for (const float x : value) count[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>((static_cast<double>(x) - low) / width)))] += 1.0;
  double total = 0.0, all = 0.0, below = 0.0, sum = 0.0, best = -1.0, at = low;
  for (int b = 0; b < kBins; ++b) {
    all += count[static_cast<std::size_t>(b)];
    total += b * count[static_cast<std::size_t>(b)];
  }
  for (int b = 0; b + 1 < kBins; ++b) {
    below += count[static_cast<std::size_t>(b)];
    sum += b * count[static_cast<std::size_t>(b)];
    if (below == 0.0 || below == all) continue;
    const double apart = sum / below - (total - sum) / (all - below), between = below * (all - below) * apart * apart;
    if (between <= best) continue;
    best = between;
    at = low + (b + 1) * width;
  }
  return at;
}

BrainScan find_brain(Volume scan, const ScanOptions& o, const std::string& file) {
  BrainScan b;
  b.threshold = otsu(scan.value);
  const Mask mask = brain_of(scan, b.threshold, o);
  double voxels = 0.0;
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < scan.size[2]; ++k)
    for (int j = 0; j < scan.size[1]; ++j)
      for (int i = 0; i < scan.size[0]; ++i)
        if (mask[scan.index(i, j, k)]) {
          voxels += 1.0;
          sum += Vec3(i, j, k);
        }
  b.volume = voxels * voxel_volume(scan);
  if (!(b.volume > 1e-4 && b.volume < 2.2e-3)) throw InputError(file, "brain", std::to_string(1e6 * b.volume) + " ml", "100 to 2200 ml of brain; is it a T1-weighted head? More: a larger --wear parts brain and scalp; nothing but brain: --extracted");
  b.middle = scan.place(sum / voxels);
  b.means = three_means(scan, mask);
  b.brain.assign(mask.begin(), mask.end());
  b.white.assign(mask.size(), 0.0f);
  for (std::size_t k = 0; k < mask.size(); ++k)
    if (mask[k] && static_cast<double>(scan.value[k]) > 0.5 * (b.means[1] + b.means[2])) b.white[k] = 1.0f;
  smooth(scan, b.brain, o.smooth);
  smooth(scan, b.white, o.smooth);
  b.grid = std::move(scan);
  b.grid.value.clear();
  return b;
}

}  // namespace filum
