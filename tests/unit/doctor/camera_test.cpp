// SPDX-License-Identifier: BSD-3-Clause
// Checks of camera and markers, and the parameters that are written for them.
#include "corridor_drive.hpp"
#include "doctor/camera/camera_calibration.hpp"
#include "doctor/doctor.hpp"
#include "doctor/verdict.hpp"
#include "drive_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace waymark {
namespace {

using ::testing::HasSubstr;

Check check_of(const DoctorInput& input, const std::string& name) {
  const Diagnosis diagnosis = diagnose(input);
  return *std::ranges::find(diagnosis.checks, name, &Check::name);
}

TEST(DoctorsCamera, ACameraThatIsTwentyMillisecondsLateIsAWarning) {
  const Check check = check_of(drive_in_room({.camera_late_s = 0.02}), "camera_time_offset");
  EXPECT_EQ(check.verdict, Verdict::kWarn) << check.finding;
  EXPECT_NEAR(check.value.value(), 20.0, 4.0);
  EXPECT_THAT(check.remedy, HasSubstr("robot.camera.late_s = 0.0"));
}

TEST(DoctorsCamera, MeasuredParametersAreWrittenIntoTheRobotFile) {
  const DoctorInput input = drive_in_room({.marker_size = 0.96});
  const Diagnosis diagnosis = diagnose(input);
  EXPECT_NEAR(diagnosis.robot.markers.size_m, 0.96 * input.described->markers.size_m, 0.004);
  EXPECT_NEAR(diagnosis.robot.camera.fx_px, input.described->camera.fx_px, 1.6);  // 0.3 %
}

/// No described value is contradicted, but all are measured much better than the limits.
TEST(DoctorsCamera, AccurateMeasurementsAreWrittenEvenIfTheDescriptionPasses) {
  const DoctorInput input = drive_in_room({.base_from_lidar = Se2{0.11, -0.05, 0.01},
                                           .lidar_late_s = 0.01,
                                           .focal = 1.006,
                                           .marker_size = 1.005,
                                           .camera_yaw_rad = 0.005,
                                           .camera_late_s = 0.006});
  const Diagnosis diagnosis = diagnose(input);
  for (const Check& check : diagnosis.checks)
    EXPECT_EQ(check.verdict, Verdict::kPass) << check.name << " " << check.finding;
  const RobotConfig& described = *input.described;
  const RobotConfig& written = diagnosis.robot;
  EXPECT_NEAR(written.lidar.x_m, 0.11, 0.002);
  EXPECT_NEAR(written.lidar.yaw_rad, 0.01, 0.001);
  EXPECT_NEAR(written.lidar.late_s, 0.01, 0.002);
  EXPECT_NEAR(written.camera.fx_px / described.camera.fx_px, 1.006, 0.002);
  EXPECT_NEAR(written.camera.yaw_rad, 0.005, 0.001);
  EXPECT_NEAR(written.camera.late_s, 0.006, 0.002);
  EXPECT_NEAR(written.markers.size_m / described.markers.size_m, 1.005, 0.002);
}

TEST(DoctorsVerdict, OnlyWhatIsContradictedOrMeasuredMuchBetterThanItsLimitIsWritten) {
  constexpr DeviationLimits kLimits{0.01, 0.05};
  const auto is_written = [&](double deviation, double sigma) {
    return is_worth_writing(verdict_of(deviation, sigma, kLimits), deviation, sigma, kLimits);
  };
  EXPECT_TRUE(is_written(0.02, 0.003));    // WARN
  EXPECT_TRUE(is_written(0.005, 0.001));   // passes, but is 5 sigma off
  EXPECT_FALSE(is_written(0.002, 0.001));  // not clearly different
  EXPECT_FALSE(is_written(0.0298, 0.0094));
}

TEST(DoctorsCamera, AStraightCorridorDoesNotDetermineTheFocalLength) {
  const DoctorInput input = drive_in_corridor();
  const Diagnosis diagnosis = diagnose(input);
  EXPECT_EQ(find(diagnosis, "odometry_distance_scale").verdict, Verdict::kUnchecked);
  EXPECT_EQ(find(diagnosis, "focal_length").verdict, Verdict::kUnchecked)
      << find(diagnosis, "focal_length").finding;
  EXPECT_EQ(find(diagnosis, "marker_size").verdict, Verdict::kPass);
  EXPECT_EQ(diagnosis.robot.camera.fx_px, input.described->camera.fx_px);
}

TEST(DoctorsCamera, NoiseOfDistancesDoesNotShrinkTheFocalLength) {
  constexpr double kScaleSigma = 0.01;
  const DoctorInput input = drive_in_corridor();
  const auto found =
      calibrate_camera(input.camera->sightings, input.described->camera, input.described->markers,
                       input.log, Duration{0}, {kScaleSigma, kScaleSigma});
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->focal.value, 1.0, 0.005) << "with an exact odometry scale";
  EXPECT_GE(found->focal.sigma, 0.9 * kScaleSigma) << "which the calibration does not know";
}

