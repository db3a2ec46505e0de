#include "collision/segment_distance.h"

#include <gtest/gtest.h>

#include <random>

namespace filum {
namespace segment_distance_test {

struct Segments {
  Vec3 p0, p1, q0, q1;
};

Segments random_segments(std::mt19937& gen) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  auto point = [&] { return Vec3(u(gen), u(gen), u(gen)); };
  Segments s{point(), point(), point(), point()};
  if (gen() % 4 == 0) s.q1 = s.q0 + 0.7 * (s.p1 - s.p0);  // parallel
  return s;
}

double at(const Segments& s, double a, double b) {
  return ((1 - a) * s.p0 + a * s.p1 - (1 - b) * s.q0 - b * s.q1).norm();
}

/// Distance minus radius at its least, by a grid that is refined about its best point (the function is convex).
double least_gap(const Segments& s, double r0, double r1) {
  double ca = 0.5, cb = 0.5, half = 0.5, least = 1e9;
  for (int round = 0; round < 12; ++round, half *= 0.35) {
    const double a0 = ca, b0 = cb;
    for (int i = -10; i <= 10; ++i) {
      for (int j = -10; j <= 10; ++j) {
        const double a = std::clamp(a0 + half * i / 10, 0.0, 1.0), b = std::clamp(b0 + half * j / 10, 0.0, 1.0);
        const double gap = at(s, a, b) - (1 - b) * r0 - b * r1;
        if (gap >= least) continue;
        least = gap;
        ca = a;
        cb = b;
      }
    }
  }
  return least;
}

TEST(SegmentDistance, EqualsBruteForceSearch) {
  std::mt19937 gen(1);
  for (int trial = 0; trial < 300; ++trial) {
    const Segments s = random_segments(gen);
    const SegmentPair c = closest_points(s.p0, s.p1, s.q0, s.q1);
    EXPECT_NEAR(c.distance, least_gap(s, 0, 0), 1e-4) << trial;
    EXPECT_NEAR(c.distance, at(s, c.s, c.t), 1e-12);
    EXPECT_NEAR(c.d.norm(), c.distance, 1e-15);
    EXPECT_TRUE(c.s >= 0 && c.s <= 1 && c.t >= 0 && c.t <= 1);
  }
}

/// |d|^2 + spread2 ((s - 1/2)^2 + (t - 1/2)^2) at its least, by a grid that is refined.
double least_pressed(const Segments& s, double spread2) {
  double ca = 0.5, cb = 0.5, half = 0.5, least = 1e9;
  for (int round = 0; round < 14; ++round, half *= 0.4) {
    const double a0 = ca, b0 = cb;
    for (int i = -10; i <= 10; ++i) {
      for (int j = -10; j <= 10; ++j) {
        const double a = std::clamp(a0 + half * i / 10, 0.0, 1.0), b = std::clamp(b0 + half * j / 10, 0.0, 1.0);
        const double sum = std::pow(at(s, a, b), 2) + spread2 * (std::pow(a - 0.5, 2) + std::pow(b - 0.5, 2));
        if (sum >= least) continue;
        least = sum;
        ca = a;
        cb = b;
      }
    }
  }
  return std::sqrt(least);
}

TEST(SegmentDistance, PressedPointsEqualBruteForceSearch) {
  std::mt19937 gen(4);
  for (int trial = 0; trial < 300; ++trial) {
    const Segments s = random_segments(gen);
    const double spread2 = trial % 2 == 0 ? 0.01 : 0.3;
    const SegmentPair c = pressed_points(s.p0, s.p1, s.q0, s.q1, spread2);
    EXPECT_NEAR(c.distance, least_pressed(s, spread2), 1e-6) << trial;
    EXPECT_TRUE(c.s >= 0 && c.s <= 1 && c.t >= 0 && c.t <= 1);
    EXPECT_NEAR(c.d.norm(), at(s, c.s, c.t), 1e-12);
    const double closest = closest_points(s.p0, s.p1, s.q0, s.q1).distance;
    EXPECT_GE(c.distance, closest - 1e-12);
    EXPECT_LE(c.distance, std::sqrt(closest * closest + 0.5 * spread2) + 1e-12);
  }
}

TEST(SegmentDistance, PressedPointsGoOverWhereClosestPointsJump) {
  const auto tilted = [](double rise) {  // two parallel segments, the second end of one raised
    return Segments{{0, 0, 1}, {2, 0, 1 + rise}, {0, 0, 0}, {2, 0, 0}};
  };
  const double spread2 = 0.01;  // the push goes over from end to end within a rise of spread2 / distance
  const auto pressed = [&](double rise) {
    const Segments s = tilted(rise);
    return pressed_points(s.p0, s.p1, s.q0, s.q1, spread2);
  };
  EXPECT_DOUBLE_EQ(pressed(0.0).s, 0.5);
  EXPECT_EQ(pressed(0.02).s, 0.0);
  EXPECT_EQ(pressed(-0.02).s, 1.0);
  EXPECT_NEAR(pressed(0.005).s, 0.25, 0.01);
  const Segments up = tilted(1e-4), down = tilted(-1e-4);
  const double jump = closest_points(up.p0, up.p1, up.q0, up.q1).s - closest_points(down.p0, down.p1, down.q0, down.q1).s;
  EXPECT_GT(std::abs(jump), 0.4);
  for (const double rise : {-0.015, -0.004, 0.0, 0.003, 0.009}) {  // the distance's gradient is d/distance, weighted
    const double h = 1e-6;
    const SegmentPair c = pressed(rise);
    EXPECT_NEAR((pressed(rise + h).distance - pressed(rise - h).distance) / (2 * h), c.s * c.d.z() / c.distance, 1e-6) << rise;
  }
}

TEST(SegmentDistance, PressOnABarGoesOverToo) {
  const auto s_at = [](double rise) {
    return pressed_on_bar({0, 0, 1}, {2, 0, 1 + rise}, {-3, 0, 0}, {5, 0, 0}, 0.02, 0.10, 0.02).s;
  };
  EXPECT_EQ(s_at(-0.07), 1.0);  // the bar thickens towards the second end by 0.02 along the segment
  EXPECT_EQ(s_at(0.07), 0.0);
  EXPECT_GT(s_at(0.018), 0.02);
  EXPECT_LT(s_at(0.022), 0.98);
  EXPECT_GT(s_at(0.018), s_at(0.022));
}

TEST(SegmentDistance, TaperedBarEqualsBruteForceSearch) {
  std::mt19937 gen(2);
  for (int trial = 0; trial < 300; ++trial) {
    const Segments s = random_segments(gen);
    const SegmentPair c = pressed_on_bar(s.p0, s.p1, s.q0, s.q1, 0.02, 0.10, 1e-12);
    const double gap = c.distance - (1 - c.t) * 0.02 - c.t * 0.10;
    if (c.distance < 0.1) continue;  // axes that meet have no normal
    EXPECT_NEAR(gap, least_gap(s, 0.02, 0.10), 1e-4) << trial;
  }
}

TEST(SegmentDistance, GapOfTaperedBarChangesAlongTheNormal) {
  std::mt19937 gen(3);
  int checked = 0;
  auto gap = [](const Segments& s) {
    const SegmentPair c = pressed_on_bar(s.p0, s.p1, s.q0, s.q1, 0.02, 0.10, 1e-12);
    return c.distance - (1 - c.t) * 0.02 - c.t * 0.10;
  };
  for (int trial = 0; trial < 300; ++trial) {
    const Segments s = random_segments(gen);
    const SegmentPair c = pressed_on_bar(s.p0, s.p1, s.q0, s.q1, 0.02, 0.10, 1e-12);
    const bool smooth = c.s > 0.05 && c.s < 0.95 && c.t > 0.05 && c.t < 0.95;
    if (!smooth || c.distance < 0.1) continue;
    ++checked;
    for (int axis = 0; axis < 3; ++axis) {
      const double h = 1e-6;
      Segments up = s, down = s;  // the whole segment moves
      up.p0[axis] += h, up.p1[axis] += h;
      down.p0[axis] -= h, down.p1[axis] -= h;
      EXPECT_NEAR((gap(up) - gap(down)) / (2 * h), c.d[axis] / c.distance, 1e-6) << trial;
    }
  }
  EXPECT_GT(checked, 20);
}

}  // namespace segment_distance_test
}  // namespace filum
