// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/current_map.hpp"

#include <gtest/gtest.h>

namespace waymark::viewer {
namespace {

using Origin = CurrentMap::Origin;

constexpr std::int64_t kOffice = 0xab;
constexpr std::int64_t kHall = 0xcd;
constexpr int kPatience = 100;  // after so many messages the clock counts as set back

Timestamp second(int seconds) {
  return Timestamp{std::chrono::seconds{seconds}};
}

/// The hall's map, begun at 100 s, after the office's.
CurrentMap hall_after_office() {
  CurrentMap current;
  current.update(kOffice, second(50));
  current.update(kHall, second(100));
  return current;
}

TEST(CurrentMap, TheFirstMessageBeginsAMapThatLaterOnesAndLateOnesBelongTo) {
  CurrentMap current;
  EXPECT_FALSE(current.id());
  EXPECT_EQ(current.update(kOffice, second(50)), Origin::kOfFirstMap);
  EXPECT_EQ(current.update(kOffice, second(51)), Origin::kOfThisMap);
  EXPECT_EQ(current.update(kOffice, second(49)), Origin::kOfThisMap);
  EXPECT_EQ(current.id(), kOffice);
}

TEST(CurrentMap, AnotherMapIsNewUnlessItsMessageIsOlderThanTheCurrentMap) {
  for (const int at_s : {100, 101}) {
    CurrentMap current;
    current.update(kOffice, second(100));
    EXPECT_EQ(current.update(kHall, second(at_s)), Origin::kOfNewMap) << at_s;
    EXPECT_EQ(current.id(), kHall);
  }
  CurrentMap current = hall_after_office();
  EXPECT_EQ(current.update(kOffice, second(99)), Origin::kLate);
  EXPECT_EQ(current.id(), kHall);
}

TEST(CurrentMap, AfterTheClockWasSetBackAnotherMapIsFollowed) {
  CurrentMap current = hall_after_office();
  int num_late = 0;
  while (num_late < kPatience &&
         current.update(kOffice, second(10 + num_late / 10)) != Origin::kOfNewMap)
    ++num_late;
  EXPECT_GT(num_late, 5);
  EXPECT_LT(num_late, kPatience);
  EXPECT_EQ(current.id(), kOffice);
  EXPECT_EQ(current.update(kHall, second(50)), Origin::kOfNewMap) << "it is after 10 s";
}

TEST(CurrentMap, LateMessagesAmongThoseOfTheCurrentMapNeverReplaceIt) {
  CurrentMap current = hall_after_office();
  for (int i = 0; i < kPatience; ++i) {
    EXPECT_EQ(current.update(kOffice, second(99)), Origin::kLate);
    EXPECT_EQ(current.update(kHall, second(100 + i)), Origin::kOfThisMap);
  }
}

}  // namespace
}  // namespace waymark::viewer
