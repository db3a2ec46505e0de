#include "server/client_message.h"

#include <gtest/gtest.h>

#include <functional>

#include "schema_check.h"

namespace filum {
namespace client_message_test {

using nlohmann::json;

const char* const kPointer =
    R"({"type":"pointer","tool":1,"time":2.5,"position":[0.001,-0.002,0.003],"quaternion":[2,0,0,0],"grip":0.75,"buttons":2})";

std::string fault_of(const std::string& text) {
  const auto parsed = parse_client_message(text);
  const auto* refusal = std::get_if<Refusal>(&parsed);
  return refusal == nullptr ? "" : refusal->what;
}

TEST(ClientMessage, ReadsPointerAndNormalisesItsQuaternion) {
  const auto parsed = parse_client_message(std::string(kPointer).replace(std::string(kPointer).find("[2,0,0,0]"), 9, "[1,1,0,0]"));
  const auto& m = std::get<PointerMessage>(std::get<ClientMessage>(parsed));
  EXPECT_EQ(m.tool, 1);
  EXPECT_EQ(m.time, 2.5);
  EXPECT_EQ(m.X_WD.p, Vec3(0.001, -0.002, 0.003));
  EXPECT_NEAR(m.X_WD.q.norm(), 1.0, 1e-15);
  EXPECT_NEAR(m.X_WD.q.x(), m.X_WD.q.w(), 1e-15);
  EXPECT_EQ(m.grip, 0.75);
  EXPECT_EQ(m.buttons, 2u);
}

TEST(ClientMessage, ReadsEveryOtherKind) {
  const auto read = [](const char* text) { return std::get<ClientMessage>(parse_client_message(text)); };
  const auto start = std::get<StartMessage>(read(R"({"type":"start","task":"knot-square","input":"demo","code":"T-07"})"));
  EXPECT_EQ(start.task, "knot-square");
  EXPECT_EQ(start.input, "demo");
  EXPECT_EQ(start.code, "T-07");
  EXPECT_FALSE(start.take_over);
  EXPECT_TRUE(std::get<StartMessage>(read(R"({"type":"start","task":"k","input":"pointer","take_over":true})")).take_over);
  EXPECT_EQ(std::get<AckMessage>(read(R"({"type":"ack","frame":18446744073709551615})")).frame, 18446744073709551615ull);
  EXPECT_EQ(std::get<SeekMessage>(read(R"({"type":"seek","time":1.5})")).time, 1.5);
  EXPECT_EQ(std::get<ReplayOpenMessage>(read(R"({"type":"replay_open","session":"a"})")).session, "a");
  EXPECT_TRUE(std::holds_alternative<StopMessage>(read(R"({"type":"stop"})")));
  EXPECT_TRUE(std::holds_alternative<TakeControlMessage>(read(R"({"type":"take_control"})")));
  EXPECT_TRUE(std::holds_alternative<PlayMessage>(read(R"({"type":"play"})")));
  EXPECT_TRUE(std::holds_alternative<PauseMessage>(read(R"({"type":"pause"})")));
}

TEST(ClientMessage, RefusesNumbersThatAreNone) {
  for (const char* bad : {"NaN", "1e999", "-Infinity", "null", "\"1\"", "2.0", "[1]"}) {
    std::string text = kPointer;
    text.replace(text.find("0.75"), 4, bad);
    EXPECT_FALSE(fault_of(text).empty()) << text;
  }
  for (const char* bad : {"[0,0,NaN]", "[0,0]", "[0,0,1e300]", "[0,0,null]", "[0,0,0,0]", "{}"}) {
    std::string text = kPointer;
    text.replace(text.find("[0.001,-0.002,0.003]"), 20, bad);
    EXPECT_FALSE(fault_of(text).empty()) << text;
  }
}

TEST(ClientMessage, RefusalNamesTheFieldAtFault) {
  EXPECT_EQ(fault_of(R"({"type":"pointer","tool":3})"), "pointer: tool: expected a whole number from 0 to 2");
  EXPECT_EQ(fault_of(R"({"type":"start","input":"demo"})"), "start: task: expected to be present");
  EXPECT_EQ(fault_of(R"({"type":"start","task":"a","input":"mouse"})"), "start: input: expected pointer, demo or device");
  EXPECT_EQ(fault_of(R"({"type":"start","task":"a","input":"demo","code":"Anna B"})"),
            "start: code: expected letters, digits, - and _ only");
  EXPECT_EQ(fault_of(R"({"type":"dance"})"), "dance: type: expected the name of a message");
  EXPECT_EQ(fault_of(R"({"type":"stop","now":1})"), "stop: now: expected a field of this message");
}

TEST(ClientMessage, RefusesWhatIsNoMessage) {
  for (const char* bad : {"", "{", "[]", "1", "null", "\"stop\"", "{}", "{\"type\":1}", "\xff\xfe", "{\"type\":\"stop\"} x"}) {
    EXPECT_FALSE(fault_of(bad).empty()) << bad;
  }
  EXPECT_FALSE(fault_of(std::string(10000, '[')).empty());
  EXPECT_FALSE(fault_of("{\"type\":\"stop\",\"x\":\"" + std::string(kMaxClientMessage, 'x') + "\"}").empty());
}

// The schema and the parser are two accounts of one contract: what one takes the other takes, field by field.
TEST(ClientMessage, AgreesWithTheSchema) {
  const SchemaCheck schema;
  const std::vector<json> good = {
      {{"type", "start"}, {"task", "knot-square"}, {"input", "device"}, {"code", "A_1"}, {"take_over", true}, {"stiffness", 0.5}, {"exam", true}},
      {{"type", "stop"}}, {{"type", "take_control"}}, {{"type", "play"}}, {{"type", "pause"}}, {{"type", "overlay"}, {"kind", "strain"}},
      {{"type", "ack"}, {"frame", 3}}, {{"type", "seek"}, {"time", 0.0}}, {{"type", "replay_open"}, {"session", "x"}},
      json::parse(kPointer)};
  EXPECT_EQ(schema.definitions().at("ClientMessage").at("oneOf").size(), good.size());
  const auto accepted = [](const json& m) { return std::holds_alternative<ClientMessage>(parse_client_message(m.dump())); };
  const std::vector<json> odd = {nullptr, true, -1, 0.5, 1e10, "", "demo", "zz zz", std::string(200, 'a'), json::array(), json::object()};
  int compared = 0;
  for (const json& message : good) {
    EXPECT_EQ(schema.fault(message, "ClientMessage"), "") << message;
    EXPECT_TRUE(accepted(message)) << message;
    for (const auto& [name, value] : message.items()) {
      json less = message;
      less.erase(name);
      EXPECT_EQ(accepted(less), schema.fault(less, "ClientMessage").empty()) << less;
      for (const json& other : odd) {
        json changed = message;
        changed[name] = other;
        // Bounds on time and length that the schema leaves to the parser only make it stricter.
        if (accepted(changed)) {
          EXPECT_EQ(schema.fault(changed, "ClientMessage"), "") << changed;
        }
        ++compared;
      }
    }
    json more = message;
    more["more"] = 1;
    EXPECT_FALSE(accepted(more));
    EXPECT_NE(schema.fault(more, "ClientMessage"), "");
  }
  EXPECT_GT(compared, 200);
}

}  // namespace client_message_test
}  // namespace filum
