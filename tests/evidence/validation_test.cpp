#include "evidence/validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"

namespace filum {
namespace validation_test {

/// Problems that ask several things of one solution are run together, under the name that all of them begin with.
std::vector<std::string> runs() {
  const std::vector<std::string> families{"cantilever-self-weight", "cantilever-tip-load", "euler-strut", "localized-helix-long", "localized-helix-short", "momentum", "plectoneme", "vessel-hgo-closed", "vessel-hgo-opened", "vessel-opening-ring", "vessel-hgo-stress-closed", "vessel-hgo-stress-opened"};
  std::vector<std::string> names;
  for (const std::string& name : validation_names()) {
    std::string run = name;
    for (const std::string& family : families)
      if (name.starts_with(family + "-")) run = family;
    if (names.empty() || names.back() != run) names.push_back(run);
  }
  return names;
}

class EveryProblem : public testing::TestWithParam<std::string> {};

TEST_P(EveryProblem, IsWithinTheToleranceStatedWithIt) {
  const std::set<std::string> long_ones{"overhand-knot-2", "overhand-knot-4", "trefoil-smooth", "trefoil-0.02", "linking-number"};
  if (long_ones.contains(GetParam()))
    GTEST_SKIP() << "too long for a test; filum validate " << GetParam() << " runs it";
  const auto solved = run_validation({GetParam()});
  EXPECT_FALSE(solved.empty());
  for (const ValidationProblem& p : solved) {
    EXPECT_TRUE(p.passed) << p.name << ", " << p.quantity << ": expected " << p.expected << ", got " << p.got << ", error "
                          << p.error << ", tolerance " << p.tolerance << ", order " << p.order.value_or(0.0);
    EXPECT_FALSE(p.source.empty()) << p.name;
    EXPECT_FALSE(p.quantity.empty()) << p.name;
    EXPECT_FALSE(p.unit.empty()) << p.name;
    EXPECT_GT(p.tolerance, 0.0) << p.name;
    EXPECT_GT(p.seconds, 0.0) << p.name;
    EXPECT_TRUE(p.order || !p.note.empty()) << p.name << " has no order of convergence and does not say why";
  }
}

INSTANTIATE_TEST_SUITE_P(Validation, EveryProblem, testing::ValuesIn(runs()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             if (c == '-' || c == '.') c = '_';
                           return name;
                         });

/// No problem falls between the runs.
TEST(Validation, EveryNameIsRun) {
  const auto names = runs();
  for (const std::string& name : validation_names())
    EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const std::string& run) { return name == run || name.starts_with(run + "-"); })) << name;
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Validation, NamesAreUnique) {
  const auto names = validation_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Validation, ANameStandsForThoseThatBeginWithIt) {
  const auto solved = run_validation({"michell-ring"});
  EXPECT_EQ(solved.size(), 4u);
}

TEST(Validation, AnUnknownNameIsRefusedAndTheKnownOnesAreNamed) {
  try {
    run_validation({"mich"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.value, "mich");
    EXPECT_NE(error.expected.find("bending-energy"), std::string::npos);
  }
}

TEST(Validation, WhatMissesItsToleranceFails) {
  ValidationProblem p;
  p.expected = 2.0;
  p.tolerance = 0.01;
  p.got = 2.019;
  p.judge();
  EXPECT_TRUE(p.passed);
  EXPECT_NEAR(p.error, 0.0095, 1e-12);
  p.got = 2.021;
  p.judge();
  EXPECT_FALSE(p.passed);
  p.got = std::numeric_limits<double>::quiet_NaN();
  p.judge();
  EXPECT_FALSE(p.passed);
}

TEST(Validation, AnOrderBelowTheOneStatedFails) {
  ValidationProblem p;
  p.expected = p.got = 1.0;
  p.least_order = 1.8;
  p.judge();
  EXPECT_FALSE(p.passed);
  p.order = 1.5;
  p.judge();
  EXPECT_FALSE(p.passed);
  p.order = 1.9;
  p.judge();
  EXPECT_TRUE(p.passed);
}

}  // namespace validation_test
}  // namespace filum
