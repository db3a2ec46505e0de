#include "reconcile/dataset.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "records.h"

namespace filum::reconcile {
namespace {

const std::string kOne = "  - { file: a.csv, protocol: { mode: compression, rate: \"0.1 mm/s\" } }\n";

double linear(double, double u, int) { return 10.0 * u; }

Dataset load(const Folder& f) { return load_dataset(f.path(), FILUM_SOURCE_DIR); }

/// The message of the refusal; empty if there was none.
std::string refusal(const Folder& f) {
  try {
    load(f);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Dataset, ReadsInSiUnits) {
  Folder f;
  f.write("experiment.yaml", block_yaml(kOne));
  f.write("a.csv", block_csv(linear));
  const Dataset d = load(f);
  EXPECT_EQ(d.trials.size(), 1u);
  EXPECT_NEAR(d.trials[0].at("displacement").minCoeff(), -0.5e-3, 1e-9);
  EXPECT_NEAR(d.trials[0].at("force").minCoeff(), -5e-3, 1e-9);
  EXPECT_NEAR(d.trials[0].size("height"), 5e-3, 1e-12);
  ASSERT_EQ(d.notices.size(), 2u);
  EXPECT_TRUE(says(d.notices[0], "one trial only"));
  EXPECT_TRUE(says(d.notices[1], "no replicates"));
}

TEST(Dataset, MissingSamplesAreCountedNotFilled) {
  Folder f;
  f.write("experiment.yaml", block_yaml(kOne));
  std::string csv = block_csv(linear);
  csv += "21,0,\n22,0,\n";
  f.write("a.csv", csv);
  const Dataset d = load(f);
  EXPECT_EQ(d.trials[0].missing, 2);
  EXPECT_TRUE(std::isnan(d.trials[0].at("force")[200]));
}

TEST(Dataset, QuotedCellsCarriageReturnsAndAByteOrderMarkAreRead) {
  Folder f;
  f.write("experiment.yaml", block_yaml(kOne));
  f.write("a.csv", "\xEF\xBB\xBFt,\"u\",F,\"a \"\"note\"\"\"\r\n0,0,0,x\r\n1,\"-0.1\",-1,y\r\n2,-0.2,-2,z\r\n3,-0.3,-3,\"1,5\"\r\n");
  const Dataset d = load(f);
  EXPECT_EQ(d.trials[0].samples(), 4);
  EXPECT_NEAR(d.trials[0].at("displacement")[1], -1e-4, 1e-12);
  EXPECT_TRUE(says(d.notices[0], "not a channel"));
}

/// A thread does not hang down by more than it is long, nor stand out by metres.
TEST(Dataset, RefusesACantileverOfTheWrongUnit) {
  for (const auto& [overhang, drop, said] : std::vector<std::tuple<std::string, std::string, std::string>>{{"mm", "mm", ""}, {"m", "mm", "a.csv:2: column L: found \"1\" m, expected an overhang of at most 0.5 m"},
                                                                                                           {"mm", "m", "a.csv:4: column y: found \"0.3\" m, expected a drop of at most three times"}}) {
    Folder f;
    f.write("experiment.yaml", "format: filum-experiment/1\ntitle: thread\nsource: test\nrig: suture-cantilever\nspecimen: { diameter: \"25 um\", density: \"1140 kg/m3\" }\nmodel:\n  file: suture/elastic\n  free: [youngs_modulus]\n"
                               "channels:\n  - { name: overhang, column: L, unit: " + overhang + ", kind: input }\n  - { name: tip_drop, column: y, unit: " + drop + ", kind: output }\ntrials:\n  - { file: a.csv }\n");
    f.write("a.csv", "L,y\n1,0.001\n2,0.005\n3,0.3\n4,0.9\n");
    EXPECT_TRUE(says(refusal(f), said)) << refusal(f);
    EXPECT_EQ(refusal(f).empty(), said.empty()) << refusal(f);
  }
}

struct BadCase {
  const char* name;
  std::string yaml, csv, expected;
};

TEST(Dataset, RefusesWithFileLineColumnAndExpectation) {
  const std::string good = block_csv(linear);
  const auto with = [](std::string text, const std::string& a, const std::string& b) { return text.replace(text.find(a), a.size(), b); };
  const std::string four = "t,u,F\n0,0,0\n1,-0.1,-1\n2,-0.2,-2\n3,-0.3,-3\n";
  const std::vector<BadCase> cases = {
      {"text cell", block_yaml(kOne), with(four, "-0.2", "abc"), "a.csv:4: column u: found \"abc\", expected a finite number"},
      {"nan", block_yaml(kOne), with(four, "-3\n", "nan\n"), "a.csv:5: column F: found \"nan\""},
      {"decimal comma", block_yaml(kOne), with(four, "-0.2", "\"-0,2\""), "a.csv:4: column u"},
      {"time backwards", block_yaml(kOne), with(four, "2,-0.2", "0.5,-0.2"), "a.csv:4: column t: found \"0.5\", expected a time later"},
      {"no time", block_yaml(kOne), with(four, "\n2,", "\n,"), "a.csv:4: column t: found no time"},
      {"short row", block_yaml(kOne), with(four, "1,-0.1,-1", "1,-0.1"), "a.csv:3: row: found 2 cells, expected 3"},
      {"column missing", block_yaml(kOne), with(four, "t,u,F", "t,x,F"), "expected a column named \"u\""},
      {"no samples", block_yaml(kOne), "t,u,F\n", "a.csv:2: rows"},
      {"empty output", block_yaml(kOne), "t,u,F\n0,0,\n1,-0.1,\n2,-0.2,\n3,-0.3,\n", "a.csv:2-5: column F: found no sample at all"},
      {"unit wrong by 1000", with(block_yaml(kOne), "unit: mm", "unit: m"), good, "less than the specimen's height (is the unit wrong by 1000?)"},
      {"wrong dimension", with(block_yaml(kOne), "unit: mm", "unit: kPa"), good, "channels[1].unit: found \"kPa\", expected a unit like m"},
      {"unknown unit", with(block_yaml(kOne), "unit: mm", "unit: furlong"), good, "channels[1].unit: found \"furlong\""},
      {"unknown rig", with(block_yaml(kOne), "tissue-block", "tensile"), good, "rig: found \"tensile\", expected one of tissue-block"},
      {"unknown key", block_yaml(kOne) + "colour: red\n", good, "colour: found \"red\", expected no such field"},
      {"unknown channel", with(block_yaml(kOne), "name: force", "name: torque"), good, "channels[2].name: found \"torque\""},
      {"unknown protocol key", with(block_yaml(kOne), "rate:", "speed:"), good, "speed"},
      {"unknown mode", with(block_yaml(kOne), "mode: compression", "mode: torsion"), good, "mode: found \"torsion\""},
      {"unknown parameter", with(block_yaml(kOne), "[youngs_modulus]", "[stiffness]"), good, "model.free"},
      {"prior without unit", block_yaml(kOne, "  prior: { youngs_modulus: [500, 5000] }\n"), good, "model.prior.youngs_modulus[0]"},
      {"no specimen", with(block_yaml(kOne), ", height: \"5 mm\"", ""), good, "specimen.height"},
      {"video", with(block_yaml(kOne), "a.csv", "a.mp4"), good, "a map with scale (length of a pixel) and points"},
      {"picture", with(block_yaml(kOne), "a.csv", "a.png"), good, "a .csv file or a video"},
      {"path outside", with(block_yaml(kOne), "a.csv", "../a.csv"), good, "inside the dataset's folder"},
      {"model unknown", with(block_yaml(kOne), "brain/linear", "brain/none"), good, "model.file"},
      {"all held out", with(block_yaml(kOne), " } }\n", " }, hold_out: true }\n"), good, "at least one trial that is not held out"}};
  for (const BadCase& c : cases) {
    Folder f;
    f.write("experiment.yaml", c.yaml);
    f.write("a.csv", c.csv);
    EXPECT_TRUE(says(refusal(f), c.expected)) << c.name << ": " << refusal(f);
  }
}

TEST(Dataset, ConstantChannelIsNoticed) {
  Folder f;
  f.write("experiment.yaml", block_yaml(kOne));
  f.write("a.csv", block_csv([](double, double, int) { return 3.0; }));
  EXPECT_TRUE(says(load(f).notices[0], "channel force is constant"));
}

TEST(Dataset, EveryRigAndEffectOfTheContractIsThere) {
  EXPECT_EQ(rigs().size(), static_cast<std::size_t>(kRigs));
  EXPECT_EQ(effects().size(), static_cast<std::size_t>(kEffects));
  for (std::size_t i = 0; i < effects().size(); ++i) EXPECT_EQ(index_of(effects()[i].effect), static_cast<int>(i));
  for (std::size_t i = 0; i < rigs().size(); ++i) EXPECT_EQ(static_cast<std::size_t>(rigs()[i].rig), i);
}

}  // namespace
}  // namespace filum::reconcile
