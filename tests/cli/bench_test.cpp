// filum bench: the keys of the contract and that they agree with one another; no speed is asked for, the machine may be busy.

#include <gtest/gtest.h>

#include <algorithm>

#include "program_call.h"

namespace filum {
namespace bench_test {

TEST(Bench, JsonHoldsTheKeysOfTheContract) {
  const auto d = call({"bench", "--json", "rod-100"}).json();
  expect_keys(d, {"machine", "benches"});
  ASSERT_EQ(d["benches"].size(), 1u);
  const auto& b = d["benches"][0];
  expect_keys(b, {"name", "nodes", "contacts", "dt_ms", "steps", "p50_ms", "p99_ms", "max_ms", "real_time_factor", "stages", "reference"});
  expect_keys(b["reference"], {"name", "p50_ms"});
  EXPECT_EQ(b["name"], "rod-100");
  EXPECT_EQ(b["nodes"], 100);
  EXPECT_GT(b["steps"], 0);
  EXPECT_LE(b["p50_ms"], b["p99_ms"]);
  EXPECT_LE(b["p99_ms"], b["max_ms"]);
  EXPECT_GT(b["p50_ms"], 0.0);
}

TEST(Bench, WildHandsAreCountedByTask) {
  const auto d = call({"bench", "--json", "--wild", "2", "--wild-seconds", "0.02", "grasp-transfer"}).json();
  expect_keys(d, {"machine", "wild"});
  ASSERT_EQ(d["wild"].size(), 1u);
  EXPECT_EQ(d["wild"][0]["task"], "grasp-transfer");
  EXPECT_EQ(d["wild"][0]["seeds"], 2);
  EXPECT_NEAR(d["wild"][0]["scene_s"].get<double>(), 0.04, 1e-9);
  EXPECT_TRUE(d["wild"][0]["faults"].empty());
}

TEST(Bench, WildHandsBeginAtAnySeed) {
  const auto fastest = [](const std::string& first, const std::string& seeds) {
    const auto d = call({"bench", "--json", "--wild", seeds, "--wild-first", first, "--wild-seconds", "0.1", "knot-throw"}).json();
    EXPECT_EQ(d["wild"][0]["first_seed"].dump(), first);
    return d["wild"][0]["fastest_m_per_s"].get<double>();
  };
  const double one = fastest("1", "1"), two = fastest("2", "1");
  EXPECT_NE(one, two);
  EXPECT_EQ(fastest("1", "2"), std::max(one, two));
}

TEST(Bench, WhatItDoesNotKnowIsRefused) {
  expect_refused({"bench", "--json", "warp-drive"}, {"found warp-drive", "expected", "rod-100"});
  expect_refused({"bench", "--wild", "0"}, {"--wild"});
  expect_refused({"bench", "--wild", "1", "--wild-first", "0"}, {"--wild-first"});
  expect_refused({"bench", "--wild", "1", "--wild-sewn", "3", "grasp-transfer"}, {"--wild-sewn", "found task grasp-transfer", "two vessels"});
  expect_refused({"bench", "--json", "--wild", "1", "no-such-task"}, {"found no-such-task", "knot-square"});
}

}  // namespace bench_test
}  // namespace filum
