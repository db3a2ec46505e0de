// T-optimality (Atkinson & Fedorov 1975) over a menu of protocols of the rig: each rival is simulated with its fitted values, the
// other one is fitted to it (linearly, about its own optimum), and the protocol with the largest remaining distance in units of
// noise wins. Its chance to decide is counted over 50 draws of the noise.

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "reconcile/result.h"

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

/// The trial with another clock (slower or faster by `factor`) and, at its end, the inputs held for `hold` times its length.
Trial altered(const Trial& t, double factor, double hold) {
  Trial out = t;
  const Eigen::Index n = 400;
  const double span = t.time[t.samples() - 1] - t.time[0];
  const Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(n, 0.0, span * (1.0 + hold));
  for (auto& [name, v] : out.data) v = resample(v, (t.time.array() - t.time[0]).matrix(), at);
  for (const char* speed : {"speed"})
    if (out.has(speed)) out.data[speed] /= factor;
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

/// Prediction over noise, of the first output; the record's own scale is free.
Eigen::VectorXd predict(const Fitter& fitter, const Fit& f, const Trial& t) {
  Fit whole = f;
  Setting s = fitter.setting(whole, 0);
  s.scale = s.gain = 1.0;
  Eigen::MatrixXd out;
  fitter.model().simulate(t, s, out);
  return out.col(0) / fitter.noise().output[0].sigma;
}

/// Squared distance that is left when the record's scale may take what it can.
double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double scatter) {
  const double bb = b.squaredNorm() + 1.0 / (scatter * scatter);
  const Eigen::VectorXd miss = a - b;
  const double along = miss.dot(b);
  return std::max(0.0, miss.squaredNorm() - along * along / bb);
}

}  // namespace

std::optional<NextExperiment> next_experiment(const Fitter& fitter, const Fit& a, const Fit& b) {
  NextExperiment best;
  double most = -1.0, left = 0.0;
  for (const Proposal& p : menu(fitter.model().data())) {
    const Eigen::VectorXd ya = predict(fitter, a, p.trial), yb = predict(fitter, b, p.trial);
    if (!ya.allFinite() || !yb.allFinite()) continue;
    const double rho = fitter.noise().output[0].rho, share = (1.0 - rho) / (1.0 + rho);
    const double d = share * std::min(distance(ya, yb, fitter.noise().scatter), distance(yb, ya, fitter.noise().scatter));
    if (d > most) most = d, best.protocol = p.text, left = d;
  }
  if (most < 0.0) return std::nullopt;
  // log likelihood ratio of the rivals is normal with mean d and variance 4 d
  Rng rng(7);
  int decided = 0;
  for (int i = 0; i < 50; ++i) decided += left + 2.0 * std::sqrt(left) * rng.normal() > 6.0 ? 1 : 0;
  best.chance = decided / 50.0;
  best.why = "it leaves the largest distance between the rivals, " + std::to_string(static_cast<int>(std::sqrt(left))) + " standard deviations of the noise";
  return best;
}

}  // namespace filum::reconcile
