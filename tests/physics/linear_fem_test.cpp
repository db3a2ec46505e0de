#include "physics/linear_fem.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"

namespace filum {
namespace linear_fem_test {

using Method = FemSolverOptions::Method;

FemSolverOptions exact(Method method = Method::conjugate_gradients, double relative = 1e-12) {
  FemSolverOptions o;
  o.method = method;
  o.relative = relative;
  o.max_iterations = 20000;
  return o;
}

/// Block of irregular tetrahedra: nodes inside are moved by up to a fifth of a cell.
TetMesh irregular_block(int n) {
  TetMesh m = box_mesh(Vec3::Zero(), Vec3::Ones(), n, n, n);
  for (int i = 0; i < m.n_nodes(); ++i) {
    const Vec3 x = m.nodes.col(i);
    const bool inside = (x.array() > 0.01).all() && (x.array() < 0.99).all();
    if (inside) m.nodes.col(i) += 0.2 / n * Vec3(std::sin(17.0 * i), std::sin(29.0 * i), std::sin(43.0 * i));
  }
  return m;
}

std::vector<int> nodes_where(const TetMesh& m, const std::function<bool(const Vec3&)>& take) {
  std::vector<int> list;
  for (int i = 0; i < m.n_nodes(); ++i)
    if (take(m.nodes.col(i))) list.push_back(i);
  return list;
}

bool on_border(const Vec3& x) { return (x.array() < 1e-9).any() || (x.array() > 1.0 - 1e-9).any(); }

class PatchTest : public testing::TestWithParam<bool> {};

TEST_P(PatchTest, LinearDisplacementIsExact) {
  FemOptions options;
  options.averaged_pressure = GetParam();
  options.solver = exact();
  const FemMaterial material{10e3, 0.45, 1000.0};
  LinearFem fem(irregular_block(4), {material}, options);
  Mat3 A;
  A << 1e-3, 2e-4, 0, 0, -5e-4, 1e-4, 3e-4, 0, 7e-4;
  std::vector<MovedNode> moved;
  for (const int i : nodes_where(fem.mesh(), on_border)) moved.push_back({i, true, A * fem.mesh().nodes.col(i)});
  FemState s = fem.rest();
  ASSERT_TRUE(fem.equilibrium(s, moved).converged);
  EXPECT_LT((s.u - A * fem.mesh().nodes).cwiseAbs().maxCoeff(), 1e-12);
  const double mu = 10e3 / 2.9, lambda = 10e3 * 0.45 / (1.45 * 0.1);
  const Mat3 strain = 0.5 * (A + A.transpose());
  const Mat3 stress = lambda * strain.trace() * Mat3::Identity() + 2.0 * mu * strain;
  for (int e = 0; e < fem.mesh().n_tets(); e += 7) EXPECT_LT((fem.stress(s.u, e) - stress).norm(), 1e-8 * stress.norm());
  const Points force = fem.elastic_force(s.u);
  for (int i = 0; i < fem.mesh().n_nodes(); ++i) {
    if (on_border(fem.mesh().nodes.col(i))) continue;
    EXPECT_LT(force.col(i).norm(), 1e-10 * force.norm());
  }
}
INSTANTIATE_TEST_SUITE_P(PlainAndAveraged, PatchTest, testing::Bool());

TEST(LinearFem, RigidTranslationAndSmallRotationCostNothing) {
  LinearFem fem(irregular_block(3), {{}}, {});
  const Vec3 w(0.3, -0.2, 0.5);
  Points u(3, fem.mesh().n_nodes());
  for (int i = 0; i < u.cols(); ++i) u.col(i) = Vec3(0.1, 0.2, -0.3) + w.cross(Vec3(fem.mesh().nodes.col(i)));
  EXPECT_LT(fem.elastic_force(u).norm(), 1e-10 * 3e3);
}

TEST(LinearFem, StiffnessIsSymmetricAndItsEnergyNeverNegative) {
  for (const bool averaged : {false, true}) {
    FemOptions options;
    options.averaged_pressure = averaged;
    LinearFem fem(irregular_block(3), {{3e3, 0.49, 1000.0}}, options);
    Rng rng(3);
    for (int trial = 0; trial < 20; ++trial) {
      Points x(3, fem.mesh().n_nodes()), y = x;
      for (int k = 0; k < x.size(); ++k) x.data()[k] = rng.uniform(-1.0, 1.0), y.data()[k] = rng.uniform(-1.0, 1.0);
      const double xy = y.cwiseProduct(fem.elastic_force(x)).sum(), yx = x.cwiseProduct(fem.elastic_force(y)).sum();
      EXPECT_NEAR(xy, yx, 1e-10 * std::abs(x.cwiseProduct(fem.elastic_force(x)).sum()));
      EXPECT_GT(x.cwiseProduct(fem.elastic_force(x)).sum(), 0.0);
    }
  }
}

/// Beam B of the reference: 0.1 m x 20 mm square, clamped at x = 0, under 0.1 m/s2 sideways.
double beam_tip(const FemOptions& options, int nx, int n) {
  TetMesh mesh = box_mesh(Vec3(0, -0.01, -0.01), Vec3(0.1, 0.01, 0.01), nx, n, n);
  LinearFem fem(mesh, {{10e3, 0.45, 1000.0}}, options);
  fem.hold(nodes_where(mesh, [](const Vec3& x) { return x.x() < 1e-9; }));
  Points loads = Points::Zero(3, mesh.n_nodes());
  loads.row(2) = -0.1 * fem.mass().transpose();
  FemState s = fem.rest();
  EXPECT_TRUE(fem.equilibrium(s, {}, &loads).converged);
  double tip = 0.0;
  for (const int i : nodes_where(mesh, [](const Vec3& x) { return x.x() > 0.1 - 1e-9 && x.segment<2>(1).norm() < 1e-9; })) tip = -s.u(2, i);
  return tip;
}

TEST(LinearFem, CantileverIsTheOneOfAnIndependentProgramOnTheSameMesh) {
  FemOptions options;
  options.solver = exact(Method::conjugate_gradients, 1e-9);
  EXPECT_NEAR(beam_tip(options, 20, 4), 2.28393e-3, 2e-5 * 2.28393e-3);  // C3D4 of CalculiX, Kuhn split
}

TEST(LinearFem, AveragedPressureUnlocksTheCantilever) {
  FemOptions options;
  options.solver = exact(Method::conjugate_gradients, 1e-9);
  options.averaged_pressure = true;
  const double plain_error = 1.0 - 2.28393 / 3.7232;  // 39 % below quadratic elements
  EXPECT_LT(std::abs(1.0 - beam_tip(options, 20, 4) / 3.7232e-3), 0.6 * plain_error);
}

TEST(LinearFem, UndampedEnergyIsKeptToRoundOff) {
  FemOptions options;
  options.dt = 5e-3;
  options.solver = exact();
  options.solver.relative = 1e-15;
  LinearFem fem(irregular_block(3), {{3e3, 0.45, 1000.0}}, options);
  FemState s = fem.rest();
  for (int i = 0; i < s.v.cols(); ++i) s.v.col(i) = 0.1 * Vec3(std::sin(3.0 * i), std::cos(5.0 * i), std::sin(7.0 * i + 1.0));
  const double start = fem.energy(s);
  // u'' must belong to the start: u = 0, so it is zero
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(fem.step(s, {}).sound);
    ASSERT_NEAR(fem.energy(s), start, 1e-10 * start) << "step " << k;
  }
}

/// Column clamped below, pulled and let go: the axial vibration of its own discrete first mode.
TEST(LinearFem, PeriodIsLongerByTheTrapezoidalRulesOwnError) {
  TetMesh mesh = box_mesh(Vec3::Zero(), Vec3(0.01, 0.01, 0.05), 1, 1, 5);
  FemOptions options;
  options.solver = exact();
  options.dt = 0.02;
  LinearFem fem(mesh, {{10e3, 0.0, 1000.0}}, options);
  fem.hold(nodes_where(mesh, [](const Vec3& x) { return x.z() < 1e-9; }));
  const int n = 3 * mesh.n_nodes();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int j = 0; j < mesh.n_nodes(); ++j)
      if (!fem.held()[static_cast<std::size_t>(i)] && !fem.held()[static_cast<std::size_t>(j)])
        K.block<3, 3>(3 * i, 3 * j) = fem.stiffness().block(i, j) / std::sqrt(fem.mass()[i] * fem.mass()[j]);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (fem.held()[static_cast<std::size_t>(i)]) K.block<3, 3>(3 * i, 3 * i) = 1e12 * Mat3::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(K);
  const double omega = std::sqrt(modes.eigenvalues()[0]);
  FemState s = fem.rest();
  for (int i = 0; i < mesh.n_nodes(); ++i) s.u.col(i) = 1e-3 * modes.eigenvectors().col(0).segment<3>(3 * i) / std::sqrt(fem.mass()[i]);
  s.a = -omega * omega * s.u;
  const Points shape = s.u;
  double angle = 0.0, before = 1.0;
  const int steps = 50;
  for (int k = 0; k < steps; ++k) {
    fem.step(s, {});
    const double c = s.u.cwiseProduct(shape).sum() / shape.squaredNorm(), v = s.v.cwiseProduct(shape).sum() / shape.squaredNorm() / omega;
    const double now = std::atan2(-v, c);
    angle += std::remainder(now - (k == 0 ? 0.0 : before), 2.0 * std::numbers::pi);
    before = now;
  }
  EXPECT_NEAR(angle / steps, 2.0 * std::atan(0.5 * omega * options.dt), 1e-9);
}

