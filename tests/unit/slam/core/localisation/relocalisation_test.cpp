// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/relocalisation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark {
namespace {

using Verdict = RelocalisationMonitor::Verdict;

const Se2 kConsecutive{10.0, 0.0, 0.0};
const Se2 kElsewhere{5.0, 0.0, 0.0};

PoseHint elsewhere(int id) {
  return {PoseHint::Kind::kElsewhere, id, kElsewhere};
}

PoseHint as_expected(int id) {
  return {PoseHint::Kind::kAgrees, id, {}};
}

PoseHint unexpected(int id) {
  return {PoseHint::Kind::kNew, id, {}, true};
}

PoseHint supports(const Se2& map_from_base, int id) {
  return {PoseHint::Kind::kElsewhere, id, map_from_base};
}

const Motion kOnwards{{1.0, 0.0, 0.0}, 1.0, 0.0};

/// A monitor with what it is given at each keyframe.
struct MonitoredRobot {
  RelocalisationMonitor monitor{};
  Se2 map_from_base{kConsecutive};  ///< as estimated
  RelocalisationMonitor::Walls walls{RelocalisationMonitor::Walls::kUndecided};
  std::vector<std::size_t> missed{};  ///< landmarks, at the pose before a relocalisation

  Verdict sees(const std::vector<PoseHint>& hints, const Motion& motion = {},
               bool may_be_carried = false) {
    map_from_base = map_from_base * motion.start_from_end;
    const Verdict verdict = monitor.update(map_from_base, hints, motion, may_be_carried,
                                           {[this](const Se2&, const Se2&) { return walls; },
                                            [this](const Se2&) {
                                              return missed;
                                            }});
    if (verdict == Verdict::kRelocated || verdict == Verdict::kReverted)
      map_from_base = monitor.map_from_base();
    return verdict;
  }

  Verdict sees_pair_elsewhere() {
    sees({elsewhere(3), elsewhere(4)});
    return sees({elsewhere(3), elsewhere(4)});
  }

  /// Two markers were moved together by 5 m, and are missed where they were.
  Verdict sees_moved_pair() {
    missed = {3, 4};
    sees({elsewhere(3)});
    return sees_pair_elsewhere();
  }
};

TEST(RelocalisationMonitor, OneMarkerElsewhereIsSuspicious) {
  MonitoredRobot robot;
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(robot.sees({elsewhere(3)}), Verdict::kSuspicious);
}

TEST(RelocalisationMonitor, TwoMarkersThatAgreeRelocate) {
  MonitoredRobot robot;
  const std::vector pair{elsewhere(3), elsewhere(4)};
  EXPECT_EQ(robot.sees(pair), Verdict::kSuspicious);
  EXPECT_EQ(robot.sees(pair), Verdict::kRelocated);
  EXPECT_EQ(robot.monitor.map_from_base().x(), kElsewhere.x());
  EXPECT_EQ(robot.sees({as_expected(3)}), Verdict::kConsistent);
}

TEST(RelocalisationMonitor, AMarkerWhereItIsExpectedEndsTheSuspicion) {
  MonitoredRobot robot;
  EXPECT_EQ(robot.sees({elsewhere(3)}), Verdict::kSuspicious);
  EXPECT_EQ(robot.sees({elsewhere(3), as_expected(5)}), Verdict::kConsistent);
}

TEST(RelocalisationMonitor, AMisreadIdIsDroppedSoon) {
  MonitoredRobot robot;
  EXPECT_EQ(robot.sees({elsewhere(3)}), Verdict::kSuspicious);
  EXPECT_EQ(robot.sees({}, kOnwards), Verdict::kConsistent);
}

TEST(RelocalisationMonitor, TwoUnexpectedIdsRevertARelocalisation) {
  MonitoredRobot robot;
  const std::vector pair{elsewhere(3), elsewhere(4)};
  robot.sees(pair);
  ASSERT_EQ(robot.sees(pair), Verdict::kRelocated);
  EXPECT_EQ(robot.sees({unexpected(20), unexpected(21)}, kOnwards), Verdict::kReverted);
  EXPECT_NEAR(robot.monitor.map_from_base().x(), kConsecutive.x() + 1.0, 1e-9);
}

TEST(RelocalisationMonitor,
     ARelocalisationThatNobodyCanHaveCausedIsDoubtedUntilAThirdMarkerIsMissed) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  ASSERT_EQ(robot.sees_moved_pair(), Verdict::kRelocated);
  EXPECT_TRUE(robot.monitor.is_doubtful());
  robot.missed.clear();
  EXPECT_EQ(robot.sees({as_expected(3), as_expected(4)}, kOnwards), Verdict::kSuspicious);
  EXPECT_NEAR(robot.monitor.alternative()->x(), kConsecutive.x() + 1.0, 1e-9);
  const PoseHint third{PoseHint::Kind::kAgrees, 5, robot.map_from_base};
  robot.missed = {5};
  robot.sees({third});
  EXPECT_TRUE(robot.monitor.is_doubtful());
  EXPECT_EQ(robot.sees({third}), Verdict::kConsistent);
  EXPECT_FALSE(robot.monitor.is_doubtful());
}

