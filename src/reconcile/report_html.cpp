#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <set>
#include <sstream>

#include "base/markup.h"
#include "base/units.h"
#include "reconcile/plot.h"
#include "reconcile/report.h"
#include "reconcile/stages.h"
#include "reconcile/transform.h"

namespace filum::reconcile {
namespace {

std::string number(double v, int digits = 4) {
  char text[40];
  const bool whole = std::abs(v) < 1e6 && std::abs(v) >= std::pow(10.0, digits) - 0.5;  // no exponents where a plain number will do
  if (whole) std::snprintf(text, sizeof text, "%.0f", v);
  else std::snprintf(text, sizeof text, "%.*g", digits, v);
  return std::isfinite(v) ? text : "-";
}

std::string names(const std::vector<Effect>& effects) {
  std::string out;
  for (const Effect e : effects) out += (out.empty() ? "" : " + ") + info(e).name;
  return out.empty() ? "none" : out;
}

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string out = "<tr>";
  for (const std::string& c : cells) out += std::string("<") + tag + ">" + escaped(c) + "</" + tag + ">";
  return out + "</tr>\n";
}

/// With a prefix where the unit is a single symbol: 119 kPa, not 1.19e+05 Pa.
std::string quantity(double v, const std::string& unit) {
  const bool plain = unit == "m" || unit == "N" || unit == "Pa" || unit == "s";
  return plain && std::isfinite(v) && v != 0.0 ? format_prefixed(v, unit) : number(v) + (unit == "-" ? "" : " " + unit);
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "" : ", ") + w;
  return out;
}

std::string at_most(double share) { return share < 1e-5 ? "less than 0.001 %" : "at most " + number(100 * share, 2) + " %"; }

std::string interval(const Estimate& e) { return quantity(e.value, e.unit) + " (" + quantity(e.low, e.unit) + " to " + quantity(e.high, e.unit) + ")"; }

/// A channel as its file writes it.
Eigen::VectorXd written(const Channel& c, const Eigen::VectorXd& si) { return (si.array() - c.shift) / c.scale; }
std::string axis(const Channel& c) { return c.name + (c.unit.empty() || c.unit == "-" ? "" : " [" + c.unit + "]"); }

std::string unit_of(const Dataset& d, const std::string& channel) {
  for (const ChannelInfo& k : info(d.rig).channels)
    if (k.name == channel) return k.unit;
  return "m";
}

/// Least and most of a trial's replicates at its own times; empty where it has none.
Curve replicate_band(const Dataset& d, std::size_t trial, const std::string& output) {
  const Trial& t = d.trials[trial];
  Curve band{t.time, {}, "#e4e4e4", false, {}};
  if (t.repeat.empty() || d.rig == Rig::tip_hold) return band;  // a hand's records wander each their own way from an origin of no meaning
  int others = 0;
  Eigen::VectorXd low = t.at(output), high = low;
  for (const Trial& o : d.trials) {
    if (&o == &t || o.repeat != t.repeat || d.protocol_text(o) != d.protocol_text(t)) continue;
    ++others;
    Eigen::Index k = 0;
    for (Eigen::Index n = 0; n < t.time.size(); ++n) {
      const double at = o.time[0] + t.time[n] - t.time[0];
      while (k + 2 < o.time.size() && o.time[k + 1] < at) ++k;
      const double w = std::clamp((at - o.time[k]) / (o.time[k + 1] - o.time[k]), 0.0, 1.0), y = o.at(output)[k] + w * (o.at(output)[k + 1] - o.at(output)[k]);
      low[n] = std::fmin(low[n], y);
      high[n] = std::fmax(high[n], y);
    }
  }
  if (others > 0) band.y = high, band.low = low;
  return band;
}

std::string protocol_of(const Trial& t) {
  std::string out;
  for (const auto& [key, value] : t.protocol) out += (out.empty() ? "" : ", ") + key + " " + value;
  return out;
}

