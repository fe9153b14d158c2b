// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/turn_by_scans.hpp"

#include "slam/core/scan/turn_monitor.hpp"
#include "support/room_with_column.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace waymark {
namespace {

using test::scan_of_room;

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(TurnBetween, MeasuresATurnThatOdometryMissed) {
  for (const double slip_deg : {-40.0, -12.0, 8.0, 35.0}) {
    const Se2 start{-0.5, 0.3, 0.2};
    const Motion measured{Se2{0.1, 0.0, 0.05}, 0.1, 0.05};
    const Se2 end{Eigen::Vector2d{(start * measured.start_from_end).translation()},
                  start.theta() + 0.05 + slip_deg * kDegree};
    const auto found = turn_between(scan_of_room(start), scan_of_room(end), measured);
    ASSERT_TRUE(found) << slip_deg;
    EXPECT_TRUE(found->contradicts_odometry) << slip_deg;
    EXPECT_NEAR(found->turn_rad, 0.05 + slip_deg * kDegree, 1.6 * kDegree) << slip_deg;
  }
}

TEST(TurnBetween, AcceptsCorrectOdometry) {
  for (const double turn_deg : {-30.0, 0.0, 1.0, 20.0}) {
    const Se2 start{0.4, -0.3, 1.0};
    const Motion measured{Se2{0.1, 0.0, turn_deg * kDegree}, 0.1, std::abs(turn_deg) * kDegree};
    const auto found =
        turn_between(scan_of_room(start), scan_of_room(start * measured.start_from_end), measured);
    ASSERT_TRUE(found) << turn_deg;
    EXPECT_FALSE(found->contradicts_odometry) << turn_deg;
  }
}

TEST(TurnBetween, GivesNothingWithoutScans) {
  EXPECT_FALSE(turn_between({}, scan_of_room({}), {}));
  EXPECT_FALSE(turn_between(scan_of_room({}), {}, {}));
}

/// The beams that point ahead, up to that angle to both sides.
std::vector<AnnotatedBeam> ahead_of(std::vector<AnnotatedBeam> beams, double half_angle_deg) {
  std::erase_if(beams, [half_angle_deg](const AnnotatedBeam& annotated) {
    const Eigen::Vector2d& end = annotated.beam.end_in_base;
    return std::abs(std::atan2(end.y(), end.x())) > half_angle_deg * kDegree;
  });
  return beams;
}

TEST(TurnBetween, ALidarThatLooksAheadOnlyIsEnough) {
  for (const double slip_deg : {-12.0, 8.0}) {
    const Se2 start{-0.5, 0.3, 0.2};
    const auto found =
        turn_between(ahead_of(scan_of_room(start), 90.0),
                     ahead_of(scan_of_room(start * Se2{0.0, 0.0, slip_deg * kDegree}), 90.0), {});
    ASSERT_TRUE(found) << slip_deg;
    EXPECT_TRUE(found->contradicts_odometry) << slip_deg;
    EXPECT_NEAR(found->turn_rad, slip_deg * kDegree, 1.6 * kDegree) << slip_deg;
  }
}

TEST(TurnBetween, NeedsMoreThanHalfOfTheLaterScanInTheEarlierOne) {
  const auto scan = scan_of_room({-0.5, 0.3, 0.2});
  EXPECT_FALSE(turn_between(ahead_of(scan, 45.0), ahead_of(scan, 90.0), {}));
  const auto found = turn_between(ahead_of(scan, 65.0), ahead_of(scan, 90.0), {});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->contradicts_odometry);
  EXPECT_EQ(found->turn_rad, 0.0);
}

/// Every step is 0.05 m and a degree by odometry; the wheels miss 20 degrees, spread over `steps`.
double turn_found(int steps) {
  const Motion measured{Se2{0.05, 0.0, kDegree}, 0.05, kDegree};
  TurnMonitor monitor;
  Se2 truth{-1.5, -0.6, 0.3};
  double found_rad = 0.0;
  monitor.missing_turn(scan_of_room(truth), {});
  for (int i = 0; i < 30; ++i) {
    truth = truth * measured.start_from_end;
    if (i >= 10 && i < 10 + steps) truth = truth * Se2{0.0, 0.0, 20.0 * kDegree / steps};
    const auto missing_rad = monitor.missing_turn(scan_of_room(truth), measured);
    EXPECT_TRUE(i >= 10 || !missing_rad) << i;
    found_rad += missing_rad.value_or(0.0);
  }
  return found_rad;
}

TEST(TurnMonitor, FindsASuddenAndAGradualSlip) {
  for (const int steps : {1, 4, 8})
    EXPECT_NEAR(turn_found(steps), 20.0 * kDegree, 3.5 * kDegree) << steps;
}

TEST(TurnMonitor, ComparesAcrossAnEmptyScan) {
  TurnMonitor monitor;
  const Motion measured{Se2{0.05, 0.0, 0.0}, 0.05, 0.0};
  Se2 truth{-0.5, 0.3, 0.2};
  EXPECT_FALSE(monitor.missing_turn(scan_of_room(truth), {}));
  truth = truth * Se2{0.05, 0.0, 0.5};
  EXPECT_FALSE(monitor.missing_turn({}, measured));
  truth = truth * measured.start_from_end;
  const auto missing_rad = monitor.missing_turn(scan_of_room(truth), measured);
  ASSERT_TRUE(missing_rad);
  EXPECT_NEAR(*missing_rad, 0.5, 1.6 * kDegree);
}

}  // namespace
}  // namespace waymark
