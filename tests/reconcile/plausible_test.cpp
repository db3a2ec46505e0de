// What can be read but cannot be. The last test throws rubbish at the reader: whatever is wrong, the answer is a dataset or an InputError that names its file.

#include "reconcile/plausible.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "base/units.h"
#include "records.h"

namespace filum::reconcile {
namespace plausible_test {

std::string with(std::string text, const std::string& a, const std::string& b) { return text.replace(text.find(a), a.size(), b); }
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string size_refusal(const KeyInfo& key, const std::string& text) {
  const YamlNode node = YamlNode::parse(key.name + ": \"" + text + "\"\n", "experiment.yaml");
  return refusal([&] { plausible_size(node, key); });
}

/// Every length (density, voltage) of every rig, from the least to the largest that is possible: right, and a thousand times off either way.
TEST(Plausible, EverySizeOfEveryRigThatIsAThousandTimesOffIsRefused) {
  int sizes = 0;
  for (const RigInfo& rig : rigs())
    for (const auto* keys : {&rig.specimen, &rig.protocol})
      for (const KeyInfo& key : *keys) {
        if (key.unit != "m" && key.unit != "V" && key.unit != "kg/m3") continue;
        ++sizes;
        ASSERT_GT(key.low, 0.0) << rig.name << " " << key.name;
        for (double share = 0.01; share < 1.0; share += 0.07) {
          const double v = key.low * std::pow(key.high / key.low, share);
          EXPECT_EQ(size_refusal(key, std::to_string(v * 1e6) + (key.unit == "m" ? " um" : key.unit == "V" ? " uV" : " mg/m3")), "");
          for (const double times : {1e-3, 1e3}) EXPECT_NE(size_refusal(key, format_quantity(times * v, key.unit, 9)), "") << rig.name << " " << key.name << " " << times * v;
        }
      }
  EXPECT_EQ(sizes, 21);
}

TEST(Plausible, TheRefusalNamesTheUnitThatWasMeant) {
  const KeyInfo blade{"blade_width", "m", {}, true, 2e-4, 0.2};
  EXPECT_EQ(size_refusal(blade, "7 m"), "experiment.yaml:1: blade_width: found \"7 m\", expected 200 um to 200 mm (did you mean mm?)");
  EXPECT_EQ(size_refusal(blade, "7 um"), "experiment.yaml:1: blade_width: found \"7 um\", expected 200 um to 200 mm (did you mean mm?)");
  EXPECT_TRUE(says(size_refusal(blade, "5000 m"), "(is the unit right?)")) << size_refusal(blade, "5000 m");
  EXPECT_EQ(size_refusal({"density", "kg/m3", {}, true, 100.0, 3e4}, "1.14 kg/m3"), "experiment.yaml:1: density: found \"1.14 kg/m3\", expected 100 kg/m3 to 3e+04 kg/m3 (did you mean Mg/m3?)");
}

const std::string kBlock = "  - { file: a.csv, protocol: { mode: compression, rate: \"0.1 mm/s\" } }\n";
double linear(double, double u, int) { return 10.0 * u; }

std::string dataset_refusal(const std::string& yaml, const std::string& csv) {
  Folder f;
  f.write("experiment.yaml", yaml);
  if (!csv.empty()) f.write("a.csv", csv);
  const std::string said = refusal([&] { load_dataset(f.path(), FILUM_SOURCE_DIR); });
  return said.rfind(f.path(), 0) == 0 ? said.substr(f.path().size() + 1) : said;
}

std::string rig_yaml(const std::string& rig, const std::string& specimen, const std::string& channels, const std::string& protocol, const std::string& own = "") {
  return "format: filum-experiment/1\ntitle: t\nsource: test\nrig: " + rig + "\nspecimen: { " + specimen + " }\nchannels:\n" + channels + "trials:\n  - { file: a.csv, protocol: { " + protocol + " }" + own + " }\n";
}

TEST(Plausible, RefusalsNameFileLineAndField) {
  const std::string good = block_csv(linear), four = "t,u,F\n0,0,0\n1,-0.1,-1\n2,-0.2,-2\n3,-0.3,-3\n";
  const std::string tube = "  - { name: pressure, column: p, unit: kPa, kind: input }\n  - { name: outer_diameter, column: d, unit: um, kind: output }\n", tube_csv = "p,d\n0,1000\n1,1010\n2,1020\n3,1030\n";
  const std::string needle = "  - { name: depth, column: x, unit: mm, kind: input }\n  - { name: force, column: F, unit: mN, kind: output }\n", needle_csv = "x,F\n0,0\n1,1\n2,2\n3,3\n";
  const std::string needle_sizes = "needle_diameter: \"0.5 mm\", wall_thickness: \"0.1 mm\"";
  struct Case {
    std::string yaml, csv, expected;
  };
  for (const Case& c : std::vector<Case>{
           {block_yaml(kBlock), "", "experiment.yaml:14: trials[0].file: found \"a.csv\", expected a file in the dataset's folder (no such file: "},
           {with(block_yaml(kBlock), "height: \"5 mm\"", "height: \"5 m\""), good, "experiment.yaml:5: specimen.height: found \"5 m\", expected 100 um to 100 mm (did you mean mm?)"},
           {with(block_yaml(kBlock), " } }\n", " }, specimen: { height: \"5 um\" } }\n"), good, "experiment.yaml:14: trials[0].specimen.height: found \"5 um\", expected 100 um to 100 mm (did you mean mm?)"},
           {with(block_yaml(kBlock), "0.1 mm/s", "7 kg"), good, "experiment.yaml:14: trials[0].protocol.rate: found \"7 kg\", expected a rate with its unit, e.g. \"0.1 mm/s\""},
           {with(block_yaml(kBlock), "\"0.1 mm/s\"", "0.1"), good, "experiment.yaml:14: trials[0].protocol.rate: found \"0.1\", expected a rate with its unit"},
           {with(block_yaml(kBlock), "rate: \"0.1 mm/s\"", "cycle: -1"), good, "experiment.yaml:14: trials[0].protocol.cycle: found \"-1\", expected a number of cycles"},
           {with(block_yaml(kBlock), "title:", "titel:"), good, "experiment.yaml:2: titel: found \"block\", expected no such field here, only: format, title, source, rig, model"},
           {with(block_yaml(kBlock), "file: brain/linear", "file: brain/linear\n  fre: [x]"), good, "experiment.yaml:8: model.fre: found [\"x\"], expected no such field here, only: file, free, prior"},
           {with(block_yaml(kBlock), "kind: output", "kind: output, sd: 3"), good, "channels[2].sd: found \"3\", expected no such field here, only: name, column, unit, kind, noise"},
           {with(block_yaml(kBlock), " } }\n", " }, held: true }\n"), good, "trials[0].held: found \"true\", expected no such field here, only: file, video, repeat, hold_out, specimen, protocol"},
           {with(block_yaml(kBlock), "kind: output", "kind: output, noise: \"1e300 N\""), good, "experiment.yaml: noise of channel force: found \"1e+303\" mN, expected at most ten times the range of its samples, \"5\" mN (is the unit right?)"},
           {with(block_yaml(kBlock), "kind: output", "kind: output, noise: \"20 mN\""), good, ""},
           {with(block_yaml(kBlock), "column: F", "column: u"), good, "channels[2].column: found \"u\", expected a column of its own, not that of displacement"},
           {with(with(block_yaml(kBlock), "column: t, ", ""), "column: u", "column: time"), with(good, "t,u", "time,u"), "channels[1].column: found \"time\", expected a column of its own, not that of time"},
           {with(block_yaml(kBlock), "file: brain/linear", "file: forceps/default"), good, "experiment.yaml:7: model.file: found \"forceps/default\", expected a model of tissue-block, with youngs_modulus, e.g. brain/linear"},
           {with(block_yaml(kBlock), "title: block", "title: bl\xF6" "ck"), good, "experiment.yaml:2: text: found the byte 0xF6 after 9 others of its line, expected a YAML file in UTF-8"},
           {block_yaml(kBlock), with(four, "F\n", "F,f\xF6rce\n"), "a.csv:1: text: found the byte 0xF6 after 7 others of its line, expected a CSV file in UTF-8"},
           {block_yaml(kBlock), "t,u,F\n0,,0\n1,,-1\n2,-0.2,-2\n3,-0.3,-3\n", "a.csv: rows: found 2 with all inputs, expected at least 4"},
           {rig_yaml("vessel-inflation", "outer_diameter: \"1 mm\", wall_thickness: \"0.6 mm\"", tube, "rate: \"800 Pa/s\""), tube_csv, "experiment.yaml:5: specimen.wall_thickness: found \"0.6 mm\", expected less than half the outer diameter, 499.9 um"},
           {rig_yaml("vessel-inflation", "outer_diameter: \"1 mm\", wall_thickness: \"0.1 mm\"", tube, "rate: \"800 Pa/s\"", ", specimen: { wall_thickness: \"0.6 mm\" }"), tube_csv, "experiment.yaml:10: trials[0].specimen.wall_thickness: found \"0.6 mm\""},
           {rig_yaml("vessel-inflation", "outer_diameter: \"1 mm\", wall_thickness: \"0.1 mm\", layer_split: { media: \"2 kg\" }", tube, "rate: \"800 Pa/s\""), tube_csv, "experiment.yaml:5: specimen.layer_split: found a map, expected lengths with a unit"},
           {rig_yaml("vessel-inflation", "outer_diameter: \"1 mm\", wall_thickness: \"0.1 mm\", layer_split: { media: 0.7, adventitia: \"30 um\" }", tube, "rate: slow"), tube_csv, ""},
           {rig_yaml("needle-insertion", needle_sizes, needle, "layers: 1"), "x,F\n0,0\n1,1\n2000,2\n3,3\n", "a.csv:4: column x: found \"2000\" mm, expected a depth of at most 0.5 m (is the unit wrong by 1000?)"},
           {rig_yaml("needle-insertion", needle_sizes, needle, "layers: 1"), "x,F\n0,0\n.001,1\n.002,2\n.003,3\n.004,0\n.005,1\n.006,2\n.007,3\n.008,0\n.009,1\n.010,2\n.011,3\n.012,4\n400,4\n", "a.csv:15: column x: found \"400\" mm, expected a sample less than a thousand times beyond all others"},
           {rig_yaml("needle-insertion", needle_sizes, needle, "layers: 2.5"), needle_csv, "trials[0].protocol.layers: found \"2.5\", expected a whole number of layers from 1 to 20"},
           {rig_yaml("needle-insertion", needle_sizes, needle, "layers: 3 kg"), needle_csv, "trials[0].protocol.layers: found \"3 kg\", expected the number of layers"},
           {rig_yaml("needle-insertion", needle_sizes, needle, "layers: [dura, arachnoid]"), needle_csv, ""},
           {rig_yaml("needle-insertion", needle_sizes, needle, "layers: \"2\""), needle_csv, ""},
           {rig_yaml("suture-pull", "diameter: \"30 um\", cylinder_diameter: \"5 mm\"",
                     "  - { name: speed, column: v, unit: mm/s, kind: input }\n  - { name: hold_force, column: h, unit: mN, kind: input }\n  - { name: wrap_angle, column: w, unit: rad, kind: input }\n  - { name: pull_force, column: F, unit: mN, kind: output }\n", "medium: dry"),
            "v,h,w,F\n1,1,180,2\n1,2,180,4\n1,3,180,6\n1,4,180,8\n", "a.csv:2: column w: found \"180\" rad, expected at most 60 rad, ten turns (is the unit deg?)"},
           {rig_yaml("forceps-bridge", "bits: 14, reference: \"3.3 V\"",
                     "  - { name: angle, column: a, unit: deg, kind: input }\n  - { name: grip_force, column: g, unit: N, kind: input }\n  - { name: temperature, column: T, unit: degC, kind: input }\n  - { name: strain_counts, column: s, unit: count, kind: output }\n", "direction: closing"),
            "a,g,T,s\n1,1,293,2\n2,2,293,4\n3,3,293,6\n4,4,293,8\n", "a.csv:2: column T: found \"293\" degC, expected 200 K to 450 K (kelvin and degC mixed up?)"}}) {
    const std::string said = dataset_refusal(c.yaml, c.csv);
    EXPECT_TRUE(says(said, c.expected)) << said;
    EXPECT_EQ(said.empty(), c.expected.empty()) << said;
  }
}

/// A text with one of a dozen things done to it.
std::string spoiled(std::string text, Rng& rng) {
  static const std::vector<std::string> rubbish = {"\xB5", "\xFF\xFE", std::string(1, '\0'), "\"", "'", "{", "]", ":", "- ", "\t", "1e999", "-", "nan", "\n\n", ",", ";", "../", "&a", "*a", "!!int", "9999999999999999999999", "\r", "0x10", "\xEF\xBB\xBF"};
  const auto place = [&] { return static_cast<std::size_t>(rng.below(text.size() + 1)); };
  for (std::size_t n = 1 + rng.below(3); n > 0; --n) {
    const std::size_t at = place(), length = static_cast<std::size_t>(rng.below(40));
    switch (rng.below(6)) {
      case 0: text.insert(at, rubbish[rng.below(rubbish.size())]); break;
      case 1: text.erase(at, length); break;
      case 2: if (at < text.size()) text[at] = static_cast<char>(rng.below(256)); break;
      case 3: text.insert(at, text.substr(place(), length)); break;
      case 4: text.replace(at, std::min(length, text.size() - at), rubbish[rng.below(rubbish.size())]); break;
      default: text.resize(at);
    }
    if (text.empty()) text = " ";
  }
  return text;
}

TEST(Plausible, RubbishIsRefusedByNameOrIsADataset) {
  Rng rng(20261123);
  int refused = 0, taken = 0;
  for (int round = 0; round < 2000; ++round) {
    Folder f;
    const bool csv = round % 2 == 1;
    const std::string yaml = block_yaml(kBlock), good = block_csv(linear);
    f.write("experiment.yaml", csv ? yaml : spoiled(yaml, rng));
    f.write("a.csv", csv ? spoiled(good, rng) : good);
    try {
      const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
      ++taken;
      for (const Trial& t : d.trials)
        for (const auto& [name, values] : t.data) EXPECT_EQ(values.size(), t.time.size());
    } catch (const InputError& error) {
      ++refused;
      const std::string said = error.what();
      EXPECT_TRUE(says(said, "experiment.yaml") || says(said, "a.csv") || says(said, "models/brain")) << said;
      EXPECT_FALSE(error.field.empty() || error.expected.empty()) << said;
    }
  }
  EXPECT_GT(refused, 700);
  EXPECT_GT(taken, 40);
}

}  // namespace plausible_test
}  // namespace filum::reconcile
