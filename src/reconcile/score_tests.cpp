#include "reconcile/score_tests.h"
#include "reconcile/rules.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace filum::reconcile {

ScoreTests::ScoreTests(const Fitter& fitter, const Fit& fit) : fitter_(fitter), fit_(fit) {
  const auto g = fitter.globals(fit.forms);
  const auto ng = static_cast<Eigen::Index>(g.size());
  const int own = fitter.own_parameters();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(ng, ng), all = A, J;
  for (std::size_t i = 0; i < fitter.use.size(); ++i) {
    if (!fitter.use[i]) continue;
    trials_.push_back(static_cast<int>(i));
    r_.push_back(fitter.residual(static_cast<int>(i), fitter.setting(fit, static_cast<int>(i))));
    fitter.linearise(fit, g, static_cast<int>(i), r_.back(), J);
    G_.push_back(J.leftCols(ng));
    N_.push_back(J.rightCols(own));
    Eigen::MatrixXd D = N_.back().transpose() * N_.back();
    int k = 0;
    if (fitter.model().has_scale()) D(k, k) += 1.0 / std::pow(fitter.noise().scatter, 2), ++k;
    if (fitter.model().has_gain()) D(k, k) += 1.0 / std::pow(fitter.noise().gain_scatter, 2);
    D_.push_back(own > 0 ? D.ldlt().solve(Eigen::MatrixXd::Identity(own, own)).eval() : D);
    C_.push_back(G_.back().transpose() * N_.back());
    all.noalias() += G_.back().transpose() * G_.back();
    A.noalias() += G_.back().transpose() * G_.back();
    if (own > 0) A.noalias() -= C_.back() * D_.back() * C_.back().transpose();
  }
  instrument_ = Eigen::VectorXd::Zero(ng);
  for (Eigen::Index k = 0; k < ng; ++k)
    if (const auto& p = g[static_cast<std::size_t>(k)]; p.form == Fitter::kInstrument) {
      const double weight = std::pow(fitter.noise().gain_scatter, -2);
      instrument_[k] = weight * std::log(fit.instrument[static_cast<std::size_t>(p.index)]);
      A(k, k) += weight, all(k, k) += weight;
      shared_.push_back(k);
    }
  for (Eigen::Index k = 0; k < ng; ++k) A(k, k) += 1e-9 * std::max(A(k, k), 1e-12) + 1e-300, all(k, k) += 1e-12 * all(k, k) + 1e-300;
  common_ = ng > 0 ? all.ldlt().solve(Eigen::MatrixXd::Identity(ng, ng)).eval() : all;
  S_ = ng > 0 ? A.ldlt().solve(Eigen::MatrixXd::Identity(ng, ng)).eval() : A;
}

ScoreTests::Signature ScoreTests::signature(const Form& form, const std::vector<double>& start) const { return signature(std::vector<const Form*>{&form}, {start}); }

ScoreTests::Signature ScoreTests::signature(const std::vector<const Form*>& forms, const std::vector<std::vector<double>>& params) const {
  Signature out;
  Fit with = fit_;
  with.forms.insert(with.forms.end(), forms.begin(), forms.end());
  with.params.insert(with.params.end(), params.begin(), params.end());
  out.g = Eigen::VectorXd::Zero(S_.rows());
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    Eigen::VectorXd s = fitter_.residual(trials_[i], fitter_.setting(with, trials_[i])) - r_[i];
    if (!s.allFinite()) s.setZero();
    Eigen::VectorXd n = N_[i].transpose() * s;
    out.g += G_[i].transpose() * s;
    if (n.size() > 0) out.g -= C_[i] * (D_[i] * n);
    out.norm += s.squaredNorm();
    out.n.push_back(std::move(n));
    out.s.push_back(std::move(s));
  }
  return out;
}

double ScoreTests::inner(const Signature& a, const Signature& b) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    sum += a.s[i].dot(b.s[i]);
    if (a.n[i].size() > 0) sum -= a.n[i].dot(D_[i] * b.n[i]);
  }
  return a.g.size() > 0 ? sum - a.g.dot(S_ * b.g) : sum;
}