TEST(DoctorsCamera, AWrongOdometryScaleDoesNotBiasTheFocalLength) {
  const DoctorInput input = drive_in_room({.distance_scale = 0.95});
  EXPECT_EQ(check_of(input, "focal_length").verdict, Verdict::kPass);
  EXPECT_EQ(check_of(input, "odometry_distance_scale").verdict, Verdict::kWarn);
}

TEST(DoctorsCamera, OdometryOfWrongScalesIsCorrectedAlongItsArcs) {
  constexpr double kStep_m = 0.05;
  constexpr double kTurn_rad = 0.06;
  constexpr int kNumSteps = 100;
  const auto on_circle = [](double distance_scale, double turn_scale) {
    const double turn_rad = turn_scale * kTurn_rad;
    const double radius_m = distance_scale * kStep_m / turn_rad;
    std::vector<ImportedPose> poses;
    for (int i = 0; i <= kNumSteps; ++i) {
      const double angle_rad = i * turn_rad;
      poses.push_back({.pose = {radius_m * std::sin(angle_rad),
                                radius_m * (1.0 - std::cos(angle_rad)), angle_rad}});
    }
    return poses;
  };
  const Se2 expected = on_circle(1.0, 1.0).back().pose;
  const Se2 corrected = rescaled(on_circle(1.25, 1.2), 1.25, 1.2).back().pose;
  EXPECT_NEAR((corrected.translation() - expected.translation()).norm(), 0.0, 0.002);
  EXPECT_NEAR(angle_difference(corrected.theta(), expected.theta()), 0.0, 1e-9);
}

TEST(DoctorsCamera, MarkersOfAnotherDictionaryAreReportedWithItsName) {
  DoctorInput input = drive_in_room({.duration_s = 20.0});
  input.camera->markers_of_described = 2;  // read by chance
  input.camera->markers_by_dictionary = {{"DICT_4X4_1000", 60}, {"DICT_7X7_1000", 1}};
  input.camera->largest_id = {{"DICT_4X4_1000", 70}, {"DICT_7X7_1000", 5}};
  const Diagnosis diagnosis = diagnose(input);
  const Check& check =
      *std::ranges::find(diagnosis.checks, std::string{"marker_dictionary"}, &Check::name);
  EXPECT_EQ(check.verdict, Verdict::kFail);
  EXPECT_THAT(check.finding,
              HasSubstr("60 markers are read with DICT_4X4_100, 2 with DICT_6X6_250"));
  EXPECT_THAT(check.remedy, HasSubstr("\"DICT_4X4_100\""));
  EXPECT_EQ(diagnosis.robot.markers.dictionary, "DICT_4X4_100");
}

TEST(DoctorsCamera, BlurAndUnreadableFramesAreNamed) {
  DoctorInput input = drive_in_room({.duration_s = 20.0});
  std::ranges::fill(input.camera->blurs_px, 4.0);
  input.camera->problems["another size"] = input.camera->num_examined / 2;
  EXPECT_EQ(check_of(input, "blur").verdict, Verdict::kFail);
  const Check frames = check_of(input, "camera_frames");
  EXPECT_EQ(frames.verdict, Verdict::kFail);
  EXPECT_THAT(frames.finding, HasSubstr("another size"));
}

TEST(DoctorsCamera, WithoutMarkersTheirChecksAreSkipped) {
  DoctorInput input = drive_in_room({.duration_s = 20.0});
  input.camera->sightings.clear();
  input.camera->blurs_px.clear();
  input.camera->markers_of_described = 0;
  for (const char* name :
       {"marker_dictionary", "blur", "focal_length", "marker_size", "camera_yaw"}) {
    EXPECT_EQ(check_of(input, name).verdict, Verdict::kUnchecked) << name;
  }
}

}  // namespace
}  // namespace waymark
