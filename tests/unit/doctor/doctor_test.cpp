// SPDX-License-Identifier: BSD-3-Clause
// One fault at a time: the doctor names it, and nothing else.
#include "doctor/doctor.hpp"

#include "doctor/report.hpp"
#include "import/findings/no_return.hpp"
#include "synthetic_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Diagnosis diagnosis_of(const DriveFaults& faults) {
  DoctorInput input = drive_in_room(faults);
  mark_no_returns(input.log, {std::nullopt, 20.0}, input.report);
  return diagnose(input);
}

std::vector<std::string> names_of(const Diagnosis& diagnosis, Verdict verdict) {
  std::vector<std::string> names;
  for (const Check& check : diagnosis.checks) {
    if (check.verdict == verdict) names.push_back(check.name);
  }
  return names;
}

const Check& find(const Diagnosis& diagnosis, const std::string& name) {
  return *std::ranges::find(diagnosis.checks, name, &Check::name);
}

TEST(Doctor, AHealthyRobotPassesEverything) {
  const Diagnosis diagnosis = diagnosis_of({});

  EXPECT_THAT(names_of(diagnosis, Verdict::kWarn), IsEmpty()) << to_text(diagnosis.checks);
  EXPECT_THAT(names_of(diagnosis, Verdict::kFail), IsEmpty()) << to_text(diagnosis.checks);
  EXPECT_THAT(names_of(diagnosis, Verdict::kUnchecked), IsEmpty()) << to_text(diagnosis.checks);
  EXPECT_EQ(diagnosis.robot.lidar.x_m, 0.1) << "the description stays";
  EXPECT_NEAR(find(diagnosis, "odometry_distance_scale").value.value(), 1.0, 0.02);
  EXPECT_NEAR(find(diagnosis, "time_offset").value.value(), 0.0, 10.0);
}

struct Fault {
  std::string check;
  DriveFaults faults;
  double value;
  double tolerance;
};

TEST(Doctor, EachFaultIsNamedWithItsNumberAndNoOther) {
  const std::vector<Fault> faults{
      {"lidar_mirrored", {.is_mirrored = true}, -1.0, 0.05},
      {"odometry_turn_scale", {.turn_scale = 1.15}, 1.15, 0.02},
      {"odometry_distance_scale", {.distance_scale = 0.8}, 0.8, 0.02},
      {"time_offset", {.lidar_late_s = 0.15}, 150.0, 15.0},
      {"time_offset", {.lidar_late_s = -0.2}, -200.0, 15.0},
      {"lidar_yaw", {.base_from_lidar = Se2{0.1, -0.05, radians(12.0)}}, 12.0, 1.0},
      {"lidar_yaw", {.base_from_lidar = Se2{0.1, -0.05, radians(90.0)}}, 90.0, 1.0},
      {"lidar_x", {.base_from_lidar = Se2{-0.2, -0.05, 0.0}}, -0.2, 0.02},
      {"lidar_y", {.base_from_lidar = Se2{0.1, 0.2, 0.0}}, 0.2, 0.02},
      {"lidar_drops", {.dropped_scans_of_ten = 2}, 20.0, 4.0},
      {"no_return", {.no_return_m = 12.0}, 12.0, 1e-6},
      {"focal_length", {.focal = 1.08}, 1.08, 0.01},
      {"marker_size", {.marker_size = 0.96}, 0.96, 0.01},
      {"camera_yaw", {.camera_yaw_rad = radians(4.0)}, 4.0, 0.3},
      {"camera_time_offset", {.camera_late_s = 0.08}, 80.0, 8.0},
  };
  for (const Fault& fault : faults) {
    const Diagnosis diagnosis = diagnosis_of(fault.faults);

    EXPECT_THAT(names_of(diagnosis, Verdict::kFail), ElementsAre(fault.check))
        << to_text(diagnosis.checks);
    EXPECT_THAT(names_of(diagnosis, Verdict::kWarn), IsEmpty()) << to_text(diagnosis.checks);
    EXPECT_NEAR(find(diagnosis, fault.check).value.value(), fault.value, fault.tolerance);
    EXPECT_FALSE(find(diagnosis, fault.check).remedy.empty());
  }
}

/// Between samples interpolation smooths odometry's noise: a fit there is better, and no sign of an
/// offset.
TEST(Doctor, NoiseOfOdometryIsNoTimeOffset) {
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

TEST(Doctor, WhatTheLogDoesNotSayIsNoPass) {
  const Diagnosis standing =
      diagnosis_of({.distance_scale = 0.0, .duration_s = 2.0, .turning = 0.0});
  for (const char* name : {"lidar_mirrored", "odometry_turn_scale", "time_offset", "lidar_x",
                           "lidar_y", "lidar_yaw", "odometry_distance_scale"}) {
    EXPECT_EQ(find(standing, name).verdict, Verdict::kUnchecked) << name;
    EXPECT_THAT(find(standing, name).finding, HasSubstr("could not be checked")) << name;
  }
}

TEST(Doctor, WithoutTurnsTheLidarsPlaceIsUnknown) {
  const Diagnosis straight = diagnosis_of({.turning = 0.0, .odometry_noise_rad = 0.002});
  for (const char* name : {"lidar_x", "lidar_y"})
    EXPECT_EQ(find(straight, name).verdict, Verdict::kUnchecked) << find(straight, name).finding;
}

TEST(Doctor, WritesWhatItFoundIntoTheRobot) {
  const Diagnosis diagnosis =
      diagnosis_of({.base_from_lidar = Se2{-0.2, -0.05, 0.0}, .no_return_m = 12.0});

  EXPECT_NEAR(diagnosis.robot.lidar.x_m, -0.2, 0.02);
  EXPECT_EQ(diagnosis.robot.lidar.y_m, -0.05);
  EXPECT_EQ(diagnosis.robot.lidar.range_max_m, 12.0);
  EXPECT_THAT(to_robot_toml(diagnosis, "run.lcm"), HasSubstr("# FAIL lidar_x: the LiDAR sits at"));
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
