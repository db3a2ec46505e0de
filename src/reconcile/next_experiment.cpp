// T-optimality (Atkinson & Fedorov 1975) over a menu of protocols of the rig. Each rival in turn is taken for the truth; what another one still
// misses of the proposed record is
//   T = min over its values d and the record's own scale c of  |W (y_true - y_rival - J d - y_rival c)|^2 + d' P d + c^2 / scatter^2,
// P the information of the trials that were run (so that no rival may take values they exclude), J by differences. The protocol that is to decide most pairs of
// rivals wins; among equals, that of the largest smallest T. Its chance is counted over 50 simulated records: the truth drawn in turn, its values by their
// covariance, noise added, every rival fitted (linearly); it decides where the truth leads all others by more than a tie, the evidence so far included.

#include "reconcile/next_experiment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/rng.h"

namespace filum::reconcile {
namespace {

struct Proposal {
  std::string text;
  Trial trial;
};

Eigen::VectorXd resample(const Eigen::VectorXd& v, const Eigen::VectorXd& time, const Eigen::VectorXd& at) {
  Eigen::VectorXd out(at.size());
  Eigen::Index k = 0;
  for (Eigen::Index n = 0; n < at.size(); ++n) {
    while (k + 2 < time.size() && time[k + 1] < at[n]) ++k;
    const double w = std::clamp((at[n] - time[k]) / (time[k + 1] - time[k]), 0.0, 1.0);
    out[n] = v[k] + w * (v[k + 1] - v[k]);
  }
  return out;
}

constexpr double kMostSamples = 600;  // that are simulated; where the record would have more, each counts for several

/// The trial with another clock (slower or faster by `factor`) and, at its end, the inputs held for `hold` times its length; sampled as before.
Trial altered(const Trial& t, double factor, double hold) {
  Trial out = t;
  const double span = t.time[t.samples() - 1] - t.time[0];
  const auto n = static_cast<Eigen::Index>(std::clamp((t.samples() - 1) * factor * (1.0 + hold), 20.0, kMostSamples)) + 1;
  const Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(n, 0.0, span * (1.0 + hold));
  for (auto& [name, v] : out.data) v = resample(v, (t.time.array() - t.time[0]).matrix(), at);
  if (out.has("speed")) out.data["speed"] /= factor;
  out.time = at * factor;
  out.file = "proposed";
  return out;
}

std::vector<Proposal> menu(const Dataset& d) {
  std::vector<Proposal> out;
  const Trial& t = d.trials[0];
  out.push_back({"the first trial ten times slower", altered(t, 10.0, 0.0)});
  out.push_back({"the first trial ten times faster", altered(t, 0.1, 0.0)});
  out.push_back({"the first trial, then its last input held for three times its length", altered(t, 1.0, 3.0)});
  const auto sized = [&](const std::string& text, const std::vector<std::string>& keys, double factor) {
    Proposal p{text, altered(t, 1.0, 1.0)};
    for (const std::string& key : keys)
      if (p.trial.specimen.count(key) > 0) p.trial.specimen[key] *= factor;
    out.push_back(std::move(p));
  };
  if (d.rig == Rig::tissue_block) {
    sized("a specimen twice as large in every direction", {"length", "width", "height", "diameter"}, 2.0);
    sized("a specimen of half the height", {"height"}, 0.5);
    for (const char* mode : {"tension", "compression", "shear"}) {
      Proposal p{std::string("the specimen in ") + mode, altered(t, 1.0, 0.5)};
      if (t.word("mode") == mode) continue;
      p.trial.protocol["mode"] = mode;
      const bool flip = (t.word("mode") == "compression") != (std::string(mode) == "compression");
      if (flip) p.trial.data["displacement"] = -p.trial.data["displacement"];
      out.push_back(std::move(p));
    }
  }
  if (d.rig == Rig::spatula_press) sized("a blade twice as long and wide", {"blade_length", "blade_width"}, 2.0);
  if (d.rig == Rig::vessel_inflation) sized("a vessel of half the wall thickness", {"wall_thickness"}, 0.5);
  if (d.rig == Rig::suture_cantilever) {
    Proposal p{"the other orientation", altered(t, 1.0, 0.0)};
    p.trial.protocol["orientation"] = t.word("orientation") == "up" ? "down" : "up";
    out.push_back(std::move(p));
  }
  if (d.rig == Rig::suture_pull) {
    for (const auto& [key, factor] : std::vector<std::pair<std::string, double>>{{"hold_force", 0.2}, {"wrap_angle", 0.3}, {"speed", 5.0}}) {
      Proposal p{"the first trial with the " + key + " times " + std::to_string(factor).substr(0, 3), altered(t, 1.0, 0.0)};
      p.trial.data[key] *= factor;
      out.push_back(std::move(p));
    }
  }
  return out;
}

/// A rival on a proposed record, whitened: prediction, its derivatives by its values and the record's scale, information on these from before.
struct Rival {
  Eigen::VectorXd y;
  Eigen::MatrixXd J, P, spread;  // spread * standard normal numbers: values as uncertain as they are
  double evidence = 0.0;         // chi-squared by which it stands behind the first rival so far
};

/// Prediction of the first output over the noise; `share` of its samples' information, since neighbours are correlated.
Eigen::VectorXd predict(const Fitter& fitter, const Fit& f, const Trial& t, double share) {
  Setting s = fitter.setting(f, 0);
  s.scale = s.gain = 1.0;
  Eigen::MatrixXd out;
  fitter.model().simulate(t, s, out);
  return out.col(0) * (std::sqrt(share) / fitter.noise().output[0].sigma);
}

Rival rival_on(const Fitter& fitter, const Fit& f, const Trial& t, double share) {
  Rival r;
  r.y = predict(fitter, f, t, share);
  const auto globals = fitter.globals(f.forms);
  const auto n = static_cast<Eigen::Index>(globals.size());
  r.J.resize(r.y.size(), n + 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Fitter::Global& g = globals[static_cast<std::size_t>(k)];
    Fit probe = f;
    double& v = Fitter::value(probe, g);
    double h = g.logarithmic ? 1e-4 : 1e-5 * std::max(std::abs(v), 1e-2 * g.unit);
    if ((g.logarithmic ? v * std::exp(h) : v + h) > g.high) h = -h;
    v = g.logarithmic ? v * std::exp(h) : v + h;
    r.J.col(k) = (predict(fitter, probe, t, share) - r.y) / h;
  }
  r.J.col(n) = r.y;
  const double own = fitter.model().has_scale() ? fitter.noise().scatter : fitter.noise().gain_scatter;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n + 1, n + 1);
  if (f.covariance.rows() == n) covariance.topLeftCorner(n, n) = f.covariance;
  covariance(n, n) = own * own;
  for (Eigen::Index k = 0; k < n; ++k) {  // no value strays farther than its range
    const Fitter::Global& g = globals[static_cast<std::size_t>(k)];
    const double range = g.logarithmic ? std::log(g.high / g.low) : g.high - g.low;
    if (const double factor = covariance(k, k) > range * range ? range / std::sqrt(covariance(k, k)) : 1.0; factor < 1.0) covariance.row(k) *= factor, covariance.col(k) *= factor;
    covariance(k, k) += 1e-12 * range * range;
  }
  r.P = covariance.ldlt().solve(Eigen::MatrixXd::Identity(n + 1, n + 1));
  r.spread = covariance.llt().matrixL();
  return r;
}

/// What the rival misses of a record at best, T.
double missed(const Rival& r, const Eigen::VectorXd& y) {
  const Eigen::VectorXd miss = y - r.y, g = r.J.transpose() * miss;
  return std::max(0.0, miss.squaredNorm() - g.dot((r.J.transpose() * r.J + r.P).ldlt().solve(g)));
}

/// Over 50 simulated records, the truth in turn each rival: the share in which it leads all others by more than `tie`, and how many rivals
/// it has left on average, itself counted.
struct Outcome {
  double chance = 0.0, left = 0.0;
};

Outcome outcome_of(const std::vector<Rival>& rivals, double tie, int records) {
  Rng rng(7);
  int decided = 0, remaining = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(records); ++i) {
    const Rival& truth = rivals[i % rivals.size()];
    Eigen::VectorXd z(truth.J.cols()), y = truth.y;
    for (double& v : z) v = rng.normal();
    y += truth.J * (truth.spread * z);
    for (double& v : y) v += rng.normal();
    const double own = truth.evidence + missed(truth, y);
    const auto others = std::count_if(rivals.begin(), rivals.end(), [&](const Rival& r) { return &r != &truth && r.evidence + missed(r, y) - own <= tie; });
    decided += others == 0 ? 1 : 0;
    remaining += 1 + static_cast<int>(others);
  }
  return {decided / static_cast<double>(records), remaining / static_cast<double>(records)};
}

