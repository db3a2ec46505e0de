#include "training/task.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "training/needle_task.h"
#include "training/rating_scale.h"

namespace filum {
namespace task_test {

const std::string kMinimal = R"(format: filum-task/1
name: t
title: T
description: D
suture: 10-0-nylon
time_limit: "60 s"
accept: [square]
throws: 2
pass_points: "5"
steps:
  - { kind: loop, throw: 1, name: a, hint: b }
rubric:
  - { measure: time, title: Time, points: "10", unit: s, full_to: "25 s", zero_above: "75 s", source: MI4 }
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kMinimal;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// Field named by the error that the text gives; empty if it gives none.
std::string refused(const std::string& text) {
  try {
    parse_task(YamlNode::parse(text, "t.yaml"));
  } catch (const InputError& e) {
    EXPECT_NE(e.file.find("t.yaml"), std::string::npos);
    return e.field;
  }
  return "";
}

TEST(Task, TheTasksOfTheCurriculumLoad) {
  for (const std::string name : {"knot-square", "knot-surgeons", "knot-granny"}) {
    const Task task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/" + name + "/task.yaml");
    EXPECT_EQ(task.name, name);
    EXPECT_EQ(task.steps.size(), 9u);
    EXPECT_NEAR(task.max_total(), 100.0, 1e-12);
    EXPECT_EQ(task.demonstration_only, name == "knot-granny");
    for (const RubricItem& item : task.rubric) EXPECT_FALSE(item.source.empty()) << item.title;
    for (const TaskStep& step : task.steps) EXPECT_FALSE(step.hint.empty()) << step.name;
  }
}

TEST(Task, TheAnastomosisAsksForEachOfEightStitchesTiedAndCut) {
  const std::string name = "anastomosis-8";
  const Task task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/" + name + "/task.yaml");
  EXPECT_EQ(task.name, name);
  ASSERT_TRUE(task.needle);
  const auto& goals = task.needle->goals;
  ASSERT_EQ(goals.size(), 1u + 3u * 8u);
  for (int k = 1; k <= 8; ++k) {
    const auto at = [&](int i) -> const NeedleGoal& { return goals[static_cast<std::size_t>(3 * k - 2 + i)]; };
    EXPECT_EQ(at(0).kind, NeedleGoal::Kind::stitch);
    EXPECT_EQ(at(0).stitch.count, 1);
    EXPECT_EQ(at(1).kind, NeedleGoal::Kind::tie);
    EXPECT_EQ(at(2).kind, NeedleGoal::Kind::cut);
    for (int i = 1; i < 3; ++i) EXPECT_EQ(at(i).passes, 2 * k);
    EXPECT_EQ(at(1).throws, 2);
    EXPECT_EQ(at(1).knots, (std::vector<std::string>{"square", "surgeons", "triple"})) << "those that hold in nylon";
  }
  EXPECT_NEAR(task.max_total(), 100.0, 1e-12);
  EXPECT_GT(task.needle->lapses.loose_gap, 0.0);
  for (const RubricItem& item : task.rubric) EXPECT_FALSE(item.source.empty()) << item.title;
}

/// Names of the scales that a task of one stitch with these lines has, or the refused field.
std::vector<std::string> scales_with(const std::string& lines) {
  const std::string text = "format: filum-task/1\nkind: needle\nname: t\ntitle: T\ndescription: D\nsuture: 10-0-nylon\ntime_limit: \"60 s\"\npass_points: \"5\"\n"
                           "lapses: curricula/lapses/vessel.yaml\n" + lines +
                           "steps:\n  - { kind: pick, name: a, hint: b, tool: \"1\" }\n"
                           "rubric:\n  - { measure: time, title: Time, points: \"10\", unit: s, full_to: \"25 s\", zero_above: \"75 s\", source: MI4 }\n";
  std::vector<std::string> names;
  try {
    const Task task = parse_task(YamlNode::parse(text, "t.yaml"), FILUM_SOURCE_DIR);
    for (const auto& scale : task.needle->scales) names.push_back(scale->name);
  } catch (const InputError& e) {
    return {"refused: " + e.field};
  }
  return names;
}

TEST(Task, RatersMarkByTheScalesOfAListOrByTheOneOfAnEarlierRecording) {
  using Names = std::vector<std::string>;
  const std::string mars = "curricula/scales/mars10.yaml", lapses = "curricula/scales/lapse-index.yaml";
  EXPECT_EQ(scales_with(""), Names{});
  EXPECT_EQ(scales_with("scales: [" + mars + ", " + lapses + "]\n"), (Names{"mars10", "lapse-index"}));
  EXPECT_EQ(scales_with("scale: " + mars + "\n"), Names{"mars10"});
  EXPECT_EQ(scales_with("scale: " + mars + "\nscales: [" + lapses + "]\n"), Names{"refused: scale"});
  EXPECT_EQ(scales_with("scales: []\n"), Names{"refused: scales"});
  EXPECT_EQ(scales_with("scales: [" + mars + ", " + mars + "]\n"), Names{"refused: scales"});
  EXPECT_EQ(scales_with("scales: " + mars + "\n"), Names{"refused: scales"});
}

TEST(Task, ReadsUnitsIntoSi) {
  const Task task = parse_task(YamlNode::parse(kMinimal, "t.yaml"));
  EXPECT_EQ(task.time_limit, 60.0);
  ASSERT_EQ(task.rubric.size(), 1u);
  EXPECT_EQ(task.rubric[0].band.full_to, 25.0);
  EXPECT_EQ(task.steps[0].kind, StepKind::loop);
}

TEST(Task, RefusesWhatItDoesNotKnowAndNamesIt) {
  EXPECT_EQ(refused(kMinimal), "");
  EXPECT_EQ(refused(with("filum-task/1", "filum-task/9")), "format");
  EXPECT_EQ(refused(with("throws: 2", "throws: 2\ncolour: red")), "colour");
  EXPECT_EQ(refused(with("[square]", "[bowline]")), "accept");
  EXPECT_EQ(refused(with("[square]", "[]")), "accept");
  EXPECT_EQ(refused(with("60 s", "60 mm")), "time_limit");
  EXPECT_EQ(refused(with("unit: s", "unit: mm")), "rubric[0].unit");
  EXPECT_EQ(refused(with("unit: s", "unit: parsec")), "rubric[0].unit");
  EXPECT_EQ(refused(with("kind: loop", "kind: jump")), "steps[0].kind");
  EXPECT_EQ(refused(with("throw: 1", "throw: 3")), "steps[0].throw");
  EXPECT_EQ(refused(with("measure: time", "measure: charm")), "rubric[0].measure");
  EXPECT_EQ(refused(with("\"75 s\"", "\"5 s\"")), "rubric[0].zero_above");
  EXPECT_EQ(refused(with("pass_points: \"5\"", "pass_points: \"50\"")), "pass_points");
  EXPECT_EQ(refused(with("source: MI4", "sauce: MI4")), "rubric[0].source");
}

TEST(Task, BandIsFullInsideZeroOutsideAndStraightBetween) {
  const Band tails{0.2, 0.8, 4.0, 8.0};
  EXPECT_EQ(tails.share(0.1), 0.0);
  EXPECT_EQ(tails.share(0.2), 0.0);
  EXPECT_NEAR(tails.share(0.5), 0.5, 1e-12);
  EXPECT_EQ(tails.share(0.8), 1.0);
  EXPECT_EQ(tails.share(4.0), 1.0);
  EXPECT_NEAR(tails.share(7.0), 0.25, 1e-12);
  EXPECT_EQ(tails.share(9.0), 0.0);
  EXPECT_EQ(tails.share(std::nan("")), 0.0);
  const double inf = std::numeric_limits<double>::infinity();
  const Band step{-inf, -inf, 0.0, 0.0};
  EXPECT_EQ(step.share(-5.0), 1.0);
  EXPECT_EQ(step.share(0.0), 1.0);
  EXPECT_EQ(step.share(0.1), 0.0);
}

}  // namespace task_test
}  // namespace filum