/// Measured, before and after of one output of one record, over time or over an input.
std::string record_plot(const Dataset& d, const Result& r, std::size_t i, std::size_t c, const Channel* input) {
  const Trial& t = d.trials[i];
  const bool held = r.decide.before.predicted[i].empty();
  const Fit &before = held ? r.challenge.before : r.decide.before, &after = held ? r.challenge.after : r.decide.after;
  const Channel& out = d.channel(d.outputs[c]);
  const Eigen::VectorXd x = input == nullptr ? t.time : written(*input, t.at(input->name));
  std::vector<Curve> lines;
  if (Curve band = replicate_band(d, i, d.outputs[c]); input == nullptr && band.low.size() > 0) {
    band.y = written(out, band.y), band.low = written(out, band.low);
    lines.push_back(std::move(band));
  }
  lines.push_back({x, written(out, t.at(d.outputs[c])), "#999", true, {}});
  lines.push_back({x, written(out, before.predicted[i][c]), "#26c", false, {}});
  const bool named = r.decide.verdict == "effect" || r.decide.verdict == "ambiguous";
  if (named && i < after.predicted.size() && !after.predicted[i].empty()) lines.push_back({x, written(out, after.predicted[i][c]), "#c22", false, {}});
  return plot({input == nullptr ? t.file + ": " + protocol_of(t) + (held ? " (held out)" : "") : protocol_of(t), input != nullptr ? axis(*input) : t.clocked ? "time [s]" : "sample", axis(out)}, lines);
}

void curves(const Dataset& d, const Result& r, std::ostringstream& s) {
  s << "<h2>Measured, before and after</h2><p>Grey: measured; pale: from the least to the most of its replicates; blue: the baseline, refitted" << (r.decide.verdict == "effect" ? "; red: with what the verdict names" : r.decide.verdict == "ambiguous" ? "; red: with the first rival" : "")
    << ". Each record keeps its own stiffness.</p><div class='plots'>";
  const Channel* input = nullptr;
  for (const Channel& c : d.channels)
    if (c.input && c.name != "time" && input == nullptr) input = &c;
  std::set<std::string> seen;
  std::string over;
  int drawn = 0;
  for (std::size_t i = 0; i < d.trials.size(); ++i) {
    if (i >= r.decide.before.predicted.size() || r.decide.before.predicted[i].empty()) continue;
    for (std::size_t c = 0; c < d.outputs.size() && drawn < 12; ++c, ++drawn) s << record_plot(d, r, i, c, nullptr);
    const bool first = seen.insert(d.protocol_text(d.trials[i])).second;
    if (first && input != nullptr && d.trials[i].has(input->name) && seen.size() <= 6) over += record_plot(d, r, i, 0, input);
  }
  for (std::size_t i = 0; i < r.challenge.before.predicted.size() && i < d.trials.size(); ++i) {
    if (!d.trials[i].hold_out || r.challenge.before.predicted[i].empty()) continue;
    for (std::size_t c = 0; c < d.outputs.size() && drawn < 16; ++c, ++drawn) s << record_plot(d, r, i, c, nullptr);
  }
  s << "</div>\n";
  if (!over.empty()) s << "<p>The same over " << escaped(input->name) << ", one record of each protocol.</p><div class='plots'>" << over << "</div>\n";
}

/// The same by single conditions: darker, the more of the excess sits there; bare where noise alone could do it.
void heat_by(const Result& r, std::ostringstream& s) {
  if (r.localise.by.empty()) return;
  s << "<p>The same by one condition at a time: share of what lies beyond the noise; in brackets what stands out by less than 4 standard deviations.</p><table class='by'>";
  for (std::size_t i = 0; i < r.localise.by.size(); ++i) {
    const Share& w = r.localise.by[i];
    if (i == 0 || r.localise.by[i - 1].axis != w.axis) s << (i == 0 ? "" : "</tr>\n") << "<tr><th scope='row'>" << escaped(w.axis) << "</th>";
    const int shade = 255 - static_cast<int>(170 * std::clamp(w.share, 0.0, 1.0));
    const std::string share = number(100 * w.share, 2) + " %";
    s << "<td style='background:rgb(" << 255 - (255 - shade) / 3 << "," << shade << "," << shade << ")'>" << escaped(w.bin) << "<br>" << (w.deviations < 4.0 ? "(" + share + ")" : share) << "</td>";
  }
  s << "</tr></table>\n";
}

