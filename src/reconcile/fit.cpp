#include "reconcile/fit.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

template <class F>
auto& value_of(F& f, const Fitter::Global& g) {
  const auto i = static_cast<std::size_t>(g.index);
  return g.form == Fitter::kInstrument ? f.instrument[i] : g.form < 0 ? f.base[i] : f.params[static_cast<std::size_t>(g.form)][i];
}

}  // namespace

Fitter::Fitter(const RigModel& model, Noise noise) : model_(model), noise_(std::move(noise)) {
  const Dataset& d = model.data();
  const auto& base = model.baseline();
  bool shear = false;
  for (const Trial& t : d.trials) shear = shear || t.word("mode") == "shear";
  for (std::size_t i = 0; i < base.size(); ++i) {
    low_.push_back(base[i].low);
    high_.push_back(base[i].high);
    if (const auto p = d.prior.find(base[i].name); p != d.prior.end()) low_[i] = p->second.low, high_[i] = p->second.high;
    const bool wanted = std::find(d.free.begin(), d.free.end(), base[i].name) != d.free.end();
    const bool seen = base[i].name != "poissons_ratio" || shear;
    const auto has = [&](const char* name) { return std::find(d.outputs.begin(), d.outputs.end(), name) != d.outputs.end(); };
    const bool channel = d.rig != Rig::forceps_bridge || has(i < 2 ? "strain_counts" : "pressure_counts");
    if (wanted && seen && channel && model.fitted(static_cast<int>(i))) free_.push_back(static_cast<int>(i));
  }
  for (const Trial& t : d.trials) {
    use.push_back(!t.hold_out);
    valid_.emplace_back();
    for (std::size_t c = 0; c < d.outputs.size(); ++c) {
      valid_.back().emplace_back();
      const Eigen::VectorXd& y = t.at(d.outputs[c]);
      for (int n = 0; n < t.samples(); ++n)
        if (std::isfinite(y[n]) && !model.masked(t, n, static_cast<int>(c))) valid_.back().back().push_back(n);
    }
  }
}

std::vector<Fitter::Global> Fitter::globals(const std::vector<const Form*>& forms) const {
  std::vector<Global> out;
  for (const int i : free_) {
    const ParameterInfo& p = model_.baseline()[static_cast<std::size_t>(i)];
    out.push_back({-1, i, low(i), high(i), p.logarithmic, std::max(1e-9 * (high(i) - low(i)), 1e-3 * std::abs(p.nominal))});
  }
  for (std::size_t f = 0; f < forms.size(); ++f)
    for (std::size_t i = 0; i < forms[f]->params.size(); ++i) {
      const ParamSpec& p = forms[f]->params[i];
      out.push_back({static_cast<int>(f), static_cast<int>(i), p.low, p.high, p.logarithmic, p.high - p.low});
    }
  // a first output's gain is the records' own; how far a second instrument is off against the first is one number for all of them
  for (std::size_t c = 1; model_.has_gain() && c < model_.data().outputs.size(); ++c) out.push_back({kInstrument, static_cast<int>(c), 0.8, 1.25, true, 1.0});
  return out;
}

double& Fitter::value(Fit& f, const Global& g) { return value_of(f, g); }

double Fitter::get(const Fit& f, const Global& g) const { return g.logarithmic ? std::log(value_of(f, g)) : value_of(f, g); }

void Fitter::put(Fit& f, const Global& g, double x) const {
  value(f, g) = std::clamp(g.logarithmic ? std::exp(x) : x, g.low, g.high);
}

Setting Fitter::setting(const Fit& f, int trial) const {
  Setting s;
  s.base = f.base.data();
  for (std::size_t i = 0; i < f.forms.size(); ++i) {
    const auto e = static_cast<std::size_t>(index_of(f.forms[i]->effect));
    s.p[e] = f.params[i].data();
    s.kind[e] = f.forms[i]->kind;
  }
  s.scale = std::exp(f.log_scale[static_cast<std::size_t>(trial)]);
  s.gain = std::exp(f.log_gain[static_cast<std::size_t>(trial)]);
  if (f.instrument.size() > 1 && model_.has_gain()) s.instrument = f.instrument.data();
  return s;
}

