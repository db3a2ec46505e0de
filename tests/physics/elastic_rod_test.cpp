#include "physics/elastic_rod.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace filum {
namespace elastic_rod_test {

constexpr double kPi = std::numbers::pi;

/// A bent, twisted, stretched rod with rest curvature: nothing about it is special.
struct Sample {
  RodMaterial m;
  RodState s;
  Points x;
  Eigen::VectorXd theta;
};

Sample crooked_rod(unsigned seed, int n = 7) {
  std::mt19937 gen(seed);
  std::normal_distribution<double> normal;
  Points nodes(3, n);
  for (int i = 0; i < n; ++i) nodes.col(i) = Vec3(i + 0.2 * normal(gen), 0.3 * normal(gen), 0.3 * normal(gen));
  Sample c;
  c.m.EA = 3.0;
  c.m.EI = 0.7;
  c.m.GJ = 0.4;
  c.s = RodState::from_nodes(nodes, n);
  for (int i = 0; i < n; ++i) {
    c.s.rest_kappa.col(i) << 0.2 * normal(gen), 0.2 * normal(gen), 0.2 * normal(gen), 0.2 * normal(gen);
    c.s.rest_twist[i] = 0.1 * normal(gen);
    c.s.rest_length[i] *= 1.0 + 0.1 * normal(gen);
  }
  c.x = c.s.x;
  c.theta = c.s.theta;
  for (int i = 0; i < n; ++i) {
    c.x.col(i) += 0.1 * Vec3(normal(gen), normal(gen), normal(gen));
    c.theta[i] += 0.5 * normal(gen);
  }
  c.theta[n - 1] = 0.0;  // there is no edge behind the last node
  return c;
}

/// The reference frames are moved along with the trial point, so that its reference is itself: this is where the
/// derivatives of a time-parallel frame are stated.
void settle(Sample& c) {
  RodGeometry g(static_cast<int>(c.x.cols()));
  update_geometry(c.s, c.x, c.theta, g);
  accept_geometry(g, c.x, c.theta, c.s);
}

double energy_at(const Sample& c, const Points& x, const Eigen::VectorXd& theta) {
  RodGeometry g(static_cast<int>(x.cols()));
  update_geometry(c.s, x, theta, g);
  return elastic_energy(c.m, c.s, g);
}

Eigen::Matrix4Xd gradient_at(const Sample& c, const Points& x, const Eigen::VectorXd& theta) {
  RodGeometry g(static_cast<int>(x.cols()));
  update_geometry(c.s, x, theta, g);
  Eigen::Matrix4Xd gradient = Eigen::Matrix4Xd::Zero(4, x.cols());
  add_elastic_gradient(c.m, c.s, g, gradient);
  return gradient;
}

void nudge(Sample& c, int q, double h) {
  if (q % 4 < 3)
    c.x(q % 4, q / 4) += h;
  else
    c.theta[q / 4] += h;
}

TEST(ElasticRod, ForceIsMinusTheGradientOfTheEnergy) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Sample c = crooked_rod(seed);
    settle(c);
    const Eigen::Matrix4Xd g = gradient_at(c, c.x, c.theta);
    for (int q = 0; q < 4 * 7 - 1; ++q) {
      const double h = 1e-6;
      Sample plus = c, minus = c;
      nudge(plus, q, h);
      nudge(minus, q, -h);
      const double slope = (energy_at(c, plus.x, plus.theta) - energy_at(c, minus.x, minus.theta)) / (2 * h);
      EXPECT_NEAR(g(q % 4, q / 4), slope, 2e-7 * (1 + std::abs(slope))) << "seed " << seed << " coordinate " << q;
    }
  }
}

TEST(ElasticRod, StiffnessIsTheDerivativeOfTheForce) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Sample c = crooked_rod(seed, 5);
    settle(c);
    const int n = 5;
    RodGeometry g(n);
    update_geometry(c.s, c.x, c.theta, g);
    BlockCholesky k(n);
    k.begin_pattern(n);
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < std::min(n, i + 3); ++j) k.connect(i, j);
    k.analyse();
    ChainSlots slots;
    for (int i = 0; i < n; ++i) {
      slots.next.push_back(i + 1 < n ? k.find(i, i + 1) : BlockCholesky::Slot{});
      slots.second.push_back(i + 2 < n ? k.find(i, i + 2) : BlockCholesky::Slot{});
    }
    k.set_zero();
    add_elastic_hessian(c.m, c.s, g, Stiffness::exact, slots, k);
    // The same matrix by differences, compared through its action: shift both by sigma I, solve, and multiply back.
    const double sigma = 200.0;
    Eigen::MatrixXd numeric(4 * n, 4 * n);
    for (int q = 0; q < 4 * n; ++q) {
      const double h = 1e-5;
      Sample plus = c, minus = c;
      nudge(plus, q, h);
      nudge(minus, q, -h);
      const Eigen::Matrix4Xd d = (gradient_at(c, plus.x, plus.theta) - gradient_at(c, minus.x, minus.theta)) / (2 * h);
      numeric.col(q) = Eigen::Map<const Eigen::VectorXd>(d.data(), 4 * n);
    }
    numeric.col(4 * n - 1).setZero();
    numeric = 0.5 * (numeric + numeric.transpose()).eval();
    numeric.diagonal().array() += sigma;
    for (int i = 0; i < n; ++i) k.add_diagonal(i, sigma * Mat4::Identity());
    ASSERT_TRUE(k.factor());
    for (int q = 0; q < 4 * n; ++q) {
      Eigen::Matrix4Xd b = Eigen::Matrix4Xd::Zero(4, n);
      b(q % 4, q / 4) = 1.0;
      k.solve(b);
      Eigen::VectorXd back = numeric * Eigen::Map<const Eigen::VectorXd>(b.data(), 4 * n);
      back[q] -= 1.0;
      EXPECT_LT(back.cwiseAbs().maxCoeff() * sigma, 2e-3) << "seed " << seed << " column " << q;
    }
  }
}