/// Mean residual of a stretch of a record over its standard error, before.
void heat(const Dataset& d, const Result& r, std::ostringstream& s) {
  std::vector<std::string> rows;
  std::vector<std::vector<double>> cells;
  for (std::size_t i = 0; i < r.decide.before.residual.size(); ++i)
    for (std::size_t c = 0; c < r.decide.before.residual[i].size(); ++c) {
      const Eigen::VectorXd& v = r.decide.before.residual[i][c];
      const Eigen::Index n = 40, w = std::max<Eigen::Index>(1, v.size() / n);
      rows.push_back(d.trials[i].file + " " + d.outputs[c]);
      cells.emplace_back();
      for (Eigen::Index k = 0; k + w <= v.size(); k += w) {
        double sum = 0;
        int m = 0;
        for (Eigen::Index j = k; j < k + w; ++j)
          if (std::isfinite(v[j])) sum += v[j], ++m;
        cells.back().push_back(m > 0 ? std::abs(sum / m) / r.fit.noise.output[c].sigma * std::sqrt(static_cast<double>(m)) : 0.0);
      }
    }
  if (rows.empty()) return;
  s << "<h2>Where the baseline misses</h2><p>Mean residual of each fortieth of a record in standard errors; dark is 8 or more. Time runs to the right.</p>" << heat_map(rows, cells, 8.0);
  heat_by(r, s);
  if (r.localise.cells.empty()) return;
  s << "<table>" << row({"record", "phase", "range", "share of the excess"}, "th");
  for (std::size_t i = 0; i < r.localise.cells.size() && i < 8; ++i) s << row({r.localise.cells[i].trial, r.localise.cells[i].phase, r.localise.cells[i].range, number(100 * r.localise.cells[i].share, 3) + " %"});
  s << "</table>\n";
}

/// Whether the baseline was lucky with its start.
void starts(const Dataset& d, const Result& r, std::ostringstream& s) {
  const BaselineSummary& b = r.baseline;
  if (b.starts.empty()) return;
  double best = INFINITY;
  for (const BaselineStart& x : b.starts) best = std::min(best, x.chi2);
  s << "<h2>Starts of the baseline</h2><p>" << b.same() << " of " << b.starts.size() << " starts ended at the same optimum"
    << (b.same() < static_cast<int>(b.starts.size()) ? "; the best was kept" : "") << ". A start counts where its chi-squared is within " << number(r.rules.baseline.same) << " or " << number(100 * r.rules.baseline.share) << " % of the best.</p><table>"
    << row({"start", "ended at", "chi-squared above the best"}, "th");
  const auto values = [&](const std::vector<double>& x) {
    std::string out;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const ParameterInfo& p = info(d.rig).baseline[i];
      if (std::find(d.free.begin(), d.free.end(), p.name) != d.free.end()) out += (out.empty() ? "" : ", ") + p.name + " " + quantity(x[i], p.unit);
    }
    return out;
  };
  for (const BaselineStart& x : b.starts) s << row({values(x.from), values(x.to), number(x.chi2 - best, 3)});
  s << "</table>\n";
}