Eigen::VectorXd Fitter::residual(int trial, const Setting& s, std::vector<Eigen::VectorXd>* raw, std::vector<Eigen::VectorXd>* predicted) const {
  const Dataset& d = model_.data();
  const Trial& t = d.trials[static_cast<std::size_t>(trial)];
  Eigen::MatrixXd out;
  model_.rig(t, s, out);
  if (!correction.empty() && correction[static_cast<std::size_t>(trial)].size() > 0) out += correction[static_cast<std::size_t>(trial)];
  model_.sense(t, s, out);
  const Eigen::MatrixXd columns = model_.free_columns(t, s);
  const auto& valid = valid_[static_cast<std::size_t>(trial)];
  Eigen::Index total = 0;
  for (const auto& v : valid) total += static_cast<Eigen::Index>(v.size());
  Eigen::VectorXd white(total);
  if (raw != nullptr) raw->clear();
  if (predicted != nullptr) predicted->clear();
  Eigen::Index at = 0;
  for (std::size_t c = 0; c < d.outputs.size(); ++c) {
    const auto& rows = valid[c];
    const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
    const bool marker = d.rig == Rig::spatula_press && d.outputs[c][0] == 'u';
    const Eigen::VectorXd& y = t.at(d.outputs[c]);
    Eigen::MatrixXd r(n, 1);
    for (Eigen::Index k = 0; k < n; ++k) {
      const int i = rows[static_cast<std::size_t>(k)];
      r(k, 0) = y[i] - (marker ? 0.0 : out(i, static_cast<Eigen::Index>(c)));
    }
    Eigen::MatrixXd B(t.samples(), columns.cols() + (marker ? 1 : 0));
    B.leftCols(columns.cols()) = columns;
    if (marker) B.rightCols(1) = out.col(static_cast<Eigen::Index>(c));
    Eigen::VectorXd amplitude = Eigen::VectorXd::Zero(B.cols());
    if (n > 0) whiten(r, rows, noise_.output[c]);
    if (B.cols() > 0 && n > B.cols()) {
      Eigen::MatrixXd W(n, B.cols());
      for (Eigen::Index k = 0; k < n; ++k) W.row(k) = B.row(rows[static_cast<std::size_t>(k)]);
      whiten(W, rows, noise_.output[c]);
      const Eigen::MatrixXd A = W.transpose() * W + 1e-12 * Eigen::MatrixXd::Identity(W.cols(), W.cols()) * W.squaredNorm();
      amplitude = A.ldlt().solve(W.transpose() * r.col(0));
      r.col(0) -= W * amplitude;
    }
    white.segment(at, n) = r.col(0);
    at += n;
    if (raw == nullptr && predicted == nullptr) continue;
    Eigen::VectorXd full = B * amplitude;
    if (!marker) full += out.col(static_cast<Eigen::Index>(c));
    if (raw != nullptr) {
      Eigen::VectorXd left = Eigen::VectorXd::Constant(t.samples(), NAN);
      for (const int i : rows) left[i] = y[i] - full[i];
      raw->push_back(std::move(left));
    }
    if (predicted != nullptr) predicted->push_back(std::move(full));
  }
  return white;
}

Eigen::VectorXd Fitter::difference(const Fit& f, const Global& g, int trial, double factor) const {
  return difference(f, g, trial, factor, residual(trial, setting(f, trial)));
}

Eigen::VectorXd Fitter::difference(const Fit& f, const Global& g, int trial, double factor, const Eigen::VectorXd& r0) const {
  Fit probe = f;
  const double x = get(f, g), top = g.logarithmic ? std::log(g.high) : g.high;
  double h = factor * (g.logarithmic ? 1e-5 : 1e-6 * std::max(std::abs(x), 1e-2 * g.unit));
  if (x + h > top) h = -h;
  put(probe, g, x + h);
  return (residual(trial, setting(probe, trial)) - r0) / h;
}

void Fitter::linearise(const Fit& f, const std::vector<Global>& g, int trial, const Eigen::VectorXd& r0, Eigen::MatrixXd& J) const {
  const auto own = own_parameters();
  J.resize(r0.size(), static_cast<Eigen::Index>(g.size()) + own);
  for (std::size_t k = 0; k < g.size(); ++k)
    J.col(static_cast<Eigen::Index>(k)) = difference(f, g[k], trial, steps.size() == g.size() ? steps[k] : 1.0, r0);
  Fit probe = f;
  auto column = static_cast<Eigen::Index>(g.size());
  const auto t = static_cast<std::size_t>(trial);
  const auto step = [&](std::vector<double>& v) {
    v[t] += 1e-5;
    J.col(column++) = (residual(trial, setting(probe, trial)) - r0) / 1e-5;
    v[t] -= 1e-5;
  };
  if (model_.has_scale()) step(probe.log_scale);
  if (model_.has_gain()) step(probe.log_gain);
}

/// Normal equations with the records' own parameters eliminated (Schur complement).
struct Fitter::Solver {
  const Fitter& fitter;
  std::vector<Global> g;
  std::vector<int> trials;
  Eigen::MatrixXd A;                 // globals
  Eigen::VectorXd b;
  std::vector<Eigen::MatrixXd> C, D; // globals x own, own x own
  std::vector<Eigen::VectorXd> d;

