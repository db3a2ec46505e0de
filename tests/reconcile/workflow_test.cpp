// The whole workflow on small records made here: what is there is named, what is not is not, and a bad folder says so.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/rng.h"
#include "records.h"
#include "reconcile/hereditary.h"
#include "reconcile/report.h"

namespace filum::reconcile {
namespace workflow_test {

const std::string kTrials =
    "  - { file: a.csv, protocol: { mode: compression, rate: \"1 mm/s\" }, repeat: A }\n  - { file: b.csv, protocol: { mode: compression, rate: \"1 mm/s\" }, repeat: A }\n"
    "  - { file: c.csv, protocol: { mode: compression, rate: \"8 mm/s\" }, repeat: B }\n  - { file: d.csv, protocol: { mode: compression, rate: \"8 mm/s\" }, repeat: B }\n";

/// Writes four records of a block of 1 kPa: force [mN] = 5 * displacement [mm], relaxed by one exponential of share g.
void write_block(const Folder& f, double g, std::uint64_t seed, double noise = 0.03, double drift = 0.0) {
  Rng rng(seed);
  f.write("experiment.yaml", block_yaml(kTrials));
  for (const auto& [name, speed] : std::vector<std::pair<std::string, double>>{{"a.csv", 1}, {"b.csv", 1}, {"c.csv", 8}, {"d.csv", 8}}) {
    double q = 0, last_t = 0, last_f = 0;
    f.write(name, block_csv([&](double t, double u, int i) {
              const double force = 5.0 * u, dt = t - last_t;  // Zener's internal variable, trapezoidal rule
              if (i > 0) q = (q * (1 - 0.25 * dt) + 0.25 * dt * (force + last_f)) / (1 + 0.25 * dt);
              last_t = t, last_f = force;
              return force - g * q + drift * t + noise * rng.normal();
            }, speed));
  }
}

Result solve(const Folder& f) {
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  return reconcile(d);
}

TEST(Workflow, NamesRelaxationWithItsParameters) {
  Folder f;
  write_block(f, 0.4, 1);
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  const Result r = reconcile(d);
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  ASSERT_EQ(r.decide.effects.size(), 1u);
  EXPECT_EQ(r.decide.effects[0].effect, Effect::viscoelastic_relaxation);
  EXPECT_NEAR(r.decide.effects[0].parameters[0].value, 0.4, 0.04);
  EXPECT_NEAR(r.decide.effects[0].parameters[1].value, 2.0, 0.3);
  EXPECT_GT(r.decide.gap.before, 2.0);
  EXPECT_NEAR(r.decide.gap.after, 1.0, 0.1);
  EXPECT_NEAR(r.decide.baseline[0].value, 1000.0, 50.0);
  ASSERT_TRUE(r.detect.has_value());
  EXPECT_LT(r.detect->p, 0.006);  // 2/401: no repetition of the baseline reaches it
  EXPECT_EQ(r.fit.noise.output[0].from, "replicates");
  EXPECT_NEAR(r.fit.noise.output[0].sigma, 0.03e-3, 0.003e-3);
}

TEST(Workflow, NamesNothingWhereNothingIsMissing) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Folder f;
    write_block(f, 0.0, seed);
    const Result r = solve(f);
    EXPECT_EQ(r.decide.verdict, "agree") << r.decide.sentence;
    EXPECT_TRUE(r.decide.effects.empty());
    EXPECT_GT(r.detect->p, 0.01);
  }
}

