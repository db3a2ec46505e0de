#include "cli/reconcile_job.h"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/rng.h"
#include "tests/reconcile/records.h"

namespace filum {
namespace reconcile_job_test {

using reconcile::Folder;

/// A block that relaxes (Zener, share 0.4, 2 s), four records at two rates of `samples` each.
void write_block(const Folder& all, const std::string& name, int samples) {
  std::filesystem::create_directories(all.file(name));
  all.write(name + "/experiment.yaml", reconcile::block_yaml("  - { file: a.csv, protocol: { mode: compression, rate: \"1 mm/s\" }, repeat: A }\n  - { file: b.csv, protocol: { mode: compression, rate: \"1 mm/s\" }, repeat: A }\n"
                                                             "  - { file: c.csv, protocol: { mode: compression, rate: \"8 mm/s\" }, repeat: B }\n  - { file: d.csv, protocol: { mode: compression, rate: \"8 mm/s\" }, repeat: B }\n"));
  Rng rng(1);
  for (const auto& [file, speed] : {std::pair{"a.csv", 1.0}, {"b.csv", 1.0}, {"c.csv", 8.0}, {"d.csv", 8.0}}) {
    double q = 0, last_t = 0, last_f = 0;
    all.write(name + "/" + file, reconcile::block_csv([&](double t, double u, int i) {
                const double force = 5.0 * u, dt = t - last_t;
                if (i > 0) q = (q * (1 - 0.25 * dt) + 0.25 * dt * (force + last_f)) / (1 + 0.25 * dt);
                last_t = t, last_f = force;
                return force - 0.4 * q + 0.03 * rng.normal();
              }, speed, samples));
  }
}

std::string state_when_over(ReconcileJob& job) {
  for (;;) {
    const auto status = job.status();
    if (status["job"]["state"] != "running") return status["job"]["state"];
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

TEST(ReconcileJob, RunsADatasetOfItsFolderAndKeepsItsReport) {
  Folder data, reports;
  write_block(data, "block", 200);
  std::filesystem::create_directories(data.file("no-dataset"));
  ReconcileJob job(data.path(), reports.path(), FILUM_SOURCE_DIR);
  ASSERT_EQ(job.status()["datasets"].size(), 1u);
  EXPECT_TRUE(job.status()["datasets"][0]["report"].is_null());
  EXPECT_FALSE(job.file("block", "report.html"));
  job.start("block");
  EXPECT_EQ(state_when_over(job), "done");
  const auto report = job.status()["datasets"][0]["report"];
  EXPECT_EQ(report["verdict"], "effect");
  EXPECT_EQ(report["effects"][0], "viscoelastic-relaxation");
  EXPECT_NE(job.file("block", "report.html")->find("viscoelastic-relaxation"), std::string::npos);
  EXPECT_NE(job.file("block", "model.yaml")->find("filum-model/1"), std::string::npos);
  EXPECT_FALSE(job.file("../block", "report.html"));
  EXPECT_FALSE(job.file("block", "../block/report.json"));
}

TEST(ReconcileJob, IsCancelledWithoutAReportAndRefusesWhatItDoesNotKnow) {
  Folder data, reports;
  write_block(data, "long", 6000);
  ReconcileJob job(data.path(), reports.path(), FILUM_SOURCE_DIR);
  EXPECT_THROW(job.start("none"), InputError);
  EXPECT_THROW(job.start("../long"), InputError);
  job.start("long");
  EXPECT_THROW(job.start("long"), InputError) << "one at a time";
  job.cancel();
  EXPECT_EQ(state_when_over(job), "cancelled");
  EXPECT_FALSE(std::filesystem::exists(reports.file("long")));
}

TEST(ReconcileJob, SaysWhyADatasetIsRefused) {
  Folder data, reports;
  write_block(data, "bad", 50);
  data.write("bad/b.csv", "t,u\n0,1\n");
  ReconcileJob job(data.path(), reports.path(), FILUM_SOURCE_DIR);
  job.start("bad");
  EXPECT_EQ(state_when_over(job), "failed");
  EXPECT_NE(job.status()["job"]["message"].get<std::string>().find("b.csv"), std::string::npos);
}

}  // namespace reconcile_job_test
}  // namespace filum
