#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "reconcile/hardware.h"
#include "reconcile/report.h"
#include "reconcile/whole_file.h"

namespace filum::reconcile {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json json_of(const Estimate& e) { return {{"value", finite(e.value)}, {"unit", e.unit}, {"low", finite(e.low)}, {"high", finite(e.high)}}; }

Json json_of(const std::vector<Estimate>& all) {
  Json out = Json::object();
  for (const Estimate& e : all) out[e.name] = json_of(e);
  return out;
}

Json json_of(const std::vector<Term>& terms) {
  Json out = Json::array();
  for (const Term& t : terms) out.push_back({{"term", t.name}, {"coefficient", finite(t.coefficient)}, {"stability", t.stability}, {"output", t.output}});
  return out;
}

Json named(const std::vector<Effect>& effects) {
  Json out = Json::array();
  for (const Effect e : effects) out.push_back(info(e).name);
  return out;
}

/// Evidence against the best set: 0 for the best, the more negative the worse.
Json rivals_json(const Result& r) {
  double best = 0.0;
  for (const Tried& t : r.tried) best = std::min(best, t.evidence);
  if (r.verdict == "ambiguous" && !r.rivals.empty()) best = r.rivals[0].evidence;
  Json out = Json::array();
  for (const Tried& t : r.rivals)
    out.push_back({{"effects", named(t.effects)}, {"evidence", finite(best - t.evidence)}, {"form", t.form}, {"explained", finite(t.explained)}});
  return out;
}

Json noise_json(const Dataset& d, const Result& r) {
  Json out = Json::object();
  for (std::size_t c = 0; c < d.outputs.size() && c < r.noise.output.size(); ++c) {
    std::string unit = "-";
    for (const ChannelInfo& k : info(d.rig).channels)
      if (k.name == d.outputs[c]) unit = k.unit;
    if (d.rig == Rig::spatula_press && d.outputs[c][0] == 'u') unit = "m";
    const OutputNoise& o = r.noise.output[c];
    out[d.outputs[c]] = {{"value", o.sigma}, {"unit", unit}, {"from", o.from}, {"autocorrelation", (1.0 - o.white) * o.rho}, {"white", o.white}};
  }
  return out;
}

Json where_json(const std::vector<Cell>& cells) {
  Json out = Json::array();
  for (std::size_t i = 0; i < cells.size() && i < 12; ++i) out.push_back({{"trial", cells[i].trial}, {"phase", cells[i].phase}, {"range", cells[i].range}, {"share", finite(cells[i].share)}});
  return out;
}

Json where_by_json(const std::vector<Share>& shares) {
  Json out = Json::array();
  for (const Share& w : shares) out.push_back({{"axis", w.axis}, {"bin", w.bin}, {"share", finite(w.share)}, {"deviations", finite(w.deviations)}});
  return out;
}

Json not_testable_json(const std::vector<NotTestable>& all) {
  Json out = Json::array();
  for (const NotTestable& n : all) out.push_back({{"effect", info(n.effect).name}, {"why", n.why}, {"needs", n.needs}});
  return out;
}

Json tried_json(const std::vector<Tried>& all) {
  Json out = Json::array();
  for (const Tried& t : all) out.push_back({{"effects", named(t.effects)}, {"form", t.form}, {"evidence", finite(-t.evidence)}, {"explained", finite(t.explained)}, {"why", t.why}});
  return out;
}

Json screened_json(const std::vector<Screened>& all) {
  Json out = Json::array();
  for (const Screened& x : all) out.push_back({{"effect", info(x.effect).name}, {"form", x.form}, {"promised", finite(x.gain)}, {"masked", finite(x.masked)}, {"what", x.what}});
  return out;
}

Json rules_json(const std::vector<RuleText>& rules) {
  Json out = Json::array();
  for (const RuleText& x : rules) out.push_back({{"rule", x.text}, {"value", x.value}, {"reference", x.reference}, {"why", x.why}});
  return out;
}

Json detection_json(const Detection& d) {
  return {{"statistic", finite(d.statistic)}, {"score", finite(d.score)}, {"score_is", d.score_is}, {"p", d.p}, {"chance", d.chance}, {"repetitions", d.repetitions}, {"excess", finite(d.excess)},
          {"trial", d.trial}, {"from", finite(d.from)}, {"to", finite(d.to)}};
}

Json confirmation_json(const Confirmation& c) {
  Json values = Json::object();
  for (const NamedEffect& e : c.values) values[info(e.effect).name] = json_of(e.parameters);
  return {{"solver", c.solver}, {"ran", c.ran}, {"holds", c.holds}, {"difference", finite(c.difference)}, {"mesh", finite(c.mesh)}, {"evidence", finite(-c.evidence)},
          {"share", finite(c.share)}, {"parameters", values}};
}

/// Of all sets that are not told apart; `correlation` and `masked` are those of the first two and of the first.
Json ambiguity_json(const Result& r) {
  Json sets = Json::array(), rows = Json::array(), masked = Json::array();
  const auto n = r.alike.correlation.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    Json one = Json::array();
    for (Eigen::Index j = 0; j < n; ++j) one.push_back(finite(r.alike.correlation(i, j)));
    rows.push_back(std::move(one));
    sets.push_back(named(r.alike_sets[k]));
    masked.push_back(finite(r.alike.masked[k]));
  }
  return {{"correlation", finite(r.alike.correlation(0, 1))}, {"masked", finite(r.alike.masked[0])}, {"sets", sets}, {"correlations", rows}, {"masked_each", masked}};
}

