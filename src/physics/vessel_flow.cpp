#include "physics/vessel_flow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace filum {
namespace {

constexpr double kLeastArea = 1e-12;  // [m2], below which a lumen is shut: 1 um across
constexpr double kStrip = 0.2e-3;     // [m], least stretch that makes a test

bool is_way(double resistance) noexcept { return resistance > 0.0 && std::isfinite(resistance); }

}  // namespace

LumenLine::LumenLine(const VesselMesh& mesh) : way_(passage_of(mesh)) {
  middle_.resize(way_.rings.size());
  for (std::vector<double>* list : {&along_, &area_, &volume_, &resistance_}) list->assign(way_.rings.size(), 0.0);
}

void LumenLine::measure(const Points& x, double viscosity) noexcept {
  for (std::size_t k = 0; k < way_.rings.size(); ++k) {
    const std::vector<int>& ring = way_.rings[k];
    Vec3 m = Vec3::Zero(), normal = Vec3::Zero();
    for (const int i : ring) m += x.col(i) / static_cast<double>(ring.size());
    for (std::size_t j = 0; j < ring.size(); ++j) normal += 0.5 * (x.col(ring[j]) - m).cross(x.col(ring[(j + 1) % ring.size()]) - m);
    middle_[k] = m;
    area_[k] = std::max(normal.norm() * way_.across[k], kLeastArea);
    if (k == 0) continue;
    const double step = (m - middle_[k - 1]).norm(), area = 0.5 * (area_[k] + area_[k - 1]);
    along_[k] = along_[k - 1] + step;
    volume_[k] = volume_[k - 1] + area * step;
    resistance_[k] = resistance_[k - 1] + 8.0 * std::numbers::pi * viscosity * step / (area_[k] * area_[k - 1]);
  }
  join_ = 0.5 * (along_[way_.second - 1] + along_[way_.second]);
}

double LumenLine::least_area() const noexcept { return *std::min_element(area_.begin(), area_.end()); }

double LumenLine::share(const std::vector<double>& sums, double from, double to) const noexcept {
  const auto at = [&](double s) {
    const auto next = std::upper_bound(along_.begin(), along_.end(), s);
    if (next == along_.begin()) return sums.front();
    if (next == along_.end()) return sums.back();
    const auto k = static_cast<std::size_t>(next - along_.begin());
    return sums[k - 1] + (sums[k] - sums[k - 1]) * (s - along_[k - 1]) / (along_[k] - along_[k - 1]);
  };
  return to > from ? at(to) - at(from) : 0.0;
}

double LumenLine::volume(double from, double to) const noexcept { return share(volume_, from, to); }
double LumenLine::resistance(double from, double to) const noexcept { return share(resistance_, from, to); }

Balance balance_blood(double source, double upstream, std::span<const EdgeGap> gaps, double downstream, double back, const BloodOptions& blood) noexcept {
  const bool up = is_way(upstream), down = is_way(downstream);
  const auto flows = [&](double p) {
    Balance b;
    b.pressure = p;
    b.from = up ? (source - p) / upstream : 0.0;
    b.on = down ? (p - back) / downstream : 0.0;
    BloodOptions here = blood;
    here.pressure = p;
    b.leak = leak_through(gaps, {}, here);
    return b;
  };
  double low = 0.0, high = std::max(up ? source : 0.0, down ? back : 0.0);
  for (int k = 0; k < 40 && high - low > 1e-3; ++k) {
    const double p = 0.5 * (low + high);
    const Balance b = flows(p);
    (b.from > b.leak + b.on ? low : high) = p;
  }
  return flows(0.5 * (low + high));
}

Balance balance_join(const LumenLine& line, std::span<const EdgeGap> gaps, const Circulation& c, const BloodOptions& blood) noexcept {
  return balance_blood(c.pressure, c.upstream() + line.resistance(0.0, line.join()), gaps, c.downstream() + line.resistance(line.join(), line.length()), c.back, blood);
}

MilkingNews milk(Milking& m, const LumenLine& line, std::span<const double> closed, bool open, const Circulation& circulation, std::span<const EdgeGap> gaps,
                 const BloodOptions& blood, double dt) noexcept {
  const auto holds = [&](std::int32_t tool) { return tool >= 0 && closed[static_cast<std::size_t>(tool)] >= 0.0; };
  int n = 0, first = -1, last = -1;  // of the tools that hold it shut behind the join
  for (std::size_t k = 0; k < closed.size(); ++k) {
    if (closed[k] <= line.join()) continue;
    ++n;
    if (first < 0 || closed[k] < closed[static_cast<std::size_t>(first)]) first = static_cast<int>(k);
    if (last < 0 || closed[k] >= closed[static_cast<std::size_t>(last)]) last = static_cast<int>(k);
  }
  if (m.stage == Milking::over && n == 0) m = {};
  if (m.stage == Milking::idle && open && n >= 2) {
    m = {Milking::stripping, first, last, closed[static_cast<std::size_t>(first)], closed[static_cast<std::size_t>(last)], closed[static_cast<std::size_t>(last)], 0.0, 0.0, 0.0};
  } else if (m.stage == Milking::stripping) {
    if (!holds(m.down) || !open) {
      const bool began = m.to - m.from > kStrip;
      m = {};
      return began ? MilkingNews::spoiled : MilkingNews::none;
    }
    m.to = std::max(m.to, closed[static_cast<std::size_t>(m.down)]);
    m.volume = m.missing = line.volume(m.from, m.to);
    if (holds(m.up)) return MilkingNews::none;
    if (m.to - m.from < kStrip) {
      m = {};
      return MilkingNews::none;
    }
    m.stage = Milking::filling;
    return MilkingNews::let_go;
  } else if (m.stage == Milking::filling) {
    if (!holds(m.down)) {
      m = {};
      return MilkingNews::spoiled;
    }
    const double front = m.from + (m.to - m.from) * (1.0 - m.missing / m.volume);
    const Balance b = balance_blood(circulation.pressure, circulation.upstream() + line.resistance(0.0, line.join()), gaps, line.resistance(line.join(), front), circulation.opening, blood);
    const double taken = std::min(dt, b.on > 0.0 ? m.missing / b.on : dt);
    m.time += taken;
    m.missing = b.on * dt >= m.missing ? 0.0 : m.missing - std::max(0.0, b.on) * dt;
    if (m.missing > 0.0 && m.time < kLongestRefill) return MilkingNews::none;
    m.stage = Milking::over;
    return m.missing > 0.0 ? MilkingNews::stayed_empty : MilkingNews::refilled;
  }
  return MilkingNews::none;
}

}  // namespace filum
