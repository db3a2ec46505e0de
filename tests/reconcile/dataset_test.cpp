#include "reconcile/dataset.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "base/error.h"
#include "records.h"

namespace filum::reconcile {
namespace dataset_test {

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
      {"beyond all numbers", block_yaml(kOne), with(four, "-3\n", "1e300\n"), "a.csv:5: column F: found \"1e300\", expected a finite number with a dot below 1e30"},
      {"lost dot", block_yaml(kOne), with(good, ",-5\n", ",-50000000\n"), "a sample less than a thousand times beyond all others"},
      {"semicolons", block_yaml(kOne), "t;u;F\n0;0;0\n1;-0.1;-1\n", "a.csv:1: header: found columns t;u;F, expected a column named \"t\" (cells are separated by commas, and numbers have a dot)"},
      {"tabs", block_yaml(kOne), "t\tu\tF\n0\t0\t0\n", "(cells are separated by commas, and numbers have a dot)"},
      {"decimal commas", block_yaml(kOne), "t,u,F\n0,0,0\n1,-0,1,-1,5\n", "a.csv:3: row: found 5 cells, expected 3 as in the header (cells are separated by commas"},
      {"both", block_yaml(kOne), "t;u;F\n0;0,0;0\n", "a.csv:2: row: found 2 cells, expected 1 as in the header (cells are separated by commas"},
      {"broken YAML", with(block_yaml(kOne), "specimen: {", "specimen: {{"), good, "experiment.yaml:5:"},
      {"unknown name", with(block_yaml(kOne), "[youngs_modulus]", "[beauty]"), good, "not \"beauty\": youngs_modulus"},
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
      {"no name of a file", with(block_yaml(kOne), "brain/linear", "brain/" + std::string(300, 'a')), good, "model.file"},
      {"no name of a table", with(block_yaml(kOne), "a.csv", std::string(300, 'a') + ".csv"), good, "trials[0].file"},
      {"all held out", with(block_yaml(kOne), " } }\n", " }, hold_out: true }\n"), good, "at least one trial that is not held out"}};
  for (const BadCase& c : cases) {
    Folder f;
    f.write("experiment.yaml", c.yaml);
    f.write("a.csv", c.csv);
    EXPECT_TRUE(says(refusal(f), c.expected)) << c.name << ": " << refusal(f);
  }
}

TEST(Dataset, ConstantChannelsAreNoticedOrRefused) {
  const std::string two = kOne + "  - { file: b.csv, protocol: { mode: compression, rate: \"0.1 mm/s\" } }\n";
  const auto dead = [](double, double, int) { return 3.0; };
  Folder one, both, still;
  one.write("experiment.yaml", block_yaml(two));
  one.write("a.csv", block_csv(dead));
  one.write("b.csv", block_csv(linear));
  EXPECT_TRUE(says(load(one).notices[0], "a.csv: channel force is constant"));
  both.write("experiment.yaml", block_yaml(two));
  both.write("a.csv", block_csv(dead));
  both.write("b.csv", block_csv(dead));
  EXPECT_TRUE(says(refusal(both), "a.csv: column F: found the same value in every row of every trial, expected an output that answers")) << refusal(both);
  still.write("experiment.yaml", block_yaml(kOne));
  still.write("a.csv", "t,u,F\n0,-0.1,1\n1,-0.1,1.5\n2,-0.1,1.4\n3,-0.1,1.6\n");
  const Dataset d = load(still);
  EXPECT_TRUE(std::any_of(d.notices.begin(), d.notices.end(), [](const std::string& n) { return says(n, "no input changes in any trial"); }));
}

TEST(Dataset, TheHashIsOfEverythingThatWasMeasuredAndSaid) {
  const auto hash = [](const std::string& yaml, const std::string& csv) {
    Folder f;
    f.write("experiment.yaml", yaml);
    f.write("a.csv", csv);
    return load(f).hash;
  };
  const std::string yaml = block_yaml(kOne), csv = "t,u,F\n0,0,0\n1,-0.1,-1\n2,-0.2,-2\n3,-0.3,-3\n";
  const auto with = [](std::string text, const std::string& a, const std::string& b) { return text.replace(text.find(a), a.size(), b); };
  EXPECT_EQ(hash(yaml, csv), hash(yaml, csv));
  for (const std::string& other : {with(csv, "-0.2,", "-0.21,"), with(csv, "-2\n", "-2.1\n"), with(csv, "\n2,", "\n2.1,")}) EXPECT_NE(hash(yaml, csv), hash(yaml, other)) << other;
  EXPECT_NE(hash(yaml, csv), hash(with(yaml, "height: \"5 mm\"", "height: \"6 mm\""), csv));
}

