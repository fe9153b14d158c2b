// SPDX-License-Identifier: BSD-3-Clause
#include "common/robot/robot_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::HasSubstr;

/// The problem with one setting; empty when it is accepted.
std::string problem_with(const std::string& setting) {
  try {
    load_config<RobotOnly>({{}, {setting}});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(RobotConfig, DegreesAndMillimetresAreRefused) {
  EXPECT_THAT(problem_with("robot.lidar.yaw_rad=180.0"), HasSubstr("robot.lidar.yaw_rad: got 180"));
  for (const char* wrong :
       {"robot.lidar.x_m=-64.0", "robot.lidar.y_m=32.0", "robot.lidar.z_m=132.0",
        "robot.lidar.z_m=-0.1", "robot.lidar.range_max_m=3500.0", "robot.camera.x_m=76.0",
        "robot.camera.y_m=-32.0", "robot.camera.z_m=103.0", "robot.camera.yaw_rad=-90.0"})
    EXPECT_NE(problem_with(wrong), "") << wrong;
}

TEST(RobotConfig, MountingsOfRealRobotsAreAccepted) {
  for (const char* right :
       {"robot.lidar.yaw_rad=3.141592653589793", "robot.lidar.yaw_rad=-3.141592653589793",
        "robot.lidar.x_m=-1.5", "robot.lidar.z_m=2.0", "robot.lidar.range_max_m=81.9"})
    EXPECT_EQ(problem_with(right), "");
}

}  // namespace
}  // namespace waymark
