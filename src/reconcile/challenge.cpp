#include "reconcile/challenge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace filum::reconcile {
namespace {

using Group = std::vector<bool>;

/// Groups of trials of one protocol among those that are free, each to be held out in turn, dealt into at most `most` folds.
std::vector<Group> by_protocol(const Dataset& d, const Group& free, std::size_t most) {
  std::map<std::string, std::vector<std::size_t>> groups;
  std::size_t all = 0, not_held = 0;
  for (std::size_t i = 0; i < d.trials.size(); ++i) {
    not_held += d.trials[i].hold_out ? 0 : 1;
    if (free[i]) groups[d.protocol_text(d.trials[i])].push_back(i), ++all;
  }
  std::vector<std::vector<std::size_t>> members;
  for (auto& [key, g] : groups) members.push_back(g);
  if (members.size() == 1 && all == not_held) {  // one protocol only: leave replicates out
    const auto one = members[0];
    members.clear();
    for (const std::size_t i : one) members.push_back({i});
  }
  if (members.empty() || (members.size() < 2 && all == not_held)) return {};
  std::vector<Group> out(std::min(most, members.size()), Group(d.trials.size(), false));
  for (std::size_t g = 0; g < members.size(); ++g)
    for (const std::size_t i : members[g]) out[g % out.size()][i] = true;
  return out;
}

/// The trials of the fastest rate; empty where all go about as fast.
Group fastest(const Dataset& d, double apart) {
  double most = 0.0;
  for (const Trial& t : d.trials)
    if (!t.hold_out) most = std::max(most, rate_of(d, t));
  Group out(d.trials.size(), false);
  bool slower = false;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (d.trials[i].hold_out) continue;
    out[i] = rate_of(d, d.trials[i]) * apart > most;
    slower = slower || !out[i];
  }
  return slower && most > 0.0 ? out : Group();
}

/// The trials of the size of which there are fewest (of equals the last); empty where there is one size.
Group other_size(const Dataset& d) {
  std::map<std::map<std::string, double>, std::size_t> count;
  for (const Trial& t : d.trials)
    if (!t.hold_out) ++count[t.specimen];
  if (count.size() < 2) return {};
  std::size_t fewest = d.trials.size() + 1;
  const std::map<std::string, double>* rarest = nullptr;
  for (const Trial& t : d.trials)
    if (!t.hold_out && count[t.specimen] <= fewest) fewest = count[t.specimen], rarest = &t.specimen;
  Group out(d.trials.size(), false);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = !d.trials[i].hold_out && d.trials[i].specimen == *rarest;
  return out;
}

/// In words: what is held out on purpose, then the rest.
std::string turn(const std::vector<Part>& parts) {
  std::string out;
  for (const Part& p : parts)
    if (p.held != "a protocol") out += p.held + ", ";
  return out + "each protocol in turn";
}

std::vector<std::string> files(const Dataset& d, const Group& g) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g[i]) out.push_back(d.trials[i].file);
  return out;
}

/// The part as the rest foretells it. What was marked was not fitted to begin with.
Fit predicted(const Fitter& all, const Part& part, const Fit& start) {
  const Dataset& d = all.model().data();
  bool fitted = false;
  Fitter rest(all);
  for (std::size_t t = 0; t < rest.use.size(); ++t) {
    rest.use[t] = !d.trials[t].hold_out && !part.trials[t];
    fitted = fitted || (part.trials[t] && !d.trials[t].hold_out);
  }
  return all.transfer(fitted ? rest.fit(start.forms, start.base, start.params, {6, 1e-4}, &start) : start, part.trials);
}

/// Adds the squares of the residuals in units of the noise, and how many they are.
void add_squares(const Noise& noise, const Fit& f, double& sum, int& n) {
  for (const auto& trial : f.residual)
    for (std::size_t c = 0; c < trial.size(); ++c)
      for (const double r : trial[c])
        if (std::isfinite(r)) sum += std::pow(r / noise.output[c].sigma, 2), ++n;
}

}  // namespace

Gap gap_of(const Noise& noise, const Fit& before, const Fit& after) {
  double sb = 0, sa = 0;
  int n = 0, m = 0;
  add_squares(noise, before, sb, n);
  add_squares(noise, after, sa, m);
  return {n > 0 ? std::sqrt(sb / n) : 0.0, m > 0 ? std::sqrt(sa / m) : 0.0};
}

