#include "analysis/correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/mean.h"
#include "base/numbers.h"

namespace filum {
namespace {

constexpr double kTwoSided95 = 1.959963984540054;

Correlation none(Correlation c, std::string why) {
  c.r = c.low = c.high = c.rank = c.slope = kNaN;
  c.why = std::move(why);
  return c;
}

/// r and slope of values whose means are taken away; `free` is n - 3 of Fisher's interval.
Correlation from_moments(Correlation c, const std::vector<double>& x, const std::vector<double>& y, double free) {
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += x[k] * x[k];
    yy += y[k] * y[k];
    xy += x[k] * y[k];
  }
  if (!(xx > 0.0) || !(yy > 0.0)) return none(c, "one of the two does not vary");
  c.r = std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0);
  c.slope = xy / xx;
  const double z = std::atanh(std::clamp(c.r, -1.0 + 1e-12, 1.0 - 1e-12)), half = kTwoSided95 / std::sqrt(free);
  c.low = std::tanh(z - half);
  c.high = std::tanh(z + half);
  return c;
}

std::vector<double> centred(const std::vector<double>& x) {
  std::vector<double> y = x;
  const double mean = mean_of(x);
  for (double& value : y) value -= mean;
  return y;
}

/// Ranks from 1; equal values share the mean of their ranks.
std::vector<double> ranks(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  std::vector<double> rank(x.size());
  for (std::size_t k = 0; k < order.size();) {
    std::size_t end = k;
    while (end < order.size() && x[order[end]] == x[order[k]]) ++end;
    for (std::size_t i = k; i < end; ++i) rank[order[i]] = 0.5 * static_cast<double>(k + end - 1) + 1.0;
    k = end;
  }
  return rank;
}

}  // namespace

Correlation correlate(const std::vector<double>& x, const std::vector<double>& y) {
  Correlation c;
  c.n = static_cast<int>(std::min(x.size(), y.size()));
  if (c.n < 4) return none(c, "fewer than 4 pairs");
  c = from_moments(c, centred(x), centred(y), c.n - 3.0);
  if (c.why.empty()) c.rank = from_moments({}, centred(ranks(x)), centred(ranks(y)), 1.0).r;
  return c;
}

Correlation correlate_within(const std::vector<PairGroup>& groups) {
  Correlation c;
  std::vector<double> x, y;
  for (const PairGroup& group : groups) {
    if (group.x.size() < 2) continue;
    ++c.groups;
    const std::vector<double> gx = centred(group.x), gy = centred(group.y);
    x.insert(x.end(), gx.begin(), gx.end());
    y.insert(y.end(), gy.begin(), gy.end());
  }
  c.n = static_cast<int>(x.size());
  const double degrees = c.n - c.groups - 1.0;
  if (degrees < 2.0) return none(c, "too few pairs within sessions");
  c = from_moments(c, x, y, degrees - 1.0);
  c.rank = kNaN;
  return c;
}

}  // namespace filum
