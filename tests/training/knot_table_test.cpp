#include "training/knot_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "training/knot_invariant.h"

namespace filum {
namespace knot_table_test {

TEST(KnotTable, FindsTheThrowsOfASum) {
  EXPECT_EQ(throws_of(jones_torus(3) * jones_torus(-3)), (std::vector<int>{3, -3}));
  EXPECT_EQ(throws_of(jones_torus(-3) * jones_torus(5)), (std::vector<int>{5, -3}));
  EXPECT_EQ(throws_of(jones_torus(7)), (std::vector<int>{7}));
  EXPECT_TRUE(throws_of(Laurent::monomial(1, 0)).empty());
  EXPECT_TRUE(throws_of(Laurent(-2, {1, -1, 1, -1, 1})).empty());  // figure-eight knot
}

TEST(KnotTable, NoTwoStacksShareAPolynomial) {
  const std::vector<int> kinds = {7, -7, 5, -5, 3, -3};
  for (int a : kinds) {
    for (int b : kinds) {
      for (int c : kinds) {
        std::vector<int> throws = {a, b, c},
                         found = throws_of(jones_torus(a) * jones_torus(b) * jones_torus(c));
        std::sort(throws.begin(), throws.end());
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, throws);
      }
    }
  }
}

/// Two knots in one thread are a sum of up to six.
TEST(KnotTable, EverySumOfUpToSixThrowsIsToldFromAllOthers) {
  const std::vector<int> kinds = {7, -7, 5, -5, 3, -3};
  int sums = 0;
  std::function<void(const std::vector<int>&, const Laurent&, std::size_t)> extend = [&](const std::vector<int>& throws, const Laurent& jones, std::size_t from) {
    EXPECT_EQ(throws_of(jones), throws);
    ++sums;
    if (throws.size() == 6) return;
    for (std::size_t k = from; k < kinds.size(); ++k) {
      std::vector<int> more = throws;
      more.push_back(kinds[k]);
      extend(more, jones * jones_torus(kinds[k]), k);
    }
  };
  extend({}, Laurent::monomial(1, 0), 0);
  EXPECT_EQ(sums, 924) << "ways to take up to six of six kinds";
}

TEST(KnotTable, ReadsANestOfThrowsFromThePostOutwards) {
  // A single throw (crossings 0-2, left-handed) outside a double one (3-7, right-handed).
  KnotDiagram d;
  d.sign = {-1, -1, -1, 1, 1, 1, 1, 1};
  for (int c : {0, 1, 2, 3, 4, 5, 6, 7, 3, 4, 5, 6, 7, 0, 1, 2}) {
    d.code.push_back({c, d.code.size() % 2 == 0});
  }
  EXPECT_EQ(stacked_throws(d), (std::vector<int>{5, -3}));
  d.sign[1] = 1;  // a throw's crossings are of one hand
  EXPECT_TRUE(stacked_throws(d).empty());
}

TEST(KnotTable, NotationAndClasses) {
  EXPECT_EQ(composition_of({3, -3}), "1=1");
  EXPECT_EQ(composition_of({-5, -3}), "2x1");
  EXPECT_EQ(composition_of({5, -3, 3}), "2=1=1");
  EXPECT_EQ(class_of({}, true), "unknot");
  EXPECT_EQ(class_of({-3}, true), "overhand");
  EXPECT_EQ(class_of({3, -3}, true), "square");
  EXPECT_EQ(class_of({3, 3}, true), "granny");
  EXPECT_EQ(class_of({5, -3}, true), "surgeons");
  EXPECT_EQ(class_of({-3, 5}, true), "other");
  EXPECT_EQ(class_of({5, 3}, true), "other");
  EXPECT_EQ(class_of({3, -3, 3}, true), "triple");
  EXPECT_EQ(class_of({3, 3, -3}, true), "other");
  EXPECT_EQ(class_of({5}, true), "other");
}

}  // namespace knot_table_test
}  // namespace filum
