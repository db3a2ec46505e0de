#include "server/server.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "base/error.h"
#include "server/connection.h"
#include "server/control.h"
#include "tests/server/client.h"

namespace filum {
namespace server_test {

namespace beast = boost::beast;
namespace http = beast::http;
using nlohmann::json;

// Remembers what it was asked for.
class RecordingHost : public ServerHost {
 public:
  void command(const ClientMessage& message) override { note([&] { commands.push_back(message); }); }
  void controlled(bool by_somebody) override { note([&] { control.push_back(by_somebody); }); }
  std::optional<std::string> api(std::string_view path) override {
    if (path == "/api/sessions") return R"({"sessions":[]})";
    if (path == "/api/agreement") throw std::runtime_error("database is locked");
    return std::nullopt;
  }
  std::optional<std::string> post(std::string_view path, const std::string& body) override {
    if (path != "/api/reconcile/start") return std::nullopt;
    note([&] { posted.push_back(body); });
    return "{}";
  }
  std::optional<Document> document(std::string_view path) override {
    if (path == "/documents/report") return Document{"text/html; charset=utf-8", "<h1>Report</h1>"};
    return std::nullopt;
  }
  std::optional<std::string> put(std::string_view path, const std::string& body) override {
    if (path != "/api/upload/1/0/0") return std::nullopt;
    note([&] { sent.push_back(body.size()); });
    return "{}";
  }
  template <class Condition>
  bool wait(Condition condition) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(20), condition);
  }

  std::mutex mutex;
  std::condition_variable changed;
  std::vector<ClientMessage> commands;
  std::vector<bool> control;
  std::vector<std::string> posted;
  std::vector<std::size_t> sent;  // [byte], of parts

 private:
  template <class Change>
  void note(Change change) {
    const std::lock_guard lock(mutex);
    change();
    changed.notify_all();
  }
};

class ServerTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("filum-server-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_ / "dist");
    std::ofstream(folder_ / "dist/index.html") << "<title>Filum</title>";
    std::ofstream(folder_ / "secret.txt") << "secret";
    ServerOptions options;
    options.port = 0;
    options.viewer_folder = folder_ / "dist";
    options.hello = {"0.1.0", {{"knot-square", "Square knot", "Tie it.", "Knots", false}}, {}, {"pointer", "demo"}};
    server_ = std::make_unique<Server>(options, host_);
    server_->start();
  }
  void TearDown() override {
    server_->stop();
    std::filesystem::remove_all(folder_);
  }

  http::response<http::string_body> get(const std::string& target, const Asked& asked = {}) { return fetch(server_->port(), target, asked); }

  std::filesystem::path folder_;
  RecordingHost host_;
  std::unique_ptr<Server> server_;
};

TEST_F(ServerTest, ServesTheViewerAndNothingElse) {
  EXPECT_EQ(get("/").body(), "<title>Filum</title>");
  EXPECT_EQ(get("/index.html?x=1").result_int(), 200u);
  EXPECT_EQ(get("/", {.verb = http::verb::head}).result_int(), 200u);
  for (const char* path : {"/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/dist/../../secret.txt", "/none"}) {
    const auto response = get(path);
    EXPECT_EQ(response.result_int(), 404u) << path;
    EXPECT_EQ(response.body().find("secret"), std::string::npos);
  }
  EXPECT_EQ(get("/%zz").result_int(), 400u);
  EXPECT_EQ(get("/", {.verb = http::verb::post}).result_int(), 405u);
}

TEST_F(ServerTest, ChangesAreAskedForByPagesOfThisServerOnly) {
  const auto post = [&](const std::string& path, const std::string& origin, const std::string& type) {
    return get(path, {http::verb::post, "", R"({"dataset":"a"})", origin, type}).result_int();
  };
  const std::string own = "http://127.0.0.1:" + std::to_string(server_->port()), path = "/api/reconcile/start";
  EXPECT_EQ(post(path, "", "application/json"), 403u) << "no page says so";
  EXPECT_EQ(post(path, "http://evil.example", "application/json"), 403u);
  EXPECT_EQ(post(path, own, "text/plain"), 415u) << "what a form can send";
  EXPECT_TRUE(host_.posted.empty());
  EXPECT_EQ(post(path, own, "application/json"), 200u);
  EXPECT_EQ(post("/api/nothing", own, "application/json"), 404u);
  ASSERT_EQ(host_.posted.size(), 1u);
  EXPECT_EQ(host_.posted[0], R"({"dataset":"a"})");
}

