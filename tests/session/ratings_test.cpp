#include "session/ratings.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace ratings_test {

using synthetic::Folder;

Rating rating(const std::string& session, const std::string& rater, int closure, int knots) {
  return {session, "anastomosis-8", "mars10", rater, "", {{"closure", closure}, {"knots", knots}}};
}

TEST(Ratings, KeepsTheNewestOfEachRaterAndIsThereAgain) {
  const Folder folder;
  {
    Ratings r(folder.file(""));
    r.put(rating("s1", "R1", 1, 2));
    r.put(rating("s1", "R2", 2, 2));
    r.put(rating("s2", "R1", 0, 1));
    r.put(rating("s1", "R1", 0, 1));
  }
  const Ratings r(folder.file(""));
  const auto all = r.list();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].rater, "R1");
  ASSERT_EQ(all[0].marks.size(), 2u);
  EXPECT_EQ(all[0].marks[0].item, "closure");
  EXPECT_EQ(all[0].marks[0].points, 0) << "the newest counts";
  EXPECT_FALSE(all[0].stored_utc.empty());
  EXPECT_EQ(r.list("s2").size(), 1u);
  EXPECT_TRUE(r.list("'; DROP TABLE filum_marks; --").empty());
  EXPECT_EQ(r.list().size(), 3u);
}

TEST(Ratings, RefusesNamesAndEmptyForms) {
  const Folder folder;
  Ratings r(folder.file(""));
  EXPECT_THROW(r.put(rating("s1", "Jane Doe", 1, 1)), InputError);
  EXPECT_THROW(r.put(rating("s1", "", 1, 1)), InputError);
  EXPECT_THROW(r.put({"s1", "t", "mars10", "R1", "", {}}), InputError);
  EXPECT_TRUE(r.list().empty());
}

TEST(Ratings, ADamagedFileIsRefusedNotReplaced) {
  const Folder folder;
  std::ofstream(folder.file("ratings.sqlite"), std::ios::binary) << "rubbish";
  EXPECT_THROW(Ratings{folder.file("")}, InputError);
  std::ifstream in(folder.file("ratings.sqlite"));
  std::string text;
  in >> text;
  EXPECT_EQ(text, "rubbish");
}

}  // namespace ratings_test
}  // namespace filum
