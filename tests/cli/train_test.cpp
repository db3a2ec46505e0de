// filum train: prints its address once it serves, and ends with exit code 0 when it is told to.

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "program_call.h"
#include "session/ratings.h"
#include "session/store.h"
#include "tests/server/client.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace train_test {

/// A folder that a page can be served from.
std::string viewer_in(const synthetic::Folder& folder) {
  std::filesystem::create_directory(folder.file("viewer"));
  std::ofstream(folder.file("viewer/index.html")) << "<!doctype html><title>Filum</title>";
  return folder.file("viewer");
}

/// `train` with a folder to serve from, beside `words`.
void expect_train_refused(const synthetic::Folder& folder, std::vector<std::string> words, const std::vector<std::string>& said) {
  std::vector<std::string> all = {"train", "--port", "0", "--viewer", viewer_in(folder), "--store", folder.file("store")};
  all.insert(all.end(), words.begin(), words.end());
  expect_refused(all, said);
}

void set_format(const std::string& file, const char* big_endian) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(60);  // user_version in the header of an SQLite file
  stream.write(big_endian, 4);
  ASSERT_TRUE(stream.flush());
}

TEST(Train, ServesUntilItIsToldToEnd) {
  const synthetic::Folder folder;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  std::FILE *said = ::fdopen(ends[0], "r"), *out = ::fdopen(ends[1], "w");
  const std::string store = folder.file("store"), viewer = viewer_in(folder);
  const char* argv[] = {"filum", "train", "--port", "0", "--store", store.c_str(), "--viewer", viewer.c_str()};
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
  std::ofstream(folder.file("model.yaml")) << "format: filum-suture/1\ntitle: no numbers\n";
  expect_train_refused(folder, {"--address", "no address"}, {"--address", "found no address", "127.0.0.1"});
  expect_train_refused(folder, {"--port", "70000"}, {"--port"});
  expect_train_refused(folder, {"--model", folder.file("model.yaml")}, {"--model", "model.yaml", "expected a model that a task can take"});
  expect_train_refused(folder, {"--hands", "mouse:1"}, {"--hands", "mouse:1", "haptic:PORT"});
  expect_train_refused(folder, {"--motion-scale", "0"}, {"--motion-scale"});
  expect_train_refused(folder, {"--motion-scale", "0.5"}, {"--motion-scale", "--hands"});
}

TEST(Train, FilesAndPortsThatAreNotThereAreNamedBeforeItServes) {
  const synthetic::Folder folder;
  std::ofstream(folder.file("text")) << "no terminal";
  std::filesystem::create_directory(folder.file("empty"));
  expect_train_refused(folder, {"--serial", folder.file("none")}, {folder.file("none"), "serial port", "No such file", "expected a serial port"});
  expect_train_refused(folder, {"--serial", folder.file("text")}, {folder.file("text"), "serial port", "expected a serial port"});
  expect_train_refused(folder, {"--serial", folder.file("none"), "--forceps", folder.file("text")}, {folder.file("text")});
  expect_train_refused(folder, {"--forceps", folder.file("text")}, {"--forceps", folder.file("text"), "expected --serial"});
  for (const char* source : {"none.avi", "empty", "none/view_%03d.png"}) expect_train_refused(folder, {"--camera", folder.file(source)}, {"--camera", folder.file(source), "expected a video that is there"});
  expect_train_refused(folder, {"--root", folder.file("nowhere")}, {"--root", folder.file("nowhere"), "expected a folder with models/ and curricula/"});
  expect_refused({"train", "--port", "0", "--store", folder.file("store"), "--viewer", folder.file("nowhere")}, {"--viewer", "index.html", folder.file("nowhere"), "expected the folder of the built viewer"});
  expect_refused({"train", "--port", "0", "--store", folder.file("store"), "--viewer", folder.file("empty")}, {"--viewer", "index.html"});
}

TEST(Train, AStoreOrRatingsOfANewerProgramAreRefusedAndLeftAlone) {
  for (const char* name : {"store/index.sqlite", "store/ratings.sqlite"}) {
    const synthetic::Folder folder;
    { const Store store(folder.file("store")); }
    { const Ratings ratings(folder.file("store")); }
    set_format(folder.file(name), "\0\0\0\x63");
    expect_train_refused(folder, {}, {folder.file(name), "format", "found 99, made by a newer Filum", "expected a format up to 1"});
  }
}

}  // namespace train_test
}  // namespace filum
