// SPDX-License-Identifier: BSD-3-Clause
// Which submaps grow, are matched, and are finished.
#include "slam/core/registration/submaps.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr int kKeyframesEach = 10;

struct Drive {
  Submaps submaps{0.25, kKeyframesEach, 100.0};
  PoseSequence keyframes{};

  void go(int num_keyframes) {
    for (int i = 0; i < num_keyframes; ++i) {
      keyframes.push_back({0.1 * static_cast<double>(keyframes.size()), 0.0, 0.0});
      submaps.add_keyframe({{1.0, 0.0}}, keyframes, 1e-4);
    }
  }
};

TEST(Submaps, WithoutKeyframesThereIsNoSubmap) {
  const Submaps submaps{0.25, kKeyframesEach, 100.0};
  EXPECT_EQ(submaps.current(), nullptr);
  EXPECT_TRUE(submaps.finished().empty());
}

TEST(Submaps, TheCurrentSubmapHasAtLeastHalfOfItsKeyframes) {
  Drive drive;
  drive.go(kKeyframesEach / 2);
  for (int i = 0; i < 40; ++i) {
    EXPECT_GE(drive.submaps.current()->num_keyframes(), kKeyframesEach / 2U);
    EXPECT_LE(drive.submaps.current()->num_keyframes(), static_cast<std::size_t>(kKeyframesEach));
    drive.go(1);
  }
}

TEST(Submaps, FinishedSubmapsOverlapByHalfALength) {
  Drive drive;
  drive.go(41);
  ASSERT_EQ(drive.submaps.finished().size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    const Submap& submap = drive.submaps.finished()[i];
    EXPECT_EQ(submap.first_keyframe(), i * kKeyframesEach / 2);
    EXPECT_EQ(submap.num_keyframes(), static_cast<std::size_t>(kKeyframesEach));
    EXPECT_EQ(drive.submaps.find(submap.first_keyframe()), &submap);
  }
  EXPECT_EQ(drive.submaps.find(1), nullptr);
}

/// The given length bounds submaps where keyframes are far apart (a slow LiDAR, a fast robot).
TEST(Submaps, EndAtTheGivenLengthOrAtMostAFifthLater) {
  Drive drive;
  drive.submaps = Submaps{0.25, 1000, 2.0};
  drive.go(60);
  ASSERT_FALSE(drive.submaps.finished().empty());
  for (const Submap& submap : drive.submaps.finished()) {
    EXPECT_GE(submap.path_length_m(), 2.0);
    EXPECT_LT(submap.path_length_m(), 2.4);  // by a keyframe of each half
  }
}

TEST(Submaps, ScansAreWhereTheirKeyframesAre) {
  Drive drive;
  drive.go(3);
  drive.submaps.add_between({{1.0, 0.5}}, {0.25, 0.0, 0.0}, drive.keyframes);
  const Points& points = drive.submaps.current()->points();
  ASSERT_EQ(points.size(), 4U);
  EXPECT_NEAR(points[2].x(), 1.2, 1e-9);
  EXPECT_NEAR(points[3].x(), 1.25, 1e-9);
  EXPECT_NEAR(points[3].y(), 0.5, 1e-9);
}

/// As after a loop closure. The scan between keyframes moves with the one before it.
TEST(Submaps, ScansFollowTheirKeyframesWhenTheseMoveRelativeToEachOther) {
  Drive drive;
  drive.go(3);
  drive.submaps.add_between({{1.0, 0.5}}, {0.25, 0.0, 0.0}, drive.keyframes);
  drive.keyframes[2] = {0.2, 0.3, 0.0};
  drive.submaps.rebuild_deformed(drive.keyframes);
  const Submap& submap = *drive.submaps.current();
  ASSERT_EQ(submap.points().size(), 4U);
  EXPECT_NEAR(submap.points()[1].y(), 0.0, 1e-9);
  EXPECT_NEAR(submap.points()[2].y(), 0.3, 1e-9);
  EXPECT_NEAR(submap.points()[3].x(), 1.25, 1e-9);
  EXPECT_NEAR(submap.points()[3].y(), 0.8, 1e-9);
  EXPECT_EQ(submap.num_keyframes(), 3U);
  EXPECT_NEAR(submap.submap_from_keyframe(2).y(), 0.3, 1e-9);
}

TEST(Submaps, ASubmapBegunBeforeItsPredecessorEndsFollowsItsKeyframes) {
  Drive drive;
  drive.go(8);
  drive.keyframes[7] = {0.7, 0.3, 0.0};
  drive.submaps.rebuild_deformed(drive.keyframes);
  drive.go(3);
  ASSERT_EQ(drive.submaps.current()->first_keyframe(), 5U);
  EXPECT_NEAR(drive.submaps.current()->submap_from_keyframe(7).y(), 0.3, 1e-9);
}

TEST(Submaps, KeyframesThatMoveTogetherLeaveTheSubmapAsItIs) {
  Drive drive;
  drive.go(3);
  const Se2 moved{5.0, 1.0, 0.5};
  for (std::size_t i = 0; i < 3; ++i)
    drive.keyframes[i] = moved * drive.keyframes[i];
  EXPECT_FALSE(drive.submaps.current()->is_deformed(drive.keyframes));
  drive.keyframes[2] = drive.keyframes[2] * Se2{0.0, 0.0, 0.05};
  EXPECT_TRUE(drive.submaps.current()->is_deformed(drive.keyframes));
}

TEST(Submaps, StartingANewSubmapKeepsFinishedOnes) {
  Drive drive;
  drive.go(21);
  const std::size_t finished = drive.submaps.finished().size();
  drive.submaps.begin_anew();
  EXPECT_EQ(drive.submaps.current(), nullptr);
  drive.go(1);
  EXPECT_EQ(drive.submaps.current()->first_keyframe(), 21U);
  EXPECT_EQ(drive.submaps.finished().size(), finished);
}

TEST(Submaps, SubmapsWithRemovedKeyframesAreDropped) {
  Drive drive;
  drive.go(41);
  drive.submaps.forget([](std::size_t keyframe) { return keyframe == 7; });
  EXPECT_EQ(drive.submaps.find(0), nullptr);
  EXPECT_EQ(drive.submaps.find(5), nullptr);
  EXPECT_NE(drive.submaps.find(10), nullptr);
}

}  // namespace
}  // namespace waymark