void checks(const Dataset& d, const Result& r, std::ostringstream& s) {
  if (r.detect) {
    const DetectSummary& x = *r.detect;
    s << "<h2>Is anything missing?</h2><p>The largest sum of the baseline's residual over any window is " << number(x.statistic, 3) << " standard deviations (" << escaped(x.trial) << ", " << number(x.from) << " s to " << number(x.to)
      << " s), the " << escaped(x.score_is) << " " << number(x.score, 4) << ". The rarer of the two among " << x.repetitions << " simulated repetitions in which the baseline is true: p = " << number(x.p, 2)
      << "; some effect or line does as well as the best single one here in " << number(100 * x.chance, 2) << " % of them. "
      << (r.fit.dispersion > 1.5 ? "In these figures what no candidate takes away counts as noise (overdispersion " + number(r.fit.dispersion, 3) + "), so that no name rests on it; against the noise as measured, sums over blocks of the residual stand " +
                                   number(r.decide.structure_before, 3) + " standard deviations out. "
                             : std::string())
      << "What lies beyond the noise amounts to " << number(100 * x.excess, 2) << " % of full scale; " << number(100 * r.rules.compare.materiality, 2) << " % is material.</p>\n";
  }
  if (!r.decide.numerics.sensitivities.empty()) {
    s << "<h2>Numbers behind the fit</h2><p>Halving the time step changes a record's prediction by " << at_most(r.decide.numerics.time) << " of full scale, halving the cells by " << at_most(r.decide.numerics.mesh)
      << (r.decide.numerics.solver() > r.rules.compare.materiality ? "; that takes the place of what the rules call material" : "") << ". ";
    std::string doubtful;
    for (const Sensitivity& v : r.decide.numerics.sensitivities)
      if (v.disagreement > kDoubtful) doubtful += (doubtful.empty() ? "" : ", ") + v.parameter + " (" + number(100 * v.disagreement, 2) + " %)";
    s << (doubtful.empty() ? "Every derivative is the same, within " + number(100 * kDoubtful, 2) + " %, by differences at one and at two steps."
                           : "Derivatives by differences at one and at two steps disagree for " + escaped(doubtful) + ": intervals of these rest on a kink of the model and are to be doubted.")
      << "</p>\n";
  }
  starts(d, r, s);
  if (!r.confirm) return;
  const ConfirmSummary& c = *r.confirm;
  s << "<h2>Full re-simulation</h2>";
  if (!c.ran) {
    s << "<p>" << escaped(c.solver) << " did not come to rest for these values; the reduced model stands alone.</p>\n";
    return;
  }
  s << "<p>Baseline and best candidate were fitted again with " << escaped(c.solver) << ". It differs from the reduced model by " << number(100 * c.difference, 2) << " % of full scale before that, and from itself with half the mesh by "
    << number(100 * c.mesh, 2) << " %. Evidence " << number(-c.evidence, 4) << "; chi-squared a sample " << number(c.chi2_before, 3) << " before, " << number(c.chi2_after, 3) << " after; the reduced model's candidate "
    << (c.holds ? "is borne out" : "is not borne out") << ".</p><table>" << row({"parameter", "by the full solver"}, "th");
  for (const NamedEffect& e : c.values)
    for (const Estimate& p : e.parameters) s << row({info(e.effect).name + ": " + p.name, interval(p)});
  s << "</table>\n";
}

void tables(const Dataset& d, const Result& r, std::ostringstream& s) {
  s << "<h2>Gap</h2><p>Root-mean-square residual over the noise's standard deviation; 1 is perfect.</p><table>" << row({"", "before", "after"}, "th")
    << row({"fitted trials", number(r.decide.gap.before, 3), number(r.decide.gap.after, 3)}) << row({"held out (" + r.challenge.how + ")", number(r.challenge.gap.before, 3), number(r.challenge.gap.after, 3)}) << "</table>";
  if (!r.challenge.folds.empty()) s << "<p>Fitted without these trials, then asked for them; only the records' own scales were fitted to them.</p><table>" << row({"held out", "trials", "before", "after", ""}, "th");
  for (const Fold& f : r.challenge.folds) s << row({f.held, joined(f.trials), number(f.gap.before, 3), number(f.gap.after, 3), f.counts ? "" : "does not count: " + f.why});
  s << (r.challenge.folds.empty() ? "<table>" : "</table><table>")
    << row({"output", "noise, 1 sd", "from", "correlation of neighbours", "share without memory", "samples", "worth, if independent", "full scale"}, "th");
  for (std::size_t c = 0; c < r.fit.noise.output.size(); ++c) {
    const OutputNoise& o = r.fit.noise.output[c];
    double samples = 0;
    for (const auto& trial : r.decide.before.residual)
      if (c < trial.size()) samples += static_cast<double>(std::count_if(trial[c].begin(), trial[c].end(), [](double v) { return std::isfinite(v); }));
    s << row({d.outputs[c], quantity(o.sigma, unit_of(d, d.outputs[c])), o.from, number((1.0 - o.white) * o.rho, 2), number(o.white, 2), number(samples), number(std::floor(samples / o.slow())), quantity(o.full_scale, unit_of(d, d.outputs[c]))});
  }
  s << "</table>";
  if (d.rig == Rig::tip_hold) s << "<p>The octave of the spectrum with most power beside what is named has twice the log likelihood of " << number(r.decide.structure_before, 3) << " against noise.</p>\n";
  else s << "<p>Records of one batch differ in stiffness by " << number(100 * r.fit.noise.scatter, 2) << " % (1 sd). Structure left in the residual: " << number(r.decide.structure_before, 3) << " standard deviations before, "
         << number(r.decide.structure_after, 3) << " after. Overdispersion used for all comparisons: " << number(r.fit.dispersion, 3) << ".</p>\n";
  s << "<h2>Parameters</h2>" << (d.rig == Rig::tip_hold ? "<p>A still hand has no parameters but those of what is named.</p>" : "") << "<table>"
    << (r.decide.verdict == "effect" ? row({"parameter", "baseline alone", "with the effect"}, "th") : r.baseline.alone.empty() ? std::string() : row({"parameter", "baseline"}, "th"));
  for (const Estimate& e : r.baseline.alone) {
    if (r.decide.verdict != "effect") {
      s << row({e.name, interval(e)});
      continue;
    }
    std::string after = "-";
    for (const Estimate& a : r.decide.baseline)
      if (a.name == e.name) after = interval(a);
    s << row({e.name, interval(e), after});
  }
  if (r.decide.verdict == "effect")
    for (const NamedEffect& e : r.decide.effects)
      for (const Estimate& p : e.parameters) s << row({info(e.effect).name + ": " + p.name, "-", interval(p)});
  s << "</table><p>Intervals are 95 %.</p>\n<h2>Everything that was tried</h2>";
  if (!r.screen.effects.empty()) {
    s << "<p>Screened, instruments as well as materials: the fall of chi-squared that a score test of the baseline's residual promises each effect, against the noise as measured; lines of free phase are judged in the spectrum.</p><table>" << row({"effect", "promise", "hidden by a refit", "what came of it"}, "th");
    for (const Screened& x : r.screen.effects) s << row({info(x.effect).name, number(x.gain, 3), std::isfinite(x.masked) ? number(100 * x.masked, 3) + " %" : "-", x.what});
    s << "</table><p>Sets that were fitted:</p>";
  }
  s << "<table>" << row({"effects", "form", "evidence", "explains", "why not"}, "th");
  for (const Tried& t : r.decide.tried) s << row({names(t.effects), t.form, number(-t.evidence, 4), number(100 * t.explained, 3) + " %", t.why});
  s << "</table><p>Evidence: fall of the Bayesian information criterion against the baseline; a difference below " << number(r.rules.decide.tie) << " is a tie.</p>\n";
}

