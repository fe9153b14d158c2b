// SPDX-License-Identifier: BSD-3-Clause
// One fault at a time: the doctor reports that fault and no other.
#include "doctor/report.hpp"
#include "drive_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Fault {
  std::string check;
  DriveFaults faults;
  double value;
  double tolerance;
};

TEST(Doctor, EachFaultIsMeasuredAndNoOtherIsReported) {
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

}  // namespace
}  // namespace waymark
