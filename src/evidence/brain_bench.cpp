// Timings of the brain: steps of a block under a blade, of an anatomy, and of collision alone.

#include "evidence/brain_bench.h"

#include <sys/resource.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "evidence/brain_block.h"
#include "evidence/percentile.h"
#include "evidence/timing.h"
#include "world/cortex.h"

namespace filum {
namespace {

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

FemOptions run_time(double dt) {
  FemOptions o;
  o.dt = dt;
  o.mass_damping = 20.0;
  o.stiffness_damping = 10e-3;
  o.single_precision = true;
  o.solver.relative = 1e-3;
  o.solver.absolute = 20e-6;
  o.solver.max_iterations = 60;
  return o;
}

/// The continuous push of the paper: down to `deepest` and up again, smoothly, while it moves sideways.
Vec3 push_at(double time, double deepest) { return {2e-3 * std::sin(2.0 * time), 0.0, 0.5e-3 - deepest * 0.5 * (1.0 - std::cos(1.5 * time))}; }

/// K_eff of the block as a plain sparse matrix; held nodes are given a large diagonal.
Eigen::SparseMatrix<double> effective_matrix(const LinearFem& fem) {
  const FemOptions& o = fem.options();
  std::vector<Eigen::Triplet<double>> entries;
  const BlockMatrix& K = fem.stiffness();
  for (int i = 0; i < K.n(); ++i)
    for (int k = K.begins()[static_cast<std::size_t>(i)]; k < K.begins()[static_cast<std::size_t>(i) + 1]; ++k) {
      const int j = K.columns()[static_cast<std::size_t>(k)];
      Mat3 block = (1.0 + 2.0 / o.dt * o.stiffness_damping) * K.at(static_cast<std::size_t>(k));
      if (i == j) block += (4.0 / (o.dt * o.dt) + 2.0 / o.dt * o.mass_damping) * fem.mass()[i] * Mat3::Identity();
      if (i == j && fem.held()[static_cast<std::size_t>(i)]) block += 1e9 * Mat3::Identity();
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) entries.emplace_back(3 * i + r, 3 * j + c, block(r, c));
    }
  Eigen::SparseMatrix<double> A(3 * K.n(), 3 * K.n());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// What the same matrix costs elsewhere: back substitution after a sparse factorisation, and plain conjugate gradients.
void time_rivals(const LinearFem& fem, BenchResult& r) {
  const Eigen::SparseMatrix<double> A = effective_matrix(fem);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(A.rows());
  for (int i = 0; i < fem.mesh().n_nodes(); ++i)
    if (fem.mesh().nodes(2, i) > -1e-9) b[3 * i + 2] = -1e-4;
  auto begin = Clock::now();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(A);
  r.stages.emplace_back("rival: sparse LDLT, factor", milliseconds_since(begin));
  std::vector<double> ms;
  for (int k = 0; k < 5; ++k) {
    begin = Clock::now();
    const Eigen::VectorXd x = factor.solve(b);
    ms.push_back(milliseconds_since(begin));
    b[0] += 1e-30 * x[0];  // the solve is not to be left out
  }
  r.stages.emplace_back("rival: sparse LDLT, back substitution", median(ms));
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> gradients;
  gradients.setTolerance(1e-6);
  gradients.compute(A);
  ms.clear();
  for (int k = 0; k < 5; ++k) {
    begin = Clock::now();
    const Eigen::VectorXd x = gradients.solve(b);
    ms.push_back(milliseconds_since(begin));
    b[0] += 1e-30 * x[0];
  }
  r.stages.emplace_back("rival: Jacobi CG to 1e-6, cold", median(ms));
}

SpatulaParameters spread_over_6_mm() {
  SpatulaParameters parameters;
  parameters.reach = 6e-3;
  return parameters;
}

TetMesh slab_of_10800() { return block_of_nodes(60, 60, 3, Vec3(0.12, 0.12, 0.01)); }

void bench_block(BenchResult& r, const StepTimer& timer, TetMesh mesh, double blade, double deepest, bool rivals) {
  BrainBlock block(std::move(mesh), run_time(1e-3 * r.dt_ms), blade, spread_over_6_mm(), 4);
  r.nodes = block.fem.mesh().n_nodes();
  std::vector<double> contact, solve, whole, processor, iterations, residual;
  int k = 0;
  timer(
      r,
      [&] {
        const double begin = processor_ms();
        block.step(push_at(1e-3 * r.dt_ms * ++k, deepest));
        processor.push_back(processor_ms() - begin);
      },
      [&] {
        r.contacts = std::max(r.contacts, static_cast<int>(block.contacts().size()));
        contact.push_back(block.contact_ms);
        solve.push_back(block.solve_ms);
        whole.push_back(block.contact_ms + block.solve_ms);
        iterations.push_back(block.summary.iterations);
        residual.push_back(block.summary.relative);
      });
  r.stages = {{"contact", median(contact)},
              {"solve", median(solve)},
              {"iterations (number, p50)", median(iterations)},
              {"iterations (number, most)", *std::max_element(iterations.begin(), iterations.end())},
              {"residual (relative, largest)", *std::max_element(residual.begin(), residual.end())},
              {"processor time, p50", percentile(processor, 0.5)},
              {"processor time, p99", percentile(processor, 0.99)},
              {"for each 1000 points", 1e3 * median(whole) / r.nodes},
              {"memory (MB, largest of the process so far)", peak_megabytes()}};
  if (rivals) time_rivals(block.fem, r);
}

/// Least squares y = a + b x, and the share of the scatter that it explains.
struct Line {
  double a = 0.0, b = 0.0, r2 = 0.0;
};
Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const Eigen::Map<const Eigen::ArrayXd> X(x.data(), static_cast<Eigen::Index>(x.size())), Y(y.data(), static_cast<Eigen::Index>(y.size()));
  const Eigen::ArrayXd dx = X - X.mean(), dy = Y - Y.mean();
  Line l;
  l.b = (dx * dy).sum() / dx.square().sum();
  l.a = Y.mean() - l.b * X.mean();
  l.r2 = 1.0 - (dy - l.b * dx).square().sum() / dy.square().sum();
  return l;
}

/// Mean time of a loop (processor time) and mean iterations while the cube of n x n x 3 points is pushed, as in fig. 16 of the paper.
std::pair<double, double> mean_loop(int n, const FemOptions& options) {
  constexpr int kLoops = 200;
  BrainBlock block(block_of_nodes(n, n, 3, Vec3(0.12, 0.12, 0.01)), options, 30e-3, spread_over_6_mm(), 4);
  double iterations = 0.0;
  const double begin = processor_ms();
  for (int k = 1; k <= kLoops; ++k) {
    block.step(push_at(options.dt * k, 2e-3));
    iterations += block.summary.iterations;
  }
  return {(processor_ms() - begin) / kLoops, iterations / kLoops};
}

/// Time of a loop against the number of points, 75 to 10,800: as the trainer solves (as far as the residual asks), and as the paper
/// does, with a fixed number of Gauss-Seidel sweeps; a line through each.
void bench_loop(BenchResult& r, const StepTimer& timer) {
  FemOptions as_paper = run_time(1e-3 * r.dt_ms);
  as_paper.solver.method = FemSolverOptions::Method::gauss_seidel;
  as_paper.solver.relative = as_paper.solver.absolute = 0.0;
  as_paper.solver.max_iterations = 10;
  std::vector<double> points, trainer, sweeps;
  std::vector<std::pair<std::string, double>> stages;
  for (const int n : {5, 8, 10, 20, 30, 40, 50, 60}) {
    const std::string name = std::to_string(3 * n * n) + " points: ";
    const auto [ms, iterations] = mean_loop(n, run_time(1e-3 * r.dt_ms));
    points.push_back(3.0 * n * n);
    trainer.push_back(ms);
    sweeps.push_back(mean_loop(n, as_paper).first);
    stages.emplace_back(name + "mean", ms);
    stages.emplace_back(name + "iterations (number, mean)", iterations);
    stages.emplace_back(name + "mean, 10 Gauss-Seidel sweeps", sweeps.back());
  }
  for (const auto& [name, ms] : {std::pair("as the trainer solves", trainer), {"10 Gauss-Seidel sweeps", sweeps}}) {
    const Line l = line_through(points, ms);
    stages.emplace_back(std::string("line, ") + name + ": slope (us for each point)", 1e3 * l.b);
    stages.emplace_back(std::string("line, ") + name + ": at 0 points", l.a);
    stages.emplace_back(std::string("line, ") + name + ": R2 (number)", l.r2);
  }
  bench_block(r, timer, slab_of_10800(), 30e-3, 2e-3, false);
  r.stages = std::move(stages);
}

/// 20,000 triangles that move all the time, and a blade of 200 that looks for what it could touch.
void bench_collision(BenchResult& r, const StepTimer& timer) {
  const TetMesh mesh = box_mesh(Vec3(-0.06, -0.06, -0.002), Vec3(0.06, 0.06, 0.0), 100, 100, 1);
  std::vector<Triangle> top;
  for (const Triangle& t : surface_triangles(mesh))
    if (mesh.nodes(2, t[0]) > -1e-9 && mesh.nodes(2, t[1]) > -1e-9 && mesh.nodes(2, t[2]) > -1e-9) top.push_back(t);
  SurfaceTree tree(top, mesh.nodes);
  BladeShape shape;
  const RigidSurface blade = blade_surface(shape, 20, 5);  // 200 triangles
  Points x = mesh.nodes;
  std::vector<int> hits, candidates;
  hits.reserve(top.size());
  candidates.reserve(top.size());
  std::vector<char> marked(static_cast<std::size_t>(mesh.n_nodes()), 0);
  r.nodes = mesh.n_nodes();
  std::size_t near = 0;
  int k = 0;
  timer(
      r,
      [&] {
        tree.refit(x);
        hits.clear();
        candidates.clear();
        const Vec3 p(0, 0, -1e-3);
        tree.overlaps({blade.low.cwiseMin(p).array() - 6e-3 - 0.04, Vec3(blade.high.x() + 6e-3, 0.05, 6e-3)}, hits);
        for (const int t : hits)
          for (const int i : tree.triangles()[static_cast<std::size_t>(t)]) {
            if (marked[static_cast<std::size_t>(i)]) continue;
            marked[static_cast<std::size_t>(i)] = 1;
            candidates.push_back(i);
          }
        near = 0;
        for (const int i : candidates) {
          marked[static_cast<std::size_t>(i)] = 0;
          const Vec3 q(x(0, i), x(2, i) - p.z(), x(1, i) + 0.04);  // the blade lies along y
          if ((q.array() < blade.low.array() - 1e-3).any() || (q.array() > blade.high.array() + 1e-3).any()) continue;
          near += nearest_point(blade, q).gap < 0.5e-3 ? 1 : 0;
        }
      },
      [&] {
        r.contacts = std::max(r.contacts, static_cast<int>(near));
        ++k;
        for (int i = 0; i < x.cols(); ++i) x(2, i) = mesh.nodes(2, i) + 1e-3 * std::sin(0.1 * k + 0.01 * i);
      });
  r.stages = {{"triangles (number)", static_cast<double>(top.size())}, {"blade triangles (number)", static_cast<double>(blade.triangles.size())}};
}

}  // namespace

