// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/mjcf.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// Masses and sizes of the Waffle Pi, from turtlebot3_description, turtlebot3_waffle_pi.urdf. The
// body has the data sheet's total of 1.8 kg less the wheels.
constexpr double kWheelMass_kg = 0.0285;
constexpr double kWheelWidth_m = 0.018;
constexpr double kBodyMass_kg = 1.8 - 2 * kWheelMass_kg;
constexpr const char* kBodyInertia = "0.0087 0.0086 0.0146";  // [kg m^2]
constexpr double kBodyCentreX_m = -0.064;
constexpr double kBodyHalfLength_m = 0.133;
constexpr double kBodyHalfHeight_m = 0.047;
constexpr double kGroundClearance_m = 0.010;
constexpr double kCasterX_m = -0.177;
constexpr double kCasterY_m = 0.064;
constexpr double kCasterRadius_m = 0.010;

// Wheel servo: torque = gain * (target speed - speed); the wheel reaches its speed in about 20 ms.
constexpr double kServoGain_Nms = 0.05;
constexpr double kMotorTorque_Nm = 1.4;      // limit; an XM430-W210 stalls at 3 Nm (12 V)
constexpr double kRotorInertia_kgm2 = 1e-4;  // at the wheel; keeps a lifted wheel stable

// Contacts about as stiff as the time step allows (time constant: two steps). With MuJoCo's
// defaults the wheels sink in by 0.4 mm, and the robot drives 0.6 % less far than the wheels roll.
constexpr const char* kStiffContact = R"(solref="0.004 1" solimp="0.98 0.999 0.0001")";

/// Options of the whole model. extent = 1, because znear and zfar are multiples of the extent.
std::string header(const MjcfOptions& options) {
  return fmt::format(R"(<mujoco model="waymark">
  <compiler angle="radian"/>
  <option timestep="{:.17g}" cone="elliptic" impratio="10"/>
  <size njmax="500" nconmax="100"/>
  <statistic extent="1" center="0 0 0"/>
  <visual>
    <global offwidth="{}" offheight="{}"/>
    <map znear="0.03" zfar="500"/>
    <headlight ambient="0.9 0.9 0.9" diffuse="0.15 0.15 0.15" specular="0 0 0"/>
    <quality shadowsize="0" offsamples="0" numquads="1"/>
  </visual>
)",
                     options.time_step_s, options.picture_width_px, options.picture_height_px);
}

/// Plates are white; PlatePrints draws the markers on them.
std::string assets() {
  return R"(  <asset>
    <material name="plate" rgba="1 1 1 1" specular="0" shininess="0" emission="0.2"/>
    <material name="side_wall" rgba="0.72 0.71 0.68 1" specular="0" shininess="0"/>
    <material name="end_wall" rgba="0.46 0.50 0.56 1" specular="0" shininess="0"/>
    <material name="door" rgba="0.50 0.36 0.24 1" specular="0" shininess="0"/>
    <material name="box" rgba="0.36 0.42 0.34 1" specular="0" shininess="0"/>
    <material name="floor" rgba="0.33 0.30 0.27 1" specular="0" shininess="0"/>
    <material name="ceiling" rgba="0.93 0.93 0.93 1" specular="0" shininess="0"/>
    <material name="robot" rgba="0.15 0.15 0.17 1"/>
  </asset>
)";
}

const char* material_of(WallKind kind) {
  switch (kind) {
    case WallKind::kSide:
      return "side_wall";
    case WallKind::kEnd:
      return "end_wall";
    case WallKind::kDoor:
      return "door";
  }
  return "";
}

std::string wall_geom(const Wall& wall) {
  const Eigen::Vector2d along = wall.along();
  const Eigen::Vector2d centre = 0.5 * (wall.from_m + wall.to_m) +
                                 0.5 * wall.thickness_m * wall.outward() +
                                 0.5 * (wall.beyond_to_m - wall.beyond_from_m) * along;
  const double half_length = 0.5 * wall.length_m() + 0.5 * (wall.beyond_from_m + wall.beyond_to_m);
  return fmt::format(
      "    <geom type=\"box\" group=\"{}\" material=\"{}\" pos=\"{:.17g} {:.17g} {:.17g}\" "
      "size=\"{:.17g} {:.17g} {:.17g}\" xyaxes=\"{:.17g} {:.17g} 0 {:.17g} {:.17g} 0\"/>\n",
      static_cast<int>(GeomGroup::kWalls), material_of(wall.kind), centre.x(), centre.y(),
      0.5 * wall.height_m, half_length, 0.5 * wall.thickness_m, 0.5 * wall.height_m, along.x(),
      along.y(), -along.y(), along.x());
}

