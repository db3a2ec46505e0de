#include "base/yaml_file.h"

#include <gtest/gtest.h>

#include "tests/refusal.h"

namespace filum {
namespace yaml_file_test {

const char* const kModel = R"(# comment
name: 10-0-nylon
diameter: 25 um
friction: 0.2
angle: 30 deg
nodes: 120
closed: false
start: [1 mm, 0 mm, -2 mm]
lengths: [1 mm, 2 cm]
words: [a, "b c"]
kind: forceps
inner:
  modulus: 2.5 GPa
tools:
  - {name: left, mass: 12 g}
  - {name: right, mass: 13 g}
)";

YamlNode model() {
  return YamlNode::parse(kModel, "model.yaml");
}

void read_everything(const YamlNode& node) {
  EXPECT_EQ(node.text("name"), "10-0-nylon");
  EXPECT_DOUBLE_EQ(node.quantity("diameter", "um"), 25e-6);
  EXPECT_DOUBLE_EQ(node.number("friction"), 0.2);
  EXPECT_NEAR(node.quantity("angle", "deg"), 0.5235987755982988, 1e-15);
  EXPECT_EQ(node.integer("nodes", 5, 1000), 120);
  EXPECT_FALSE(node.flag("closed"));
  EXPECT_TRUE(node.vec3("start", "mm").isApprox(Vec3(1e-3, 0, -2e-3)));
  EXPECT_EQ(node.quantities("lengths", "m"), (std::vector<double>{1e-3, 2e-2}));
  EXPECT_EQ(node.texts("words"), (std::vector<std::string>{"a", "b c"}));
  EXPECT_EQ(node.choice("kind", {"forceps", "needle-holder"}), "forceps");
  EXPECT_DOUBLE_EQ(node.map("inner").quantity("modulus", "Pa"), 2.5e9);
  const std::vector<YamlNode> tools = node.items("tools");
  ASSERT_EQ(tools.size(), 2u);
  EXPECT_EQ(tools[1].text("name"), "right");
  EXPECT_DOUBLE_EQ(tools[1].quantity("mass", "kg"), 0.013);
  EXPECT_DOUBLE_EQ(tools[0].quantity("mass", "kg"), 0.012);
  EXPECT_EQ(tools[0].text("name"), "left");
}

TEST(YamlFile, ReadsEveryKindOfFieldAndFinishes) {
  const YamlNode node = model();
  read_everything(node);
  EXPECT_NO_THROW(node.finish());
}

TEST(YamlFile, FallbacksAreForAbsentKeysOnly) {
  const YamlNode node = model();
  EXPECT_EQ(node.quantity_or("length", "mm", 0.5), 0.5);
  EXPECT_EQ(node.integer_or("seed", 3, 0, 9), 3);
  EXPECT_EQ(node.text_or("title", "none"), "none");
  EXPECT_TRUE(node.flag_or("open", true));
  EXPECT_EQ(node.vec3_or("end", "m", Vec3::Ones()), Vec3::Ones());
  EXPECT_TRUE(node.items_or_none("vessels").empty());
  EXPECT_THROW(node.quantity_or("name", "mm", 0.5), InputError);
}

TEST(YamlFile, UnknownKeyIsNamedWithItsLine) {
  YamlNode node = YamlNode::parse("a: 1\nb: 2\n", "f.yaml");
  node.number("a");
  const InputError error = refusal_by([&] { node.finish(); });
  EXPECT_EQ(error.file, "f.yaml:2");
  EXPECT_EQ(error.field, "b");
  EXPECT_EQ(error.expected, "no such field here, only: a");
}

TEST(YamlFile, UnknownKeyInsideAListItemIsNamed) {
  YamlNode node = YamlNode::parse("tools:\n  - {name: a}\n  - name: b\n    nmae: c\n", "f.yaml");
  for (const YamlNode& tool : node.items("tools")) tool.text("name");
  const InputError error = refusal_by([&] { node.finish(); });
  EXPECT_EQ(error.file, "f.yaml:4");
  EXPECT_EQ(error.field, "tools[1].nmae");
  EXPECT_EQ(error.expected, "no such field here, only: name");
}

TEST(YamlFile, ScalarsOfAFreeFieldAtAnyDepth) {
  const YamlNode node = YamlNode::parse("a: 1\nb: [1, [2, 3]]\nc: { x: 4, y: [{ z: 5 }] }\n", "f.yaml");
  EXPECT_EQ(node.scalars("a"), std::vector<std::string>{"1"});
  EXPECT_EQ(node.scalars("b"), (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(node.scalars("c"), (std::vector<std::string>{"4", "5"}));
  EXPECT_THROW(node.scalars("d"), InputError);
  EXPECT_NO_THROW(node.finish());
}

TEST(YamlFile, WrongUnitNamesFileLineFieldValueAndExpected) {
  const YamlNode node = YamlNode::parse("x: 1\ninner:\n  modulus: 3 mm\n", "m.yaml");
  const InputError error = refusal_by([&] { node.map("inner").quantity("modulus", "GPa"); });
  EXPECT_EQ(error.file, "m.yaml:3");
  EXPECT_EQ(error.field, "inner.modulus");
  EXPECT_EQ(error.value, "\"3 mm\"");
  EXPECT_NE(error.expected.find("GPa"), std::string::npos);
}

TEST(YamlFile, MissingFieldNamesTheMapItBelongsTo) {
  const YamlNode node = YamlNode::parse("x: 1\ninner:\n  y: 2\n", "m.yaml");
  const InputError error = refusal_by([&] { node.map("inner").quantity("modulus", "GPa"); });
  EXPECT_EQ(error.field, "inner.modulus");
  EXPECT_EQ(error.value, "nothing");
}

TEST(YamlFile, RangesAreChecked) {
  const YamlNode node = YamlNode::parse("a: 0 mm\nb: 5 mm\n", "m.yaml");
  EXPECT_THROW(node.quantity("a", "mm", Range::positive()), InputError);
  EXPECT_EQ(node.quantity("a", "mm", Range::not_negative()), 0.0);
  EXPECT_EQ(node.quantity("b", "mm", Range::between(5e-3, 6e-3)), 5e-3);
  const InputError error = refusal_by([&] { node.quantity("b", "mm", Range::between(6e-3, 8e-3)); });
  EXPECT_NE(error.expected.find("6 mm"), std::string::npos);
  EXPECT_NE(error.expected.find("8 mm"), std::string::npos);
}

TEST(YamlFile, WrongShapesAreRefused) {
  const YamlNode node = model();
  EXPECT_THROW(node.text("tools"), InputError);
  EXPECT_THROW(node.vec3("lengths", "mm"), InputError);
  EXPECT_THROW(node.map("name"), InputError);
  EXPECT_THROW(node.items("inner"), InputError);
  EXPECT_THROW(node.items("words"), InputError);
  EXPECT_THROW(node.integer("friction", 0, 9), InputError);
  EXPECT_THROW(node.integer("nodes", 0, 9), InputError);
  EXPECT_THROW(node.flag("name"), InputError);
  EXPECT_THROW(node.choice("kind", {"scissors"}), InputError);
  const InputError error = refusal_by([&] { node.quantities("words", "mm"); });
  EXPECT_EQ(error.field, "words[0]");
}

TEST(YamlFile, CallersRefuseWithTheSameDetail) {
  const YamlNode node = model();
  const InputError error = refusal_by([&] { node.refuse("diameter", "less than 20 um"); });
  EXPECT_EQ(error.file, "model.yaml:3");
  EXPECT_EQ(error.value, "\"25 um\"");
}

struct Bad {
  const char* what;
  const char* text;
  const char* line;
};

class Malformed : public testing::TestWithParam<Bad> {};

TEST_P(Malformed, IsAnInputErrorWithALine) {
  const InputError error = refusal_by([&] { YamlNode::parse(GetParam().text, "f.yaml"); });
  EXPECT_EQ(error.file, std::string("f.yaml") + GetParam().line) << error.what();
}

INSTANTIATE_TEST_SUITE_P(
    YamlFile, Malformed,
    testing::Values(Bad{"empty", "", ":1"}, Bad{"scalar", "hello", ":1"}, Bad{"list", "[1, 2]", ":1"},
                    Bad{"twice", "a: 1\nb: 2\na: 3\n", ":3"}, Bad{"alias", "a: &x 1\nb: *x\n", ":1"},
                    Bad{"tag", "a: !!binary aGVsbG8=\n", ":1"}, Bad{"key", "? [a]\n: 1\n", ":1"},
                    Bad{"open", "a: [1, 2\nb: 3\n", ":2:2"}, Bad{"tab", "a:\n\t- 1\n", ":2:2"},
                    Bad{"two", "a: 1\n---\nb: 1\n", ""}),
    [](const auto& info) { return std::string(info.param.what); });

TEST(YamlFile, DepthAndSizeAreBounded) {
  EXPECT_THROW(YamlNode::parse("a: " + std::string(100000, '['), "f.yaml"), InputError);
  EXPECT_THROW(YamlNode::parse("a: " + std::string(5u << 20, 'x'), "f.yaml"), InputError);
  std::string many = "a: [";
  for (int i = 0; i < 300000; ++i) many += "1,";
  EXPECT_THROW(YamlNode::parse(many + "1]", "f.yaml"), InputError);
  EXPECT_THROW(YamlNode::parse(std::string("a: 1\0b: 2", 9), "f.yaml"), InputError);
}

TEST(YamlFile, MissingFileIsAnInputError) {
  const InputError error = refusal_by([] { YamlNode::load("no/such/file.yaml"); });
  EXPECT_EQ(error.file, "no/such/file.yaml");
  EXPECT_THROW(YamlNode::load(FILUM_SOURCE_DIR), InputError);  // a folder
}

}  // namespace yaml_file_test
}  // namespace filum
