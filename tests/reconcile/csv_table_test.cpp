#include "reconcile/csv_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace filum::reconcile {
namespace csv_table_test {

/// Quotes may hold quotes, commas and line ends; what stands between blanks is the cell. A byte order mark is no part of the first name.
TEST(CsvTable, CellsAreWhatStandsInQuotesOrBetweenBlanks) {
  const CsvTable t = CsvTable::parse("\xEF\xBB\xBF t ,\"the \"\"force\"\", N\"\r\n x , 2\n\"1\",\t\n", "a.csv");
  EXPECT_EQ(t.header, (std::vector<std::string>{"t", "the \"force\", N"}));
  ASSERT_EQ(t.rows(), 2u);
  EXPECT_EQ(t.cell(0, 1), "2");
  EXPECT_EQ(t.cell(1, 0), "1");
  EXPECT_EQ(t.cell(1, 1), "");
  EXPECT_EQ(t.line, (std::vector<int>{2, 3}));
  EXPECT_TRUE(std::isnan(t.numbers(1)[1]));
  EXPECT_EQ(CsvTable::parse("\"a\"\"b\",c\n\"x\n\"\"y\"\"\",3\n7,8\n", "a.csv").cell(0, 0), "x\n\"y\"");
  EXPECT_EQ(CsvTable::parse("\"a\"\"b\",c\n\"x\n\"\"y\"\"\",3\n7,8\n", "a.csv").line, (std::vector<int>{2, 4}));
}

TEST(CsvTable, MoreRowsThanAreReadAreRefused) {
  EXPECT_EQ(CsvTable::parse("a\n1\n2\n3\n", "a.csv", 3).rows(), 3u);
  try {
    CsvTable::parse("a\n1\n2\n3\n4\n", "a.csv", 3);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a.csv:5: rows: found more than 3, expected at most 3 rows"), std::string::npos) << error.what();
  }
}

}  // namespace csv_table_test
}  // namespace filum::reconcile
