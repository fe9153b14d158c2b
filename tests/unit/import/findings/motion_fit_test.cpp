// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/motion_fit.hpp"

#include "import/findings/findings.hpp"
#include "synthetic_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// 80 s of straight drives to and fro in the room.
ImportedLog long_drive() {
  std::vector<Se2> steps;
  for (int i = 0; i < 400; ++i) {
    const double forward_m = i / 20 % 2 == 0 ? 0.07 : -0.07;
    steps.emplace_back(forward_m, 0.0, i % 20 == 0 ? 0.2 : 0.0);
  }
  return drive(steps, CountedAs::kDriven);
}

/// Steps of 2 cm with turns by up to 0.06 rad.
std::vector<Se2> to_and_fro_turning() {
  std::vector<Se2> steps;
  for (int i = 0; i < 400; ++i)
    steps.emplace_back(0.02, 0.0, 0.06 * (i / 50 % 2 == 0 ? 1.0 : -1.0));
  return steps;
}

std::vector<std::string> what_is_found(ImportedLog log) {
  ImportReport report{"log", AddressUnit::kLine};
  examine(log, ReversedOdometry::kReport, report);
  return report.notes();
}

TEST(MotionFit, OdometryInInchesIsTheOnlyFindingOfItsMotion) {
  ImportedLog log = long_drive();
  scale_distances(log.odometry, 1.0 / 0.0254);

  EXPECT_NEAR(odometry_factor(log, {}).value_or(0.0), 0.0254, 0.0025);
  EXPECT_THAT(what_is_found(log), Contains(HasSubstr("inches: --odometry-scale 0.0254")));
  EXPECT_THAT(what_is_found(log), Not(Contains(HasSubstr("--fix-reversed-odometry"))));
}

TEST(MotionFit, OdometryInMetresIsNotReported) {
  EXPECT_FALSE(odometry_factor(long_drive(), {}));
  EXPECT_THAT(what_is_found(long_drive()), Not(Contains(HasSubstr("distances"))));
}

TEST(MotionFit, ALidarThatIsTurnedByFiveDegreesIsNamedWithItsYaw) {
  ImportedLog log = long_drive();
  const auto seen = [&](const auto& change) {
    for (ImportedScan& scan : log.scans) {
      auto message = decode<planar_lidar_t>(scan.message.payload).message.value();
      change(message);
      scan.message = encode(channels::kLidar, message);
    }
  };
  // The LiDAR's zero direction is 5 degrees to the left of the base's.
  seen([](planar_lidar_t& message) { message.rad0 -= static_cast<float>(radians(5.0)); });

  const auto error = lidar_yaw_error(log, {});

  ASSERT_TRUE(error);
  EXPECT_NEAR(degrees(error->yaw_rad), 5.0, 0.5);
  EXPECT_THAT(what_is_found(log), Contains(HasSubstr("further to the left than described")));
}

TEST(MotionFit, ScansThatDoNotOverlapShowNoYaw) {
  ImportedLog log = long_drive();
  edit_ranges(log, [](float, std::size_t) { return std::numeric_limits<float>::infinity(); });

  EXPECT_FALSE(lidar_yaw_error(log, {}));
  EXPECT_THAT(what_is_found(log), Not(Contains(HasSubstr("further to the"))));
}

TEST(MotionFit, OdometryInAMapGridStartsAtTheOrigin) {
  ImportedLog log = long_drive();
  for (ImportedPose& sample : log.odometry)
    sample.pose = Se2{500'000.0, 5'400'000.0, 0.0} * sample.pose;
  const Se2 motion = log.odometry.front().pose.inverse() * log.odometry.back().pose;
  ImportReport report{"log", AddressUnit::kLine};

  examine(log, ReversedOdometry::kReport, report);

  EXPECT_EQ(log.odometry.front().pose.translation().norm(), 0.0);
  EXPECT_NEAR((log.odometry.front().pose.inverse() * log.odometry.back().pose).x(), motion.x(),
              1e-6);
  EXPECT_THAT(report.notes(), Contains(HasSubstr("shifted to start at (0, 0)")));
  EXPECT_THAT(what_is_found(long_drive()), Not(Contains(HasSubstr("shifted"))));
}

TEST(MotionFit, ALidarWhoseBeamsCountTheOtherWayIsNamed) {
  ImportedLog log = drive(to_and_fro_turning(), CountedAs::kDriven);
  EXPECT_THAT(what_is_found(log), Not(Contains(HasSubstr("the other way round"))));

  for (ImportedScan& scan : log.scans) {
    auto message = decode<planar_lidar_t>(scan.message.payload).message.value();
    std::ranges::reverse(message.ranges);
    scan.message = encode(channels::kLidar, message);
  }

  EXPECT_THAT(what_is_found(log), Contains(HasSubstr("lidar.mirrored = true")));
}

TEST(MotionFit, ALidarThatLooksAheadHasAYawOfZeroAndNoFinding) {
  const auto error = lidar_yaw_error(long_drive(), {});
  ASSERT_TRUE(error);
  EXPECT_NEAR(degrees(error->yaw_rad), 0.0, 0.5);
  EXPECT_THAT(what_is_found(long_drive()), Not(Contains(HasSubstr("further to the"))));
}

}  // namespace
}  // namespace waymark
