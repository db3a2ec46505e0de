#include "base/exchange.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace filum {
namespace exchange_test {

TEST(Queue, KeepsOrderAndRefusesWhenFull) {
  Queue<int> queue(3);
  int item = 0;
  EXPECT_FALSE(queue.pop(item));
  EXPECT_TRUE(queue.push(1));
  EXPECT_TRUE(queue.push(2));
  EXPECT_TRUE(queue.push(3));
  EXPECT_FALSE(queue.push(4));
  for (const int expected : {1, 2, 3}) {
    ASSERT_TRUE(queue.pop(item));
    EXPECT_EQ(item, expected);
  }
  EXPECT_FALSE(queue.pop(item));
}

TEST(Queue, WrapsRoundManyTimes) {
  Queue<int> queue(2);
  int item = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(queue.push(i));
    ASSERT_TRUE(queue.pop(item));
    ASSERT_EQ(item, i);
  }
}

TEST(Queue, TwoThreadsLoseAndReorderNothing) {
  Queue<std::uint64_t> queue(64);
  constexpr std::uint64_t kItems = 200000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kItems; ++i)
      while (!queue.push(i)) std::this_thread::yield();
  });
  std::uint64_t expected = 1;
  std::uint64_t item = 0;
  bool in_order = true;
  while (expected <= kItems) {
    if (!queue.pop(item)) {
      std::this_thread::yield();
      continue;
    }
    in_order = in_order && item == expected;
    ++expected;
  }
  writer.join();
  EXPECT_TRUE(in_order);
  EXPECT_FALSE(queue.pop(item));
}

TEST(Latest, ReadsTheInitialValueThenTheNewest) {
  Latest<int> slot(7);
  EXPECT_FALSE(slot.fresh());
  EXPECT_EQ(slot.read(), 7);
  slot.write_slot() = 8;
  slot.publish();
  slot.write_slot() = 9;
  slot.publish();
  EXPECT_TRUE(slot.fresh());
  EXPECT_EQ(slot.read(), 9);
  EXPECT_FALSE(slot.fresh());
  EXPECT_EQ(slot.read(), 9);
}

TEST(Latest, NeverShowsAHalfWrittenValueNorGoesBack) {
  using Block = std::array<std::uint64_t, 32>;
  Latest<Block> slot(Block{});
  constexpr std::uint64_t kWrites = 100000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) {
      slot.write_slot().fill(i);
      slot.publish();
    }
  });
  bool whole = true;
  bool forward = true;
  std::uint64_t last = 0;
  while (last < kWrites) {
    const Block& block = slot.read();
    for (const std::uint64_t x : block) whole = whole && x == block[0];
    forward = forward && block[0] >= last;
    last = block[0];
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(forward);
}

}  // namespace exchange_test
}  // namespace filum