/// Drift so weak that BIC's log n leaves too little of it, while not one null set in 400 would look like it; and the chance told for null sets is
/// spread evenly.
TEST(Workflow, AWeakEffectIsNamedByItsChanceAndNoiseIsNot) {
  int rare = 0;
  for (std::uint64_t seed = 11; seed < 23; ++seed) {
    Folder f;
    write_block(f, 0.0, seed);
    const Result r = solve(f);
    EXPECT_EQ(r.decide.verdict, "agree") << seed;
    rare += r.detect->chance < 0.2 ? 1 : 0;
  }
  EXPECT_LE(rare, 6);  // of 12, 2.4 expected: more than 6 once in 250 times
  Folder f;
  write_block(f, 0.0, 6, 0.2, 0.0065);  // of nine sets tried (three slopes, three seeds) the one whose evidence lies between
  const Result r = solve(f);
  const Rules rules;
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence << " chance " << r.detect->chance;
  EXPECT_EQ(r.decide.effects[0].effect, Effect::sensor_drift);
  EXPECT_LT(r.decide.tried[0].evidence, 0.0);
  EXPECT_GT(r.decide.tried[0].evidence, -rules.compare.accept_evidence);
}

TEST(Workflow, OneTrialWithoutReplicatesIsSolvedAndSaidSo) {
  Folder f;
  write_block(f, 0.4, 1);
  f.write("experiment.yaml", block_yaml("  - { file: a.csv, protocol: { mode: compression, rate: \"1 mm/s\" } }\n"));
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  std::string notices;
  for (const std::string& n : d.notices) notices += n + "\n";
  EXPECT_NE(notices.find("one trial only"), std::string::npos) << notices;
  EXPECT_NE(notices.find("no replicates"), std::string::npos) << notices;
  const Result r = reconcile(d);
  EXPECT_EQ(r.challenge.how, "nothing can be held out");
  EXPECT_TRUE(std::isnan(r.challenge.gap.after)) << r.challenge.gap.after;
  EXPECT_EQ(r.fit.noise.output[0].from, "fast part");
  EXPECT_NE(r.decide.verdict, "agree");
}

/// A block that loses a quarter of its stiffness at once, half way: no law of the catalogue.
TEST(Workflow, AnUnknownEffectIsDescribedAndNotForced) {
  Folder f;
  Rng rng(4);
  f.write("experiment.yaml", block_yaml(kTrials));
  for (const auto& [name, speed] : std::vector<std::pair<std::string, double>>{{"a.csv", 1}, {"b.csv", 1}, {"c.csv", 8}, {"d.csv", 8}})
    f.write(name, block_csv([&, v = speed](double t, double u, int) { return 5.0 * u * (t * v > 9.0 ? 0.75 : 1.0) + 0.03 * rng.normal(); }, speed));
  const Result r = solve(f);
  EXPECT_EQ(r.decide.verdict, "unknown") << r.decide.sentence;
  EXPECT_TRUE(r.decide.effects.empty());
  ASSERT_FALSE(r.describe.shape.empty());
  EXPECT_GT(r.describe.shape[0].stability, 0.6);
  // a step is no term of the list: the load's product with time comes nearest to it (force or displacement, which are alike)
  EXPECT_TRUE(std::any_of(r.describe.shape.begin(), r.describe.shape.end(), [](const Term& t) { return (t.name == "output*time" || t.name == "displacement*time") && t.stability > 0.5; }));
  ASSERT_FALSE(r.localise.cells.empty());
  EXPECT_NE(r.decide.sentence.find("it follows " + r.describe.shape[0].name), std::string::npos) << r.decide.sentence;
  EXPECT_NE(r.decide.sentence.find("would change this"), std::string::npos);
}

