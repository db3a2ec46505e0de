#include "reconcile/confirm.h"

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

/// True outputs, before the sensor; empty where the solver failed.
std::vector<Eigen::MatrixXd> run_all(const Fitter& fitter, const FullSolver& solver, const Fit& f, bool fine, bool& good) {
  const Dataset& d = fitter.model().data();
  std::vector<Eigen::MatrixXd> out(d.trials.size());
  for (std::size_t i = 0; i < d.trials.size(); ++i) {
    if (!fitter.use[i]) continue;
    good = good && solver.run(d.trials[i], fitter.setting(f, static_cast<int>(i)), fine, out[i]) && out[i].allFinite();
    if (!good) return {};
  }
  return out;
}

std::vector<Eigen::MatrixXd> sensed(const Fitter& fitter, const Fit& f, std::vector<Eigen::MatrixXd> out) {
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i].size() > 0) fitter.model().sense(fitter.model().data().trials[i], fitter.setting(f, static_cast<int>(i)), out[i]);
  return out;
}

/// Largest rms difference of a record, over full scale.
double most(const Fitter& fitter, const std::vector<Eigen::MatrixXd>& a, const std::vector<Eigen::MatrixXd>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (Eigen::Index c = 0; c < a[i].cols() && a[i].size() == b[i].size(); ++c)
      worst = std::max(worst, std::sqrt((a[i].col(c) - b[i].col(c)).squaredNorm() / static_cast<double>(a[i].rows())) / fitter.noise().output[static_cast<std::size_t>(c)].full_scale);
  return worst;
}

/// `a` times the one factor that brings it nearest to `b`: a stiffness common to all records is fitted anyway.
std::vector<Eigen::MatrixXd> scaled(std::vector<Eigen::MatrixXd> a, const std::vector<Eigen::MatrixXd>& b) {
  double ab = 0.0, aa = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].size() == b[i].size()) ab += a[i].cwiseProduct(b[i]).sum(), aa += a[i].squaredNorm();
  for (Eigen::MatrixXd& m : a) m *= aa > 0.0 ? ab / aa : 1.0;
  return a;
}

}  // namespace

FullFit refit_fully(const Fitter& fitter, const FullSolver& solver, const Fit& reduced, bool mesh, const ConfirmOptions& options) {
  FullFit out{reduced, {}, 0.0, 0.0, 0};
  const Dataset& d = fitter.model().data();
  for (int round = 1; round <= options.rounds; ++round) {
    bool good = true;
    std::vector<Eigen::MatrixXd> full = run_all(fitter, solver, out.fit, false, good), plain(d.trials.size());
    if (!good) return out.rounds = 0, out;
    for (std::size_t i = 0; i < full.size(); ++i)
      if (fitter.use[i]) fitter.model().rig(d.trials[i], fitter.setting(out.fit, static_cast<int>(i)), plain[i]);
    if (round == 1) out.change = most(fitter, sensed(fitter, out.fit, full), sensed(fitter, out.fit, plain));
    for (std::size_t i = 0; i < full.size(); ++i)
      if (fitter.use[i]) full[i] -= plain[i];
    const double moved = out.correction.empty() ? 1.0 : most(fitter, full, out.correction);
    out.correction = full;
    out.rounds = round;
    Fitter corrected(fitter);
    corrected.correction = out.correction;
    out.fit = corrected.fit(out.fit.forms, out.fit.base, out.fit.params, {10, 1e-6}, &out.fit);
    if (moved < options.rest) break;
  }
  if (!mesh) return out;
  bool good = true;
  const auto coarse = run_all(fitter, solver, out.fit, false, good), fine = run_all(fitter, solver, out.fit, true, good);
  if (good) out.mesh = most(fitter, sensed(fitter, out.fit, fine), sensed(fitter, out.fit, scaled(coarse, fine)));
  return out;
}

std::optional<ConfirmSummary> confirm(const Candidates& sets, const Fit* named, const ConfirmOptions& options, const Run& run) {
  const Fitter& fitter = sets.fitter();
  const auto solver = make_full_solver(fitter.model());
  if (named == nullptr || solver == nullptr || !solver->needed(named->forms)) return std::nullopt;
  const Fit& winner = *named;
  const CompareOptions& rules = sets.rules();
  say(run, "re-simulation", 0.9);
  const FullFit base = refit_fully(fitter, *solver, sets.base(), false, options);
  stop_if_cancelled(run);
  const FullFit full = refit_fully(fitter, *solver, winner, true, options);
  ConfirmSummary c;
  c.solver = solver->name();
  c.ran = base.rounds > 0 && full.rounds > 0;
  if (!c.ran) return c;
  c.difference = std::max(base.change, full.change);
  c.mesh = full.mesh;
  c.evidence = sets.bic(full.fit) - sets.bic(base.fit);
  c.chi2_before = base.fit.chi2 / std::max(1, base.fit.samples);
  c.chi2_after = full.fit.chi2 / std::max(1, full.fit.samples);
  const double gained = sets.base().chi2 - winner.chi2;
  c.share = gained > 0.0 ? (base.fit.chi2 - full.fit.chi2) / gained : 0.0;
  // what the solver's own mesh could account for is not worth a name
  const double floor = std::max(1.0, c.mesh / rules.materiality);
  c.material = sets.material(full.fit, base.fit);
  // a name that was taken by its chance (decide.cpp) has less evidence in either model: its share is what is asked
  const bool by_chance = sets.bic(winner) - sets.bic(sets.base()) > -rules.accept_evidence;
  c.holds = (by_chance || c.evidence < -rules.accept_evidence) && c.share >= rules.explained && c.material >= floor;
  c.values = effect_estimates(fitter, full.fit, sets.dispersion());
  return c;
}

}  // namespace filum::reconcile
