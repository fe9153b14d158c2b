// SPDX-License-Identifier: BSD-3-Clause
// The robot's description, known to every process: its sensors, their mounting, and what its
// markers look like, but no positions in the world.
#pragma once

#include "common/config/config.hpp"
#include "common/geometry/se2.hpp"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace waymark {

/// Differential drive. Defaults: ROBOTIS TurtleBot3 Waffle Pi.
struct BaseConfig {
  double wheel_radius_m{0.033};
  double wheel_separation_m{0.287};
  double odometry_rate_hz{30.0};

  void describe(Fields& fields);
};

/// Planar LiDAR. Defaults: HLDS LDS-01 as mounted on the Waffle Pi (turtlebot3_description).
struct LidarConfig {
  double x_m{-0.064};
  double y_m{0.0};
  double z_m{0.132};
  double yaw_rad{0.0};
  int num_beams{360};
  double rate_hz{5.0};
  double range_min_m{0.12};
  double range_max_m{3.5};
  double range_sigma_m{0.01};
  bool mirrored{false};
  double late_s{0.0};

  Se2 base_from_lidar() const { return {x_m, y_m, yaw_rad}; }

  /// Names, units and explanations of the keys: robot_config.cpp.
  void describe(Fields& fields);
};

/// Pinhole camera with OpenCV's five-parameter lens. Defaults: Raspberry Pi camera v2 of the Waffle
/// Pi, 62.2 degrees across 640 pixels. Pixel centres are integers, so the middle of the image is
/// (W-1)/2.
struct CameraConfig {
  int width_px{640};
  int height_px{480};
  double fx_px{530.4663};
  double fy_px{530.4663};
  double cx_px{319.5};
  double cy_px{239.5};
  std::vector<double> distortion{0.0, 0.0, 0.0, 0.0, 0.0};
  double x_m{0.076};
  double y_m{0.0};
  double z_m{0.103};
  double roll_rad{0.0};
  double pitch_rad{0.0};
  double yaw_rad{0.0};
  double rate_hz{10.0};
  double late_s{0.0};
  double focal_sigma{0.002};
  double yaw_sigma_rad{0.0087};
  double bearing_sigma_rad{0.0001};
  double position_sigma_m{0.0003};

  /// Pose of the optical frame (x right, y down, z forward) in the base frame.
  Eigen::Isometry3d base_from_camera() const;
  /// Names, units and explanations of the keys: robot_config.cpp.
  void describe(Fields& fields);
  void check(Problems& problems) const;
};

/// What the markers look like, and how precisely they are mounted on the walls.
struct MarkerConfig {
  std::string dictionary{"DICT_6X6_250"};
  double size_m{0.4};
  std::vector<int> ids{};
  double standoff_sigma_m{0.003};
  double bulge_sigma_m{0.002};
  double skew_sigma_rad{0.01};
  std::string survey_file{};

  /// Names, units and explanations of the keys: robot_config.cpp.
  void describe(Fields& fields);
};

struct RobotConfig {
  BaseConfig base{};
  LidarConfig lidar{};
  CameraConfig camera{};
  MarkerConfig markers{};

  void describe(Fields& fields);
  void check(Problems& problems) const;
};

/// The content of a robot.toml: section [robot] alone.
struct RobotOnly {
  RobotConfig robot{};

  void describe(Fields& fields);
  void check(Problems& problems) const;
};

/// Section [robot] as TOML.
std::string dump_robot_config(const RobotConfig& robot);

}  // namespace waymark
