#include "session/records.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/session/synthetic.h"

namespace filum {
namespace records_test {

TEST(Records, StepsSurvivePackingBitForBit) {
  std::vector<StepRecord> records;
  for (std::uint64_t i = 1; i <= 100; ++i) records.push_back(synthetic::step(i));
  records[3].inputs.tools[1].grip_angle = -0.0;
  records[4].inputs.tools[0].X_WD.p.x() = std::numeric_limits<double>::denorm_min();
  std::vector<char> bytes;
  pack(records, 2, bytes);
  std::vector<StepRecord> back;
  ASSERT_TRUE(unpack(bytes, records.size(), 2, back));
  ASSERT_EQ(back.size(), records.size());
  for (std::size_t i = 0; i < records.size(); ++i) EXPECT_TRUE(synthetic::same(records[i], back[i])) << i;
  EXPECT_TRUE(std::signbit(back[3].inputs.tools[1].grip_angle));
}

TEST(Records, InputsOfToolsThatAreNotThereAreNotStored) {
  const std::vector<StepRecord> records{synthetic::step(1)};
  std::vector<char> two;
  std::vector<char> none;
  pack(records, 2, two);
  pack(records, 0, none);
  EXPECT_LT(none.size() + 100, two.size());
  std::vector<StepRecord> back;
  ASSERT_TRUE(unpack(none, 1, 0, back));
  EXPECT_FALSE(back[0].inputs.tools[0].valid);
  EXPECT_FALSE(unpack(none, 1, 2, back));
  EXPECT_FALSE(unpack(two, 1, 1, back));
}

TEST(Records, SamplesEventsAndHashesSurvivePacking) {
  std::vector<SampleRecord> samples;
  std::vector<EventRecord> events;
  std::vector<ArrayHashRecord> hashes;
  for (std::uint64_t i = 1; i <= 60; ++i) {
    samples.push_back(synthetic::sample(i));
    events.push_back(synthetic::event(i));
    hashes.push_back({i, "positions", i * 7919});
  }
  std::vector<char> bytes;
  std::vector<SampleRecord> samples_back;
  pack(samples, bytes);
  ASSERT_TRUE(unpack(bytes, 60, samples_back));
  for (std::size_t i = 0; i < 60; ++i) EXPECT_TRUE(synthetic::same(samples[i], samples_back[i])) << i;
  std::vector<EventRecord> events_back;
  pack(events, bytes);
  ASSERT_TRUE(unpack(bytes, 60, events_back));
  for (std::size_t i = 0; i < 60; ++i) EXPECT_TRUE(synthetic::same(events[i], events_back[i])) << i;
  std::vector<ArrayHashRecord> hashes_back;
  pack(hashes, bytes);
  ASSERT_TRUE(unpack(bytes, 60, hashes_back));
  EXPECT_EQ(hashes_back[59].hash, 60u * 7919);
  EXPECT_EQ(hashes_back[59].name.view(), "positions");
}

TEST(Records, BytesOfAnotherLengthAreRefused) {
  const std::vector<EventRecord> events{synthetic::event(1), synthetic::event(2)};
  std::vector<char> bytes;
  pack(events, bytes);
  std::vector<EventRecord> back;
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(unpack(std::span<const char>(bytes).first(n), 2, back)) << n;
  EXPECT_FALSE(unpack(bytes, 1, back));
  EXPECT_FALSE(unpack(bytes, 3, back));
  EXPECT_TRUE(unpack(bytes, 2, back));
}

TEST(Records, ATextWithAZeroWithinIsRefused) {
  const std::vector<EventRecord> events{{3, 0.006, "throw", 1, 1.0, "-", "square"}};
  std::vector<char> bytes;
  pack(std::span<const EventRecord>(events), bytes);
  std::vector<EventRecord> read;
  ASSERT_TRUE(unpack(bytes, 1, read));
  bytes[bytes.size() - 3] = '\0';
  EXPECT_FALSE(unpack(bytes, 1, read));
}

TEST(Records, FixedTextCutsAndCompares) {
  const FixedText<5> text("abcdefgh");
  EXPECT_EQ(text.view(), "abcd");
  EXPECT_EQ(FixedText<5>("abc\u00e9").view(), "abc") << "no half of a character";
  EXPECT_EQ(FixedText<6>("abc\u00e9").view(), "abc\u00e9");
  EXPECT_EQ(FixedText<5>(""), FixedText<5>());
  EXPECT_FALSE(text == FixedText<5>("abce"));
}

TEST(Records, ParticipantsAreCodes) {
  for (const char* good : {"A17", "a_b-3", "x", "12345678901234567890123456789012"})
    EXPECT_TRUE(is_participant_code(good));
  for (const char* bad : {"", "Jane Doe", "a.b", "../x", "\xC3\xA9", "123456789012345678901234567890123"})
    EXPECT_FALSE(is_participant_code(bad)) << bad;
}

}  // namespace records_test
}  // namespace filum
