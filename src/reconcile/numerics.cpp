#include "reconcile/numerics.h"

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

/// The same trial with a sample put halfway between any two, what is told linear between them.
Trial halved(const Trial& t) {
  const auto finer = [](const Eigen::VectorXd& v) {
    Eigen::VectorXd out(2 * v.size() - 1);
    for (Eigen::Index n = 0; n < v.size(); ++n) {
      out[2 * n] = v[n];
      if (n > 0) out[2 * n - 1] = 0.5 * (v[n - 1] + v[n]);
    }
    return out;
  };
  Trial out = t;
  out.time = finer(t.time);
  for (auto& [name, v] : out.data) v = finer(v);
  return out;
}

double most_rms(const Eigen::MatrixXd& change, const Noise& noise) {
  double worst = 0.0;
  for (Eigen::Index c = 0; c < change.cols(); ++c)
    worst = std::max(worst, std::sqrt(change.col(c).squaredNorm() / static_cast<double>(change.rows())) / noise.output[static_cast<std::size_t>(c)].full_scale);
  return std::isfinite(worst) ? worst : 0.0;
}

}  // namespace

Numerics solver_error(const Fitter& fitter, const Fit& fit) {
  const RigModel& model = fitter.model();
  Numerics out;
  Eigen::MatrixXd plain, fine;
  for (std::size_t i = 0; i < fitter.use.size(); ++i) {
    if (!fitter.use[i]) continue;
    const Trial& t = model.data().trials[i];
    Setting s = fitter.setting(fit, static_cast<int>(i));
    model.simulate(t, s, plain);
    if (model.steps_in_time()) {
      const Trial twice = halved(t);
      model.simulate(twice, s, fine);
      Eigen::MatrixXd change(plain.rows(), plain.cols());
      for (Eigen::Index n = 0; n < plain.rows(); ++n) change.row(n) = fine.row(2 * n) - plain.row(n);
      out.time = std::max(out.time, most_rms(change, fitter.noise()));
    }
    s.mesh = 2;
    model.simulate(t, s, fine);
    out.mesh = std::max(out.mesh, most_rms(fine - plain, fitter.noise()));
  }
  return out;
}

std::vector<Sensitivity> check_sensitivities(const Fitter& fitter, const Fit& fit) {
  const auto globals = fitter.globals(fit.forms);
  std::vector<Sensitivity> out;
  for (std::size_t k = 0; k < globals.size(); ++k) {
    const Fitter::Global& g = globals[k];
    const std::string name = g.form == Fitter::kInstrument ? "gain of " + fitter.model().data().outputs[static_cast<std::size_t>(g.index)]
                             : g.form < 0 ? fitter.model().baseline()[static_cast<std::size_t>(g.index)].name
                                        : info(fit.forms[static_cast<std::size_t>(g.form)]->effect).name + ": " + fit.forms[static_cast<std::size_t>(g.form)]->params[static_cast<std::size_t>(g.index)].name;
    if (g.form >= 0 && g.high - g.low <= 0.01 * std::abs(g.high)) continue;  // held
    Sensitivity best{name, INFINITY, 1.0};
    for (const double factor : {1.0, 10.0, 0.1, 100.0, 1000.0}) {
      double apart = 0.0, size = 0.0;
      for (std::size_t i = 0; i < fitter.use.size(); ++i) {
        if (!fitter.use[i]) continue;
        const Eigen::VectorXd one = fitter.difference(fit, g, static_cast<int>(i), factor), two = fitter.difference(fit, g, static_cast<int>(i), 2.0 * factor);
        apart += (two - one).squaredNorm();
        size += one.squaredNorm();
      }
      const double share = size > 0.0 ? std::sqrt(apart / size) : 0.0;
      if (share < best.disagreement) best = {name, share, factor};
      if (best.disagreement < 1e-3) break;
    }
    out.push_back(best);
  }
  return out;
}

}  // namespace filum::reconcile
