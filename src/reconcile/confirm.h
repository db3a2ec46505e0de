#pragma once
// Acceptance by full re-simulation: the fits that decide are made again with the trainer's own solver in place of the reduced model.
// Output space mapping (Bandler et al., IEEE Trans. MTT 52:337, 2004): the reduced model plus (full - reduced) at the present values is
// fitted, the full solver run at the new values, until the values stay; what stands then is a least-squares fit of the full solver.

#include "reconcile/full_solver.h"
#include "reconcile/result.h"
#include "reconcile/search.h"

namespace filum::reconcile {

/// A fit of the full solver, from one of the reduced model; `rounds` of the mapping that it took, 0 where the solver failed.
struct FullFit {
  Fit fit;
  std::vector<Eigen::MatrixXd> correction;
  double change = 0.0;  // largest difference of the two models, over full scale
  double mesh = 0.0;    // of the full solver against itself at half the mesh, over full scale, where that was asked for
  int rounds = 0;
};
FullFit refit_fully(const Fitter& fitter, const FullSolver& solver, const Fit& reduced, bool mesh);

/// Baseline and winner by the full solver; fills result.confirmation. False: the name does not hold there.
bool confirm(const Search& search, const Fit& winner, const Options& options, Result& result);

}  // namespace filum::reconcile
