#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <sstream>

#include "base/markup.h"
#include "base/units.h"
#include "reconcile/hardware.h"
#include "reconcile/plot.h"
#include "reconcile/report.h"

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
  if (t.repeat.empty()) return band;
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
  const Channel& out = d.channel(d.outputs[c]);
  const Eigen::VectorXd x = input == nullptr ? t.time : written(*input, t.at(input->name));
  std::vector<Curve> lines;
  if (Curve band = replicate_band(d, i, d.outputs[c]); input == nullptr && band.low.size() > 0) {
    band.y = written(out, band.y), band.low = written(out, band.low);
    lines.push_back(std::move(band));
  }
  lines.push_back({x, written(out, t.at(d.outputs[c])), "#999", true, {}});
  lines.push_back({x, written(out, r.before.predicted[i][c]), "#26c", false, {}});
  const bool named = r.verdict == "effect" || r.verdict == "ambiguous";
  if (named && i < r.after.predicted.size() && !r.after.predicted[i].empty()) lines.push_back({x, written(out, r.after.predicted[i][c]), "#c22", false, {}});
  return plot({input == nullptr ? t.file + ": " + protocol_of(t) : protocol_of(t), input != nullptr ? axis(*input) : t.clocked ? "time [s]" : "sample", axis(out)}, lines);
}

void curves(const Dataset& d, const Result& r, std::ostringstream& s) {
  s << "<h2>Measured, before and after</h2><p>Grey: measured; pale: from the least to the most of its replicates; blue: the baseline, refitted" << (r.verdict == "effect" ? "; red: with what the verdict names" : r.verdict == "ambiguous" ? "; red: with the first rival" : "")
    << ". Each record keeps its own stiffness.</p><div class='plots'>";
  const Channel* input = nullptr;
  for (const Channel& c : d.channels)
    if (c.input && c.name != "time" && input == nullptr) input = &c;
  std::set<std::string> seen;
  std::string over;
  int drawn = 0;
  for (std::size_t i = 0; i < d.trials.size(); ++i) {
    if (i >= r.before.predicted.size() || r.before.predicted[i].empty()) continue;
    for (std::size_t c = 0; c < d.outputs.size() && drawn < 12; ++c, ++drawn) s << record_plot(d, r, i, c, nullptr);
    const bool first = seen.insert(d.protocol_text(d.trials[i])).second;
    if (first && input != nullptr && d.trials[i].has(input->name) && seen.size() <= 6) over += record_plot(d, r, i, 0, input);
  }
  s << "</div>\n";
  if (!over.empty()) s << "<p>The same over " << escaped(input->name) << ", one record of each protocol.</p><div class='plots'>" << over << "</div>\n";
}

/// Mean residual of a stretch of a record over its standard error, before.
void heat(const Dataset& d, const Result& r, std::ostringstream& s) {
  std::vector<std::string> rows;
  std::vector<std::vector<double>> cells;
  for (std::size_t i = 0; i < r.before.residual.size(); ++i)
    for (std::size_t c = 0; c < r.before.residual[i].size(); ++c) {
      const Eigen::VectorXd& v = r.before.residual[i][c];
      const Eigen::Index n = 40, w = std::max<Eigen::Index>(1, v.size() / n);
      rows.push_back(d.trials[i].file + " " + d.outputs[c]);
      cells.emplace_back();
      for (Eigen::Index k = 0; k + w <= v.size(); k += w) {
        double sum = 0;
        int m = 0;
        for (Eigen::Index j = k; j < k + w; ++j)
          if (std::isfinite(v[j])) sum += v[j], ++m;
        cells.back().push_back(m > 0 ? std::abs(sum / m) / r.noise.output[c].sigma * std::sqrt(static_cast<double>(m)) : 0.0);
      }
    }
  if (rows.empty()) return;
  s << "<h2>Where the baseline misses</h2><p>Mean residual of each fortieth of a record in standard errors; dark is 8 or more. Time runs to the right.</p>" << heat_map(rows, cells, 8.0);
  if (r.where.empty()) return;
  s << "<table>" << row({"record", "phase", "range", "share of the excess"}, "th");
  for (std::size_t i = 0; i < r.where.size() && i < 8; ++i) s << row({r.where[i].trial, r.where[i].phase, r.where[i].range, number(100 * r.where[i].share, 3) + " %"});
  s << "</table>\n";
}

