// SPDX-License-Identifier: BSD-3-Clause
// World and robot as MJCF text, MuJoCo's modelling language.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/robot/robot_config.hpp"
#include "sim/core/world/world.hpp"

#include <string>

namespace waymark {

/// Groups of geoms; sensors see or ignore a whole group.
enum class GeomGroup : int {
  kWalls = 0,    ///< seen by LiDAR and camera, collide
  kRobot = 1,    ///< seen by nobody on board, collides
  kMarkers = 2,  ///< seen by the camera only, no contacts
  kFloor = 3,    ///< seen by the camera, carries the wheels
};

/// Names that the simulation looks up in the model.
namespace mjcf_names {
inline constexpr const char* kBase = "base";
inline constexpr const char* kLeftWheel = "left_wheel";
inline constexpr const char* kRightWheel = "right_wheel";
inline constexpr const char* kMarkerPrefix = "marker_";  ///< + index into World::markers
inline constexpr const char* kBoxPrefix = "box_";        ///< + index into World::boxes
}  // namespace mjcf_names

struct MjcfOptions {
  double time_step_s{1.0 / 600.0};
  double plate_size_m{0.6};  ///< side of a marker with its quiet zone
  int picture_width_px{640};
  int picture_height_px{480};
  Se2 world_from_start{};  ///< initial pose of the base
};

/// Name of the body of a marker or box, given the name of its geom. Only markers and boxes that
/// move, appear or disappear have a body of their own (a mocap body at the world's origin); the
/// others belong to the world body.
std::string body_of(const std::string& geom);

/// The model of a TurtleBot3 Waffle Pi (masses and sizes: turtlebot3_description) in the world.
/// The base frame lies on the floor between the wheels.
std::string to_mjcf(const World& world, const RobotConfig& robot, const MjcfOptions& options);

}  // namespace waymark