Score ScoreTests::score(const Form& form, const std::vector<double>& start) const {
  Score out{&form, start, 0.0, 0.0, 0.0, 1.0, 1.0};
  const Signature s = signature(form, start);
  out.seen = std::max(0.0, inner(s, s));
  if (s.norm <= 0.0) out.imitated = 0.0;  // there is nothing to imitate
  if (s.norm <= 0.0 || out.seen <= 1e-9 * s.norm) return out;
  out.masked = 1.0 - out.seen / s.norm;
  Eigen::VectorXd g = Eigen::VectorXd::Zero(common_.rows());
  for (std::size_t i = 0; i < trials_.size(); ++i) g += G_[i].transpose() * s.s[i];
  out.imitated = g.size() > 0 ? g.dot(common_ * g) / s.norm : 0.0;
  // at the optimum the residual is orthogonal to what is fitted, so no projection of it is needed
  double along = 0.0;
  for (std::size_t i = 0; i < trials_.size(); ++i) along += s.s[i].dot(r_[i]);
  if (!S_.isZero(0.0) || !D_.empty()) {
    Signature r;
    r.g = Eigen::VectorXd::Zero(S_.rows());
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      Eigen::VectorXd n = N_[i].transpose() * r_[i];
      const auto t = static_cast<std::size_t>(trials_[i]);
      int k = 0;
      if (fitter_.model().has_scale()) n[k++] += fit_.log_scale[t] / std::pow(fitter_.noise().scatter, 2);
      if (fitter_.model().has_gain()) n[k] += fit_.log_gain[t] / std::pow(fitter_.noise().gain_scatter, 2);
      r.g += G_[i].transpose() * r_[i];
      if (n.size() > 0) r.g -= C_[i] * (D_[i] * n), along -= s.n[i].dot(D_[i] * n);
    }
    if (r.g.size() > 0) along -= s.g.dot(S_ * (r.g + instrument_));
  }
  out.amplitude = -along / out.seen;
  const bool either_sign = !form.params.empty() && form.params[0].low < 0.0 && form.params[0].high > 0.0;
  if (out.amplitude > 0.0 || either_sign) out.gain = along * along / out.seen;
  if (out.amplitude > assumed::kFarStart) out.gain *= assumed::kFarPromise;  // far from the start: the promise is less sure
  return out;
}

std::vector<Score> ScoreTests::all(const std::vector<Form>& forms) const {
  std::vector<Score> out;
  for (const Form& f : forms) {
    if (f.line) continue;
    if (std::any_of(fit_.forms.begin(), fit_.forms.end(), [&](const Form* g) { return g->effect == f.effect; })) continue;
    for (const auto& start : f.starts) out.push_back(score(f, start));
  }
  std::stable_sort(out.begin(), out.end(), [](const Score& a, const Score& b) { return a.gain > b.gain; });
  return out;
}

std::vector<Eigen::VectorXd> ScoreTests::repetition(Rng& rng) const {
  std::vector<Eigen::VectorXd> y;
  std::vector<double> gain;  // errors of the instruments, the same in all records
  for (std::size_t k = 0; k < shared_.size(); ++k) gain.push_back(fitter_.noise().gain_scatter * rng.normal());
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    y.emplace_back(r_[i].size());
    for (double& v : y[i]) v = rng.normal();
    Eigen::Index k = 0;
    if (fitter_.model().has_scale()) y[i] += N_[i].col(k++) * (fitter_.noise().scatter * rng.normal());
    if (fitter_.model().has_gain()) y[i] += N_[i].col(k) * (fitter_.noise().gain_scatter * rng.normal());
    for (std::size_t k = 0; k < shared_.size(); ++k) y[i] += G_[i].col(shared_[k]) * gain[k];
  }
  return y;
}

void ScoreTests::refit(std::vector<Eigen::VectorXd>& y) const {
  std::vector<Eigen::VectorXd> n;
  Eigen::VectorXd g = Eigen::VectorXd::Zero(S_.rows());
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    n.push_back(N_[i].transpose() * y[i]);
    g += G_[i].transpose() * y[i];
    if (n[i].size() > 0) g -= C_[i] * (D_[i] * n[i]);
  }
  const Eigen::VectorXd x = S_.rows() > 0 ? Eigen::VectorXd(S_ * g) : g;
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    if (x.size() > 0) y[i] -= G_[i] * x;
    if (n[i].size() == 0) continue;
    if (x.size() > 0) n[i] -= C_[i].transpose() * x;
    y[i] -= N_[i] * (D_[i] * n[i]);
  }
}

ScoreTests::Direction ScoreTests::direction(const Form& form, const std::vector<double>& start) const {
  const Signature s = signature(form, start);
  Direction out{s.s, std::max(0.0, inner(s, s)), !form.params.empty() && form.params[0].low < 0.0 && form.params[0].high > 0.0};
  if (out.seen <= 1e-9 * s.norm) out.seen = 0.0;
  refit(out.q);  // the projection is symmetric: P s
  return out;
}

Likeness ScoreTests::likeness(const std::vector<const Fit*>& sets) const {
  std::vector<Signature> all;
  for (const Fit* f : sets) all.push_back(signature(f->forms, f->params));
  const auto n = static_cast<Eigen::Index>(sets.size());
  Likeness out{Eigen::MatrixXd::Zero(n, n), {}};
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) out.correlation(i, k) = inner(all[static_cast<std::size_t>(i)], all[static_cast<std::size_t>(k)]);
  const Eigen::VectorXd seen = out.correlation.diagonal().cwiseMax(0.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double norm = all[static_cast<std::size_t>(i)].norm;
    out.masked.push_back(norm > 0.0 ? 1.0 - seen[i] / norm : 1.0);
    for (Eigen::Index k = 0; k < n; ++k) out.correlation(i, k) = i == k ? 1.0 : seen[i] > 0.0 && seen[k] > 0.0 ? out.correlation(i, k) / std::sqrt(seen[i] * seen[k]) : 0.0;
  }
  return out;
}

}  // namespace filum::reconcile
