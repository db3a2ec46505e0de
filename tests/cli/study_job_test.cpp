#include "cli/study_job.h"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace filum {
namespace study_job_test {

using namespace std::chrono_literals;

RecordedSession made(const std::string& file) {
  if (file == "damaged") throw InputError(file, "block 3", "a wrong checksum", "an undamaged recording");
  RecordedSession s;
  s.file = file;
  s.meta.task = "trace";
  s.meta.input = "pointer";
  s.seconds = 8.0;
  ToolSeries tool;
  tool.target_error = {{1.0, 1e-4}, {5.0, 2e-4}};
  s.tools.push_back(tool);
  return s;
}

std::string ended(const StudyJob& job) {
  for (const auto end = std::chrono::steady_clock::now() + 20s; std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(2ms))
    if (job.status()["state"] != "running") break;
  return job.status()["state"];
}

TEST(StudyJob, ReadsWhatItCanAndSaysWhatItCouldNot) {
  StudyJob job(made);
  EXPECT_EQ(job.status()["state"], "idle");
  EXPECT_FALSE(job.file("study.html"));
  EXPECT_THROW(job.start({}, {}), InputError);
  job.start({{"one", "one.rec"}, {"two", "damaged"}, {"three", "three.rec"}}, {});
  ASSERT_EQ(ended(job), "done");
  const auto status = job.status();
  ASSERT_EQ(status["left_out"].size(), 1u);
  EXPECT_EQ(status["left_out"][0]["id"], "two");
  EXPECT_NE(status["left_out"][0]["why"].get<std::string>().find("checksum"), std::string::npos);
  EXPECT_EQ(status["tasks"], nlohmann::ordered_json({"trace"}));
  EXPECT_NE(job.file("study.html")->text.find("2 sessions"), std::string::npos);
  EXPECT_NE(job.file("sessions.csv")->text.find("\"three\""), std::string::npos);
  EXPECT_EQ(job.file("plot-trace.svg")->type, "image/svg+xml");
  for (const char* name : {"plot-.svg", "plot-knot.svg", "../x", ""}) EXPECT_FALSE(job.file(name)) << name;
}

TEST(StudyJob, NothingReadableIsAFailureAndARunCanBeCancelled) {
  StudyJob job([](const std::string& file) {
    std::this_thread::sleep_for(5ms);
    return made(file);
  });
  job.start({{"x", "damaged"}}, {});
  EXPECT_EQ(ended(job), "failed");
  job.start(std::vector<StudyJob::Choice>(500, {"one", "one.rec"}), {});
  EXPECT_THROW(job.start({{"one", "one.rec"}}, {}), InputError);
  job.cancel();
  EXPECT_EQ(ended(job), "cancelled");
  EXPECT_FALSE(job.file("study.json"));
}

}  // namespace study_job_test
}  // namespace filum
