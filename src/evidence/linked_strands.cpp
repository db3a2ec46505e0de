#include "evidence/linked_strands.h"

#include <array>
#include <cmath>

#include "base/numbers.h"
#include "evidence/linking.h"

namespace filum {
namespace {

constexpr int kHookNodes = 11;            // of a hook
constexpr double kEdge = 0.4e-3;      // [m]
constexpr double kEnd = 1.6e-3;       // [m], mean height of the ends above the middle, and depth below it
constexpr double kSwing = 0.35e-3;    // [m], of the ends, up and down
constexpr double kWidth = 0.25e-3;    // [m], half the distance of the two ends of a hook
constexpr int kStrikeEvery = 40;      // steps
constexpr double kStrike = 2.0;       // [m/s]

/// A hook that hangs from z = `end`: down, half round and up again, in the plane of z and `across`.
Points hook(double end, const Vec3& across) {
  const double down = end > 0.0 ? -1.0 : 1.0, straight = 0.5 * ((kHookNodes - 1) * kEdge - kPi * kWidth);
  Points x(3, kHookNodes);
  for (int i = 0; i < kHookNodes; ++i) {
    const double s = kEdge * i - straight, turn = s / kWidth;
    Vec3 p = -kWidth * across + Vec3(0, 0, down * (straight + s));
    if (turn > 0.0) p = -kWidth * std::cos(turn) * across + Vec3(0, 0, down * (straight + kWidth * std::sin(turn)));
    if (turn > kPi) p = kWidth * across + Vec3(0, 0, down * (straight - (s - kPi * kWidth)));
    x.col(i) = p + Vec3(0, 0, end);
  }
  return x;
}

RodState two_hooks() {
  Points x(3, 2 * kHookNodes);
  x << hook(kEnd, Vec3::UnitX()), hook(-kEnd, -Vec3::UnitY());
  RodState s = RodState::from_nodes(x, 2 * kHookNodes);
  s.alive[kHookNodes - 1] = 0;  // between the hooks
  return s;
}

}  // namespace

LinkedStrands::LinkedStrands()
    : rod(RodMaterial(), ContactMaterial(), 2 * kHookNodes), state(two_hooks()), memory_(rod.make_memory()) {
  options_.max_iterations = 4;  // most of these steps do not converge, and must not cross all the same
  for (int i : {0, kHookNodes - 1, kHookNodes, 2 * kHookNodes - 1}) rod.boundary.held.col(i).head<3>() = true;
}

/// Frequencies without a common period: the motion does not repeat.
void LinkedStrands::drive(double t) noexcept {
  const double w = 2.0 * kPi * t;
  for (int k = 0; k < 2; ++k) {
    const double side = k == 0 ? 1.0 : -1.0, start = k == 0 ? 0.0 : -0.5 * kPi;
    const double turn = start + side * 0.9 * kPi * std::sin(1.7 * w);
    const Vec3 across = kWidth * Vec3(std::cos(turn), std::sin(turn), 0.0);
    const double height = side * (kEnd + kSwing * std::sin((k == 0 ? 41.0 : 29.3) * w));
    const Vec3 middle(0.3e-3 * std::sin((k == 0 ? 13.1 : 17.9) * w), 0.3e-3 * std::sin((k == 0 ? 19.7 : 11.3) * w), height);
    rod.boundary.target.col(k * kHookNodes).head<3>() = middle - across;
    rod.boundary.target.col(k * kHookNodes + kHookNodes - 1).head<3>() = middle + across;
  }
}

void LinkedStrands::strike() {
  std::uniform_real_distribution<double> speed(-kStrike, kStrike);
  for (int i = 0; i < state.n; ++i)
    for (int c = 0; c < 3; ++c) state.v(c, i) = speed(random_);
}

RodStepSummary LinkedStrands::advance() {
  drive(options_.dt * ++step_);
  if (step_ % kStrikeEvery == 0) strike();
  return rod.step(state, memory_, options_);
}

double LinkedStrands::linking() const { return linking_number(state.x.leftCols(kHookNodes), state.x.middleCols(kHookNodes, kHookNodes)); }

}  // namespace filum
