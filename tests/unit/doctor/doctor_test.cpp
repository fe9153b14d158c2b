// SPDX-License-Identifier: BSD-3-Clause
// The doctor's verdicts on a robot, also where the log observes nothing.
#include "doctor/doctor.hpp"

#include "doctor/checks.hpp"
#include "doctor/report.hpp"
#include "drive_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace waymark {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Doctor, AHealthyRobotPassesEverything) {
  const Diagnosis diagnosis = diagnosis_of({});

  EXPECT_THAT(names_of(diagnosis, Verdict::kWarn), IsEmpty()) << to_text(diagnosis.checks);
  EXPECT_THAT(names_of(diagnosis, Verdict::kFail), IsEmpty()) << to_text(diagnosis.checks);
  EXPECT_THAT(names_of(diagnosis, Verdict::kUnchecked), IsEmpty()) << to_text(diagnosis.checks);
  EXPECT_NEAR(diagnosis.robot.lidar.x_m, 0.1, 0.005);
  EXPECT_NEAR(find(diagnosis, "odometry_distance_scale").value.value(), 1.0, 0.02);
  EXPECT_NEAR(find(diagnosis, "time_offset").value.value(), 0.0, 10.0);
}

/// Interpolation between samples smooths the noise of odometry: a better fit at a time between
/// samples is no sign of a time offset.
TEST(Doctor, NoisyOdometryIsNotReportedAsATimeOffset) {
  const Diagnosis diagnosis = diagnosis_of({.odometry_noise_rad = 0.004});
  const Check& check = find(diagnosis, "time_offset");
  EXPECT_EQ(check.verdict, Verdict::kPass);
  EXPECT_NEAR(check.value.value(), 0.0, 5.0) << "a sample has 20 ms";
}

TEST(Doctor, BackingUpThatIsCountedAsForwardIsNamed) {
  const Diagnosis diagnosis = diagnosis_of({.counts_backing_as_forward = true});
  EXPECT_THAT(names_of(diagnosis, Verdict::kFail), ::testing::Contains("backing_up"))
      << to_text(diagnosis.checks);
}

TEST(Doctor, WhatTheLogDoesNotObserveIsUnknownAndNotPassed) {
  const Diagnosis standing =
      diagnosis_of({.distance_scale = 0.0, .duration_s = 2.0, .turning = 0.0});
  for (const char* name : {"lidar_mirrored", "odometry_turn_scale", "time_offset", "lidar_x",
                           "lidar_y", "lidar_yaw", "odometry_distance_scale"}) {
    EXPECT_EQ(find(standing, name).verdict, Verdict::kUnchecked) << name;
    EXPECT_THAT(find(standing, name).finding, HasSubstr("could not be checked")) << name;
  }
}

TEST(Doctor, WithoutTurnsTheLidarsPositionIsUnknown) {
  const Diagnosis straight = diagnosis_of({.turning = 0.0, .odometry_noise_rad = 0.002});
  for (const char* name : {"lidar_x", "lidar_y"})
    EXPECT_EQ(find(straight, name).verdict, Verdict::kUnchecked) << find(straight, name).finding;
}

TEST(Doctor, LidarYawIsReportedInDegreesAndAdvisedInRadians) {
  const Check yaw =
      find(diagnosis_of({.base_from_lidar = Se2{0.1, -0.05, radians(12.0)}}), "lidar_yaw");
  EXPECT_THAT(yaw.finding, HasSubstr("the LiDAR's yaw is 12.0"));
  EXPECT_THAT(yaw.finding, HasSubstr(" deg, "));
  EXPECT_THAT(yaw.remedy, HasSubstr("robot.lidar.yaw_rad = 0.2"));
}

TEST(Doctor, WritesMeasuredParametersIntoTheRobotFile) {
  const Diagnosis diagnosis =
      diagnosis_of({.base_from_lidar = Se2{-0.2, -0.05, 0.0}, .no_return_m = 12.0});

  EXPECT_NEAR(diagnosis.robot.lidar.x_m, -0.2, 0.02);
  EXPECT_NEAR(diagnosis.robot.lidar.y_m, -0.05, 0.005);
  EXPECT_EQ(diagnosis.robot.lidar.range_max_m, 12.0);
  const std::string file = to_robot_toml(diagnosis, "run.lcm");
  EXPECT_THAT(file, HasSubstr("# FAIL lidar_x: the LiDAR's x is"));
  EXPECT_THAT(file, HasSubstr("range_max_m = 12"));
}

TEST(Doctor, ASensorThatIsSilentAtAnEndOfTheLogIsMissing) {
  DoctorInput input = drive_in_room({});
  ChannelTraffic& lidar = input.channels["LIDAR"];
  lidar.first_s = 2.0;
  EXPECT_EQ(check_lidar_drops(input).verdict, Verdict::kPass) << "it starts a little later";
  lidar.first_s = 9.0;
  EXPECT_THAT(check_lidar_drops(input).finding, HasSubstr("none in the first 9.0 s"));
  EXPECT_EQ(check_lidar_drops(input).verdict, Verdict::kWarn);
  input.recorded_s = 180.0;
  EXPECT_THAT(check_lidar_drops(input).finding, HasSubstr("none in the last 90.0 s"));
  EXPECT_EQ(check_lidar_drops(input).verdict, Verdict::kFail);
  EXPECT_NEAR(check_traffic(input).value.value(), 1000.0 / 180.0, 1e-9);
}

TEST(Doctor, JsonHasEveryCheck) {
  const DoctorInput input = drive_in_room({.duration_s = 5.0});
  const Diagnosis diagnosis = diagnose(input);

  const auto json = nlohmann::json::parse(to_json(diagnosis, input));

  ASSERT_EQ(json["checks"].size(), diagnosis.checks.size());
  EXPECT_EQ(json["checks"][0]["name"], "records");
  EXPECT_EQ(json["checks"][0]["verdict"], "PASS");
  EXPECT_EQ(json["channels"]["LIDAR"]["messages"], 900);
}

}  // namespace
}  // namespace waymark
