#include "analysis/agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace filum {
namespace agreement_test {

// Six targets, four judges: table 2 of Shrout and Fleiss 1979, whose ICC(2,1) is 0.29.
TEST(Agreement, IccIsThatOfShroutAndFleiss) {
  Eigen::MatrixXd x(6, 4);
  x << 9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7;
  EXPECT_NEAR(icc_2_1(x), 0.29, 0.005);
}

// By the definition: 1 - sum w o / sum w e with w = (i - j)^2 over a table of counts.
TEST(Agreement, KappaIsThatOfTheTable) {
  const int table[3][3] = {{4, 1, 0}, {2, 5, 1}, {0, 3, 6}};
  std::vector<double> a, b;
  double n = 0.0, rows[3] = {}, columns[3] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      a.insert(a.end(), static_cast<std::size_t>(table[i][j]), i);
      b.insert(b.end(), static_cast<std::size_t>(table[i][j]), j);
      n += table[i][j];
      rows[i] += table[i][j];
      columns[j] += table[i][j];
    }
  double seen = 0.0, chance = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      seen += (i - j) * (i - j) * table[i][j] / n;
      chance += (i - j) * (i - j) * rows[i] * columns[j] / (n * n);
    }
  EXPECT_NEAR(weighted_kappa(a, b), 1.0 - seen / chance, 1e-12);
  EXPECT_NEAR(weighted_kappa(a, a), 1.0, 1e-12);
  EXPECT_NEAR(weighted_kappa({0, 0, 2, 2}, {0, 2, 0, 2}), 0.0, 1e-12) << "no better than chance";
  EXPECT_TRUE(std::isnan(weighted_kappa({1, 1, 1}, {1, 1, 1}))) << "points that do not vary say nothing";
}

Rating rating(int session, const std::string& rater, int closure, int knots) {
  Rating r{"s" + std::to_string(session), "anastomosis-8", "mars10", rater, "2026-11-22T00:00:00Z", {{"closure", closure}}};
  if (knots >= 0) r.marks.push_back({"knots", knots});
  return r;
}

const Agreement* find(const std::vector<Agreement>& all, const std::string& item, const std::string& a, const std::string& b) {
  for (const Agreement& g : all)
    if (g.item == item && g.a == a && g.b == b) return &g;
  return nullptr;
}

TEST(Agreement, PairsRatersWithEachOtherAndWithTheSimulator) {
  std::vector<Rating> ratings;
  for (int s = 0; s < 9; ++s) {
    ratings.push_back(rating(s, "R1", s % 3, 2 - s % 3));
    ratings.push_back(rating(s, "R2", s % 3, s == 4 ? 0 : 2 - s % 3));
    ratings.push_back(rating(s, "simulator", std::min(2, s % 3 + 1), -1));
    if (s > 0) ratings.push_back(rating(s, "R3", s % 3, 1));
  }
  const std::vector<Agreement> all = agreements(ratings);
  const Agreement* people = find(all, "closure", "R1", "R2");
  ASSERT_NE(people, nullptr);
  EXPECT_EQ(people->sessions, 9);
  EXPECT_EQ(people->kappa, 1.0);
  EXPECT_EQ(people->icc, 1.0);
  EXPECT_EQ(people->low, 1.0);
  const Agreement* simulator = find(all, "closure", "R1", "simulator");
  ASSERT_NE(simulator, nullptr);
  EXPECT_NEAR(simulator->bias, -2.0 / 3.0, 1e-12) << "the simulator is kinder";
  EXPECT_NEAR(simulator->same, 1.0 / 3.0, 1e-12);
  EXPECT_LT(simulator->kappa, 1.0);
  EXPECT_LT(simulator->low, simulator->kappa);
  EXPECT_GT(simulator->high, simulator->kappa);
  EXPECT_EQ(find(all, "knots", "R1", "simulator"), nullptr) << "left to the rater";
  EXPECT_EQ(find(all, "total", "R1", "simulator"), nullptr) << "one item is no total";
  ASSERT_NE(find(all, "total", "R1", "R2"), nullptr);
  const Agreement* everybody = find(all, "closure", "raters", "");
  ASSERT_NE(everybody, nullptr);
  EXPECT_EQ(everybody->sessions, 8);
  EXPECT_EQ(everybody->raters, 3);
  EXPECT_EQ(everybody->icc, 1.0);
}

/// Items of 0 and 1: (p_o - p_e) / (1 - p_e) of Cohen 1960, from a table of both, either, neither.
TEST(Agreement, OfALapseItIsCohensUnweightedKappaAndScalesStandApart) {
  constexpr int kBoth = 7, kFirst = 2, kSecond = 4, kNeither = 12, kAll = 25;
  std::vector<Rating> ratings;
  for (int s = 0; s < kAll; ++s) {
    const int first = s < kBoth + kFirst ? 1 : 0, second = s < kBoth || (s >= kBoth + kFirst && s < kBoth + kFirst + kSecond) ? 1 : 0;
    ratings.push_back({"s" + std::to_string(s), "t", "lapse-index", "R1", "", {{"oblique", first}, {"closure", 0}}});
    ratings.push_back({"s" + std::to_string(s), "t", "lapse-index", "simulator", "", {{"oblique", second}}});
    ratings.push_back(rating(s, "R1", 1, 1));
  }
  const std::vector<Agreement> all = agreements(ratings);
  ASSERT_EQ(all.size(), 1u) << "marks by another scale are no second rater's";
  EXPECT_EQ(all[0].scale, "lapse-index");
  EXPECT_EQ(all[0].item, "oblique");
  const double n = kAll, seen = (kBoth + kNeither) / n;
  const double chance = (kBoth + kFirst) / n * (kBoth + kSecond) / n + (kNeither + kSecond) / n * (kNeither + kFirst) / n;
  EXPECT_NEAR(all[0].kappa, (seen - chance) / (1.0 - chance), 1e-12);
  EXPECT_NEAR(all[0].same, seen, 1e-12);
}

TEST(Agreement, FilesHaveARowForEachAndNoInventedNumber) {
  const std::vector<Rating> ratings = {rating(1, "R1", 2, 1), rating(1, "R2", 2, 1)};
  const std::vector<Agreement> all = agreements(ratings);
  EXPECT_EQ(agreement_csv(all),
            "scale,item,a,b,sessions,raters,same_share,bias_points,kappa,kappa_low,kappa_high,icc_2_1\r\n"
            "mars10,closure,R1,R2,1,2,1.0,0.0,,,,\r\nmars10,knots,R1,R2,1,2,1.0,0.0,,,,\r\nmars10,total,R1,R2,1,2,1.0,0.0,,,,\r\n");
  EXPECT_NE(ratings_csv(ratings).find("s1,anastomosis-8,mars10,R2,2026-11-22T00:00:00Z,knots,1\r\n"), std::string::npos);
  const auto json = agreement_json(all, ratings);
  EXPECT_TRUE(json["agreement"][0]["kappa"].is_null());
  EXPECT_EQ(json["ratings"][1]["marks"]["closure"], 2);
}

}  // namespace agreement_test
}  // namespace filum