void checks(const Result& r, std::ostringstream& s) {
  if (r.detection) {
    const Detection& x = *r.detection;
    s << "<h2>Is anything missing?</h2><p>The largest sum of the baseline's residual over any window is " << number(x.statistic, 3) << " standard deviations (" << escaped(x.trial) << ", " << number(x.from) << " s to " << number(x.to)
      << " s), the best score test of the catalogue " << number(x.score, 4) << ". The rarer of the two among " << x.repetitions << " simulated repetitions in which the baseline is true: p = " << number(x.p, 2)
      << "; some effect or line does as well as the best single one here in " << number(100 * x.chance, 2) << " % of them. "
      << (r.dispersion > 1.5 ? "In these figures what no candidate takes away counts as noise (overdispersion " + number(r.dispersion, 3) + "), so that no name rests on it; against the noise as measured, sums over blocks of the residual stand " +
                                   number(r.structure_before, 3) + " standard deviations out. "
                             : std::string())
      << "What lies beyond the noise amounts to " << number(100 * x.excess, 2) << " % of full scale; " << number(100 * r.rules.materiality, 2) << " % is material.</p>\n";
  }
  if (!r.numerics.sensitivities.empty()) {
    s << "<h2>Numbers behind the fit</h2><p>Halving the time step changes a record's prediction by " << at_most(r.numerics.time) << " of full scale, halving the cells by " << at_most(r.numerics.mesh)
      << (r.numerics.solver() > r.rules.materiality ? "; that takes the place of what the rules call material" : "") << ". ";
    std::string doubtful;
    for (const Sensitivity& v : r.numerics.sensitivities)
      if (v.disagreement > kDoubtful) doubtful += (doubtful.empty() ? "" : ", ") + v.parameter + " (" + number(100 * v.disagreement, 2) + " %)";
    s << (doubtful.empty() ? "Every derivative is the same, within " + number(100 * kDoubtful, 2) + " %, by differences at one and at two steps."
                           : "Derivatives by differences at one and at two steps disagree for " + escaped(doubtful) + ": intervals of these rest on a kink of the model and are to be doubted.")
      << "</p>\n";
  }
  if (!r.confirmation) return;
  const Confirmation& c = *r.confirmation;
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
    << row({"fitted trials", number(r.fit.before, 3), number(r.fit.after, 3)}) << row({"held out (" + r.held_out_how + ")", number(r.held_out.before, 3), number(r.held_out.after, 3)}) << "</table><table>"
    << row({"output", "noise, 1 sd", "from", "correlation of neighbours", "full scale"}, "th");
  for (std::size_t c = 0; c < r.noise.output.size(); ++c) {
    const OutputNoise& o = r.noise.output[c];
    s << row({d.outputs[c], quantity(o.sigma, unit_of(d, d.outputs[c])), o.from, number(o.rho, 2), quantity(o.full_scale, unit_of(d, d.outputs[c]))});
  }
  s << "</table><p>Records of one batch differ in stiffness by " << number(100 * r.noise.scatter, 2) << " % (1 sd). Structure left in the residual: " << number(r.structure_before, 3) << " standard deviations before, "
    << number(r.structure_after, 3) << " after. Overdispersion used for all comparisons: " << number(r.dispersion, 3) << ".</p>\n<h2>Parameters</h2><table>" << (r.verdict == "effect" ? row({"parameter", "baseline alone", "with the effect"}, "th") : row({"parameter", "baseline"}, "th"));
  for (const Estimate& e : r.baseline_alone) {
    if (r.verdict != "effect") {
      s << row({e.name, interval(e)});
      continue;
    }
    std::string after = "-";
    for (const Estimate& a : r.baseline)
      if (a.name == e.name) after = interval(a);
    s << row({e.name, interval(e), after});
  }
  if (r.verdict == "effect")
    for (const NamedEffect& e : r.effects)
      for (const Estimate& p : e.parameters) s << row({info(e.effect).name + ": " + p.name, "-", interval(p)});
  s << "</table><p>Intervals are 95 %.</p>\n<h2>Everything that was tried</h2><table>" << row({"effects", "form", "evidence", "explains", "why not"}, "th");
  for (const Tried& t : r.tried) s << row({names(t.effects), t.form, number(-t.evidence, 4), number(100 * t.explained, 3) + " %", t.why});
  s << "</table><p>Evidence: fall of the Bayesian information criterion against the baseline; a difference below " << number(r.rules.tie) << " is a tie.</p>\n";
}

void residual_after(const Dataset& d, const Result& r, std::ostringstream& s) {
  for (std::size_t i = 0; i < r.after.residual.size(); ++i) {
    if (r.after.residual[i].empty()) continue;
    const Eigen::VectorXd& v = r.after.residual[i][0];
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
    const Eigen::Index bins = std::min<Eigen::Index>(200, v.size() / 2 - 1);
    Eigen::VectorXd f(bins), p(bins);
    const double span = d.trials[i].time[v.size() - 1] - d.trials[i].time[0];
    for (Eigen::Index k = 0; k < bins; ++k) {
      double re = 0, im = 0;
      for (Eigen::Index n = 0; n < v.size(); ++n) {
        if (!std::isfinite(v[n])) continue;
        const double phase = 2 * std::numbers::pi * static_cast<double>((k + 1) * n) / static_cast<double>(v.size());
        re += v[n] * std::cos(phase);
        im += v[n] * std::sin(phase);
      }
      f[k] = static_cast<double>(k + 1) / span;
      p[k] = std::log10(std::max((re * re + im * im) / static_cast<double>(v.size()), 1e-300));
    }
    s << "<h2>What is left afterwards</h2><div class='plots'>" << plot({"autocorrelation, " + d.trials[i].file, "lag [samples]", "correlation"}, {{x, a, "#444", false, {}}})
      << plot({"spectrum, " + d.trials[i].file, "frequency [Hz]", "log10 power"}, {{f, p, "#444", false, {}}}) << "</div>\n";
    return;
  }
}

