#include "training/patency_factors.h"

#include <gtest/gtest.h>

#include <string>

namespace filum {
namespace patency_factors_test {

const PatencyFactor& of(const std::vector<PatencyFactor>& all, const std::string& name) {
  for (const PatencyFactor& f : all)
    if (name == f.name) return f;
  throw std::out_of_range(name);
}

TEST(PatencyFactors, AreNamedWithTheirNumberAndNothingIsConcluded) {
  NeedleReport r;
  r.has_tissue = true;
  EXPECT_TRUE(patency_factors(r).empty()) << "without a vessel under pressure there is nothing to say";
  r.join = JoinReport{};
  r.join->patent = true;
  for (const PatencyFactor& f : patency_factors(r)) {
    EXPECT_FALSE(f.raised) << f.name;
    EXPECT_STRNE(f.source, "") << f.name;
  }
  r.join->narrowing = 0.4;
  r.handling.walls = 2;
  r.lapses = {{"back-wall", 1, 3.0, 120.0, "deg"}, {"back-wall", 2, 4.0, 130.0, "deg"}, {"wide-bite", 2, 4.0, 5.0, "thicknesses"}};
  const auto all = patency_factors(r);
  EXPECT_TRUE(of(all, "back-wall").raised);
  EXPECT_EQ(of(all, "back-wall").value, 2.0);
  EXPECT_TRUE(of(all, "wall-grasped").raised);
  EXPECT_EQ(of(all, "wall-grasped").value, 2.0);
  EXPECT_TRUE(of(all, "narrowing").raised);
  EXPECT_DOUBLE_EQ(of(all, "narrowing").value, 40.0);
  EXPECT_FALSE(of(all, "too-tight").raised);
  EXPECT_FALSE(of(all, "not-patent").raised);
}

}  // namespace patency_factors_test
}  // namespace filum
