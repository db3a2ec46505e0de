#include "physics/rod_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "collision/segment_distance.h"

namespace filum {
namespace rod_contact_test {

constexpr double kRadius = 12.5e-6;

Vec3 random_vector(std::mt19937& gen, double size) {
  std::normal_distribution<double> n;
  return size * Vec3(n(gen), n(gen), n(gen));
}

RodState tangle(std::mt19937& gen, int n) {
  Points x(3, n);
  x.col(0).setZero();
  for (int i = 1; i < n; ++i) {
    const Vec3 back = -0.1 * x.col(i - 1);  // keeps the walk in a ball
    x.col(i) = x.col(i - 1) + 100e-6 * (back / 100e-6 + random_vector(gen, 1.0)).normalized();
  }
  return RodState::from_nodes(x, n);
}

TEST(RodContact, PairPotentialDerivativesAgreeWithDifferences) {
  const double k = 1e4;
  for (double q : {0.05, 0.3, 0.7, 0.98, 1.02, 1.5, 1.9, 1.99}) {
    const double d = q * kRadius, h = 1e-6 * d;
    const PairPotential p = pair_potential(d, kRadius, k);
    const PairPotential up = pair_potential(d + h, kRadius, k), down = pair_potential(d - h, kRadius, k);
    EXPECT_NEAR((up.energy - down.energy) / (2 * h), p.slope, 1e-5 * std::abs(p.slope)) << q;
    EXPECT_NEAR((up.slope - down.slope) / (2 * h), p.curvature, 1e-5 * p.curvature) << q;
    EXPECT_LT(p.slope, 0.0);
  }
  EXPECT_EQ(pair_potential(2.0 * kRadius, kRadius, k).energy, 0.0);
  EXPECT_GT(pair_potential(1e-300, kRadius, k).energy, 1.9 * pair_potential(1e-150, kRadius, k).energy);  // without bound
}

TEST(RodContact, SqueezeIsHertzOfCrossedCylinders) {
  const double E = 2.5e9, nu = 0.4, h = 12.5e-6;
  const double hertz = 4.0 / 3.0 * E / (2.0 * (1.0 - nu * nu)) * std::sqrt(h);  // F = hertz o^(3/2), equal crossed cylinders
  const double k = hertz * std::sqrt(0.6 * h);
  for (double o : {0.1e-6, 1e-6, 6e-6}) {
    const PairPotential p = squeeze(o, h, k);
    EXPECT_NEAR(-p.slope, hertz * std::pow(o, 1.5), 1e-12 * hertz * std::pow(o, 1.5)) << o;
    EXPECT_NEAR(p.energy, 0.4 * hertz * std::pow(o, 2.5), 1e-12 * hertz * std::pow(o, 2.5)) << o;
  }
  EXPECT_EQ(squeeze(-1e-6, h, k).slope, 0.0);
}

/// Signed volume of the tetrahedron a0 a1 b0 b1: two segments can pass through each other only while it is zero.
double side(const Vec3 p[4]) { return (p[1] - p[0]).cross(p[3] - p[2]).dot(p[2] - p[0]); }

TEST(RodContact, ConservativeAdvanceNeverLetsSegmentsCross) {
  std::mt19937 gen(7);
  std::uniform_real_distribution<double> log_size(-7.0, -1.0);  // of the moves [m], from a radius to a hundred metres a second
  int stopped = 0, would_cross = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Vec3 ends[4], moves[4];
    const double size = std::pow(10.0, log_size(gen));
    for (int e = 0; e < 4; ++e) {
      ends[e] = random_vector(gen, 100e-6);
      moves[e] = random_vector(gen, size);
    }
    const double distance = closest_points(ends[0], ends[1], ends[2], ends[3]).distance;
    const double keep = std::min(1.7 * kRadius, 0.8 * distance);
    const double fraction = conservative_advance(ends, moves, keep);
    ASSERT_GT(fraction, 0.0);
    ASSERT_LE(fraction, 1.0);
    if (fraction < 1.0) ++stopped;
    double least = distance;
    for (int k = 1; k <= 200; ++k) {  // looks on the way for what the bound claims cannot be
      Vec3 p[4];
      for (int e = 0; e < 4; ++e) p[e] = ends[e] + fraction * k / 200.0 * moves[e];
      least = std::min(least, closest_points(p[0], p[1], p[2], p[3]).distance);
    }
    ASSERT_GE(least, keep * (1.0 - 1e-9)) << trial;
    Vec3 last[4];
    for (int e = 0; e < 4; ++e) last[e] = ends[e] + moves[e];
    if ((side(ends) > 0) != (side(last) > 0) && fraction < 1.0) ++would_cross;
  }
  EXPECT_GT(stopped, 500);
  EXPECT_GT(would_cross, 100);
}

TEST(RodContact, HeadOnStrandsStopShortAtAnySpeed) {
  for (double speed : {1e-5, 1e-3, 1.0, 1e3}) {
    const Vec3 ends[4] = {Vec3(-1e-4, 0, 0), Vec3(1e-4, 0, 0), Vec3(0, -1e-4, 5e-5), Vec3(0, 1e-4, 5e-5)};
    const Vec3 down(0, 0, -(5e-5 + speed));
    const Vec3 moves[4] = {Vec3::Zero(), Vec3::Zero(), down, down};
    const double fraction = conservative_advance(ends, moves, 2e-5);
    EXPECT_LT(fraction * (5e-5 + speed), 3e-5);
    EXPECT_GT(fraction * (5e-5 + speed), 2e-5) << "stops early, at speed " << speed;
  }
}

TEST(RodContact, NearPairsEqualBruteForce) {
  std::mt19937 gen(11);
  int found = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const int n = 20 + 7 * trial;
    const RodState s = tangle(gen, n);
    RodContact contact(n, 200000);
    for (int j = 0; j + 1 < n; ++j) contact.travel.reach[j] = std::uniform_real_distribution(0.0, (trial % 4) * 40e-6)(gen);
    contact.find_pairs(s, s.x, kRadius);
    ASSERT_FALSE(contact.overflowed());
    std::set<std::pair<int, int>> expected, actual;
    for (int i = 0; i + 1 < n; ++i) {
      for (int j = i + 2; j + 1 < n; ++j) {
        const double between = s.rest_length.segment(i + 1, j - i - 1).sum();
        if (between < 4.0 * kRadius) continue;
        const double near = 2.0 * kRadius + contact.travel.reach[i] + contact.travel.reach[j];
        if (closest_points(s.x.col(i), s.x.col(i + 1), s.x.col(j), s.x.col(j + 1)).distance <= near)
          expected.emplace(i, j);
      }
    }
    for (const RodPair& p : contact.pairs()) actual.emplace(p.i, p.j);
    EXPECT_TRUE(std::is_sorted(contact.pairs().begin(), contact.pairs().end(), [](const RodPair& p, const RodPair& q) {
      return std::pair(p.i, p.j) < std::pair(q.i, q.j);
    }));
    EXPECT_EQ(actual, expected) << n;
    found += static_cast<int>(expected.size());
  }
  EXPECT_GT(found, 1000);
}

