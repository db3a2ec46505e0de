#pragma once
// Acceptance by full re-simulation: the fits that decide are made again with the trainer's own solver in place of the reduced model.
// Output space mapping (Bandler et al., IEEE Trans. MTT 52:337, 2004): the reduced model plus (full - reduced) at the present values is
// fitted, the full solver run at the new values, until the values stay; what stands then is a least-squares fit of the full solver.
// The sensor is the same behind both, so the difference is that of the true outputs: a clipped reading hides it, and must not carry it.

#include <optional>

#include "reconcile/candidates.h"
#include "reconcile/estimate.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {

/// What the trainer's own solver says of a name.
struct ConfirmSummary {
  std::string solver;
  bool ran = false, holds = false;
  double difference = 0.0, mesh = 0.0;          // of full scale: full against reduced model; full against itself at half the step
  double evidence = 0.0;                        // BIC less that of the baseline, both by the full solver
  double share = 0.0;                           // of the fall of chi2 that the reduced model promised
  double material = 0.0;                        // change of the prediction over the materiality
  double chi2_before = 0.0, chi2_after = 0.0;   // a sample
  std::vector<NamedEffect> values;              // refitted
  bool refutes() const { return ran && !holds; }
};

/// A fit of the full solver, from one of the reduced model; `rounds` of the mapping that it took, 0 where the solver failed.
struct FullFit {
  Fit fit;
  std::vector<Eigen::MatrixXd> correction;  // of the true outputs
  double change = 0.0;  // largest difference of the two models, over full scale
  double mesh = 0.0;    // of the full solver against itself at half the mesh, over full scale, where that was asked for
  int rounds = 0;
};
FullFit refit_fully(const Fitter& fitter, const FullSolver& solver, const Fit& reduced, bool mesh, const ConfirmOptions& options = {});

/// Baseline and winner by the full solver; nullopt where there is no winner, or none for which the trainer has a solver of its own.
std::optional<ConfirmSummary> confirm(const Candidates& sets, const Fit* winner, const ConfirmOptions& options, const Run& run);

}  // namespace filum::reconcile