class SolverTest : public testing::TestWithParam<int> {};

TEST_P(SolverTest, StepWithMovedNodesEqualsADirectSolve) {
  FemOptions options;
  options.dt = 4e-3;
  options.mass_damping = 5.0;
  options.stiffness_damping = 2e-3;
  options.solver = exact(GetParam() == 2 ? Method::conjugate_gradients : Method::gauss_seidel);
  options.solver.relaxation = GetParam() == 1 ? 1.5 : 1.0;
  options.solver.symmetric = GetParam() == 1;
  TetMesh mesh = irregular_block(5);
  mesh.nodes *= 0.05;
  LinearFem fem(mesh, {{3e3, 0.45, 1040.0}}, options);
  fem.hold(nodes_where(mesh, [](const Vec3& x) { return x.z() < 1e-9; }));
  std::vector<MovedNode> moved;
  for (const int i : nodes_where(mesh, [](const Vec3& x) { return x.z() > 0.05 - 1e-9 && x.x() < 0.021; })) {
    MovedNode m{i, i % 2 == 0, Vec3(1e-3, 0, -4e-3)};
    m.stiffness = Vec3(1.0, 3.0, 200.0).asDiagonal();
    moved.push_back(m);
  }
  FemState s = fem.rest();
  for (int i = 0; i < s.u.cols(); ++i)
    if (!fem.held()[static_cast<std::size_t>(i)]) s.v.col(i) = 0.01 * Vec3(std::sin(i), std::cos(i), 0.3);
  const FemState before = s;
  const FemSummary summary = fem.step(s, moved);
  ASSERT_TRUE(summary.converged) << summary.relative;

  // Eq. 2-4 as printed but for the sign of K, with supports, by sparse Cholesky
  const int n = mesh.n_nodes();
  const double dt = options.dt;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(3 * n);
  const Points w = options.stiffness_damping * (2.0 / dt * before.u + before.v), Kw = fem.elastic_force(w);
  std::vector<int> mover(static_cast<std::size_t>(n), -1);
  for (std::size_t k = 0; k < moved.size(); ++k) mover[static_cast<std::size_t>(moved[k].node)] = static_cast<int>(k);
  for (int i = 0; i < n; ++i) {
    const double m = fem.mass()[i];
    right.segment<3>(3 * i) = m * (4.0 / (dt * dt) * before.u.col(i) + 4.0 / dt * before.v.col(i) + before.a.col(i)) +
                              options.mass_damping * m * (2.0 / dt * before.u.col(i) + before.v.col(i)) + Kw.col(i);
    for (int j = 0; j < n; ++j) {
      Mat3 block = (1.0 + 2.0 / dt * options.stiffness_damping) * fem.stiffness().block(i, j);
      if (i == j) block += (4.0 / (dt * dt) + 2.0 / dt * options.mass_damping) * m * Mat3::Identity();
      const int k = mover[static_cast<std::size_t>(i)];
      if (i == j && fem.held()[static_cast<std::size_t>(i)]) block += 1e9 * Mat3::Identity();
      if (i == j && k >= 0) {
        const Mat3 S = moved[static_cast<std::size_t>(k)].prescribed ? Mat3(1e9 * Mat3::Identity()) : moved[static_cast<std::size_t>(k)].stiffness;
        block += S;
        right.segment<3>(3 * i) += S * moved[static_cast<std::size_t>(k)].target;
      }
      if (block.isZero()) continue;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) entries.emplace_back(3 * i + r, 3 * j + c, block(r, c));
    }
  }
  Eigen::SparseMatrix<double> A(3 * n, 3 * n);
  A.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd answer = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(A).solve(right);
  EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(s.u.data(), 3 * n) - answer).norm(), 1e-6 * answer.norm());
}
INSTANTIATE_TEST_SUITE_P(GaussSeidelSorConjugateGradients, SolverTest, testing::Range(0, 3));