void closing(const Dataset& d, const Result& r, const std::string& program, std::ostringstream& s) {
  if (!r.shape.empty()) {
    s << "<h2>Shape of what is not explained</h2><p>Sparse regression of the residual, in parts of full scale, on terms scaled to 1; stability is the share of 30 resamplings that chose the term.</p><table>" << row({"term", "coefficient", "stability"}, "th");
    for (const Term& t : r.shape) s << row({t.name, number(t.coefficient, 3), number(t.stability, 2)});
    s << "</table>\n";
  }
  if (r.verdict == "ambiguous") {
    s << "<h2>Rivals</h2><table>" << row({"effects", "form", "behind the best, BIC", "explains"}, "th");
    for (const Tried& t : r.rivals) s << row({names(t.effects), t.form, number(t.evidence - r.rivals[0].evidence, 3), number(100 * t.explained, 3) + " %"});
    s << "</table><p>The signatures of the first two correlate by " << number(r.correlation, 3) << "; a refit of the baseline hides " << number(100 * r.masked, 3) << " % of the first one's.</p>\n";
  }
  if (r.next) s << "<h2>Next experiment</h2><p>" << escaped(r.next->protocol) << ": " << escaped(r.next->why) << ". It would decide in " << number(100 * r.next->chance, 3) << " % of 50 simulated repetitions.</p>\n";
  s << "<h2>Not testable with these trials</h2>";
  if (r.not_testable.empty()) {
    s << "<p>Every effect that the catalogue has for this rig would show in these trials.</p>\n";
  } else {
    s << "<table>" << row({"effect", "why", "what would show it"}, "th");
    for (const NotTestable& n : r.not_testable) s << row({info(n.effect).name, n.why, n.needs});
    s << "</table>\n";
  }
  s << "<h2>Rules</h2><table>" << row({"rule", "value"}, "th");
  const Rules& k = r.rules;
  for (const auto& [name, value] : std::vector<std::pair<std::string, double>>{{"material change, share of full scale", k.materiality}, {"the same in an eighth of a record", k.window_materiality},
       {"chance of noise alone to detect", k.detect_p}, {"fall of chi-squared to detect", k.detect}, {"residual structure that proves a gap, sd", k.structure}, {"fall of BIC to accept", k.accept_evidence}, {"share of the gap to be explained", k.explained},
       {"the same on held-out protocols", k.held_out}, {"tie, BIC", k.tie}, {"tie of a rival that these trials could not show", k.aside_tie}, {"tie of a name whose deciding protocol was not run", k.untestable_tie},
       {"by which another form must beat the catalogue's, BIC", k.form_preference}, {"effects at most", k.most_effects}, {"a further effect: BIC", k.pair_evidence}, {"a further effect: share of the gap, or", k.pair_share},
       {"this share", k.pair_least}, {"with a change of the prediction, times what is material, of", k.pair_material}, {"or this share (change twice that)", k.pair_clean}, {"if it takes of what is left", k.pair_rest},
       {"or of its gain from samples where the others are silent", k.silent_share}, {"which are at least this part", k.silent_least}, {"partial: sd left", k.partial_structure}, {"partial: share left", k.partial_share},
       {"partial: gain error asked for", k.gain_most}, {"masked share that hides an effect", k.masked}, {"squared signal to noise that shows one", k.testable}, {"effects screened at most", k.screen_most},
       {"with a share of the best score of", k.screen_share}})
    s << row({name, number(value)});
  s << "</table>\n";
  auto hardware = check_units(d, r.baseline);
  for (const HardwareCheck& h : check_hardware(d)) hardware.push_back(h);
  if (!hardware.empty()) {
    s << "<h2>What the records say of the hardware</h2><table>" << row({"check", "where", "found"}, "th");
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
    << "td,th{border-bottom:1px solid #ddd;padding:.2rem .7rem .2rem 0;text-align:left;vertical-align:top}.verdict{border-left:4px solid #c22;padding:.4rem 1rem;background:#faf6f4}.small,svg text{font:11px sans-serif}"
    << ".plots{display:flex;flex-wrap:wrap;gap:.5rem}svg{max-width:100%}</style>\n<h1>" << escaped(d.title) << "</h1><p>" << info(d.rig).name << ", " << d.trials.size() << " trials, model " << escaped(d.model)
    << (d.source.empty() ? "" : "; source: " + escaped(d.source)) << "</p>\n<p class='verdict'><b>" << r.verdict << (r.partial ? ", partial" : "") << ".</b> ";
  if (r.verdict == "effect")
    for (const NamedEffect& e : r.effects) s << "<b>" << info(e.effect).name << "</b> (" << escaped(info(e.effect).law) << "; form: " << escaped(e.form) << "). ";
  s << escaped(r.sentence) << "</p>\n";
  curves(d, r, s);
  heat(d, r, s);
  checks(r, s);
  tables(d, r, s);
  residual_after(d, r, s);
  closing(d, r, program, s);
  s << "</html>\n";
  return s.str();
}

}  // namespace filum::reconcile