/// Nodes are worked out four at a time: of what lies beyond the inner ones nothing is taken over.
TEST(ElasticRod, FirstAndLastNodeHaveNoReferenceTwist) {
  for (int n = 4; n < 9; ++n) {
    Sample c = crooked_rod(1, n);
    c.s.ref_twist[0] = c.s.ref_twist[n - 1] = 0.7;
    settle(c);
    EXPECT_EQ(c.s.ref_twist[0], 0.0);
    EXPECT_EQ(c.s.ref_twist[n - 1], 0.0) << n << " nodes";
  }
}

TEST(ElasticRod, RestShapeAndRigidMotionGiveNoForce) {
  Points nodes(3, 20);
  for (int i = 0; i < 20; ++i) nodes.col(i) = Vec3(std::cos(0.3 * i), std::sin(0.3 * i), 0.1 * i);
  Sample c;
  c.s = RodState::from_nodes(nodes, 20, false);
  c.m = RodMaterial::round_wire(0.01, 1e6, 0.4, 1000);
  EXPECT_LT(gradient_at(c, c.s.x, c.s.theta).cwiseAbs().maxCoeff(), 1e-9);
  // A rigid turn, taken in small steps, with the material directors turned along: parallel transport leaves each edge a
  // different spin about its tangent, and twist must not notice.
  RodGeometry rest(20);
  update_geometry(c.s, c.s.x, c.s.theta, rest);
  for (int step = 1; step <= 200; ++step) {
    const Quat q(Eigen::AngleAxisd(2.5 * step / 200.0, Vec3(1, 2, 3).normalized()));
    Points moved(3, 20);
    for (int i = 0; i < 20; ++i) moved.col(i) = q * Vec3(nodes.col(i)) + 0.01 * step * Vec3(3, -1, 2);
    RodGeometry g(20);
    update_geometry(c.s, moved, c.s.theta, g);
    Eigen::VectorXd theta = c.s.theta;
    for (int j = 0; j < 19; ++j) {
      const Vec3 target = q * Vec3(rest.m1.col(j));
      theta[j] += std::atan2(Vec3(g.m1.col(j)).cross(target).dot(g.t.col(j)), g.m1.col(j).dot(target));
    }
    update_geometry(c.s, moved, theta, g);
    Eigen::Matrix4Xd force = Eigen::Matrix4Xd::Zero(4, 20);
    add_elastic_gradient(c.m, c.s, g, force);
    EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-9) << "step " << step;
    accept_geometry(g, moved, theta, c.s);
  }
}

// A regular N-gon with rest lengths equal to the arc: U / (EI pi / R) = (tan x / x)^2 with x = pi/N, order 2
// (Bergou 2008 curvature binormal; rods.md V11).
TEST(ElasticRod, BendingEnergyOfAPolygonConvergesAtOrderTwo) {
  const double R = 0.8;
  auto ratio = [&](int n) {
    Points nodes(3, n + 3);
    for (int i = 0; i < n + 3; ++i) nodes.col(i) = R * Vec3(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0);
    RodState s = RodState::from_nodes(nodes, n + 3);
    s.rest_length.setConstant(2 * kPi * R / n);
    RodMaterial m;
    m.EA = 0;
    m.EI = 2.0;
    RodGeometry g(n + 3);
    update_geometry(s, s.x, s.theta, g);
    return elastic_energy(m, s, g) * n / (n + 1.0) / (m.EI * kPi / R);  // n + 1 inner nodes measured, n make the circle
  };
  EXPECT_NEAR(ratio(20), 1.01668, 1e-5);
  EXPECT_NEAR(ratio(50), 1.00264, 1e-5);
  EXPECT_NEAR(std::log2((ratio(50) - 1) / (ratio(100) - 1)), 2.0, 0.01);
}