TEST(RodContact, PartedEdgeTouchesNothing) {
  std::mt19937 gen(12);
  RodState s = tangle(gen, 60);
  RodContact contact(60, 20000);
  contact.travel.reach.setConstant(20e-6);
  contact.find_pairs(s, s.x, kRadius);
  ASSERT_FALSE(contact.pairs().empty());
  const int edge = contact.pairs().front().i;
  s.alive[edge] = 0;  // what is left is the gap between two cut ends
  contact.find_pairs(s, s.x, kRadius);
  for (const RodPair& p : contact.pairs()) EXPECT_TRUE(p.i != edge && p.j != edge);
}

// What lies still beside a strand that flies is not measured again, and what flies is: distances and forces are those of a contact that
// looks at every pair.
TEST(RodContact, TravelOfEdgesHidesNoTouch) {
  std::mt19937 gen(14);
  const int n = 90;
  RodState s = tangle(gen, n);
  const ContactMaterial m;
  RodContact told(n, 20000), fresh(n, 20000);
  told.travel.reach.setConstant(400e-6);
  told.find_pairs(s, s.x, kRadius);
  told.update(s.x, kRadius, m, FrictionLoad::anew);
  std::uniform_real_distribution<double> by(-1.0, 1.0);
  int touching = 0;
  for (int k = 0; k < 20; ++k) {
    Eigen::Matrix4Xd move = Eigen::Matrix4Xd::Zero(4, n);
    for (int i = 0; i < n; ++i) move.col(i).head<3>() = (i / 10 % 3 == k % 3 ? 40e-6 : 1e-7) * Vec3(by(gen), by(gen), by(gen));
    told.travel.look_along(move);
    Points x = s.x;
    x.leftCols(n) += 0.5 * move.topRows<3>();
    fresh.travel.reach.setConstant(20e-6);
    fresh.find_pairs(s, x, kRadius);
    fresh.update(x, kRadius, m, FrictionLoad::anew);
    double energy = 0.0;
    for (const RodPair& p : fresh.pairs()) energy += pair_potential(p.distance, kRadius, m.stiffness).energy;
    ContactMaterial slippery = m;
    slippery.friction = 0.0;
    EXPECT_NEAR(told.energy(x, s.x, kRadius, slippery, 0.5), energy, 1e-12 * energy) << k;
    told.travel.went(0.5);
    s.x = x;
    told.update(x, kRadius, m, FrictionLoad::anew);
    const auto sum = [](double f, const RodPair& p) { return f + p.force; };
    const double expected = std::accumulate(fresh.pairs().begin(), fresh.pairs().end(), 0.0, sum);
    EXPECT_NEAR(std::accumulate(told.pairs().begin(), told.pairs().end(), 0.0, sum), expected, 1e-12 * expected) << k;
    touching += fresh.n_touching(kRadius);
  }
  EXPECT_GT(touching, 20) << "or the test shows nothing";
}