std::function<void()> pressed_block() {
  constexpr double kStep = 10e-3;  // [s]
  auto block = std::make_shared<BrainBlock>(slab_of_10800(), run_time(kStep), 20e-3, spread_over_6_mm(), 4);
  return [block, k = 0]() mutable { block->step(push_at(kStep * ++k, 2e-3)); };
}

std::vector<std::pair<BenchResult, TimedBench>> brain_benches() {
  std::vector<std::pair<BenchResult, TimedBench>> list;
  const auto add = [&](const std::string& name, double dt_ms, int steps, TimedBench run) {
    BenchResult r;
    r.name = name;
    r.dt_ms = dt_ms;
    r.steps = steps;
    list.emplace_back(r, std::move(run));
  };
  add("brain-2000", 2.0, 2000, [](BenchResult& r, const StepTimer& t) { bench_block(r, t, block_of_nodes(16, 16, 8, Vec3(0.06, 0.06, 0.03)), 20e-3, 6e-3, true); });
  add("brain-10800", 10.0, 500, [](BenchResult& r, const StepTimer& t) { bench_block(r, t, slab_of_10800(), 20e-3, 2e-3, true); });
  add("brain-anatomy", 10.0, 500, [](BenchResult& r, const StepTimer& t) {
    CortexShape shape;
    shape.cells = {34, 28, 9};
    shape.fissure_depth = 24e-3;
    shape.fissure_gap = 3e-3;
    TetMesh mesh = make_cortex(shape, "brain-anatomy").mesh;
    mesh.region.clear();  // one tissue
    bench_block(r, t, std::move(mesh), 20e-3, 6e-3, false);
  });
  add("blade-collision", 2.0, 1000, bench_collision);
  add("brain-loop", 10.0, 200, bench_loop);
  return list;
}

}  // namespace filum