TEST(LinearFem, AnElementTakenOutLeavesTheMatrixOfTheMeshWithoutIt) {
  for (const bool single : {false, true}) {
    FemOptions options;
    options.single_precision = single;
    TetMesh mesh = irregular_block(3);
    LinearFem fem(mesh, {{}}, options);
    FemState s = fem.rest();
    EXPECT_TRUE(fem.remove_element(s, 40));
    EXPECT_FALSE(fem.remove_element(s, 40));
    TetMesh without = mesh;
    without.tets.erase(without.tets.begin() + 40);
    const LinearFem fresh(without, {{}}, options);
    for (int i = 0; i < mesh.n_nodes(); ++i)
      for (int j = 0; j < mesh.n_nodes(); ++j)
        EXPECT_LT((fem.stiffness().block(i, j) - fresh.stiffness().block(i, j)).norm(), 1e-9 * 3e3);
    FemState whole = fem.rest();
    fem.match(whole);  // a restored state brings the element back
    EXPECT_LT((fem.stiffness().block(5, 5) - LinearFem(mesh, {{}}, options).stiffness().block(5, 5)).norm(), 1e-9);
  }
}

TEST(LinearFem, TissueWithoutAllItsElementsStaysFinite) {
  TetMesh mesh = irregular_block(2);
  LinearFem fem(mesh, {{}}, {});
  FemState s = fem.rest();
  for (int e = 0; e < mesh.n_tets(); ++e) fem.remove_element(s, e);
  std::vector<MovedNode> moved = {{0, true, Vec3(1e-3, 0, 0)}};
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(fem.step(s, moved).sound);
  EXPECT_TRUE(s.u.allFinite());
}