  double chi2(const Fit& f, std::vector<Eigen::VectorXd>& r) const {
    double sum = 0.0;
    r.resize(trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      r[i] = fitter.residual(trials[i], fitter.setting(f, trials[i]));
      sum += r[i].squaredNorm() + prior(f, trials[i]);
    }
    for (const Global& p : g)
      if (p.form == kInstrument) sum += std::pow(fitter.get(f, p) / fitter.noise_.gain_scatter, 2);
    return std::isfinite(sum) ? sum : 1e300;
  }
  double prior(const Fit& f, int trial) const {
    const auto t = static_cast<std::size_t>(trial);
    return std::pow(f.log_scale[t] / fitter.noise_.scatter, 2) + std::pow(f.log_gain[t] / fitter.noise_.gain_scatter, 2);
  }

  void assemble(const Fit& f, const std::vector<Eigen::VectorXd>& r) {
    const auto n = static_cast<Eigen::Index>(g.size());
    const int own = fitter.own_parameters();
    A = Eigen::MatrixXd::Zero(n, n);
    b = Eigen::VectorXd::Zero(n);
    C.assign(trials.size(), {});
    D.assign(trials.size(), {});
    d.assign(trials.size(), {});
    Eigen::MatrixXd J;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      fitter.linearise(f, g, trials[i], r[i], J);
      const auto G = J.leftCols(n), N = J.rightCols(own);
      A.noalias() += G.transpose() * G;
      b.noalias() -= G.transpose() * r[i];
      C[i] = G.transpose() * N;
      D[i] = N.transpose() * N;
      d[i] = -N.transpose() * r[i];
      int k = 0;
      const auto t = static_cast<std::size_t>(trials[i]);
      const auto add = [&](double value, double sd) {
        D[i](k, k) += 1.0 / (sd * sd);
        d[i][k++] -= value / (sd * sd);
      };
      if (fitter.model_.has_scale()) add(f.log_scale[t], fitter.noise_.scatter);
      if (fitter.model_.has_gain()) add(f.log_gain[t], fitter.noise_.gain_scatter);
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      if (g[static_cast<std::size_t>(k)].form != kInstrument) continue;
      const double weight = std::pow(fitter.noise_.gain_scatter, -2);
      A(k, k) += weight;
      b[k] -= weight * fitter.get(f, g[static_cast<std::size_t>(k)]);
    }
  }

  /// Reduced system of the globals.
  void reduce(Eigen::MatrixXd& S, Eigen::VectorXd& s) const {
    S = A;
    s = b;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (C[i].size() == 0) continue;  // nothing of its own, or no globals
      const Eigen::MatrixXd X = D[i].ldlt().solve(C[i].transpose());
      S.noalias() -= C[i] * X;
      s.noalias() -= X.transpose() * d[i];
    }
  }

  Fit step(const Fit& f, double lambda) const {
    Eigen::MatrixXd S;
    Eigen::VectorXd s;
    reduce(S, s);
    for (Eigen::Index k = 0; k < s.size(); ++k) {  // a parameter at its bound that wants out stays
      const Global& p = g[static_cast<std::size_t>(k)];
      const double x = fitter.get(f, p), low = p.logarithmic ? std::log(p.low) : p.low, high = p.logarithmic ? std::log(p.high) : p.high;
      const double margin = 1e-9 * std::max(1.0, std::abs(high - low));
      if ((x <= low + margin && s[k] < 0) || (x >= high - margin && s[k] > 0)) {
        S.row(k).setZero();
        S.col(k).setZero();
        S(k, k) = 1.0;
        s[k] = 0.0;
      }
    }
    Eigen::MatrixXd M = S;
    for (Eigen::Index k = 0; k < s.size(); ++k) M(k, k) += lambda * std::max(A(k, k), 1e-12) + 1e-14;
    const Eigen::VectorXd dx = M.ldlt().solve(s);
    Fit next = f;
    for (Eigen::Index k = 0; k < s.size(); ++k) {
      const Global& p = g[static_cast<std::size_t>(k)];
      const double limit = p.logarithmic ? 1.5 : 0.4 * std::max(p.unit, std::abs(fitter.get(f, p)));
      const double move = std::isfinite(dx[k]) ? std::clamp(dx[k], -limit, limit) : 0.0;
      fitter.put(next, p, fitter.get(f, p) + move);
    }
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (D[i].rows() == 0) continue;
      const Eigen::VectorXd dn = D[i].ldlt().solve(d[i] - C[i].transpose() * dx);
      const auto t = static_cast<std::size_t>(trials[i]);
      int k = 0;
      if (fitter.model_.has_scale()) next.log_scale[t] = std::clamp(f.log_scale[t] + dn[k++], -2.0, 2.0);
      if (fitter.model_.has_gain()) next.log_gain[t] = std::clamp(f.log_gain[t] + dn[k], -0.2, 0.2);
    }
    return next;
  }
};

