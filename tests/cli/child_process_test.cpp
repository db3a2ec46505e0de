#include "cli/child_process.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace filum {
namespace child_process_test {

using Read = ChildProcess::Read;

TEST(ChildProcess, AnswersLineByLine) {
  ChildProcess cat({"/bin/cat"});
  std::string line;
  EXPECT_EQ(cat.receive(line, 10), Read::nothing);
  ASSERT_TRUE(cat.send("first"));
  ASSERT_TRUE(cat.send("second"));
  ASSERT_EQ(cat.receive(line, 5000), Read::line);
  EXPECT_EQ(line, "first");
  ASSERT_EQ(cat.receive(line, 5000), Read::line);
  EXPECT_EQ(line, "second");
}

TEST(ChildProcess, ItsEndAndItsTroublesAreTold) {
  ChildProcess shell({"/bin/sh", "-c", "echo last; echo trouble >&2"});
  std::string line;
  ASSERT_EQ(shell.receive(line, 5000), Read::line);
  EXPECT_EQ(line, "last");
  EXPECT_EQ(shell.receive(line, 5000), Read::ended);
  EXPECT_NE(shell.errors().find("trouble"), std::string::npos);
}

TEST(ChildProcess, AProgramThatIsNotThereIsRefused) {
  try {
    ChildProcess none({"/no/such/program"});
    std::string line;
    EXPECT_EQ(none.receive(line, 5000), Read::ended);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/program"), std::string::npos);
  }
}

}  // namespace child_process_test
}  // namespace filum