TEST(LinearFem, ForcesOfMovedAndHeldNodesBalanceTheLoad) {
  FemOptions options;
  options.solver = exact();
  TetMesh mesh = irregular_block(4);
  LinearFem fem(mesh, {{}}, options);
  std::vector<MovedNode> moved;
  for (const int i : nodes_where(mesh, [](const Vec3& x) { return x.z() < 1e-9; })) moved.push_back({i, true, Vec3::Zero()});
  Points loads = Points::Zero(3, mesh.n_nodes());
  loads.col(mesh.n_nodes() - 1) = Vec3(0.1, -0.2, 0.3);
  FemState s = fem.rest();
  ASSERT_TRUE(fem.equilibrium(s, moved, &loads).converged);
  Vec3 sum = Vec3(0.1, -0.2, 0.3);
  for (const MovedNode& m : moved) sum += m.force;
  EXPECT_LT(sum.norm(), 1e-9);
}

TEST(LinearFem, SinglePrecisionMatrixGivesTheSameStepToAMillionth) {
  TetMesh mesh = irregular_block(4);
  FemState narrow, wide;
  for (const bool single : {false, true}) {
    FemOptions options;
    options.single_precision = single;
    options.solver = exact();
    options.solver.relative = 1e-9;
    LinearFem fem(mesh, {{}}, options);
    std::vector<MovedNode> moved = {{3, true, Vec3(0.01, 0, 0.02)}};
    FemState& s = single ? narrow : wide;
    s = fem.rest();
    for (int k = 0; k < 5; ++k) fem.step(s, moved);
  }
  EXPECT_LT((narrow.u - wide.u).norm(), 1e-6 * wide.u.norm());
}

