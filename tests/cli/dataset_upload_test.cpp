#include "cli/dataset_upload.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "tests/session/disk_limit.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace dataset_upload_test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string wish(const std::string& dataset, const std::vector<std::pair<std::string, std::size_t>>& files) {
  Json list = Json::array();
  for (const auto& [name, bytes] : files) list.push_back({{"name", name}, {"bytes", bytes}});
  return Json{{"dataset", dataset}, {"files", list}}.dump();
}

std::string number_of(const Json& status) { return status["upload"].dump(); }
std::string named(const Json& status) { return Json{{"upload", status["upload"]}}.dump(); }

class DatasetUploadTest : public testing::Test {
 protected:
  std::string text(const std::string& name) const {
    std::ifstream in(folder_.file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Everything in the folder, hidden or not.
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()); }
  /// What is said against it; empty if nothing.
  template <class Ask>
  static std::string refusal(const Ask& ask) {
    try {
      ask();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  synthetic::Folder folder_;
};

/// A second trainer in the same store took away what the first was being sent.
TEST_F(DatasetUploadTest, WhatAnotherTrainerIsBeingSentIsLeft) {
  const std::string running = folder_.file(".upload-" + std::to_string(::getppid()) + "-1"), gone = folder_.file(".upload-999999999-1");
  fs::create_directories(running);
  fs::create_directories(gone);
  const DatasetUpload upload(folder_.file(""));
  EXPECT_TRUE(fs::exists(running));
  EXPECT_FALSE(fs::exists(gone)) << "of a trainer that was killed";
}

TEST_F(DatasetUploadTest, PartsBecomeTheFolderThatWasChosen) {
  DatasetUpload upload(folder_.file(""));
  const Json begun = upload.begin(wish("block", {{"experiment.yaml", 5}, {"a.csv", 8}, {"empty.txt", 0}}));
  EXPECT_EQ(begun["of"], 13);
  const std::string n = number_of(begun);
  upload.part(n + "/1/0", "t,u\n");
  upload.part(n + "/0/0", "hello");
  EXPECT_FALSE(fs::exists(folder_.file("block"))) << "in no list before all is there";
  EXPECT_NE(refusal([&] { upload.finish(named(begun)); }).find("found 4 of a.csv, expected 8"), std::string::npos);
  EXPECT_EQ(upload.part(n + "/1/4", "1,2\n")["bytes"], 13);
  upload.finish(named(begun));
  EXPECT_EQ(text("block/experiment.yaml"), "hello");
  EXPECT_EQ(text("block/a.csv"), "t,u\n1,2\n");
  EXPECT_EQ(fs::file_size(folder_.file("block/empty.txt")), 0u);
  EXPECT_EQ(entries(), 1);
}

TEST_F(DatasetUploadTest, BadNamesAndSizesAreRefusedBeforeAnythingIsSent) {
  fs::create_directory(folder_.file("there"));
  DatasetUpload upload(folder_.file(""));
  const auto refused = [&](const std::string& body, const char* said) { EXPECT_NE(refusal([&] { upload.begin(body); }).find(said), std::string::npos) << body; };
  for (const char* name : {"", "..", ".hidden", "a/b", "../x", "a b", "a\nb"}) {
    refused(wish("block", {{"experiment.yaml", 1}, {name, 1}}), "name: found");
    refused(wish(name, {{"experiment.yaml", 1}}), "dataset: found");
  }
  refused("{\"dataset\":\"a\xff\",\"files\":[]}", "dataset: found nothing");
  refused(wish(std::string(65, 'a'), {{"experiment.yaml", 1}}), "dataset: found");
  refused(wish("there", {{"experiment.yaml", 1}}), "there already");
  refused(wish("block", {{"a.csv", 1}}), "no experiment.yaml");
  refused(wish("block", {}), "1 to 200 files");
  refused(wish("block", std::vector<std::pair<std::string, std::size_t>>(201, {"a", 1})), "1 to 200 files");
  refused(wish("block", {{"experiment.yaml", 1}, {"a.csv", 1}, {"a.csv", 1}}), "a.csv twice");
  refused(wish("block", {{"experiment.yaml", 1}, {"a.csv", kUploadBytes}}), "at most 256 MiB");
  refused(wish("block", {{"experiment.yaml", 1}, {"a.csv", ~std::size_t{0}}, {"b.csv", ~std::size_t{0}}}), "at most 256 MiB");
  for (const char* body : {"", "[]", "{}", R"({"dataset":7,"files":[]})", R"({"dataset":"a","files":[3]})", R"({"dataset":"a","files":[{"name":"experiment.yaml","bytes":-1}]})"})
    EXPECT_NE(refusal([&] { upload.begin(body); }), "") << body;
  EXPECT_EQ(entries(), 1);
}

TEST_F(DatasetUploadTest, PartsOutOfTurnChangeNothing) {
  DatasetUpload upload(folder_.file(""));
  const Json begun = upload.begin(wish("block", {{"experiment.yaml", 4}}));
  const std::string n = number_of(begun);
  upload.part(n + "/0/0", "ab");
  const auto refused = [&](const std::string& where, const std::string& bytes) { return refusal([&] { upload.part(where, bytes); }); };
  EXPECT_NE(refused(n + "/0/0", "ab").find("offset: found 0, expected 2"), std::string::npos) << "sent twice";
  EXPECT_NE(refused(n + "/0/3", "d").find("offset: found 3, expected 2"), std::string::npos);
  EXPECT_NE(refused(n + "/0/2", "cde").find("found 3 bytes"), std::string::npos) << "more than was said";
  EXPECT_NE(refused(n + "/0/2", ""), "");
  EXPECT_NE(refused(n + "/1/0", "x").find("file: found 1"), std::string::npos);
  EXPECT_NE(refused("99/0/2", "cd").find("has ended"), std::string::npos);
  for (const char* where : {"", "1", "1/0", "1/0/", "1/0/2x", "1/0/2/3", "-1/0/2", "1/../2"}) EXPECT_NE(refused(where, "cd").find("UPLOAD/FILE/OFFSET"), std::string::npos) << where;
  upload.part(n + "/0/2", "cd");
  upload.finish(named(begun));
  EXPECT_EQ(text("block/experiment.yaml"), "abcd");
  EXPECT_NE(refused(n + "/0/4", "e").find("has ended"), std::string::npos);
}

TEST_F(DatasetUploadTest, ACancelledUploadLeavesNothing) {
  DatasetUpload upload(folder_.file(""));
  const Json begun = upload.begin(wish("block", {{"experiment.yaml", 4}}));
  upload.part(number_of(begun) + "/0/0", "ab");
  EXPECT_EQ(entries(), 1);
  upload.cancel(named(begun));
  EXPECT_EQ(entries(), 0);
  upload.cancel(named(begun));
  const Json again = upload.begin(wish("block", {{"experiment.yaml", 4}}));
  upload.cancel(named(begun));  // the one before: not this one
  upload.part(number_of(again) + "/0/0", "abcd");
  upload.finish(named(again));
  EXPECT_EQ(text("block/experiment.yaml"), "abcd");
}

TEST_F(DatasetUploadTest, OneAtATimeUntilItIsAbandoned) {
  {
    DatasetUpload upload(folder_.file(""));
    upload.begin(wish("one", {{"experiment.yaml", 4}}));
    EXPECT_NE(refusal([&] { upload.begin(wish("two", {{"experiment.yaml", 4}})); }).find("until one is there"), std::string::npos);
  }
  EXPECT_EQ(entries(), 0) << "ended with its trainer";
  DatasetUpload upload(folder_.file(""), std::chrono::milliseconds(0));
  const Json one = upload.begin(wish("one", {{"experiment.yaml", 4}}));
  upload.begin(wish("two", {{"experiment.yaml", 4}}));
  EXPECT_NE(refusal([&] { upload.part(number_of(one) + "/0/0", "ab"); }).find("has ended"), std::string::npos);
  EXPECT_EQ(entries(), 1);
}

TEST_F(DatasetUploadTest, WhatAKilledTrainerLeftIsRemovedAndNothingElse) {
  fs::create_directories(folder_.file(".upload-999999999-1"));
  std::ofstream(folder_.file(".upload-999999999-1/a.csv")) << "half";
  fs::create_directories(folder_.file("mine"));
  std::ofstream(folder_.file(".keep")) << "";
  const DatasetUpload upload(folder_.file(""));
  EXPECT_FALSE(fs::exists(folder_.file(".upload-999999999-1")));
  EXPECT_EQ(entries(), 2);
}

TEST_F(DatasetUploadTest, AFullDiskEndsItWithWordsAndTheNextOneWorks) {
  DatasetUpload upload(folder_.file(""));
  const Json begun = upload.begin(wish("block", {{"experiment.yaml", 200'000}}));
  upload.part(number_of(begun) + "/0/0", std::string(50'000, 'x'));
  {
    const DiskLimit full(64 * 1024);
    const std::string said = refusal([&] { upload.part(number_of(begun) + "/0/50000", std::string(100'000, 'x')); });
    EXPECT_NE(said.find("what was sent is removed"), std::string::npos) << said;
    EXPECT_NE(said.find("room for the whole dataset"), std::string::npos) << said;
  }
  EXPECT_EQ(entries(), 0);
  const Json again = upload.begin(wish("block", {{"experiment.yaml", 2}}));
  upload.part(number_of(again) + "/0/0", "ok");
  upload.finish(named(again));
  EXPECT_EQ(text("block/experiment.yaml"), "ok");
}

TEST_F(DatasetUploadTest, AFolderThatCannotBeWrittenIsSaid) {
  fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec);
  const synthetic::OrdinaryUser user;
  if (!user.is()) GTEST_SKIP() << "cannot become an ordinary user";
  DatasetUpload upload(folder_.file("datasets"));
  EXPECT_NE(refusal([&] { upload.begin(wish("block", {{"experiment.yaml", 2}})); }).find("a folder that can be written"), std::string::npos);
}

}  // namespace dataset_upload_test
}  // namespace filum