TEST(Workflow, WritesTheReportOfTheContract) {
  Folder f;
  write_block(f, 0.4, 2);
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  const Result r = reconcile(d);
  EXPECT_EQ(write_report(d, r, {f.file("out"), "test"}).files, (std::vector<std::string>{"report.html", "model.yaml", "report.json"}));
  const auto j = nlohmann::json::parse(std::ifstream(f.file("out/report.json")));
  for (const char* key : {"format", "dataset", "rig", "verdict", "effects", "baseline", "rivals", "gap", "where", "not_testable", "partial", "next_experiment", "model_written", "seconds"})
    EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_EQ(j["format"], "filum-reconcile/1");
  EXPECT_EQ(j["effects"][0]["name"], "viscoelastic-relaxation");
  EXPECT_TRUE(j["effects"][0]["parameters"]["g1"].contains("low"));
  EXPECT_TRUE(j["gap"]["noise"]["force"].contains("from"));
  EXPECT_GT(j["gap"]["held_out"]["before"].get<double>(), j["gap"]["held_out"]["after"].get<double>());
  std::ifstream html(f.file("out/report.html"));
  const std::string page{std::istreambuf_iterator<char>(html), std::istreambuf_iterator<char>()};
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);  // opens without a network
  EXPECT_TRUE(std::filesystem::exists(f.file("out/model.yaml")));
  // each stage is to be seen: what was screened and came to nothing, where by every axis, all rules
  for (const char* heading : {"Measured, before and after", "Where the baseline misses", "Is anything missing?", "Numbers behind the fit", "Gap", "Parameters", "Everything that was tried", "What is left afterwards",
                              "Not testable with these trials", "Rules", "What the records say of the hardware"})
    EXPECT_NE(page.find(heading), std::string::npos) << heading;
  std::set<std::string> screened, axes;
  for (const auto& s : j["screened"]) screened.insert(s["effect"]);
  for (const char* effect : {"viscoelastic-relaxation", "strain-stiffening", "sensor-lag", "mains-hum", "rig-compliance"}) EXPECT_TRUE(screened.count(effect)) << effect;
  for (const auto& w : j["where_by"]) axes.insert(w["axis"]);
  EXPECT_EQ(axes, (std::set<std::string>{"trial", "phase", "strain", "rate", "frequency"}));  // one output and one cycle: nothing to compare
  EXPECT_EQ(j["rules"].size(), 84u);  // 46 that may be set, the order of stages, 37 that are taken as given
  std::set<std::string> said;
  for (const auto& rule : j["rules"]) {
    EXPECT_TRUE(said.insert(rule["rule"].get<std::string>() + rule["why"].get<std::string>() + rule["value"].dump()).second) << rule["rule"];
    EXPECT_FALSE(rule["reference"].get<std::string>().empty()) << rule["rule"];
    EXPECT_FALSE(rule["reference"] == "-" && rule["why"].get<std::string>().empty()) << rule["rule"];  // what the reference does not say has its own reason
  }
  EXPECT_NE(page.find("discovery.md 4.3"), std::string::npos);
  std::string stages;
  for (const auto& x : j["stages"]) stages += x["stage"].get<std::string>() + ":" + x["summary"].get<std::string>() + "\n";
  for (const char* part : {"lint:", "noise:force 1.1 % of full scale, from replicates", "baseline:3 of 3 starts", "detect:p = 0.001", "localise:most of it, 13 %, in c.csv", "screen:", "fit:", "challenge:2 folds, 2 of them count (the fastest rate, each protocol in turn): gap", "decide:effect\n", "next experiment:none"})
    EXPECT_NE(stages.find(part), std::string::npos) << part << "\n" << stages;
  EXPECT_EQ(j["gap"]["held_out"]["folds"].size(), 2u);
  EXPECT_EQ(j["baseline_starts"]["of"], 3);
  EXPECT_EQ(j["baseline_starts"]["same"], 3);  // a block has one optimum
  EXPECT_NE(page.find("3 of 3 starts ended at the same optimum"), std::string::npos);
}