TEST(RodContact, SaysSoWhenPairsDoNotFit) {
  std::mt19937 gen(13);
  const RodState s = tangle(gen, 100);
  RodContact contact(100, 3);
  contact.travel.reach.setConstant(50e-6);
  contact.find_pairs(s, s.x, kRadius);
  EXPECT_TRUE(contact.overflowed());
}

TEST(RodContact, ForceIsMinusTheGradientOfTheEnergy) {
  Points x(3, 6);  // two strands one diameter less a bit apart, crossing, joined far away
  x << -1e-4, 1e-4, 1e-3, 1e-3, 3e-5, -2e-5,  //
      0, 1e-5, 0, 1e-3, 1e-4, -1e-4,          //
      0, 0, 1e-3, 1e-3, 1.6e-5, 1.9e-5;
  const RodState s = RodState::from_nodes(x, 6);
  ContactMaterial m;
  m.friction = 0.0;
  RodContact contact(6, 20);
  contact.travel.reach.setConstant(1e-5);
  contact.find_pairs(s, x, kRadius);
  contact.update(x, kRadius, m, FrictionLoad::anew);
  ASSERT_EQ(contact.n_touching(kRadius), 1);
  Eigen::Matrix4Xd gradient = Eigen::Matrix4Xd::Zero(4, 6);
  contact.add_gradient(x, x, m, gradient);
  EXPECT_NEAR(gradient.rowwise().sum().norm(), 0.0, 1e-15);  // action and reaction
  const double h = 1e-10;
  contact.travel.look_along(Eigen::Matrix4Xd::Constant(4, 6, h));
  for (int i = 0; i < 6; ++i) {
    for (int c = 0; c < 3; ++c) {
      Points up = x, down = x;
      up(c, i) += h;
      down(c, i) -= h;
      const double slope = (contact.energy(up, x, kRadius, m, 1.0) - contact.energy(down, x, kRadius, m, 1.0)) / (2 * h);
      EXPECT_NEAR(slope, gradient(c, i), 1e-5 * gradient.norm());
    }
  }
}

}  // namespace rod_contact_test
}  // namespace filum
