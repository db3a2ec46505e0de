#include "devices/clock_sync.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace filum {
namespace clock_sync_test {

TEST(WideClock, GoesOnAfter71Minutes) {
  WideClock clock;
  std::int64_t truth = 4'290'000'000;  // just below 2^32
  for (int i = 0; i < 20'000; ++i, truth += 1000)
    ASSERT_EQ(clock.unwrap(static_cast<std::uint32_t>(truth)), truth);
  EXPECT_GT(truth, std::int64_t{1} << 32);
}

TEST(WideClock, FollowsASmallStepBackAcrossTheWrap) {
  WideClock clock;
  EXPECT_EQ(clock.unwrap(0xFFFFFFF0u), 0xFFFFFFF0LL);
  EXPECT_EQ(clock.unwrap(0x10u), 0x100000010LL);
  EXPECT_EQ(clock.unwrap(0xFFFFFFFFu), 0xFFFFFFFFLL);
}

TEST(WideClock, CountsManyTurns) {
  WideClock clock;
  std::int64_t truth = 17;
  for (int i = 0; i < 100; ++i, truth += 2'000'000'000)
    ASSERT_EQ(clock.unwrap(static_cast<std::uint32_t>(truth)), truth);
}

TEST(ClockSync, FindsTheOffsetWithinItsUncertaintyThroughJitter) {
  std::mt19937 random(4);
  std::exponential_distribution<double> delay(1.0 / 2000.0);  // [us]
  const std::int64_t offset = -123'456'789;
  ClockSync sync;
  EXPECT_FALSE(sync.known());
  for (int i = 0; i < 200; ++i) {
    const std::int64_t sent = 1'000'000LL * i;
    const std::int64_t arrived = sent + 100 + static_cast<std::int64_t>(delay(random));
    const std::int64_t back = arrived + 100 + static_cast<std::int64_t>(delay(random));
    sync.pong(sent, arrived + offset, back);
    ASSERT_TRUE(sync.known());
    ASSERT_LE(std::llabs(sync.offset_us() - offset), sync.uncertainty_us()) << "after " << i + 1;
  }
  EXPECT_LT(sync.uncertainty_us(), 2000);
}

TEST(ClockSync, FollowsAClockThatDrifts) {
  ClockSync sync;
  for (int i = 0; i < 100; ++i)
    sync.pong(1'000'000LL * i, 1'000'000LL * i + 50 * i + 200, 1'000'000LL * i + 400);
  EXPECT_NEAR(static_cast<double>(sync.offset_us()), 50.0 * 99, 50.0 * 16);  // at most 16 exchanges old
}

TEST(ClockSync, IgnoresAnswersThatCannotBe) {
  ClockSync sync;
  sync.pong(1000, 5, 900);               // back before it left
  sync.pong(1000, 5, 1000 + 1'000'001);  // another boot's ping
  EXPECT_FALSE(sync.known());
}

}  // namespace clock_sync_test
}  // namespace filum