TEST(Workflow, EveryStageTellsItsOptionsAndWhatItFound) {
  Folder f;
  write_block(f, 0.4, 2);
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  Options options;
  options.rules.screen.share = 0.11;
  options.rules.challenge.folds = 2;
  const auto j = report_json(d, reconcile(d, options));
  std::map<std::string, nlohmann::ordered_json> stages;
  std::string order;
  for (const auto& s : j["stages"]) stages[s["stage"]] = s, order += s["stage"].get<std::string>() + ", ";
  EXPECT_EQ(order, "lint, noise, baseline, screen, fit, detect, challenge, decide, localise, describe, next experiment, write, ");
  for (const auto& [name, s] : stages) EXPECT_TRUE(s["options"].is_object() && s["found"].is_object() && (name == "write" || !s["options"].empty())) << name;
  EXPECT_EQ(stages["screen"]["options"]["share"], 0.11);
  EXPECT_EQ(stages["challenge"]["options"]["folds"], 2);
  EXPECT_EQ(stages["lint"]["found"]["not_testable"], j["not_testable"].size());
  EXPECT_EQ(stages["baseline"]["found"]["starts"], 3);
  EXPECT_EQ(stages["fit"]["found"]["sets"], j["tried"].size());
  EXPECT_GE(stages["fit"]["found"]["fits"], stages["screen"]["found"]["starts"]);
  EXPECT_EQ(stages["detect"]["found"]["p"], j["detection"]["p"]);
  EXPECT_EQ(stages["localise"]["found"]["trial"], j["where"][0]["trial"]);
  EXPECT_EQ(stages["challenge"]["found"]["after"], j["gap"]["held_out"]["after"]);
  EXPECT_EQ(stages["decide"]["found"]["effects"][0], j["effects"][0]["name"]);
  EXPECT_EQ(stages["write"]["found"]["files"].size(), 3u);
}

TEST(Workflow, RecordsThatAreHeldOutChooseAndFitNothing) {
  std::vector<Result> two;
  for (const double times : {1.0, 1.7}) {
    Folder f;
    write_block(f, 0.4, 1);
    std::string trials = kTrials;
    trials.insert(trials.rfind(" }"), ", hold_out: true");
    f.write("experiment.yaml", block_yaml(trials));
    f.write("d.csv", block_csv([&](double, double u, int) { return times * 4.0 * u; }, 8));
    two.push_back(solve(f));
  }
  ASSERT_FALSE(two[0].decide.tried.empty());
  ASSERT_FALSE(two[1].decide.tried.empty());
  EXPECT_EQ(two[0].decide.tried[0].effects, two[1].decide.tried[0].effects);
  EXPECT_EQ(two[0].decide.tried[0].explained, two[1].decide.tried[0].explained);
  EXPECT_EQ(two[0].fit.noise.output[0].full_scale, two[1].fit.noise.output[0].full_scale);
  EXPECT_EQ(two[0].baseline.alone[0].value, two[1].baseline.alone[0].value);
  EXPECT_EQ(two[0].fit.noise.output[0].sigma, two[1].fit.noise.output[0].sigma);
  EXPECT_NE(two[0].challenge.gap.after, two[1].challenge.gap.after);
}

TEST(Workflow, ProgressRisesWithTheFits) {
  Folder f;
  write_block(f, 0.4, 2);
  Options o;
  std::vector<double> shares;
  o.progress = [&](const std::string&, double share) { shares.push_back(share); };
  reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR), o);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_LE(shares.back(), 1.0);
  EXPECT_GT(shares.size(), 10u);
}

TEST(Workflow, WhereNothingIsMissingTheSentenceSaysWhatWouldChangeIt) {
  Folder f;
  write_block(f, 0.0, 2);
  const Result r = reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR));
  EXPECT_EQ(r.decide.verdict, "agree");
  EXPECT_NE(r.decide.sentence.find("An effect that lowers BIC by 10 and changes a record by 0.6 % of full scale would change this"), std::string::npos) << r.decide.sentence;
}

TEST(Workflow, ThreadsDoNotChangeTheResult) {
  Folder f;
  write_block(f, 0.4, 3);
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  Options one, four;
  one.threads = 1;
  four.threads = 4;
  Result a = reconcile(d, one), b = reconcile(d, four);
  a.seconds = b.seconds = 0.0;
  EXPECT_EQ(report_json(d, a).dump(), report_json(d, b).dump());
}

}  // namespace workflow_test
}  // namespace filum::reconcile