// A straight round rod bent to a polygon: whatever its directors do, the bending energy is EI/2 sum |kb|^2 / l, its force on the
// nodes the same, and it has no grip on the twist. (The square of the mean curvature loses cos^2(twist/2): 17 % at 0.84 rad.)
TEST(ElasticRod, BendingStiffnessDoesNotDependOnTwist) {
  const int n = 24;
  const double side = 2 * std::sin(kPi / n);
  Points nodes(3, n);
  for (int i = 0; i < n; ++i) nodes.col(i) = Vec3(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0);
  Sample c;
  c.s = RodState::from_nodes(nodes, n);
  c.m.EA = c.m.GJ = 0;
  c.m.EI = 2.0;
  c.x = nodes;
  c.theta = Eigen::VectorXd::Zero(n);
  const double untwisted = energy_at(c, c.x, c.theta);
  EXPECT_NEAR(untwisted, 0.5 * c.m.EI * (n - 2) * std::pow(2 * std::tan(kPi / n), 2) / side, 1e-12);
  const Eigen::Matrix4Xd force = gradient_at(c, c.x, c.theta);
  for (double per_edge : {0.1, 0.84, 1.6, -3.0}) {
    for (int j = 0; j + 1 < n; ++j) c.theta[j] = per_edge * j;
    EXPECT_NEAR(energy_at(c, c.x, c.theta), untwisted, 1e-12 * untwisted) << per_edge << " rad per edge";
    EXPECT_LT((gradient_at(c, c.x, c.theta) - force).cwiseAbs().maxCoeff(), 1e-12 * force.cwiseAbs().maxCoeff());
  }
}

TEST(ElasticRod, PartedEdgeCarriesNothing) {
  Sample c = crooked_rod(3);
  settle(c);
  c.s.alive[2] = 0;
  const Eigen::Matrix4Xd g = gradient_at(c, c.x, c.theta);
  Vec3 left = Vec3::Zero(), right = Vec3::Zero();
  for (int i = 0; i < 7; ++i) (i <= 2 ? left : right) += g.col(i).head<3>();
  EXPECT_LT(left.norm(), 1e-12);
  EXPECT_LT(right.norm(), 1e-12);
}

TEST(ElasticRod, ParallelTransportKeepsLengthAndAngle) {
  const Vec3 a = Vec3(1, 2, 0.5).normalized(), b = Vec3(-0.3, 1, 1).normalized();
  const Vec3 d = a.unitOrthogonal();
  const Vec3 moved = parallel_transport(d, a, b);
  EXPECT_NEAR(moved.norm(), 1.0, 1e-14);
  EXPECT_NEAR(moved.dot(b), 0.0, 1e-14);
  EXPECT_NEAR(moved.dot(a.cross(b)), d.dot(a.cross(b)), 1e-14);
}

// A wire wound on a mandrel past its elastic limit springs back by the limit and no further: 1/R_free = 1/R - kappa_limit.
TEST(ElasticRod, KeepsASetWhenBentBeyondItsLimit) {
  constexpr int n = 41;
  constexpr double radius = 12.5e-6, limit_strain = 0.05, mandrel = 60e-6;
  const double limit = most_elastic_curvature(limit_strain, radius);
  EXPECT_NEAR(limit, 16.0 / (3.0 * kPi) * limit_strain / radius, 1e-9 * limit);
  ASSERT_GT(1.0 / mandrel, limit);
  RodMaterial m = RodMaterial::round_wire(radius, 2.5e9, 0.37, 1140.0);
  Points straight = Points::Zero(3, n), wound(3, n);
  constexpr double step = 0.1;  // [rad] between nodes
  for (int i = 0; i < n; ++i) {
    straight(0, i) = i * 2.0 * mandrel * std::sin(0.5 * step);
    wound.col(i) = mandrel * Vec3(std::sin(i * step), 1.0 - std::cos(i * step), 0.0);
  }
  RodGeometry g(n);
  for (bool yields : {false, true}) {
    m.most_elastic_curvature = yields ? limit : std::numeric_limits<double>::infinity();
    RodState s = RodState::from_nodes(straight, n);
    update_geometry(s, wound, s.theta, g);
    accept_geometry(g, wound, s.theta, s);
    take_set(m, s, g);
    const double kept = s.rest_kappa.col(n / 2).head<2>().norm() / s.rest_length[0];
    EXPECT_NEAR(kept, yields ? 1.0 / mandrel - limit : 0.0, 0.003 / mandrel) << yields;
    const Eigen::Matrix4Xd before = s.rest_kappa;
    take_set(m, s, g);
    EXPECT_LT((s.rest_kappa - before).cwiseAbs().maxCoeff(), 1e-12) << "nothing more flows at the limit";
  }
}

}  // namespace elastic_rod_test
}  // namespace filum
