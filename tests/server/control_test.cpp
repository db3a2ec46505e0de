#include "server/control.h"

#include <gtest/gtest.h>

namespace filum {
namespace control_test {

TEST(Control, FirstOneControlsTheOthersWatch) {
  Control control;
  control.join(1);
  control.join(2);
  EXPECT_EQ(control.controller(), 0);
  EXPECT_TRUE(control.acquire(2, false));
  EXPECT_TRUE(control.in_control(2));
  EXPECT_FALSE(control.acquire(1, false));
  EXPECT_TRUE(control.in_control(2));
  EXPECT_TRUE(control.acquire(2, false));
  EXPECT_EQ(control.clients(), 2);
}

TEST(Control, TakesOverOnlyOpenly) {
  Control control;
  control.join(1);
  control.join(2);
  control.acquire(1, false);
  EXPECT_TRUE(control.acquire(2, true));
  EXPECT_FALSE(control.in_control(1));
  EXPECT_FALSE(control.acquire(1, false));
}

TEST(Control, LeavingFreesControlAndStrangersHaveNone) {
  Control control;
  control.join(1);
  control.join(2);
  control.acquire(1, false);
  control.leave(2);
  EXPECT_TRUE(control.in_control(1));
  control.leave(1);
  EXPECT_EQ(control.controller(), 0);
  EXPECT_EQ(control.clients(), 0);
  EXPECT_FALSE(control.acquire(1, true));
}

TEST(FrameCredit, TwoFramesAreUnderWayAtMost) {
  FrameCredit credit;
  EXPECT_TRUE(credit.available());
  EXPECT_EQ(credit.take(), 1u);
  EXPECT_EQ(credit.take(), 2u);
  EXPECT_FALSE(credit.available());
  credit.ack(1);
  EXPECT_TRUE(credit.available());
  EXPECT_EQ(credit.take(), 3u);
  EXPECT_FALSE(credit.available());
}

TEST(FrameCredit, ForgedAndRepeatedAcksGiveNothing) {
  FrameCredit credit;
  credit.take();
  credit.take();
  credit.ack(99);
  EXPECT_FALSE(credit.available());
  credit.ack(2);
  credit.ack(1);
  credit.ack(2);
  credit.take();
  credit.take();
  EXPECT_FALSE(credit.available());
}

}  // namespace control_test
}  // namespace filum
