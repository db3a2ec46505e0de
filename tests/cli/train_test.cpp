// filum train: prints its address once it serves, and ends with exit code 0 when it is told to.

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "program_call.h"
#include "tests/server/client.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace {

TEST(Train, ServesUntilItIsToldToEnd) {
  const synthetic::Folder folder;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  std::FILE *said = ::fdopen(ends[0], "r"), *out = ::fdopen(ends[1], "w");
  const std::string store = folder.file("store");
  const char* argv[] = {"filum", "train", "--port", "0", "--store", store.c_str(), "--viewer", store.c_str()};
  const Ear err;
  int code = -1;
  std::thread runs([&] { code = program(8, argv, {stdin, out, err.stream()}); });
  char line[200] = "";
  EXPECT_NE(std::fgets(line, sizeof line, said), nullptr);
  const std::string text = line;
  EXPECT_EQ(text.find("Filum trainer: http://127.0.0.1:"), 0u) << text;
  const auto port = static_cast<std::uint16_t>(std::stoi(text.substr(text.rfind(':') + 1)));
  EXPECT_EQ(nlohmann::json::parse(fetch(port, "/api/health").body()).at("state"), "idle");
  ::kill(::getpid(), SIGTERM);
  runs.join();
  EXPECT_EQ(code, kDone);
  EXPECT_EQ(err.heard(), "");
  std::fclose(out);
  std::fclose(said);
}

TEST(Train, WhatItCannotServeFromIsNamedBeforeItServes) {
  const synthetic::Folder folder;
  const std::string store = folder.file("store");
  std::ofstream(folder.file("model.yaml")) << "format: filum-suture/1\ntitle: no numbers\n";
  expect_refused({"train", "--store", store, "--port", "0", "--address", "no address"}, {"--address", "found no address", "127.0.0.1"});
  expect_refused({"train", "--store", store, "--port", "70000"}, {"--port"});
  expect_refused({"train", "--store", store, "--port", "0", "--model", folder.file("model.yaml")}, {"--model", "model.yaml", "expected a model that a task can take"});
  expect_refused({"train", "--store", store, "--port", "0", "--hands", "mouse:1"}, {"mouse:1", "haptic:PORT"});
  expect_refused({"train", "--store", store, "--port", "0", "--motion-scale", "0"}, {"--motion-scale"});
}

}  // namespace
}  // namespace filum
