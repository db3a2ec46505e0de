#include "reconcile/hereditary.h"

#include <cmath>

#include "base/numbers.h"

namespace filum::reconcile {
namespace {

/// Per term: decay over dt and the mean of the decay over a linear increment, A = (1 - exp(-dt/tau)) tau/dt.
struct Step {
  double dt = -1.0;
  std::vector<double> decay, mean;

  void set(const Kernel& k, double new_dt) {
    if (std::abs(new_dt - dt) <= 1e-9 * new_dt) return;
    dt = new_dt;
    decay.resize(k.tau.size());
    mean.resize(k.tau.size());
    for (std::size_t i = 0; i < k.tau.size(); ++i) {
      const double x = dt / k.tau[i];
      decay[i] = std::exp(-x);
      mean[i] = x < 1e-6 ? 1.0 - 0.5 * x : -std::expm1(-x) / x;
    }
  }
};

}  // namespace

Kernel prony(double g1, double tau1) { return {1.0 - g1, {g1}, {tau1}}; }

Kernel prony(double g1, double tau1, double g2, double tau2) { return {1.0 - g1 - g2, {g1, g2}, {tau1, tau2}}; }

Kernel fractional(double g1, double tau1, double order, int finer) {
  const int terms = 12 * finer + 1;
  Kernel k{1.0 - g1, std::vector<double>(static_cast<std::size_t>(terms)), std::vector<double>(static_cast<std::size_t>(terms))};
  const double reach = std::min(4.0 / order, 9.0);  // of ln x; what lies beyond is gathered at the ends
  double sum = 0.0;
  for (int i = 0; i < terms; ++i) {
    const double x = reach * (2.0 * i / (terms - 1) - 1.0);
    k.weight[static_cast<std::size_t>(i)] = std::sin(order * kPi) / (std::cosh(order * x) + std::cos(order * kPi));
    k.tau[static_cast<std::size_t>(i)] = tau1 * std::exp(x);
    sum += k.weight[static_cast<std::size_t>(i)];
  }
  for (double& w : k.weight) w *= g1 / sum;
  return k;
}

namespace {

/// What the series leaves out goes into one more exponential with its weight and first moment (sum w tau = size^2/D times `moment`).
Kernel drainage(double g1, double time, const std::vector<double>& m, double weight, double moment) {
  Kernel k{1.0 - g1, {}, {}};
  double rest = 1.0;
  for (const double a : m) {
    const double w = weight / (a * a);
    k.weight.push_back(g1 * w);
    k.tau.push_back(time / (a * a));
    rest -= w;
    moment -= w / (a * a);
  }
  k.weight.push_back(g1 * rest);
  k.tau.push_back(time * moment / rest);
  return k;
}

}  // namespace

Kernel slab_drainage(double g1, double diffusivity, double size, int modes) {
  std::vector<double> m;
  for (int n = 0; n < modes; ++n) m.push_back((2 * n + 1) * kPi);
  return drainage(g1, size * size / diffusivity, m, 8.0, 1.0 / 12.0);
}

Kernel radial_drainage(double g1, double diffusivity, double size, int modes) {
  std::vector<double> zeros = {2.404825558, 5.520078110, 8.653727913, 11.79153444};
  for (int n = 4; n < modes; ++n) {  // McMahon's expansion, here right to 1e-7
    const double b = (n + 0.75) * kPi;
    zeros.push_back(b + 1.0 / (8.0 * b) - 124.0 / (3.0 * std::pow(8.0 * b, 3)));
  }
  return drainage(g1, size * size / diffusivity, zeros, 4.0, 1.0 / 8.0);
}

void relax(const Kernel& k, const Eigen::VectorXd& time, Eigen::Ref<Eigen::VectorXd> f) {
  // what was applied before the record is taken to have been applied at its first sample
  std::vector<double> h(k.tau.size());
  for (std::size_t i = 0; i < h.size(); ++i) h[i] = k.weight[i] * f[0];
  double before = f[0];
  Step step;
  for (Eigen::Index n = 1; n < f.size(); ++n) {
    step.set(k, time[n] - time[n - 1]);
    const double rise = f[n] - before;
    before = f[n];
    double sum = k.rest * f[n];
    for (std::size_t i = 0; i < h.size(); ++i) {
      h[i] = step.decay[i] * h[i] + k.weight[i] * step.mean[i] * rise;
      sum += h[i];
    }
    f[n] = sum;
  }
}

void creep(const Kernel& k, const Eigen::VectorXd& time, Eigen::Ref<Eigen::VectorXd> f) {
  std::vector<double> h(k.tau.size());
  for (std::size_t i = 0; i < h.size(); ++i) h[i] = k.weight[i] * f[0];
  double before = f[0];
  Step step;
  for (Eigen::Index n = 1; n < f.size(); ++n) {
    step.set(k, time[n] - time[n - 1]);
    double known = 0.0, slope = k.rest;
    for (std::size_t i = 0; i < h.size(); ++i) {
      known += step.decay[i] * h[i] - k.weight[i] * step.mean[i] * before;
      slope += k.weight[i] * step.mean[i];
    }
    const double elastic = (f[n] - known) / slope;
    for (std::size_t i = 0; i < h.size(); ++i) h[i] = step.decay[i] * h[i] + k.weight[i] * step.mean[i] * (elastic - before);
    before = elastic;
    f[n] = elastic;
  }
}

}  // namespace filum::reconcile