/// Frequencies [Hz] up to half the sampling rate and log10 of the periodogram there; of many, each point is the strongest of its neighbours, so that no line is lost.
std::pair<Eigen::VectorXd, Eigen::VectorXd> spectrum_of(const Eigen::VectorXd& v, double span) {
  constexpr Eigen::Index kPoints = 400;
  const auto out = transform(v);
  const auto n = static_cast<Eigen::Index>(out.size());
  span *= static_cast<double>(n) / static_cast<double>(v.size());
  const Eigen::Index all = std::max<Eigen::Index>(1, n / 2 - 1), each = (all + kPoints - 1) / kPoints, points = (all + each - 1) / each;
  Eigen::VectorXd f(points), p = Eigen::VectorXd::Constant(points, 1e-300);
  for (Eigen::Index k = 0; k < all; ++k) {
    const double power = std::norm(out[static_cast<std::size_t>(k + 1)]) / static_cast<double>(n);
    if (k % each == 0 || power > p[k / each]) p[k / each] = std::max(power, 1e-300), f[k / each] = static_cast<double>(k + 1) / span;
  }
  return {f, p.array().log10()};
}

void residual_after(const Dataset& d, const Result& r, std::ostringstream& s) {
  // the output and record of which most is left
  double most = -1.0;
  std::size_t record = 0, output = 0;
  for (std::size_t i = 0; i < r.decide.after.residual.size(); ++i)
    for (std::size_t c = 0; c < r.decide.after.residual[i].size(); ++c) {
      double sum = 0.0, n = 1e-300;
      for (const double x : r.decide.after.residual[i][c])
        if (std::isfinite(x)) sum += x * x, n += 1.0;
      if (const double left = sum / n / std::pow(r.fit.noise.output[c].sigma, 2); left > most) most = left, record = i, output = c;
    }
  if (most < 0.0) return;
  {
    const std::size_t i = record;
    const Eigen::VectorXd& v = r.decide.after.residual[i][output];
    const Eigen::Index lags = std::min<Eigen::Index>(60, v.size() / 4);
    Eigen::VectorXd x(lags), a(lags);
    const auto product = [&](Eigen::Index lag) {
      double sum = 0;
      for (Eigen::Index k = lag; k < v.size(); ++k)
        if (std::isfinite(v[k]) && std::isfinite(v[k - lag])) sum += v[k] * v[k - lag];
      return sum;
    };
    const double zero = product(0);
    for (Eigen::Index k = 0; k < lags; ++k) x[k] = static_cast<double>(k), a[k] = zero > 0 ? product(k) / zero : 0.0;
    const auto [f, p] = spectrum_of(v, d.trials[i].time[v.size() - 1] - d.trials[i].time[0]);
    s << "<h2>What is left afterwards</h2><p>Of the record of which most is left: " << number(std::sqrt(most), 3) << " standard deviations of the noise.</p><div class='plots'>" << plot({"autocorrelation, " + d.trials[i].file + ", " + d.outputs[output], "lag [samples]", "correlation"}, {{x, a, "#444", false, {}}})
      << plot({"spectrum, " + d.trials[i].file + ", " + d.outputs[output], "frequency [Hz]", "log10 power"}, {{f, p, "#444", false, {}}}) << "</div>\n";
  }
}