Fit Fitter::fit(const std::vector<const Form*>& forms, const std::vector<double>& base, const std::vector<std::vector<double>>& params,
                const Effort& o, const Fit* warm) const {
  Fit f;
  f.forms = forms;
  f.base = base;
  f.params = params;
  if (f.params.empty())
    for (const Form* form : forms) f.params.push_back(form->starts.at(0));
  f.log_scale.assign(use.size(), 0.0);
  f.log_gain.assign(use.size(), 0.0);
  f.instrument.assign(model_.data().outputs.size(), 1.0);
  if (warm != nullptr) f.log_scale = warm->log_scale, f.log_gain = warm->log_gain, f.instrument = warm->instrument;
  Solver solver{*this, globals(forms), {}, {}, {}, {}, {}, {}};
  for (const Global& g : solver.g) put(f, g, get(f, g));
  for (std::size_t i = 0; i < use.size(); ++i)
    if (use[i]) solver.trials.push_back(static_cast<int>(i));
  std::vector<Eigen::VectorXd> r, trial_r;
  f.chi2 = solver.chi2(f, r);
  double lambda = 1e-3;
  for (int i = 0; i < o.iterations; ++i) {
    solver.assemble(f, r);
    const double before = f.chi2;
    bool better = false;
    for (int k = 0; k < 6 && !better; ++k) {
      Fit next = solver.step(f, lambda);
      next.chi2 = solver.chi2(next, trial_r);
      better = next.chi2 < f.chi2;
      if (better) {
        f = std::move(next);
        r.swap(trial_r);
        lambda = std::max(lambda * 0.2, 1e-9);
      } else {
        lambda *= 8.0;
      }
    }
    if (!better || before - f.chi2 < o.tolerance * f.chi2) break;
  }
  complete(f, solver.g);
  return f;
}

void Fitter::complete(Fit& f, const std::vector<Global>& g) const {
  Solver solver{*this, g, {}, {}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < use.size(); ++i)
    if (use[i]) solver.trials.push_back(static_cast<int>(i));
  f.residual.assign(use.size(), {});
  f.predicted.assign(use.size(), {});
  f.white.assign(use.size(), {});
  std::vector<Eigen::VectorXd> r;
  f.samples = 0;
  Eigen::Index columns = 0;
  for (const int i : solver.trials) {
    const auto t = static_cast<std::size_t>(i);
    f.white[t] = residual(i, setting(f, i), &f.residual[t], &f.predicted[t]);
    r.push_back(f.white[t]);
    f.samples += static_cast<int>(r.back().size());
    columns += model_.free_columns(model_.data().trials[t], setting(f, i)).cols() * static_cast<Eigen::Index>(model_.data().outputs.size());
  }
  f.parameters = static_cast<int>(columns);
  f.at_bound = false;
  for (const Global& p : g) {
    if (p.form == kInstrument) continue;  // in every fit, and known beforehand as the records' gains are
    // what is held within a hundredth (the depth of a layer that was read off, an angle that only scales) costs no evidence
    if (p.form >= 0 && p.high - p.low <= 0.01 * std::abs(p.high)) continue;
    ++f.parameters;
    const double v = get(f, p), low = p.logarithmic ? std::log(p.low) : p.low, high = p.logarithmic ? std::log(p.high) : p.high;
    if (p.form >= 0 && (v <= low + 1e-4 * (high - low) || v >= high - 1e-4 * (high - low))) f.at_bound = true;
  }
  solver.assemble(f, r);
  Eigen::MatrixXd S;
  Eigen::VectorXd s;
  solver.reduce(S, s);
  for (Eigen::Index k = 0; k < S.rows(); ++k) S(k, k) += 1e-10 * std::max(S(k, k), 1e-12) + 1e-300;
  f.covariance = S.rows() > 0 ? S.ldlt().solve(Eigen::MatrixXd::Identity(S.rows(), S.cols())).eval() : S;
}

Fit Fitter::transfer(const Fit& fitted, const std::vector<bool>& trials) const {
  Fitter other(*this);
  other.use = trials;
  other.free_.clear();
  Fit f = fitted;
  Solver solver{other, {}, {}, {}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (trials[i]) {
      solver.trials.push_back(static_cast<int>(i));
      f.log_scale[i] = f.log_gain[i] = 0.0;
    }
  std::vector<Eigen::VectorXd> r;
  f.chi2 = solver.chi2(f, r);
  for (int i = 0; i < 6; ++i) {
    solver.assemble(f, r);
    Fit next = solver.step(f, 0.0);
    next.chi2 = solver.chi2(next, r);
    if (!(next.chi2 < f.chi2 * (1.0 - 1e-6))) break;
    f = next;
  }
  other.complete(f, {});
  return f;
}

}  // namespace filum::reconcile