TEST_F(ServerTest, PartsOfFilesMayBeLongerThanOtherRequests) {
  const std::string own = "http://127.0.0.1:" + std::to_string(server_->port()), bytes = "application/octet-stream", part(kMaxPart, 'x');
  const auto put = [&](const std::string& path, const std::string& body, const std::string& origin, const std::string& type) {
    return get(path, {http::verb::put, "", body, origin, type}).result_int();
  };
  EXPECT_EQ(put("/api/upload/1/0/0", part, own, bytes), 200u);
  EXPECT_EQ(put("/api/upload/9/0/0", "x", own, bytes), 404u);
  EXPECT_EQ(put("/api/upload/1/0/0", part + "x", own, bytes), 413u);
  EXPECT_EQ(put("/api/upload/1/0/0", part, "", bytes), 403u) << "no page says so";
  EXPECT_EQ(put("/api/upload/1/0/0", part, "http://evil.example", bytes), 403u);
  EXPECT_EQ(put("/api/upload/1/0/0", part, own, "text/plain"), 415u) << "what a form can send";
  EXPECT_EQ(put("/api/reconcile/start", part, own, bytes), 413u);
  EXPECT_EQ(put("/api/reconcile/start", "x", own, bytes), 405u);
  EXPECT_EQ(host_.sent, (std::vector<std::size_t>{kMaxPart}));
}