/// A term with the output's own name.
std::string in_words(const Term& t) {
  std::string term = t.name;
  if (const std::size_t at = term.find("output"); at != std::string::npos) term.replace(at, 6, t.output);
  return term;
}

/// How alike the signatures of all sets are that the data do not tell apart.
void ambiguity(const Result& r, std::ostringstream& s) {
  if (r.decide.alike_sets.size() < 2) return;
  s << "<h2>How alike they are</h2><p>Correlation of the signatures of each two sets, in what a refit of the baseline cannot answer (1 or -1: no record of these trials tells them apart), and the share of each that such a refit hides.</p><table>";
  std::vector<std::string> head = {""};
  for (const auto& set : r.decide.alike_sets) head.push_back(names(set));
  head.push_back("hidden by a refit");
  s << row(head, "th");
  for (std::size_t i = 0; i < r.decide.alike_sets.size(); ++i) {
    std::vector<std::string> cells = {names(r.decide.alike_sets[i])};
    for (std::size_t k = 0; k < r.decide.alike_sets.size(); ++k) cells.push_back(number(r.decide.alike.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)), 3));
    cells.push_back(number(100 * r.decide.alike.masked[i], 3) + " %");
    s << row(cells);
  }
  s << "</table>\n";
}

std::string listed_as_text(const nlohmann::ordered_json& values) {
  std::string out;
  for (const auto& [key, v] : values.items()) out += (out.empty() ? "" : ", ") + key + " " + (v.is_number_float() ? number(v.get<double>()) : v.is_string() ? v.get<std::string>() : v.dump());
  return out;
}

/// Each stage with the numbers that it went by and what it left to the next, in the order in which they ran.
void stages(const Dataset& d, const Result& r, std::ostringstream& s) {
  s << "<h2>Stages</h2><table>" << row({"stage", "what it did", "options", "found"}, "th");
  for (const Stage& x : stages_of(d, r)) s << row({x.name, x.summary, listed_as_text(x.options), listed_as_text(x.found)});
  s << "</table>\n";
}

