// SPDX-License-Identifier: BSD-3-Clause
#include "common/robot/robot_config.hpp"

#include <numbers>
#include <set>

namespace waymark {
namespace {

// Bounds on sensor poses that catch angles in degrees and positions in centimetres.
constexpr Range kAngle{-std::numbers::pi, std::numbers::pi};
constexpr Range kPlace_m{-5.0, 5.0};
constexpr Range kHeight_m{0.0, 5.0};
constexpr Range kLongestRange_m{0.01, 500.0};
constexpr Range kLate_s{-1.0, 1.0};

}  // namespace

void BaseConfig::describe(Fields& fields) {
  fields.field("wheel_radius_m", wheel_radius_m, {0.001, 1.0}, "radius of a driven wheel");
  fields.field("wheel_separation_m", wheel_separation_m, {0.01, 5.0},
               "distance between the wheels' contact points");
  fields.field("odometry_rate_hz", odometry_rate_hz, {1.0, 200.0}, "ODOMETRY messages per second");
}

void LidarConfig::describe(Fields& fields) {
  fields.field("x_m", x_m, kPlace_m, "position in the base frame");
  fields.field("y_m", y_m, kPlace_m, "position in the base frame");
  fields.field("z_m", z_m, kHeight_m, "height of the scan plane over the floor");
  fields.field("yaw_rad", yaw_rad, kAngle, "direction of the LiDAR's x axis in the base frame");
  fields.field("num_beams", num_beams, {1, 4000}, "beams in one turn");
  fields.field("rate_hz", rate_hz, {0.1, 100.0}, "turns per second");
  fields.field("range_min_m", range_min_m, kNotNegative, "shortest range measured");
  fields.field("range_max_m", range_max_m, kLongestRange_m, "longest range measured");
  fields.field("range_sigma_m", range_sigma_m, kPositive, "standard deviation of a range");
  fields.field("mirrored", mirrored, "beams count clockwise, as of a LiDAR that hangs upside down");
  fields.field("late_s", late_s, kLate_s, "its stamps are that much behind odometry's");
}

Eigen::Isometry3d CameraConfig::base_from_camera() const {
  // Columns: the optical axes (right, down, forward) in a body frame (forward, left, up).
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.translation() = Eigen::Vector3d{x_m, y_m, z_m};
  base_from_camera.linear() = (Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()} *
                               Eigen::AngleAxisd{pitch_rad, Eigen::Vector3d::UnitY()} *
                               Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitX()})
                                  .toRotationMatrix() *
                              body_from_optical;
  return base_from_camera;
}

void CameraConfig::describe(Fields& fields) {
  fields.field("width_px", width_px, {16, 8192}, "image width");
  fields.field("height_px", height_px, {16, 8192}, "image height");
  fields.field("fx_px", fx_px, {1.0, 1e5}, "focal length along u");
  fields.field("fy_px", fy_px, {1.0, 1e5}, "focal length along v");
  fields.field("cx_px", cx_px, kAnyNumber, "principal point; pixel centres are integers");
  fields.field("cy_px", cy_px, kAnyNumber, "principal point");
  fields.field("distortion", distortion, kAnyNumber, "OpenCV's k1 k2 p1 p2 k3");
  fields.field("x_m", x_m, kPlace_m, "position in the base frame");
  fields.field("y_m", y_m, kPlace_m, "position in the base frame");
  fields.field("z_m", z_m, kHeight_m, "height over the floor");
  fields.field("roll_rad", roll_rad, kAngle, "turn about the viewing direction");
  fields.field("pitch_rad", pitch_rad, kAngle, "positive looks down");
  fields.field("yaw_rad", yaw_rad, kAngle, "positive looks left");
  fields.field("rate_hz", rate_hz, {0.1, 200.0}, "frames per second");
  fields.field("late_s", late_s, kLate_s, "its stamps are that much behind odometry's");
  fields.field("focal_sigma", focal_sigma, kNotNegative,
               "how well fx and fy are known, relative; learnt while driving, unless 0");
  fields.field("yaw_sigma_rad", yaw_sigma_rad, kNotNegative,
               "how well yaw_rad is known; learnt while driving, unless 0");
  fields.field(
      "bearing_sigma_rad", bearing_sigma_rad, kNotNegative,
      "error of bearings that neighbouring frames have in common: what is left of the lens");
  fields.field("position_sigma_m", position_sigma_m, kNotNegative,
               "the same of places: the mounting's position, stamps that are late");
}

void CameraConfig::check(Problems& problems) const {
  if (distortion.size() != 5) {
    problems.add("robot.camera.distortion", "got " + std::to_string(distortion.size()) +
                                                " numbers, expected 5 (k1 k2 p1 p2 k3)");
  }
}

void MarkerConfig::describe(Fields& fields) {
  fields.field("dictionary", dictionary, "predefined dictionary of OpenCV's aruco module");
  fields.field("size_m", size_m, {0.005, 10.0}, "side of the black square");
  fields.field("ids", ids, {0, 100000}, "ids in use; [] = every id of the dictionary");
  fields.field("standoff_sigma_m", standoff_sigma_m, kNotNegative,
               "how far all markers hang before their walls; learnt while driving, unless 0");
  fields.field("bulge_sigma_m", bulge_sigma_m, kNotNegative, "how far they differ in that");
  fields.field("skew_sigma_rad", skew_sigma_rad, kNotNegative, "how skew they hang");
  fields.field("survey_file", survey_file,
               "CSV with the columns of markers.csv: surveyed markers, which define the map's "
               "frame; a path from where slam is started; empty: none");
}

void RobotConfig::describe(Fields& fields) {
  fields.section("base", base);
  fields.section("lidar", lidar);
  fields.section("camera", camera);
  fields.section("markers", markers);
}

void RobotConfig::check(Problems& problems) const {
  if (lidar.range_min_m >= lidar.range_max_m) {
    problems.add("robot.lidar.range_min_m", "must be below range_max_m");
  }
  camera.check(problems);
  if (std::set<int>(markers.ids.begin(), markers.ids.end()).size() != markers.ids.size()) {
    problems.add("robot.markers.ids", "an id is listed twice");
  }
}

void RobotOnly::describe(Fields& fields) {
  fields.section("robot", robot);
}

void RobotOnly::check(Problems& problems) const {
  robot.check(problems);
}

std::string dump_robot_config(const RobotConfig& robot) {
  return dump_config(RobotOnly{robot});
}

}  // namespace waymark
