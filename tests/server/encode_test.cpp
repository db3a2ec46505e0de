#include "server/encode.h"

#include <gtest/gtest.h>

#include <limits>

#include "schema_check.h"

namespace filum {
namespace encode_test {

using nlohmann::json;

Observation observation_of(int nodes, int capacity) {
  Observation o;
  o.n_nodes = nodes;
  o.positions = Points::Zero(3, capacity);
  for (int i = 0; i < nodes; ++i) o.positions.col(i) = Vec3(1e-3 * i, 0.5e-3, -1.25e-7);
  o.tension.assign(static_cast<std::size_t>(capacity), 0.25);
  o.contact.assign(static_cast<std::size_t>(capacity), 0.0);
  o.n_tools = 2;
  o.step = 41;
  o.time = 0.082;
  o.tools[1].X_WT.p = Vec3(0.01, 0.02, 0.03);
  o.tools[1].grasped_edge = 7;
  o.n_parted = 3;
  o.parted = {1, 2, 3};
  o.break_edge = 2;
  return o;
}

TEST(Encode, FrameHoldsTheNodesInUse) {
  const TaskView task{"Lay the throw", 2, {"a", "b", "c"}, "pull", 12.5, false, {{"warn", "too tight \"now\"", "thread-overload"}}, {}, 0.0, {}};
  const std::string text = frame_message(9, frame_body(observation_of(4, 10), &task, {{"pointer", "live", 5, 0, 0, 1}}));
  const json frame = json::parse(text);
  EXPECT_EQ(SchemaCheck().fault(frame, "ServerMessage"), "");
  EXPECT_EQ(frame.at("id"), 9);
  EXPECT_EQ(frame.at("step"), 41);
  ASSERT_EQ(frame.at("positions").size(), 12u);
  EXPECT_EQ(frame.at("tension").size(), 3u);
  EXPECT_EQ(frame.at("contact").size(), 4u);
  EXPECT_DOUBLE_EQ(frame.at("positions")[3].get<double>(), 1e-3);
  EXPECT_DOUBLE_EQ(frame.at("positions")[5].get<double>(), -1.25e-7);
  EXPECT_EQ(frame.at("tools").size(), 2u);
  EXPECT_EQ(frame.at("tools")[1].at("pose").at("position"), json({0.01, 0.02, 0.03}));
  EXPECT_EQ(frame.at("tools")[1].at("pose").at("quaternion"), json({1, 0, 0, 0}));
  EXPECT_EQ(frame.at("tools")[1].at("grasped"), 7);
  EXPECT_EQ(frame.at("cuts"), json({1, 3})) << "the edge that broke is told by itself";
  EXPECT_EQ(frame.at("task").at("warnings")[0].at("text"), "too tight \"now\"");
  EXPECT_EQ(frame.at("devices")[0].at("rejected"), 1);
}

TEST(Encode, ObjectsAndTheTargetOfTheLaboratoryAreTold) {
  Observation o = observation_of(2, 2);
  o.n_pellets = 2;
  o.pellets[1] = {Vec3(0.001, 0.002, 0.003), -1, true};
  TaskView task;
  task.target = {0.004, 0.005, 0.006};
  task.within = 0.0005;
  const json frame = json::parse(frame_message(1, frame_body(o, &task, {})));
  EXPECT_EQ(SchemaCheck().fault(frame, "ServerMessage"), "");
  EXPECT_EQ(frame.at("objects"), json({0, 0, 0, 0, 0.001, 0.002, 0.003, 1}));
  EXPECT_EQ(frame.at("task").at("target"), json({0.004, 0.005, 0.006}));
  SceneDescription scene;
  scene.n_pellets = 1;
  scene.pellets[0] = {"fragile", 0.4e-3, 0.05, 0.15};
  scene.has_field = true;
  const json described = json::parse(scene_message(scene));
  EXPECT_EQ(SchemaCheck().fault(described, "ServerMessage"), "");
  EXPECT_EQ(described.at("objects")[0].at("radius"), 0.4e-3);
}

TEST(Encode, FrameOfABrokenNumberIsStillJson) {
  Observation o = observation_of(2, 2);
  o.positions(0, 0) = std::numeric_limits<double>::quiet_NaN();
  o.tools[0].grip_force = std::numeric_limits<double>::infinity();
  const json frame = json::parse(frame_message(1, frame_body(o, nullptr, {})));
  EXPECT_EQ(SchemaCheck().fault(frame, "Frame"), "");
  EXPECT_TRUE(frame.at("task").is_null());
}

TEST(Encode, EmptySceneIsAFrameToo) {
  const json frame = json::parse(frame_message(1, frame_body(Observation(), nullptr, {})));
  EXPECT_EQ(SchemaCheck().fault(frame, "Frame"), "");
  EXPECT_EQ(frame.at("positions").size(), 0u);
}

TEST(Encode, AnOverlayIsToldInItsUnitWhileItIsThere) {
  const std::vector<double> values = {0.0, 0.125, std::numeric_limits<double>::quiet_NaN()};
  const json frame = json::parse(frame_message(1, frame_body(Observation(), nullptr, {}, {"strain", "%", 30.0, 100.0, &values})));
  EXPECT_EQ(SchemaCheck().fault(frame, "Frame"), "");
  EXPECT_EQ(frame.at("overlay").at("values"), json({0.0, 12.5, 0.0}));
  EXPECT_TRUE(json::parse(frame_message(1, frame_body(Observation(), nullptr, {}))).at("overlay").is_null());
}

TEST(Encode, EveryOtherMessageFollowsTheSchema) {
  const SchemaCheck schema;
  const auto fault = [&schema](const std::string& text) { return schema.fault(json::parse(text), "ServerMessage"); };
  HelloView hello{"0.1.0", {{"knot-square", "Square knot", "Tie it.", "Knots", false}}, {{"serial \xff", "lost", 1, 2, 3, 4}}, {"pointer", "demo"}};
  EXPECT_EQ(fault(hello_message(hello, 3)), "");
  SceneDescription scene;
  scene.n_tools = 2;
  scene.tools[0].kind = scene.tools[1].kind = "forceps";
  EXPECT_EQ(fault(scene_message(scene)), "");
  const StitchGuide guide{{Vec3(1e-3, 0, 0), 4, {Vec3::Zero(), Vec3(0, 0, -1e-4)}}, {Vec3(2e-3, 0, 0), 5, {}}};
  EXPECT_EQ(fault(scene_message(scene, {guide})), "");
  EXPECT_EQ(json::parse(scene_message(scene, {guide})).at("guides")[0].at("in").at("path"), json({0.0, 0.0, 0.0, 0.0, 0.0, -1e-4}));
  scene.has_post = true;
  EXPECT_EQ(fault(scene_message(scene)), "");
  EXPECT_EQ(json::parse(scene_message(scene)).at("post").at("radius"), 0.5e-3);
  EXPECT_EQ(fault(event_message({1.5, "drop", 1, 0.25, "N", ""})), "");
  EXPECT_EQ(fault(session_state_message({}, 0, false, 1)), "");
  EXPECT_EQ(fault(session_state_message({"running", "knot-square", "demo", true, "id", "", -1.0}, 1, true, 2)), "");
  EXPECT_EQ(fault(session_state_message({"ended", "knot-square", "demo", false, "id", "", 0.4}, 1, true, 2)), "");
  EXPECT_EQ(fault(replay_state_message({"id", 1.0, 2.0, 1.5, true})), "");
  EXPECT_EQ(fault(error_message({"a", "b", "c"})), "");
  EXPECT_EQ(schema.fault(json::parse(task_list_json(hello.tasks)), "TaskList"), "");
  EXPECT_EQ(schema.fault(json::parse(health_json("0.1.0", {}, 2, 1.0, 3)), "Health"), "");
}

TEST(SchemaCheck, FindsFaults) {
  const SchemaCheck schema;
  json error = json::parse(error_message({"a", "b", "c"}));
  error.erase("advice");
  EXPECT_NE(schema.fault(error, "ServerMessage"), "");
  error["advice"] = 3;
  EXPECT_NE(schema.fault(error, "ServerMessage"), "");
}

}  // namespace encode_test
}  // namespace filum