TEST(RelocalisationMonitor, AnotherSetOfTheSameIdsDoesNotRelocateARobotThatDroveThere) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  EXPECT_EQ(robot.sees_pair_elsewhere(), Verdict::kConsistent);
  for (int id = 5; id < 9; ++id)
    for (int i = 0; i < 3; ++i)
      EXPECT_NE(robot.sees({elsewhere(id)}, kOnwards), Verdict::kRelocated);
  EXPECT_TRUE(robot.monitor.is_certain());
}

PoseHint displaced(int id, double along_m) {
  return {PoseHint::Kind::kElsewhere, id, Se2{kConsecutive.x() + along_m, 0.02, 0.01}};
}

TEST(RelocalisationMonitor, TwoMarkersThatAreNearlyWhereTheyAreMappedShowASlip) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  EXPECT_EQ(robot.sees({displaced(3, 0.2), displaced(4, 0.2)}), Verdict::kSuspicious);
  EXPECT_EQ(robot.sees({displaced(3, 0.2), displaced(4, 0.2)}), Verdict::kSlipped);
  EXPECT_EQ(robot.sees({}), Verdict::kConsistent);
}

TEST(RelocalisationMonitor, WheelsThatSpanRelocateTheRobotAlongItsPath) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  robot.sees({displaced(3, -0.8), displaced(4, -0.8)});
  EXPECT_EQ(robot.sees({displaced(3, -0.8), displaced(4, -0.8)}), Verdict::kRelocated);
  EXPECT_FALSE(robot.monitor.is_doubtful());
}

TEST(RelocalisationMonitor, MarkersFarApartShowTheSameSpin) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(robot.sees({displaced(3, -0.8)}), Verdict::kSuspicious);
  for (int i = 0; i < 8; ++i)
    robot.sees({}, kOnwards);
  EXPECT_EQ(robot.sees({}), Verdict::kConsistent);
  EXPECT_FALSE(robot.monitor.alternative());
  const PoseHint next = displaced(4, 8.0 - 0.8);
  EXPECT_EQ(robot.sees({next}), Verdict::kSuspicious);
  EXPECT_EQ(robot.sees({next}), Verdict::kRelocated);
}

TEST(RelocalisationMonitor, MarkersMissedOnTheWayShowThatARobotWasCarriedAlthoughItsWheelsTurned) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  robot.missed = {10, 11, 12};
  for (int i = 0; i < 3; ++i)
    robot.sees({}, kOnwards);
  EXPECT_EQ(robot.sees_pair_elsewhere(), Verdict::kRelocated);
  EXPECT_FALSE(robot.monitor.is_doubtful());
}

TEST(RelocalisationMonitor, MarkersMappedSinceTheRobotMayHaveBeenCarriedConfirmNothing) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  PoseHint since = as_expected(20);
  since.is_mapped_since = true;
  robot.sees({since}, kOnwards, true);
  EXPECT_FALSE(robot.monitor.is_certain());
  EXPECT_EQ(robot.sees_pair_elsewhere(), Verdict::kRelocated);
  EXPECT_FALSE(robot.monitor.is_doubtful());
}

TEST(RelocalisationMonitor, ARobotThatStoodMayHaveBeenCarried) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  robot.sees({}, {}, true);
  ASSERT_EQ(robot.sees_pair_elsewhere(), Verdict::kRelocated);
  EXPECT_FALSE(robot.monitor.is_doubtful());
}

TEST(RelocalisationMonitor, AMarkerThatSupportsTheFormerPoseRevertsAndTheMovedPairIsKnown) {
  MonitoredRobot robot;
  robot.sees({as_expected(2)});
  ASSERT_EQ(robot.sees_moved_pair(), Verdict::kRelocated);
  robot.sees({}, kOnwards);
  const Se2 former{kConsecutive.x() + 1.0, 0.0, 0.0};
  EXPECT_EQ(robot.sees({supports(former, 6)}), Verdict::kSuspicious);
  EXPECT_EQ(robot.sees({supports(former, 6)}), Verdict::kReverted);
  EXPECT_NEAR(robot.map_from_base.x(), former.x(), 1e-9);
  EXPECT_EQ(robot.sees_moved_pair(), Verdict::kConsistent);
}

TEST(RelocalisationMonitor, WallsDecideBetweenTwoPoses) {
  MonitoredRobot moved;
  moved.sees({as_expected(2)});
  moved.walls = RelocalisationMonitor::Walls::kContradictFirst;
  EXPECT_EQ(moved.sees_moved_pair(), Verdict::kConsistent);

  MonitoredRobot carried;
  carried.sees({as_expected(2)});
  carried.walls = RelocalisationMonitor::Walls::kContradictSecond;
  EXPECT_EQ(carried.sees_pair_elsewhere(), Verdict::kRelocated);
  EXPECT_FALSE(carried.monitor.is_doubtful());

  MonitoredRobot later;
  later.sees({as_expected(2)});
  ASSERT_EQ(later.sees_moved_pair(), Verdict::kRelocated);
  later.walls = RelocalisationMonitor::Walls::kContradictFirst;
  EXPECT_EQ(later.sees({}, kOnwards), Verdict::kReverted);
}

}  // namespace
}  // namespace waymark