void closing(const Dataset& d, const Result& r, const std::string& program, std::ostringstream& s) {
  if (!r.describe.shape.empty()) {
    if (d.rig == Rig::tip_hold) s << "<h2>Shape of what is not explained</h2><p>The octave of the spectrum with most power beside what is named; stability is the share of 30 resamplings of the records that chose it.</p><table>" << row({"band", "times the noise's power", "stability"}, "th");
    else s << "<h2>Shape of what is not explained</h2><p>Sparse regression of the residual, in parts of full scale, on terms scaled to 1; stability is the share of 30 resamplings that chose the term.</p><table>" << row({"output", "term", "coefficient", "stability"}, "th");
    for (const Term& t : r.describe.shape) s << (d.rig == Rig::tip_hold ? row({t.name, number(t.coefficient, 3), number(t.stability, 2)}) : row({t.output, in_words(t), number(t.coefficient, 3), number(t.stability, 2)}));
    s << "</table>\n";
  }
  if (r.decide.verdict == "ambiguous") {
    s << "<h2>Rivals</h2><table>" << row({"effects", "form", "behind the best, BIC", "explains"}, "th");
    for (const Tried& t : r.decide.rivals) s << row({names(t.effects), t.form, number(t.evidence - r.decide.rivals[0].evidence, 3), number(100 * t.explained, 3) + " %"});
    s << "</table>";
  }
  ambiguity(r, s);
  if (r.next) s << "<h2>Next experiment</h2><p>" << escaped(r.next->protocol) << ": " << escaped(r.next->why) << ". It would decide in " << number(100 * r.next->chance, 3) << " % of 50 simulated repetitions.</p>\n";
  s << "<h2>Not testable with these trials</h2>";
  if (r.lint.not_testable.empty()) {
    s << "<p>Every effect that the catalogue has for this rig would show in these trials.</p>\n";
  } else {
    s << "<table>" << row({"effect", "why", "what would show it"}, "th");
    for (const NotTestable& n : r.lint.not_testable) s << row({info(n.effect).name, n.why, n.needs});
    s << "</table>\n";
  }
  stages(d, r, s);
  s << "<h2>Rules</h2><table>" << row({"rule", "discovery.md 4.3, or as said", "used here", "why, where different"}, "th");
  for (const RuleText& x : rules_of(d, r)) s << row({x.text, x.reference, number(x.value), x.why});
  s << "</table>\n";
  auto hardware = r.decide.units;
  hardware.insert(hardware.end(), r.lint.hardware.begin(), r.lint.hardware.end());
  s << "<h2>What the records say of the hardware</h2>";
  if (hardware.empty()) s << "<p>Clock, gaps, frozen samples, steps of the converter, clipped tops and units were looked at: nothing was found.</p>\n";
  else {
    s << "<table>" << row({"check", "where", "found"}, "th");
    for (const HardwareCheck& h : hardware) s << row({h.what, h.where, h.found});
    s << "</table>\n";
  }
  if (!d.notices.empty()) {
    s << "<h2>Notices</h2><ul>";
    for (const std::string& n : d.notices) s << "<li>" << escaped(n) << "</li>";
    s << "</ul>";
  }
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(d.hash));
  s << "<p class='small'>" << escaped(program) << "; data " << hash << "; " << number(r.seconds, 3) << " s. Trials marked hold_out were used for the held-out gap only. A name means: the measurements behave as this law says, under these protocols.</p>";
}

}  // namespace

std::string report_html(const Dataset& d, const Result& r, const std::string& program) {
  std::ostringstream s;
  s << "<!doctype html><html lang='en'><meta charset='utf-8'><meta name='viewport' content='width=device-width'><title>" << escaped(d.title) << "</title><style>"
    << "body{font:16px/1.5 Georgia,serif;max-width:52rem;margin:2rem auto;padding:0 1rem;color:#222}h1{font-size:1.6rem}h2{font-size:1.15rem;margin-top:2rem}table{border-collapse:collapse;font-size:.9rem;margin:.6rem 0}"
    << "td,th{border-bottom:1px solid #ddd;padding:.2rem .7rem .2rem 0;text-align:left;vertical-align:top}.verdict{border-left:4px solid #c22;padding:.4rem 1rem;background:#faf6f4}.by td{min-width:5.5rem;padding:.2rem .5rem;font-size:.8rem}.small,svg text{font:11px sans-serif}"
    << ".plots{display:flex;flex-wrap:wrap;gap:.5rem}svg{max-width:100%}</style>\n<h1>" << escaped(d.title) << "</h1><p>" << info(d.rig).name << ", " << d.trials.size() << " trials, model " << escaped(d.model)
    << (d.source.empty() ? "" : "; source: " + escaped(d.source)) << "</p>\n<p class='verdict'><b>" << r.decide.verdict << (r.decide.partial ? ", partial" : "") << ".</b> ";
  if (r.decide.verdict == "effect")
    for (const NamedEffect& e : r.decide.effects) s << "<b>" << info(e.effect).name << "</b> (" << escaped(info(e.effect).law) << "; form: " << escaped(e.form) << "). ";
  s << escaped(r.decide.sentence) << "</p>\n";
  curves(d, r, s);
  heat(d, r, s);
  checks(d, r, s);
  tables(d, r, s);
  residual_after(d, r, s);
  closing(d, r, program, s);
  s << "</html>\n";
  return s.str();
}

}  // namespace filum::reconcile
