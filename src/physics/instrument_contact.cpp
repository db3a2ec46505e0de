#include "physics/instrument_contact.h"

#include <algorithm>
#include <array>

#include "collision/segment_distance.h"

namespace filum {
namespace {

constexpr double kReach = 0.3e-3;       // [m], beyond what the speeds at the step's start cover: hands and closing jaws speed up within it
constexpr double kApart = 2e-3;         // [m], least distance of two contacts along one bar
constexpr std::size_t kPlaces = 5;      // of contact of two bars: where they are nearest, and the four ends

double radius_at(const RoundBar& bar, double s) noexcept { return bar.r_a + s * (bar.r_b - bar.r_a); }
Vec3 axis_at(const RoundBar& bar, double s) noexcept { return bar.a + s * (bar.b - bar.a); }
double nearest_to(const RoundBar& bar, const Vec3& p) noexcept {
  return std::clamp((p - bar.a).dot(bar.b - bar.a) / (bar.b - bar.a).squaredNorm(), 0.0, 1.0);
}

}  // namespace

InstrumentContact::InstrumentContact(int n_tools, Surroundings surroundings)
    : surroundings_(std::move(surroundings)), tools_(static_cast<std::size_t>(n_tools)) {
  const std::size_t n = tools_.size(), pairs = 9 * n * (n - 1) / 2 + 3 * n * kMostBars;
  surroundings_.bars.reserve(kMostBars);
  touches_.reserve(kPlaces * pairs + 6 * n);
}

void InstrumentContact::find(const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, double h) noexcept {
  touches_.clear();
  for (std::size_t i = 0; i < tools_.size(); ++i) place(tools[i], states[i], tools_[i]);
  const int n = static_cast<int>(tools_.size());
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      for (int j = i + 1; j < n; ++j)
        for (int l = 0; l < 3; ++l) meet(i, k, j, l, tools_[static_cast<std::size_t>(j)].bars[l], h);
      for (const RoundBar& bar : surroundings_.bars) meet(i, k, -1, -1, bar, h);
      meet_sheet(i, k, h);
    }
  }
  if (touches_.size() <= kMost) return;
  std::nth_element(touches_.begin(), touches_.begin() + kMost, touches_.end(), [](const auto& a, const auto& b) { return a.gap < b.gap; });
  touches_.resize(kMost);
}

void InstrumentContact::place(const InstrumentParameters& p, const InstrumentState& s, Moving& tool) const noexcept {
  const InstrumentBars bars = instrument_bars(p, s.angle, 0.0);
  for (std::size_t k = 0; k < 3; ++k) tool.bars[k] = {s.X_WT * bars.a_T[k], s.X_WT * bars.b_T[k], bars.r_a[k], bars.r_b[k]};
  tool.p = s.X_WT.p;
  tool.v = s.v;
  tool.w = s.w;
}

/// Where the axes are nearest, and at their ends: bars that lie along each other touch all along.
void InstrumentContact::meet(int tool, int bar, int other, int other_bar, const RoundBar& against, double h) noexcept {
  const RoundBar& own = tools_[static_cast<std::size_t>(tool)].bars[bar];
  const SegmentPair nearest = closest_points(own.a, own.b, against.a, against.b);
  const double own_length = (own.b - own.a).norm(), other_length = (against.b - against.a).norm();
  std::array<std::array<double, 2>, kPlaces> places{};
  std::size_t n = 0;
  const auto add = [&](double s, double t) {
    for (std::size_t k = 0; k < n; ++k)
      if (std::abs(s - places[k][0]) * own_length < kApart && std::abs(t - places[k][1]) * other_length < kApart) return;
    places[n++] = {s, t};
    meet_at(tool, bar, other, other_bar, against, s, t, h);
  };
  add(nearest.s, nearest.t);
  for (const double s : {0.0, 1.0}) add(s, nearest_to(against, axis_at(own, s)));
  for (const double t : {0.0, 1.0}) add(nearest_to(own, axis_at(against, t)), t);
}

void InstrumentContact::meet_at(int tool, int bar, int other, int other_bar, const RoundBar& against, double s, double t, double h) noexcept {
  const RoundBar& own = tools_[static_cast<std::size_t>(tool)].bars[bar];
  const Vec3 p = axis_at(own, s), q = axis_at(against, t), d = p - q;
  const double distance = d.norm(), gap = distance - radius_at(own, s) - radius_at(against, t);
  const Vec3 speed = velocity(tool, p) - velocity(other, q);
  if (gap > kReach + h * speed.norm() || !(distance > 0.0)) return;
  const Vec3 normal = d / distance;
  touches_.push_back({tool, bar, other, other_bar, q + (radius_at(against, t) + 0.5 * gap) * normal, normal, gap});
}

/// By the ends of its axis: a jaw is flat at its tip, where it picks up what lies on the sheet.
void InstrumentContact::meet_sheet(int tool, int bar, double h) noexcept {
  const RoundBar& own = tools_[static_cast<std::size_t>(tool)].bars[bar];
  for (const double s : {0.0, 1.0}) {
    const Vec3 p = axis_at(own, s);
    const double gap = p.z() - surroundings_.sheet;
    if (gap > kReach + h * velocity(tool, p).norm()) continue;
    touches_.push_back({tool, bar, -1, -1, p - 0.5 * gap * Vec3::UnitZ(), Vec3::UnitZ(), gap});
  }
}

Vec3 InstrumentContact::velocity(int tool, const Vec3& p) const noexcept {
  if (tool < 0) return Vec3::Zero();
  const Moving& m = tools_[static_cast<std::size_t>(tool)];
  return m.v + m.w.cross(p - m.p);
}

}  // namespace filum