Json folds_json(const std::vector<Fold>& folds) {
  Json out = Json::array();
  for (const Fold& f : folds) {
    Json one = {{"held_out", f.held}, {"trials", f.trials}, {"before", finite(f.gap.before)}, {"after", finite(f.gap.after)}, {"counts", f.counts}};
    if (!f.counts) one["why"] = f.why;
    out.push_back(std::move(one));
  }
  return out;
}

Json starts_json(const Dataset& d, const BaselineSummary& b) {
  const auto values = [&](const std::vector<double>& x) {
    Json out = Json::object();
    for (std::size_t i = 0; i < x.size(); ++i) out[info(d.rig).baseline[i].name] = finite(x[i]);
    return out;
  };
  Json starts = Json::array();
  for (const BaselineStart& s : b.starts) starts.push_back({{"from", values(s.from)}, {"to", values(s.to)}, {"chi2", finite(s.chi2)}, {"same", s.same}});
  return {{"same", b.same()}, {"of", b.starts.size()}, {"starts", starts}};
}

Json numerics_json(const Numerics& n) {
  Json steps = Json::object();
  for (const Sensitivity& v : n.sensitivities) steps[v.parameter] = {{"disagreement", finite(v.disagreement)}, {"step", v.step}};
  return {{"time_halved", finite(n.time)}, {"mesh_halved", finite(n.mesh)}, {"sensitivities", steps}};
}

Json hardware_json(const Dataset& d, const Result& r) {
  Json out = Json::array();
  for (const auto& checks : {check_hardware(d), check_units(d, r.baseline)})
    for (const HardwareCheck& h : checks) out.push_back({{"check", h.what}, {"where", h.where}, {"found", h.found}});
  return out;
}

std::string hash_text(const Dataset& d) {
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(d.hash));
  return hash;
}

/// What the verdict rests on, after what it says.
void add_grounds(const Dataset& d, const Result& r, Json& j) {
  if (!r.shape.empty()) j["shape"] = json_of(r.shape);
  if (!r.residual_terms.empty()) j["residual_terms"] = json_of(r.residual_terms);
  j["tried"] = tried_json(r.tried);
  j["screened"] = screened_json(r.screened);
  Json stages = Json::array();
  for (const StageText& x : stages_of(d, r)) stages.push_back({{"stage", x.stage}, {"summary", x.summary}});
  j["stages"] = stages;
  j["rules"] = rules_json(rules_of(d, r));
  if (r.alike_sets.size() > 1) j["ambiguity"] = ambiguity_json(r);
  if (r.detection) j["detection"] = detection_json(*r.detection);
  if (r.confirmation) j["confirmation"] = confirmation_json(*r.confirmation);
  j["baseline_starts"] = starts_json(d, r.starts);
  j["numerics"] = numerics_json(r.numerics);
  j["hardware"] = hardware_json(d, r);
  j["notices"] = d.notices;
  j["dataset_hash"] = hash_text(d);
}

}  // namespace

std::vector<RuleText> rules_of(const Dataset& d, const Result& r) { return d.rig == Rig::tip_hold ? listed(HoldRules{}, r.rules) : listed(r.rules); }

Json report_json(const Dataset& d, const Result& r) {
  const bool effect = r.verdict == "effect";
  Json j = {{"format", "filum-reconcile/1"}, {"dataset", d.name}, {"rig", info(d.rig).name}, {"verdict", r.verdict}};
  Json effects = Json::array();
  if (effect)
    for (const NamedEffect& e : r.effects) effects.push_back({{"name", info(e.effect).name}, {"form", e.form}, {"parameters", json_of(e.parameters)}});
  j["effects"] = effects;
  j["baseline"] = json_of(r.baseline.empty() ? r.baseline_alone : r.baseline);
  j["rivals"] = rivals_json(r);
  j["gap"] = {{"noise", noise_json(d, r)},
              {"fit", {{"before", finite(r.fit.before)}, {"after", finite(r.fit.after)}}},
              {"held_out", {{"before", finite(r.held_out.before)}, {"after", finite(r.held_out.after)}, {"how", r.held_out_how}, {"folds", folds_json(r.folds)}}}};
  j["where"] = where_json(r.where);
  j["where_by"] = where_by_json(r.where_by);
  j["not_testable"] = not_testable_json(r.not_testable);
  j["partial"] = r.partial;
  j["next_experiment"] = r.next ? Json{{"protocol", r.next->protocol}, {"why", r.next->why}, {"chance", r.next->chance}} : Json(nullptr);
  j["model_written"] = effect ? Json("model.yaml") : Json(nullptr);
  j["seconds"] = r.seconds;
  j["sentence"] = r.sentence;
  add_grounds(d, r, j);
  return j;
}

namespace {

}  // namespace

void write_report(const Dataset& d, const Result& r, const std::string& folder, const std::string& program) {
  std::filesystem::create_directories(folder);
  write_whole(folder + "/report.html", report_html(d, r, program));
  if (r.verdict == "effect") write_whole(folder + "/model.yaml", model_yaml(d, r, program));
  else std::filesystem::remove(folder + "/model.yaml");
  // last, since its presence says that the report is whole
  write_whole(folder + "/report.json", report_json(d, r).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace filum::reconcile
