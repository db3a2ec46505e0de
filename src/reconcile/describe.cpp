// What is not named, described: sparse regression of the residual on printable terms (orthogonal matching pursuit; Pati, Rezaiifar & Krishnaprasad 1993)
// with stability over resampled blocks (Meinshausen & Buhlmann 2010).

#include "reconcile/describe.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/rng.h"

namespace filum::reconcile {
namespace {

constexpr std::size_t kBlockSamples = 20, kLeast = 30;  // samples
constexpr double kAlike = 0.9999;  // correlation from which two terms are one: the simpler, which stands first, is kept

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  // term x row
  std::vector<double> y;                     // residual over full scale
};

/// Inputs over their largest value; their rates such that a tenth of the record at a steady pace makes 1.
struct Moving {
  double x = 0.0, rate = 0.0;
};

std::vector<std::string> inputs_of(const Dataset& d) {
  std::vector<std::string> out;
  for (const Channel& c : d.channels)
    if (c.input && c.name != "time" && std::all_of(d.trials.begin(), d.trials.end(), [&](const Trial& t) { return t.has(c.name); })) out.push_back(c.name);
  return out;
}

using Row = std::vector<std::pair<std::string, double>>;

/// All terms at one sample: time s and output f from 0 to 1, and of each input itself, its rate and products; then products of two inputs.
Row terms(const std::vector<std::string>& inputs, const std::vector<Moving>& at, double s, double f) {
  Row out = {{"1", 1.0}};
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto [u, v] = at[i];
    const std::string& x = inputs[i];
    const std::string rate = i == 0 ? "rate" : "rate of " + x, product = i == 0 ? x + "*rate" : x + "*(" + rate + ")";
    const double sign = (v > 1e-9) - (v < -1e-9);
    const Row own = {{x, u},           {rate, v},         {x + "^2", u * u},                    {"|" + rate + "|", std::abs(v)},           {"sign(" + rate + ")", sign}, {x + "*time", u * s},
                     {product, u * v}, {x + "^3", u * u * u}, {"output*" + (i == 0 ? rate : "(" + rate + ")"), f * v}, {rate + "*|" + rate + "|", v * std::abs(v)}};
    out.insert(out.end(), own.begin(), own.end());
    if (i > 0) out.emplace_back("output*" + x, f * u);
    for (std::size_t k = 0; k < i; ++k) out.emplace_back(inputs[k] + "*" + x, at[k].x * u);
  }
  out.insert(out.end(), {{"time", s}, {"output", f}, {"output*time", f * s}, {"output^2", f * f}});
  return out;
}

Table table_of(const RigModel& model, const Fit& fit, std::size_t output, const std::vector<std::string>& inputs) {
  const Dataset& d = model.data();
  const double fs = model.full_scale(d.outputs[output]);
  Table out;
  std::vector<double> most(inputs.size(), 1e-300);  // of all records: an input that is held in each still differs from one to the next
  for (std::size_t i = 0; i < fit.residual.size(); ++i)
    for (std::size_t m = 0; m < inputs.size() && !fit.residual[i].empty(); ++m) most[m] = std::max(most[m], d.trials[i].at(inputs[m]).cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < fit.residual.size(); ++i) {
    if (fit.residual[i].empty()) continue;
    const Trial& t = d.trials[i];
    const double span = t.time[t.samples() - 1] - t.time[0];
    const int step = std::max(1, t.samples() / 300);
    for (int k = step; k < t.samples(); k += step) {
      const double r = fit.residual[i][output][k];
      std::vector<Moving> at;
      for (std::size_t m = 0; m < inputs.size(); ++m) {
        const Eigen::VectorXd& x = t.at(inputs[m]);
        at.push_back({x[k] / most[m], (x[k] - x[k - step]) / most[m] / (t.time[k] - t.time[k - step]) * 0.1 * span});
      }
      const Row row = terms(inputs, at, (t.time[k] - t.time[0]) / span, fit.predicted[i][output][k] / fs);
      if (!std::isfinite(r) || std::any_of(row.begin(), row.end(), [](const auto& term) { return !std::isfinite(term.second); })) continue;
      if (out.names.empty())
        for (const auto& [name, value] : row) out.names.push_back(name), out.columns.emplace_back();
      for (std::size_t m = 0; m < row.size(); ++m) out.columns[m].push_back(row[m].second);
      out.y.push_back(r / fs);
    }
  }
  return out;
}