/// A thin box; the marker is on its +z face, its x axis points to the right as seen from the front.
std::string marker_geom(const MarkerPlate& marker, std::size_t index, double plate_size_m) {
  const Eigen::Vector3d facing{std::cos(marker.yaw_rad), std::sin(marker.yaw_rad), 0.0};
  const Eigen::Vector3d right{-facing.y(), facing.x(), 0.0};
  const Eigen::Vector3d centre = marker.centre_m - 0.5 * kPlateThickness_m * facing;
  return fmt::format(
      "    <geom name=\"{}{}\" type=\"box\" group=\"{}\" material=\"plate\" contype=\"0\" "
      "conaffinity=\"0\" pos=\"{:.17g} {:.17g} {:.17g}\" size=\"{:.17g} {:.17g} {:.17g}\" "
      "xyaxes=\"{:.17g} {:.17g} 0 0 0 1\"/>\n",
      mjcf_names::kMarkerPrefix, index, static_cast<int>(GeomGroup::kMarkers), centre.x(),
      centre.y(), centre.z(), 0.5 * plate_size_m, 0.5 * plate_size_m, 0.5 * kPlateThickness_m,
      right.x(), right.y());
}

std::string box_geom(const BoxConfig& box, std::size_t index) {
  return fmt::format(
      "    <geom name=\"{}{}\" type=\"box\" group=\"{}\" material=\"box\" pos=\"{:.17g} {:.17g} "
      "{:.17g}\" size=\"{:.17g} {:.17g} {:.17g}\" euler=\"0 0 {:.17g}\"/>\n",
      mjcf_names::kBoxPrefix, index, static_cast<int>(GeomGroup::kWalls), box.x_m, box.y_m,
      0.5 * box.height_m, 0.5 * box.length_m, 0.5 * box.width_m, 0.5 * box.height_m,
      radians(box.yaw_deg));
}

std::string on_its_own_body(const std::string& name, const std::string& geom) {
  return fmt::format("    <body name=\"{}\" mocap=\"true\">\n{}    </body>\n", body_of(name), geom);
}

/// Floor and ceiling, drawn as far as the walls extend (contacts do not end there), as one piece
/// each: MuJoCo draws infinite planes in thousands of pieces, which costs 10 ms per frame.
std::string floor_and_ceiling(const World& world) {
  Eigen::AlignedBox2d extent;
  for (const Wall& wall : world.walls)
    extent.extend(wall.from_m).extend(wall.to_m);
  const Eigen::Vector2d half = 0.5 * extent.sizes();
  const double piece_m = extent.sizes().maxCoeff();
  const auto plane = [&](const char* material, double z_m, const char* more) {
    return fmt::format(
        "    <geom type=\"plane\" group=\"{}\" material=\"{}\" size=\"{:.17g} {:.17g} {:.17g}\" "
        "pos=\"{:.17g} {:.17g} {:.17g}\" {}/>\n",
        static_cast<int>(GeomGroup::kFloor), material, half.x(), half.y(), piece_m,
        extent.center().x(), extent.center().y(), z_m, more);
  };
  return plane("floor", 0.0, "") +
         plane("ceiling", world.ceiling_height_m,
               R"(euler="3.141592653589793 0 0" contype="0" conaffinity="0")");
}

