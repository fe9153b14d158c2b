// SPDX-License-Identifier: BSD-3-Clause
// Stamps that are seconds off: named as such, instead of spoiling every other measurement.
#include "doctor/motion/far_offset.hpp"

#include "doctor/checks.hpp"
#include "doctor/report.hpp"
#include "drive_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace waymark {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kSearchStep_s = 0.1;

/// Odometry of turns whose rate changes at random every second, or that repeat themselves.
std::vector<ImportedPose> odometry_of_turns(double repeats_every_s = 0.0) {
  constexpr double kInterval_s = 0.02;
  constexpr double kDuration_s = 120.0;
  std::mt19937 random{3};
  std::vector<double> rates_rad_s;
  for (int i = 0; i <= static_cast<int>(kDuration_s); ++i)
    rates_rad_s.push_back(std::uniform_real_distribution<double>{-1.0, 1.0}(random));
  std::vector<ImportedPose> odometry;
  double yaw_rad = 0.0;
  for (double t_s = 0.0; t_s < kDuration_s; t_s += kInterval_s) {
    odometry.push_back({timestamp_from_us(static_cast<std::int64_t>(1e6 * (100.0 + t_s))), 0,
                        Se2{0.0, 0.0, yaw_rad}});
    const double in_pattern_s = repeats_every_s > 0.0 ? std::fmod(t_s, repeats_every_s) : t_s;
    yaw_rad += kInterval_s * rates_rad_s[static_cast<std::size_t>(in_pattern_s)];
  }
  return odometry;
}

/// Turns of a LiDAR that scans ten times a second, `sign` times those of odometry.
std::vector<LidarTurn> lidar_turns(const std::vector<ImportedPose>& odometry, double late_s,
                                   double sign = 1.0) {
  const Duration period = duration_from_seconds(0.1);
  const Duration late = duration_from_seconds(late_s);
  std::vector<LidarTurn> turns;
  for (Timestamp time = odometry.front().time; time + period < odometry.back().time;
       time += period) {
    const double turn_rad =
        angle_difference(pose_at(odometry, time + period).theta(), pose_at(odometry, time).theta());
    turns.push_back({time + late, time + period + late, sign * turn_rad});
  }
  return turns;
}

TEST(FarOffset, OfTheLidarIsFoundToATenthOfASecondWhateverItsSign) {
  const std::vector<ImportedPose> odometry = odometry_of_turns();
  for (const double late_s : {-9.0, -3.04, 0.8, 7.5}) {
    for (const double sign : {1.0, -1.0}) {
      const auto found = far_lidar_late_s(lidar_turns(odometry, late_s, sign), odometry);
      ASSERT_TRUE(found) << late_s;
      EXPECT_NEAR(*found, late_s, kSearchStep_s);
    }
  }
}

TEST(FarOffset, ThereIsNoneWhereTheStampsFitOrAreFartherOffThanTheSearch) {
  const std::vector<ImportedPose> odometry = odometry_of_turns();
  EXPECT_FALSE(far_lidar_late_s(lidar_turns(odometry, 0.0), odometry));
  EXPECT_FALSE(far_lidar_late_s(lidar_turns(odometry, 0.3), odometry));
  EXPECT_FALSE(far_lidar_late_s(lidar_turns(odometry, 30.0), odometry));
}

TEST(FarOffset, ADriveThatRepeatsItselfFitsAtSeveralSoThatNoneIsNamed) {
  const std::vector<ImportedPose> odometry = odometry_of_turns(5.0);
  EXPECT_FALSE(far_lidar_late_s(lidar_turns(odometry, 3.0), odometry));
}

TEST(FarOffset, TurnsPersistAndNoiseDoesNot) {
  EXPECT_GT(persistence_of(lidar_turns(odometry_of_turns(), 0.0)), 0.8);
  std::vector<LidarTurn> noise;
  std::mt19937 random{7};
  for (int i = 0; i < 1000; ++i)
    noise.push_back({{}, {}, std::normal_distribution<double>{0.0, 0.001}(random)});
  EXPECT_LT(persistence_of(noise), 0.2);
  EXPECT_EQ(persistence_of({}), 0.0);
}

/// The drive of synthetic_drive.hpp with stamps that are off.
TEST(FarOffset, OfTheLidarFailsAndWhatItSpoilsIsNotChecked) {
  const Diagnosis diagnosis = diagnosis_of({.lidar_late_s = 3.0});
  const Check& offset = find(diagnosis, "time_offset");
  EXPECT_EQ(offset.verdict, Verdict::kFail) << to_text(diagnosis.checks);
  EXPECT_NEAR(offset.value.value(), 3000.0, 100.0);
  EXPECT_THAT(offset.finding, HasSubstr("the stamps of LIDAR are 3.0 s later than those of "));
  EXPECT_THAT(offset.remedy, HasSubstr("one clock"));
  for (const char* name : {"lidar_mirrored", "odometry_turn_scale", "odometry_distance_scale",
                           "lidar_x", "lidar_y", "lidar_yaw", "backing_up", "marker_size"})
    EXPECT_EQ(find(diagnosis, name).verdict, Verdict::kUnchecked) << find(diagnosis, name).finding;
  EXPECT_EQ(names_of(diagnosis, Verdict::kFail), std::vector<std::string>{"time_offset"});
  EXPECT_THAT(names_of(diagnosis, Verdict::kWarn), IsEmpty()) << to_text(diagnosis.checks);
}

TEST(FarOffset, OfTheCameraFailsInsteadOfAskingForMoreMarkers) {
  const Diagnosis diagnosis = diagnosis_of({.camera_late_s = -2.0});
  const Check& offset = find(diagnosis, "camera_time_offset");
  EXPECT_EQ(offset.verdict, Verdict::kFail) << to_text(diagnosis.checks);
  EXPECT_NEAR(offset.value.value(), -2000.0, 100.0);
  EXPECT_THAT(offset.finding, HasSubstr("2.0 s earlier than those of odometry"));
  EXPECT_EQ(find(diagnosis, "focal_length").verdict, Verdict::kUnchecked);
  EXPECT_EQ(names_of(diagnosis, Verdict::kFail), std::vector<std::string>{"camera_time_offset"});
}

TEST(FarOffset, WithoutTurnsTheDistanceIsStillChecked) {
  const Diagnosis straight = diagnosis_of({.turning = 0.0, .odometry_noise_rad = 0.002});
  EXPECT_EQ(find(straight, "odometry_distance_scale").verdict, Verdict::kPass)
      << to_text(straight.checks);
}

// The importer has put odometry onto the LiDAR's clock, which slam does not do.
TEST(FarOffset, ADifferenceOfClocksThatTheImporterHasCorrectedFails) {
  DoctorInput input = drive_in_room({});
  input.log.odometry_shift = std::chrono::hours{48};
  const Diagnosis diagnosis = diagnose(input);
  EXPECT_EQ(names_of(diagnosis, Verdict::kFail), std::vector<std::string>{"time_offset"});
  EXPECT_THAT(find(diagnosis, "time_offset").finding,
              HasSubstr("172800.0 s later than those of odometry: by the times at which the log"));
  input.log.odometry_shift = Duration{0};
  input.log.images_shift = std::chrono::hours{-1};
  const Diagnosis camera = diagnose(input);
  EXPECT_EQ(names_of(camera, Verdict::kFail), std::vector<std::string>{"camera_time_offset"});
  EXPECT_THAT(find(camera, "camera_time_offset").finding, HasSubstr("are 3600.0 s later than"));
}

}  // namespace
}  // namespace waymark