/// A camera above a still hand sees two axes; three samples are no spectrum.
TEST(Dataset, AStillHandNeedsTwoAxesAndEnoughSamples) {
  const auto hand = [](int samples, bool still) {
    std::ostringstream s;
    s << "t,x,y,z\n";
    for (int i = 0; i < samples; ++i) s << 0.01 * i << "," << (still ? 0.0 : std::sin(0.7 * i)) << "," << (still ? 0.0 : std::cos(0.3 * i)) << ",0\n";
    return s.str();
  };
  const std::string yaml = "format: filum-experiment/1\ntitle: hand\nsource: test\nrig: tip-hold\nspecimen: { sensor: camera }\nmodel:\n  file: hand/still\nchannels:\n  - { name: time, column: t, unit: s }\n"
                           "  - { name: x, column: x, unit: um, kind: output }\n  - { name: y, column: y, unit: um, kind: output }\n  - { name: z, column: z, unit: um, kind: output }\ntrials:\n  - { file: a.csv, protocol: { support: free } }\n";
  Folder good, dead, few;
  for (const Folder* f : {&good, &dead, &few}) f->write("experiment.yaml", yaml);
  good.write("a.csv", hand(200, false));
  dead.write("a.csv", hand(200, true));
  few.write("a.csv", hand(5, false));
  EXPECT_EQ(load(good).outputs, (std::vector<std::string>{"x", "y"}));
  EXPECT_TRUE(says(refusal(dead), "the same value in every row of every trial")) << refusal(dead);
  EXPECT_TRUE(says(refusal(few), "a.csv: rows: found 5, expected at least 64 samples")) << refusal(few);
}

/// What cannot be read as a file at all must neither hang nor fill the memory.
TEST(Dataset, RefusesWhatIsNoFile) {
  const auto of = [](const char* name, auto put) {
    Folder f;
    f.write("experiment.yaml", block_yaml(kOne));
    f.write("a.csv", block_csv(linear));
    std::filesystem::remove(f.file(name));
    put(f.file(name));
    return refusal(f);
  };
  const auto folder = [](const std::string& path) { std::filesystem::create_directory(path); };
  const auto pipe = [](const std::string& path) { ASSERT_EQ(mkfifo(path.c_str(), 0600), 0); };
  const auto device = [](const std::string& path) { std::filesystem::create_symlink("/dev/zero", path); };
  const auto huge = [](const std::string& path) { std::ofstream(path) << "t,u,F\n", std::filesystem::resize_file(path, std::uintmax_t{3} << 30); };
  EXPECT_TRUE(says(of("a.csv", folder), "a.csv: file: found a folder")) << of("a.csv", folder);
  EXPECT_TRUE(says(of("a.csv", pipe), "a.csv: file: found a pipe")) << of("a.csv", pipe);
  EXPECT_TRUE(says(of("a.csv", device), "a.csv: file: found a pipe or a device")) << of("a.csv", device);
  EXPECT_TRUE(says(of("a.csv", huge), "a.csv: file: found more than 256 MiB")) << of("a.csv", huge);
  EXPECT_TRUE(says(of("a.csv", [](const std::string&) {}), "trials[0].file: found \"a.csv\", expected a file in the dataset's folder (no such file: "));
  EXPECT_TRUE(says(of("experiment.yaml", folder), "experiment.yaml: file: found a folder"));
  EXPECT_TRUE(says(of("experiment.yaml", pipe), "experiment.yaml: file: found a pipe"));
}

TEST(Dataset, EveryRigAndEffectOfTheContractIsThere) {
  EXPECT_EQ(rigs().size(), static_cast<std::size_t>(kRigs));
  EXPECT_EQ(effects().size(), static_cast<std::size_t>(kEffects));
  for (std::size_t i = 0; i < effects().size(); ++i) EXPECT_EQ(index_of(effects()[i].effect), static_cast<int>(i));
  for (std::size_t i = 0; i < rigs().size(); ++i) EXPECT_EQ(static_cast<std::size_t>(rigs()[i].rig), i);
}

}  // namespace dataset_test
}  // namespace filum::reconcile