std::string world_geoms(const World& world, const MjcfOptions& options) {
  std::string text =
      "    <light directional=\"true\" castshadow=\"false\" pos=\"0 0 10\" dir=\"0.35 0.2 -1\" "
      "diffuse=\"0.3 0.3 0.3\" specular=\"0 0 0\"/>\n" +
      floor_and_ceiling(world);
  for (const Wall& wall : world.walls)
    text += wall_geom(wall);
  for (std::size_t i = 0; i < world.markers.size(); ++i) {
    const std::string geom = marker_geom(world.markers[i], i, options.plate_size_m);
    const bool moves = std::any_of(world.moves.begin(), world.moves.end(),
                                   [i](const MarkerMove& move) { return move.marker == i; });
    text += moves ? on_its_own_body(mjcf_names::kMarkerPrefix + std::to_string(i), geom) : geom;
  }
  for (std::size_t i = 0; i < world.boxes.size(); ++i) {
    const std::string geom = box_geom(world.boxes[i], i);
    const bool stays = world.boxes[i].present.is_always();
    text += stays ? geom : on_its_own_body(mjcf_names::kBoxPrefix + std::to_string(i), geom);
  }
  return text;
}

/// A tyre with a crowned tread (an ellipsoid) has one contact point, so the wheel separation is
/// exact.
std::string wheel(const char* name, double y_m, double radius_m) {
  return fmt::format(
      R"(      <body name="{0}" pos="0 {1:.17g} {2:.17g}">
        <joint name="{0}" type="hinge" axis="0 1 0" armature="{3}"/>
        <geom type="ellipsoid" group="{4}" material="robot" size="{2:.17g} {5:.17g} {2:.17g}" mass="{6}" friction="1 0.005 0.0001" priority="1" {7}/>
      </body>
)",
      name, y_m, radius_m, kRotorInertia_kgm2, static_cast<int>(GeomGroup::kRobot),
      0.5 * kWheelWidth_m, kWheelMass_kg, kStiffContact);
}

/// Casters have no friction, because dragging casters would make the wheels slip. This needs
/// priority=1: without it, a contact takes the greater friction of its two geoms.
std::string caster(double y_m) {
  return fmt::format(
      "      <geom type=\"sphere\" group=\"{}\" material=\"robot\" pos=\"{} {} {}\" size=\"{}\" "
      "mass=\"0\" condim=\"1\" priority=\"1\" {}/>\n",
      static_cast<int>(GeomGroup::kRobot), kCasterX_m, y_m, kCasterRadius_m, kCasterRadius_m,
      kStiffContact);
}

std::string robot_body(const RobotConfig& robot, const Se2& world_from_start) {
  std::string text = fmt::format(
      R"(    <body name="{}" pos="{:.17g} {:.17g} 0" euler="0 0 {:.17g}">
      <freejoint/>
      <inertial pos="{} 0 {}" mass="{}" diaginertia="{}"/>
      <geom type="box" group="{}" material="robot" pos="{} 0 {}" size="{} {} {}" mass="0" friction="0.2 0 0" priority="1"/>
)",
      mjcf_names::kBase, world_from_start.x(), world_from_start.y(), world_from_start.theta(),
      kBodyCentreX_m, kGroundClearance_m + kBodyHalfHeight_m, kBodyMass_kg, kBodyInertia,
      static_cast<int>(GeomGroup::kRobot), kBodyCentreX_m, kGroundClearance_m + kBodyHalfHeight_m,
      kBodyHalfLength_m, kBodyHalfLength_m, kBodyHalfHeight_m);
  text += caster(kCasterY_m) + caster(-kCasterY_m);
  const double half_separation = 0.5 * robot.base.wheel_separation_m;
  text += wheel(mjcf_names::kLeftWheel, half_separation, robot.base.wheel_radius_m);
  text += wheel(mjcf_names::kRightWheel, -half_separation, robot.base.wheel_radius_m);
  return text + "    </body>\n";
}

std::string wheel_servo(const char* joint) {
  return fmt::format(
      "    <velocity name=\"{0}\" joint=\"{0}\" kv=\"{1}\" forcelimited=\"true\" forcerange=\"-{2} "
      "{2}\"/>\n",
      joint, kServoGain_Nms, kMotorTorque_Nm);
}

}  // namespace

std::string body_of(const std::string& geom) {
  return geom + "_body";
}

std::string to_mjcf(const World& world, const RobotConfig& robot, const MjcfOptions& options) {
  return header(options) + assets() + "  <worldbody>\n" + world_geoms(world, options) +
         robot_body(robot, options.world_from_start) + "  </worldbody>\n  <actuator>\n" +
         wheel_servo(mjcf_names::kLeftWheel) + wheel_servo(mjcf_names::kRightWheel) +
         "  </actuator>\n</mujoco>\n";
}

}  // namespace waymark
