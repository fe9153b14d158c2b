// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/reorder_buffer.hpp"

#include "common/messages/codec.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

Message at(std::int64_t utime_us, std::string channel = "A") {
  return {std::move(channel), timestamp_from_us(utime_us), {}};
}

constexpr std::int64_t kSecond_us = 1'000'000;

/// Channel "A" every 50 ms for 10 s: the released and the expected messages.
struct Streamed {
  explicit Streamed(const std::map<int, std::int64_t>& wrong_by_us) {
    ReorderBuffer buffer{Duration{150'000}};
    for (int i = 0; i < 200; ++i) {
      const auto wrong = wrong_by_us.find(i);
      const std::int64_t utime_us = 50'000 * i;
      keep(buffer.add(at(utime_us + (wrong == wrong_by_us.end() ? 0 : wrong->second)), counters));
      keep(buffer.add(at(utime_us, "B"), counters));
    }
    keep(buffer.flush());
  }

  void keep(const std::vector<Message>& messages) {
    for (const Message& message : messages)
      ++released[message.channel];
  }

  Counters counters{};
  std::map<std::string, int> released{};
};

TEST(ReorderBuffer, SortsWithinItsWindowAndDropsWhatIsLate) {
  Counters counters;
  ReorderBuffer buffer{Duration{100}};
  EXPECT_TRUE(buffer.add(at(1000), counters).empty());
  EXPECT_TRUE(buffer.add(at(1050), counters).empty());
  EXPECT_TRUE(buffer.add(at(1020), counters).empty());
  const auto released = buffer.add(at(1150), counters);
  ASSERT_EQ(released.size(), 3U);
  EXPECT_EQ(released[1].time, timestamp_from_us(1020));
  EXPECT_TRUE(buffer.add(at(1040), counters).empty());
  EXPECT_EQ(counters.get("A late, dropped"), 1);
  EXPECT_EQ(counters.total(CountKind::kLoss), 1);
  EXPECT_EQ(buffer.flush().size(), 1U);
}

TEST(ReorderBuffer, AMessageOlderThanOtherChannelsIsReleasedIfItsOwnIsInOrder) {
  Counters counters;
  ReorderBuffer buffer{Duration{100}};
  buffer.add(at(1000, "SENSOR"), counters);
  EXPECT_EQ(buffer.add(at(2000, "SENSOR"), counters).size(), 1U);
  EXPECT_EQ(buffer.add(at(900, "ANSWER"), counters).size(), 1U);
  EXPECT_EQ(buffer.add(at(950, "ANSWER"), counters).size(), 1U);
  EXPECT_TRUE(buffer.add(at(940, "ANSWER"), counters).empty());
  EXPECT_EQ(counters.get("ANSWER late, dropped"), 1);
}

TEST(ReorderBuffer, AfterAClockStepMessagesAreReleasedAgain) {
  constexpr std::int64_t kHour_us = 3'600'000'000;
  for (const std::int64_t step_us : {-kHour_us, kHour_us}) {
    Counters counters;
    ReorderBuffer buffer{Duration{0}};
    int released = 0;
    for (std::int64_t i = 0; i < 200; ++i) {
      const std::int64_t utime = 2 * kHour_us + 100'000 * i + (i < 100 ? 0 : step_us);
      released += static_cast<int>(buffer.add(at(utime, i % 2 ? "A" : "B"), counters).size());
    }
    EXPECT_EQ(counters.get("clock was set"), 1) << step_us;
    EXPECT_GT(released, 170) << step_us;
  }
}

TEST(ReorderBuffer, AClockJumpOfOneSenderDoesNotBlockTheOthers) {
  Counters counters;
  ReorderBuffer buffer{Duration{0}};
  EXPECT_EQ(buffer.add(at(1000), counters).size(), 1U);
  EXPECT_TRUE(buffer.add(at(3'600'000'000), counters).empty());
  EXPECT_EQ(counters.get("A rejected: time jumps ahead"), 1);
  EXPECT_EQ(counters.total(CountKind::kRejection), 1);
  EXPECT_EQ(buffer.add(at(2000), counters).size(), 1U);
}

TEST(ReorderBuffer, AStampInTheFutureAffectsItsOwnMessageOnly) {
  for (const std::int64_t ahead_us : {kSecond_us, 3 * kSecond_us, 100 * kSecond_us}) {
    const Streamed streamed{{{50, ahead_us}, {90, ahead_us}, {91, ahead_us / 2}, {150, ahead_us}}};
    EXPECT_EQ(streamed.released.at("A"), 196) << ahead_us;
    EXPECT_EQ(streamed.released.at("B"), 200) << ahead_us;
    EXPECT_EQ(streamed.counters.get("A rejected: time jumps ahead"), 4) << ahead_us;
    EXPECT_EQ(streamed.counters.total(CountKind::kLoss), 0) << ahead_us;
  }
}

TEST(ReorderBuffer, ACommandAndItsReplyBeforeTheSensorsDoNotSetTheTime) {
  Counters counters;
  ReorderBuffer buffer{Duration{0}};
  const Message command = encode(channels::kSlamCommand, command_t{});
  reply_t done{};
  done.state = reply_t::STATE_DONE;
  const Message reply = encode(channels::kSlamReply, done);
  EXPECT_EQ(buffer.add(command, counters), std::vector{command});
  EXPECT_EQ(buffer.add(reply, counters), std::vector{reply});
  int released = 0;
  for (int i = 0; i < 30; ++i)
    released += static_cast<int>(buffer.add(at(3600 * kSecond_us + 50'000 * i), counters).size());
  EXPECT_EQ(released, 30);
  EXPECT_EQ(buffer.add(reply, counters).at(0).time,
            timestamp_from_us(3600 * kSecond_us + 29 * 50'000));
  EXPECT_EQ(counters.total(CountKind::kRejection) + counters.total(CountKind::kLoss), 0);
}

TEST(ReorderBuffer, AfterAPauseNothingIsLost) {
  Counters counters;
  ReorderBuffer buffer{Duration{150'000}};
  int released = 0;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t utime_us = 50'000 * i + (i < 50 ? 0 : 20 * kSecond_us);
    for (const char* channel : {"A", "B"})
      released += static_cast<int>(buffer.add(at(utime_us, channel), counters).size());
  }
  released += static_cast<int>(buffer.flush().size());
  EXPECT_EQ(released, 200);
  EXPECT_EQ(counters.total(CountKind::kRejection) + counters.total(CountKind::kLoss), 0);
}

TEST(ReorderBuffer, ASingleMessageAfterAPauseIsReleasedByFlush) {
  Counters counters;
  ReorderBuffer buffer{Duration{0}};
  EXPECT_EQ(buffer.add(at(0), counters).size(), 1U);
  EXPECT_TRUE(buffer.add(at(20 * kSecond_us), counters).empty());
  EXPECT_EQ(buffer.flush().size(), 1U);
}

TEST(ReorderBuffer, ASlowChannelIsNotDelayed) {
  Counters counters;
  ReorderBuffer buffer{Duration{0}};
  int released = 0;
  for (int i = 0; i < 20; ++i)
    released += static_cast<int>(buffer.add(at(2 * kSecond_us * i), counters).size());
  EXPECT_EQ(released, 20);
  EXPECT_EQ(buffer.flush().size(), 0U);
}

TEST(ReorderBuffer, MessagesInPartsStayTogether) {
  Counters counters;
  ReorderBuffer buffer{Duration{0}};
  buffer.add(at(0), counters);
  for (const std::uint8_t part : std::vector<std::uint8_t>{1, 2, 3})
    EXPECT_TRUE(buffer.add({"A", timestamp_from_us(20 * kSecond_us), {part}}, counters).empty());
  EXPECT_EQ(buffer.add(at(21 * kSecond_us), counters).size(), 4U);
  EXPECT_EQ(counters.total(CountKind::kRejection) + counters.total(CountKind::kLoss), 0);
}

// The payloads differ, so that no message is a duplicate of another.
TEST(ReorderBuffer, AFloodOfOneStampStaysBounded) {
  for (const std::int64_t stamp_us : {kSecond_us, 10 * kSecond_us}) {  // the other is set aside
    Counters counters;
    ReorderBuffer buffer{Duration{150'000}};
    std::size_t released = buffer.add(at(kSecond_us - 1), counters).size();
    constexpr int kFlood = 5000;
    for (int i = 0; i < kFlood; ++i) {
      Message message = at(stamp_us);
      message.payload = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i / 256)};
      released += buffer.add(std::move(message), counters).size();
    }
    const std::size_t held = buffer.flush().size();
    EXPECT_LE(held, ReorderBuffer::kMaxWaiting + ReorderBuffer::kMaxSetAside);
    EXPECT_EQ(released + held + static_cast<std::size_t>(counters.get("A of one time, dropped")),
              kFlood + 1U);
  }
}

}  // namespace
}  // namespace waymark