Eigen::Map<const Eigen::VectorXd> column(const std::vector<double>& v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

/// Without terms that are zero throughout or another one over again (an input that is held says no more than 1).
void drop_repeated(Table& t) {
  std::vector<std::size_t> kept;
  for (std::size_t m = 0; m < t.columns.size(); ++m) {
    const auto x = column(t.columns[m]);
    const auto same = [&](std::size_t k) { return std::abs(x.dot(column(t.columns[k]))) > kAlike * x.norm() * column(t.columns[k]).norm(); };
    if (x.norm() > 1e-9 && std::none_of(kept.begin(), kept.end(), same)) kept.push_back(m);
  }
  Table out;
  for (const std::size_t m : kept) out.names.push_back(t.names[m]), out.columns.push_back(std::move(t.columns[m]));
  out.y = std::move(t.y);
  t = std::move(out);
}

/// The terms that explain most, one after the other, from the normal equations A b = c.
std::vector<Eigen::Index> pursue(const Eigen::MatrixXd& A, const Eigen::VectorXd& c, int terms, Eigen::VectorXd& beta) {
  std::vector<Eigen::Index> active;
  Eigen::VectorXd left = c;
  for (int m = 0; m < terms; ++m) {
    Eigen::Index best = -1;
    double most = 0.0;
    for (Eigen::Index j = 0; j < A.rows(); ++j) {
      if (A(j, j) < 1e-18 || std::find(active.begin(), active.end(), j) != active.end()) continue;
      if (const double along = std::abs(left[j]) / std::sqrt(A(j, j)); along > most) most = along, best = j;
    }
    if (best < 0) break;
    active.push_back(best);
    beta = A(active, active).colPivHouseholderQr().solve(c(active));
    left = c - A(Eigen::all, active) * beta;
  }
  return active;
}

std::vector<Term> stable_terms(const Table& t, const std::string& output, const DescribeOptions& options, Rng& rng) {
  const auto n = static_cast<Eigen::Index>(t.y.size()), p = static_cast<Eigen::Index>(t.names.size()), block = static_cast<Eigen::Index>(kBlockSamples);
  Eigen::MatrixXd X(n, p);
  for (Eigen::Index m = 0; m < p; ++m) X.col(m) = column(t.columns[static_cast<std::size_t>(m)]);
  const auto y = column(t.y);
  std::map<Eigen::Index, int> chosen;
  std::map<Eigen::Index, double> coefficient;
  for (int round = 0; round < options.resamplings; ++round) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(p, p);
    Eigen::VectorXd c = Eigen::VectorXd::Zero(p), beta;
    for (Eigen::Index k = 0; k < n; k += block) {
      const auto start = static_cast<Eigen::Index>(rng.below(static_cast<std::uint32_t>(n - block)));
      const auto B = X.middleRows(start, block);
      A.noalias() += B.transpose() * B;
      c.noalias() += B.transpose() * y.segment(start, block);
    }
    const auto active = pursue(A, c, options.terms, beta);
    for (std::size_t m = 0; m < active.size(); ++m) ++chosen[active[m]], coefficient[active[m]] += beta[static_cast<Eigen::Index>(m)];
  }
  std::vector<Term> out;
  for (const auto& [j, count] : chosen)
    if (count >= options.chosen * options.resamplings) out.push_back({t.names[static_cast<std::size_t>(j)], coefficient[j] / count, static_cast<double>(count) / options.resamplings, output});
  std::stable_sort(out.begin(), out.end(), [](const Term& a, const Term& b) { return a.stability > b.stability; });
  return out;
}

}  // namespace

std::vector<Term> describe(const RigModel& model, const Fit& fit, const Noise& noise, const DescribeOptions& options) {
  const Dataset& d = model.data();
  const auto inputs = inputs_of(d);
  if (inputs.empty()) return {};
  std::vector<std::pair<double, std::vector<Term>>> all;  // by what is left of an output, in units of its noise
  Rng rng(20260101);
  for (std::size_t c = 0; c < d.outputs.size(); ++c) {
    Table t = table_of(model, fit, c, inputs);
    if (t.y.size() < kLeast) continue;
    drop_repeated(t);
    const double left = column(t.y).norm() / std::sqrt(static_cast<double>(t.y.size())) * model.full_scale(d.outputs[c]) / noise.output[c].sigma;
    all.emplace_back(left, stable_terms(t, d.outputs[c], options, rng));
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Term> out;
  for (auto& [left, terms] : all) out.insert(out.end(), terms.begin(), terms.end());
  return out;
}

}  // namespace filum::reconcile