TEST(LinearFem, ForceOfAFixedExposureRelaxesByItsShareAndTime) {
  FemOptions options;
  options.dt = 0.01;
  options.mass_damping = 20.0;
  options.stiffness_damping = 2e-3;
  options.solver.relative = 1e-6;
  options.relaxation = {{0.75, 2.0}};
  TetMesh mesh = irregular_block(3);
  mesh.nodes *= 0.03;
  LinearFem fem(mesh, {{}}, options);
  fem.hold(nodes_where(mesh, [](const Vec3& x) { return x.z() < 1e-9; }));
  std::vector<MovedNode> moved;
  for (const int i : nodes_where(mesh, [](const Vec3& x) { return x.z() > 0.03 - 1e-9; })) moved.push_back({i, true, Vec3(0, 0, -2e-3)});
  FemState rest = fem.rest(), s = rest;
  const auto press = [&] {
    double sum = 0.0;
    for (const MovedNode& m : moved) sum -= m.force.z();
    return sum;
  };
  fem.equilibrium(rest, moved);
  const double at_once = press();
  for (int k = 0; k < 200; ++k) fem.step(s, moved);
  EXPECT_NEAR(press() / at_once, 1.0 - 0.75 * (1.0 - std::exp(-1.0)), 0.02);
  for (int k = 0; k < 1400; ++k) fem.step(s, moved);
  EXPECT_NEAR(press() / at_once, 0.25, 0.01);
}

TEST(LinearFem, NumbersThatAreNotFiniteAreReportedAndNotKept) {
  TetMesh mesh = irregular_block(2);
  LinearFem fem(mesh, {{}}, {});
  FemState s = fem.rest();
  std::vector<MovedNode> moved = {{0, true, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0)}};
  EXPECT_FALSE(fem.step(s, moved).sound);
  EXPECT_TRUE(s.u.allFinite());
  EXPECT_TRUE(moved[0].force.allFinite());
}

TEST(LinearFem, ImpossibleMaterialsAndMeshesAreRefused) {
  const auto refused = [](const FemMaterial& m) {
    try {
      LinearFem fem(irregular_block(2), {m}, {}, "tissue.yaml");
    } catch (const InputError& e) {
      return e.field;
    }
    return std::string();
  };
  EXPECT_EQ(refused({3e3, 0.5, 1000.0}), "poisson");
  EXPECT_EQ(refused({3e3, 0.7, 1000.0}), "poisson");
  EXPECT_EQ(refused({3e3, 0.3, -1.0}), "density");
  EXPECT_EQ(refused({0.0, 0.3, 1000.0}), "young");
  EXPECT_EQ(refused({std::nan(""), 0.3, 1000.0}), "young");
  EXPECT_EQ(refused({3e3, 0.45, 1040.0}), "");
  TetMesh mesh = irregular_block(2);
  mesh.region.assign(mesh.tets.size(), 1);
  EXPECT_THROW(LinearFem(mesh, {{}}, {}), InputError);
}

}  // namespace linear_fem_test
}  // namespace filum