TEST_F(ServerTest, DocumentsRunNoScripts) {
  const auto report = get("/documents/report");
  EXPECT_EQ(report.body(), "<h1>Report</h1>");
  const std::string policy(report["Content-Security-Policy"]);
  EXPECT_NE(policy.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(policy.find("script"), std::string::npos);
  EXPECT_EQ(get("/documents/none").result_int(), 404u);
}

TEST_F(ServerTest, AnswersUnderApi) {
  const SchemaCheck schema;
  EXPECT_EQ(schema.fault(json::parse(get("/api/tasks").body()), "TaskList"), "");
  EXPECT_EQ(schema.fault(json::parse(get("/api/health").body()), "Health"), "");
  EXPECT_EQ(schema.fault(json::parse(get("/api/sessions").body()), "SessionList"), "");
  EXPECT_EQ(get("/api/nothing").result_int(), 404u);
}

/// A store that another process held brought the whole trainer down.
TEST_F(ServerTest, WhatFailsForOnePageIsSaidAndTheNextIsAnswered) {
  const auto failed = fetch(server_->port(), "/api/agreement");
  EXPECT_EQ(failed.result(), http::status::internal_server_error);
  EXPECT_NE(failed.body().find("database is locked"), std::string::npos);
  EXPECT_EQ(fetch(server_->port(), "/api/sessions").result(), http::status::ok);
}

TEST_F(ServerTest, RefusesOversizedRequestsAndForeignNames) {
  EXPECT_EQ(get("/", {http::verb::post, "", std::string(100'000, 'x'), "", ""}).result_int(), 413u);
  EXPECT_EQ(get("/" + std::string(20'000, 'a')).result_int(), 431u);
  EXPECT_EQ(get("/", {.host = "evil.example"}).result_int(), 403u);
  EXPECT_EQ(get("/").result_int(), 200u);
}

TEST_F(ServerTest, RefusesPagesOfOtherOrigins) {
  EXPECT_THROW(Client(server_->port(), "http://evil.example"), beast::system_error);
  EXPECT_THROW(Client(server_->port(), "", "evil.example"), beast::system_error);
  Client good(server_->port(), "http://127.0.0.1:" + std::to_string(server_->port()));
  EXPECT_EQ(good.hear().at("type"), "hello");
}

TEST_F(ServerTest, PortInUseIsAClearError) {
  ServerOptions second;
  second.port = server_->port();
  try {
    Server server(second, host_);
    FAIL() << "two servers on one port";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("another program"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("--port"), std::string::npos);
  }
  second.address = "not an address";
  EXPECT_THROW(Server(second, host_), InputError);
}

TEST_F(ServerTest, TwoBrowsersOneControls) {
  Client first(server_->port());
  EXPECT_EQ(first.hear().at("type"), "hello");
  Client second(server_->port());
  EXPECT_EQ(second.hear().at("type"), "hello");
  first.say(R"({"type":"start","task":"knot-square","input":"demo"})");
  ASSERT_TRUE(host_.wait([this] { return host_.commands.size() == 1; }));
  second.say(R"({"type":"stop"})");
  EXPECT_EQ(second.hear("error").at("code"), "not-in-control");
  second.say(R"({"type":"take_control"})");
  second.say(R"({"type":"stop"})");
  ASSERT_TRUE(host_.wait([this] { return host_.commands.size() == 2; }));
  EXPECT_TRUE(std::holds_alternative<StopMessage>(host_.commands[1]));
  first.say(R"({"type":"pause"})");
  EXPECT_EQ(first.hear("error").at("code"), "not-in-control");
}

TEST_F(ServerTest, BrowserThatReturnsSeesEverythingAgain) {
  SceneDescription scene;
  scene.task = "knot-square";
  server_->publish_scene(scene);
  server_->publish_trainer({"running", "knot-square", "pointer", true, "id-1", ""});
  server_->publish_frame(frame_body(Observation(), nullptr, {}), 1.0, 0);
  for (int visit = 0; visit < 3; ++visit) {
    Client client(server_->port());
    EXPECT_EQ(client.hear().at("type"), "hello");
    EXPECT_EQ(client.hear().at("task"), "knot-square");
    const json state = client.hear("session_state");
    EXPECT_EQ(state.at("state"), "running");
    EXPECT_EQ(state.at("session"), "id-1");
    EXPECT_EQ(client.hear("frame").at("id"), 1);
    client.say(R"({"type":"play"})");
    ASSERT_TRUE(host_.wait([&] { return host_.commands.size() == static_cast<std::size_t>(visit) + 1; }));
    client.vanish();
    // Losing the one in control is told, so that the pointer's tools become invalid.
    ASSERT_TRUE(host_.wait([&] { return host_.control.size() == 2 * (static_cast<std::size_t>(visit) + 1); }));
    EXPECT_FALSE(host_.control.back());
  }
}

TEST_F(ServerTest, FramesWaitForCreditAndTheNewestWins) {
  Client client(server_->port());
  client.hear("session_state");
  Observation o;
  for (int i = 1; i <= 50; ++i) {
    o.step = static_cast<std::uint64_t>(i);
    server_->publish_frame(frame_body(o, nullptr, {}), 1.0, 0);
  }
  server_->publish_event({1.0, "marker", -1, 0.0, "-", ""});
  int frames = 0;
  for (json message = client.hear(); message.at("type") != "event"; message = client.hear()) frames += message.at("type") == "frame";
  EXPECT_LE(frames, FrameCredit::kFramesInFlight);
  client.say(R"({"type":"ack","frame":2})");
  json last = client.hear("frame");
  if (frames < FrameCredit::kFramesInFlight && last.at("step") != 50) last = client.hear("frame");
  EXPECT_EQ(last.at("step"), 50);
}

TEST_F(ServerTest, GarbageIsAnsweredAndTheRestGoesOn) {
  Client client(server_->port());
  for (const char* bad : {"", "{", "{\"type\":\"pointer\",\"tool\":NaN}", "[[[[", "{\"type\":\"start\"}"}) {
    client.say(bad);
    EXPECT_EQ(client.hear("error").at("code"), "bad-message") << bad;
  }
  client.say(R"({"type":"stop"})");
  EXPECT_TRUE(host_.wait([this] { return host_.commands.size() == 1; }));
}

TEST_F(ServerTest, OversizedAndEndlessGarbageEndTheConnectionOnly) {
  Client big(server_->port());
  Client watcher(server_->port());
  big.say(std::string(2 * kMaxClientMessage, 'x'));
  EXPECT_THROW(while (true) big.hear(), beast::system_error);
  Client noisy(server_->port());
  EXPECT_THROW(
      {
        for (int i = 0; i < 1000; ++i) {
          noisy.say("x");
          noisy.hear("error");
        }
      },
      beast::system_error);
  watcher.say(R"({"type":"stop"})");
  EXPECT_TRUE(host_.wait([this] { return host_.commands.size() == 1; }));
}

TEST_F(ServerTest, StopsWithBrowsersConnected) {
  Client client(server_->port());
  client.hear();
  server_->stop();
  server_->stop();
  EXPECT_THROW(while (true) client.hear(), beast::system_error);
}

}  // namespace server_test
}  // namespace filum
