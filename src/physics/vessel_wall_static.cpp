#include "physics/vessel_wall_static.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>

#include "physics/vessel_wall_pressure.h"

namespace filum {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Unbalanced force, pressure's part of it, and the energy of the elements and of dead loads [J]; infinite if an element is inside out.
struct Balance {
  Points force, push;
  double energy = 0.0;
  Balance(const VesselMesh& mesh, const WallElements& elements, const WallLoadCase& load, const Points& x)
      : force(Points::Zero(3, x.cols())), push(Points::Zero(3, x.cols())) {
    energy = elements.add_forces(x, load.soundness.empty() ? std::vector<double>(static_cast<std::size_t>(mesh.n_elements()), 1.0) : load.soundness, force);
    if (!load.pressure.empty()) add_pressure_forces(mesh, load.pressure, x, push);
    force += push;
    if (load.force.cols() > 0) {
      energy -= load.force.cwiseProduct(x).sum();
      force += load.force;
    }
    if (!force.allFinite()) energy = std::numeric_limits<double>::infinity();
  }
};

void add_block(const std::vector<char>& fixed, int i, int j, const Mat3& k, std::vector<Eigen::Triplet<double>>& list) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      if (!fixed[static_cast<std::size_t>(3 * i + r)] && !fixed[static_cast<std::size_t>(3 * j + c)]) list.emplace_back(3 * i + r, 3 * j + c, k(r, c));
}

Sparse assemble(const VesselMesh& mesh, const WallElements& elements, const WallLoadCase& load, const Points& x) {
  std::vector<Eigen::Triplet<double>> list;
  list.reserve(static_cast<std::size_t>(mesh.n_elements()) * 576);
  for (int e = 0; e < mesh.n_elements(); ++e) {
    WallElements::Stiffness K = elements.stiffness(e, x);
    if (!load.soundness.empty()) K *= load.soundness[static_cast<std::size_t>(e)];
    const auto& nodes = mesh.elements[static_cast<std::size_t>(e)];
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        add_block(load.fixed, nodes[static_cast<std::size_t>(a)], nodes[static_cast<std::size_t>(b)], K.block<3, 3>(3 * a, 3 * b), list);
  }
  for (const WallFace& f : mesh.faces) {
    if (load.pressure.empty() || f.surface != WallSurface::inner) continue;
    const double p = load.pressure[static_cast<std::size_t>(mesh.part[static_cast<std::size_t>(f.element)])];
    const Eigen::Matrix<double, 12, 12> K = pressure_stiffness(mesh, f, p, x);
    const Eigen::Matrix<double, 12, 12> even = 0.5 * (K + K.transpose());
    const auto& nodes = mesh.elements[static_cast<std::size_t>(f.element)];
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        add_block(load.fixed, nodes[static_cast<std::size_t>(f.corner[static_cast<std::size_t>(a)])],
                  nodes[static_cast<std::size_t>(f.corner[static_cast<std::size_t>(b)])], even.block<3, 3>(3 * a, 3 * b), list);
  }
  for (std::size_t i = 0; i < load.fixed.size(); ++i)
    if (load.fixed[i]) list.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
  Sparse A(static_cast<int>(load.fixed.size()), static_cast<int>(load.fixed.size()));
  A.setFromTriplets(list.begin(), list.end());
  return A;
}

double largest_free(const std::vector<char>& fixed, const Points& r) {
  double most = 0.0;
  for (int i = 0; i < r.size(); ++i)
    if (!fixed[static_cast<std::size_t>(i)]) most = std::max(most, std::abs(r.data()[i]));
  return most;
}

/// A shift of the diagonal for which the matrix is positive definite: none if it is, else the least of a growing series.
bool factor(const Sparse& A, Eigen::SimplicialLDLT<Sparse>& solver) {
  double shift = 0.0;
  for (int k = 0; k < 12; ++k) {
    solver.setShift(shift);
    solver.factorize(A);
    if (solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 0.0) return true;
    shift = k == 0 ? 1e-4 * A.diagonal().mean() : 5.0 * shift;
  }
  return false;
}

}  // namespace

Points reactions(const VesselMesh& mesh, const WallElements& elements, const WallLoadCase& load, const Points& x) {
  return -Balance(mesh, elements, load, x).force;
}

StaticSummary solve_static(const VesselMesh& mesh, const WallElements& elements, const WallLoadCase& load, Points& x, double tolerance,
                           int max_iterations) {
  StaticSummary s;
  Balance now(mesh, elements, load, x);
  if (!std::isfinite(now.energy)) return s;
  s.residual = largest_free(load.fixed, now.force);
  Eigen::SimplicialLDLT<Sparse> solver;
  for (; s.iterations < max_iterations && s.residual > tolerance; ++s.iterations) {
    const Sparse A = assemble(mesh, elements, load, x);
    if (s.iterations == 0) solver.analyzePattern(A);
    if (!factor(A, solver)) return s;
    Eigen::VectorXd b = now.force.reshaped();
    for (int i = 0; i < b.size(); ++i)
      if (load.fixed[static_cast<std::size_t>(i)]) b[i] = 0.0;
    const Eigen::VectorXd d = solver.solve(b);
    bool better = false;
    double step = 1.0;
    for (int halving = 0; halving < 25 && !better; ++halving, step *= 0.5) {
      const Points move = step * d.reshaped(3, x.cols());
      Balance trial(mesh, elements, load, x + move);
      const double work = 0.5 * (now.push + trial.push).cwiseProduct(move).sum();  // of the pressure on the way
      const double residual = largest_free(load.fixed, trial.force);
      better = std::isfinite(trial.energy) && (trial.energy - work <= now.energy - 1e-4 * step * b.dot(d) || residual < 0.5 * s.residual);
      if (!better) continue;
      x += move;
      now = std::move(trial);
      s.residual = residual;
    }
    if (!better) break;
  }
  s.converged = s.residual <= tolerance;
  return s;
}

}  // namespace filum
