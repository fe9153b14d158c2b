// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/association/marker_book.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace waymark {
namespace {

constexpr int kId = 7;

Timestamp at_s(int seconds) {
  return Timestamp{std::chrono::seconds{seconds}};
}

/// A confirmed marker at the origin, last seen 10 s after `start_s`.
class MissedMarker {
 public:
  explicit MissedMarker(int start_s) {
    book_.add(kId, at_s(start_s));
    state_.keyframes.push_back({});
    state_.landmarks.emplace_back();
    for (int s = 1; s <= 10; ++s)
      book_.note_sighting(0, at_s(start_s + s));
  }

  MarkerBook& book() { return book_; }

  /// In view, and not sighted, in so many keyframes, one per second.
  void look_for_it(int from_s, int keyframes) {
    for (int i = 0; i < keyframes; ++i)
      book_.note_misses(book_.missed(
          state_, {}, [](const Se2&) { return true; }, at_s(from_s + i - 1)));
  }

  void add_another(int first_s) {
    state_.landmarks.emplace_back(5.0, 0.0, 0.0);
    book_.add(kId, at_s(first_s));
    book_.note_sighting(1, at_s(first_s + 1));
    book_.note_sighting(1, at_s(first_s + 2));
  }

 private:
  MarkerBook book_{};
  State state_{};
};

TEST(MarkerBook, AMarkerIsMissedOnlyAfterItsLastSighting) {
  MissedMarker marker{1000};
  marker.look_for_it(1000, 11);
  EXPECT_EQ(marker.book().entries()[0].misses, 0);
  marker.look_for_it(1012, 10);
  EXPECT_TRUE(marker.book().entries()[0].is_missed());
}

TEST(MarkerBook, AMissedMarkerWithANewOneOfItsIdElsewhereWasMoved) {
  MissedMarker marker{1000};
  marker.add_another(1020);
  marker.look_for_it(1025, 10);
  EXPECT_TRUE(marker.book().is_retired(0));
  EXPECT_EQ(marker.book().moved_from(1), 0U);
  EXPECT_TRUE(marker.book().entries()[1].was_moved);
}

TEST(MarkerBook, AMarkerSeenAfterANewOneOfItsIdAppearedWasNotMoved) {
  MissedMarker marker{1000};
  marker.add_another(1005);
  marker.look_for_it(1025, 10);
  EXPECT_TRUE(marker.book().entries()[0].is_missed());
  EXPECT_FALSE(marker.book().is_retired(0));
}

TEST(MarkerBook, MissesAndMovesAreCountedAfterTheClockWasSetBackOrAhead) {
  for (const int step_s : {-900, 3600}) {
    MissedMarker marker{1000};
    marker.book().set_clock(std::chrono::seconds{step_s});
    marker.add_another(1020 + step_s);
    marker.look_for_it(1025 + step_s, 10);
    EXPECT_TRUE(marker.book().is_retired(0)) << step_s;
    EXPECT_EQ(marker.book().moved_from(1), 0U) << step_s;
  }
}

TEST(MarkerBook, AMarkerOfALoadedMapThatWasNotSightedHasNoTime) {
  MarkerBook book;
  book.add_known({});
  book.set_clock(std::chrono::hours{1});
  EXPECT_EQ(book.entries()[0].last_seen, Timestamp{});
}

}  // namespace
}  // namespace waymark