double rate_of(const Dataset& d, const Trial& t) {
  if (!t.clocked) return 0.0;
  std::vector<double> rates;
  if (t.has("speed")) {
    for (const double v : t.at("speed")) if (std::isfinite(v)) rates.push_back(std::abs(v));
  } else {
    const auto input = std::find_if(d.channels.begin(), d.channels.end(), [&](const Channel& c) { return c.input && c.name != "time" && t.has(c.name); });
    if (input == d.channels.end()) return 0.0;
    const Eigen::VectorXd& x = t.at(input->name);
    const int step = std::max(1, t.samples() / 50);  // long enough that quantisation and jitter of a step do not count
    for (int k = step; k < t.samples(); ++k)
      if (const double v = (x[k] - x[k - step]) / (t.time[k] - t.time[k - step]); std::isfinite(v)) rates.push_back(std::abs(v));
  }
  if (rates.empty()) return 0.0;
  const auto at = rates.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(rates.size() - 1));
  std::nth_element(rates.begin(), at, rates.end());
  return *at;
}

std::vector<Part> parts_of(const Dataset& d, const ChallengeOptions& options) {
  std::vector<Part> out;
  Group marked(d.trials.size()), free(d.trials.size());
  bool any = false;
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = d.trials[i].hold_out, free[i] = !marked[i], any = any || marked[i];
  if (any) out.push_back({"marked hold_out", marked, true});
  const auto on_purpose = [&](Group g, const char* held) {
    if (g.empty() || std::any_of(out.begin(), out.end(), [&](const Part& p) { return p.trials == g; })) return;
    for (std::size_t i = 0; i < g.size(); ++i) free[i] = free[i] && !g[i];
    out.push_back({held, std::move(g), !any});
  };
  on_purpose(fastest(d, options.rate_apart), "the fastest rate");
  on_purpose(other_size(d), "another size");
  if (any) return out;
  const auto most = static_cast<std::size_t>(options.folds);
  for (Group& g : by_protocol(d, free, out.size() + 1 < most ? most - out.size() : 1)) out.push_back({"a protocol", std::move(g), true});
  return out;
}

ChallengeSummary challenge(const Candidates& sets, const Fit* winner, const ChallengeOptions& options, const Run& run) {
  const Fitter& all = sets.fitter();
  const Fit &base = sets.base(), &named = winner != nullptr ? *winner : base;
  const Dataset& d = all.model().data();
  const auto parts = parts_of(d, options);
  const bool marked = std::any_of(d.trials.begin(), d.trials.end(), [](const Trial& t) { return t.hold_out; });
  ChallengeSummary out;
  out.how = marked ? "trials marked hold_out" : parts.empty() ? "nothing can be held out" : turn(parts);
  std::vector<Fit> b(parts.size()), a(parts.size());
  const bool same = winner == nullptr;  // nothing is named: one prediction serves as both
  parallel(run.threads, (same ? 1 : 2) * parts.size(), [&](std::size_t k) {
    stop_if_cancelled(run);
    const std::size_t i = k % parts.size();
    (k < parts.size() ? b : a)[i] = predicted(all, parts[i], k < parts.size() ? base : named);
  });
  if (same) a = b;
  double before = 0, after = 0, sb = 0, sa = 0;
  int n = 0, m = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Fold fold{parts[i].held, files(d, parts[i].trials), gap_of(all.noise(), b[i], a[i]), b[i].chi2 / sets.dispersion() - b[i].samples, a[i].chi2 / sets.dispersion() - a[i].samples, b[i].samples, parts[i].counts, ""};
    if (!fold.counts) fold.why = "trials are marked hold_out: these alone decide";
    // a protocol without which the effect cannot be learnt says nothing about transfer
    if (!marked && a[i].chi2 > options.unlearnt * b[i].chi2 && parts.size() > 2) fold.counts = false, fold.why = "the rest cannot teach the effect";
    out.folds.push_back(fold);
    if (!fold.counts) continue;
    before += fold.before;
    after += fold.after;
    add_squares(all.noise(), b[i], sb, n);
    add_squares(all.noise(), a[i], sa, m);
  }
  if (marked) out.before = b[0], out.after = a[0];
  if (n == 0) {
    out.gap.before = out.gap.after = std::numeric_limits<double>::quiet_NaN();  // no number: 0 would be better than noise
    return out;
  }
  out.gap = {std::sqrt(sb / n), std::sqrt(sa / m)};
  out.done = before > options.judged * std::sqrt(2.0 * n);
  if (out.done) out.explained = 1.0 - std::max(0.0, after) / before;
  return out;
}

}  // namespace filum::reconcile