/// Share of the pairs that a record is to decide: twice the log likelihood ratio of two rivals is normal, mean T and variance 4 T (Cox 1961).
double pairs_decided(const std::vector<Rival>& rivals, double tie, double& least) {
  double sum = 0.0;
  least = 1e300;
  for (const Rival& a : rivals)
    for (const Rival& b : rivals) {
      if (&a == &b) continue;
      const double T = a.y.allFinite() && b.J.allFinite() && b.y.allFinite() ? missed(b, a.y) : 0.0;
      least = std::min(least, T);
      sum += 0.5 * std::erfc((tie - T - b.evidence + a.evidence) / (2.0 * std::sqrt(2.0 * std::max(T, 1e-9))));
    }
  return sum / static_cast<double>(rivals.size() * (rivals.size() - 1));
}

}  // namespace

std::optional<NextSummary> next_experiment(const Fitter& fitter, const std::vector<const Fit*>& rivals, const std::vector<double>& evidence, double dispersion, double tie, const NextOptions& options) {
  NextSummary best;
  double most = -1.0, distance = 0.0;
  std::vector<Rival> chosen;
  const OutputNoise& noise = fitter.noise().output[0];
  const Trial& first = fitter.model().data().trials[0];
  const double step = (first.time[first.samples() - 1] - first.time[0]) / (first.samples() - 1);
  for (const Proposal& p : menu(fitter.model().data())) {
    const Eigen::Index n = p.trial.time.size();
    const double each = (p.trial.time[n - 1] - p.trial.time[0]) / static_cast<double>(n - 1) / step;  // samples that one stands for
    const double share = each / noise.slow() / dispersion;
    std::vector<Rival> on;
    for (std::size_t i = 0; i < rivals.size(); ++i) {
      on.push_back(rival_on(fitter, *rivals[i], p.trial, share));
      on.back().evidence = evidence[i] - evidence[0];
    }
    double least = 0.0;
    const double share_decided = pairs_decided(on, tie, least);
    if (share_decided > most + 1e-3 || (share_decided > most - 1e-3 && least > distance)) most = share_decided, distance = least, best.protocol = p.text, chosen = std::move(on);
  }
  if (most < 0.0) return std::nullopt;
  const Outcome outcome = outcome_of(chosen, tie, options.records);
  best.chance = outcome.chance;
  char text[160];
  std::snprintf(text, sizeof text, "it leaves %.1f standard deviations of the noise between the two rivals that stay nearest, and on average %.1f of %d rivals", std::sqrt(distance), outcome.left,
                static_cast<int>(rivals.size()));
  best.why = text;
  return best;
}

}  // namespace filum::reconcile
