// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/reversed_odometry.hpp"

#include "common/messages/convert.hpp"
#include "import/findings/findings.hpp"
#include "synthetic_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace waymark {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

TEST(ReversedOdometry, BackingUpThatIsCountedAsForwardIsFound) {
  const ImportedLog log = drive(to_and_fro(), CountedAs::kForward);

  const std::vector<ReversedStep> steps = find_reversed_steps(log);

  ASSERT_THAT(steps, SizeIs(20));
  EXPECT_EQ(steps.front().after, log.scans[20].time);
  EXPECT_EQ(steps.back().until, log.scans[40].time);
  EXPECT_NEAR(steps[5].distance_m, 0.05, 1e-9);
}

TEST(ReversedOdometry, CorrectOdometryHasNoReversedSteps) {
  EXPECT_THAT(find_reversed_steps(drive(to_and_fro(), CountedAs::kDriven)), IsEmpty());
}

TEST(ReversedOdometry, IsFoundWithClockwiseScansToo) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kForward);
  for (ImportedScan& scan : log.scans) {
    lidar_t message = to_mbot_lidar(scan_of(scan));
    for (float& theta_rad : message.thetas)
      theta_rad += static_cast<float>(4.0 * std::numbers::pi);
    std::ranges::reverse(message.thetas);
    std::ranges::reverse(message.ranges);
    scan.message = encode(channels::kMbotLidar, message);
  }
  EXPECT_THAT(find_reversed_steps(log), SizeIs(20));
}

TEST(ReversedOdometry, ABareCorridorDecidesNothing) {
  const ImportedLog log = drive(to_and_fro(0.0), CountedAs::kForward, Walls::kCorridor);
  EXPECT_THAT(find_reversed_steps(log), IsEmpty());
}

TEST(ReversedOdometry, UndecidedStepsFollowTheirNeighbours) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kForward);
  // The scans of five steps in the middle of backing up have no returns.
  for (std::size_t i = 28; i < 33; ++i) {
    auto message = decode<planar_lidar_t>(log.scans[i].message.payload).message.value();
    std::ranges::fill(message.ranges, std::numeric_limits<float>::infinity());
    log.scans[i].message = encode(channels::kLidar, message);
  }
  EXPECT_THAT(find_reversed_steps(log), SizeIs(20));
}

TEST(ReversedOdometry, IsCorrectedOnRequestAndAlwaysReported) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kForward);
  const Se2 wrong_end = log.odometry.back().pose;
  ImportReport named{"log", AddressUnit::kLine};
  examine(log, ReversedOdometry::kReport, named);
  EXPECT_EQ(log.odometry.back().pose.x(), wrong_end.x());
  EXPECT_THAT(named.notes(), Contains(HasSubstr("--fix-reversed-odometry turns it round")));

  ImportReport repaired{"log", AddressUnit::kLine};
  examine(log, ReversedOdometry::kCorrect, repaired);
  EXPECT_THAT(repaired.notes(), Contains(HasSubstr("20 steps between scans, 0.9 m")));
  const Se2 end = drive(to_and_fro(), CountedAs::kDriven).odometry.back().pose;
  EXPECT_NEAR(log.odometry.back().pose.x(), end.x(), 1e-6);
  EXPECT_NEAR(log.odometry.back().pose.y(), end.y(), 1e-6);
  EXPECT_NEAR(log.odometry.back().pose.theta(), end.theta(), 1e-6);

  ImportReport again{"log", AddressUnit::kLine};
  examine(log, ReversedOdometry::kReport, again);
  EXPECT_THAT(again.notes(), Not(Contains(HasSubstr("backing up"))));
}

}  // namespace
}  // namespace waymark
