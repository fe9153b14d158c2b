// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/robot/physics.hpp"

#include "sim/core/world/mjcf.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace waymark {
namespace {

constexpr double kSettlingTime_s = 0.5;

/// MuJoCo reads models from files; this one is in memory.
mjModel* compile(const std::string& mjcf) {
  constexpr const char* kName = "world.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const int size = static_cast<int>(mjcf.size());
  if (mj_makeEmptyFileVFS(files.get(), kName, size) != 0) {
    throw SimulatorError{"MuJoCo: no room for the model's text"};
  }
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kName)], mjcf.data(), mjcf.size());
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteVFS(files.get());
  if (model == nullptr) throw SimulatorError{std::string{"MuJoCo: "} + error.data()};
  return model;
}

[[noreturn]] void throw_simulator_error(const char* text) {
  throw SimulatorError{std::string{"MuJoCo: "} + text};
}

}  // namespace

void report_mujoco_errors_as_exceptions() {
  mju_user_error = throw_simulator_error;
  mju_user_warning = throw_simulator_error;
}

Physics::Physics(const std::string& mjcf)
    : model_{(report_mujoco_errors_as_exceptions(), compile(mjcf))} {
  data_.reset(mj_makeData(model_.get()));
  const int base = mj_name2id(model_.get(), mjOBJ_BODY, mjcf_names::kBase);
  base_position_address_ = model_->jnt_qposadr[model_->body_jntadr[base]];
  base_velocity_address_ = model_->jnt_dofadr[model_->body_jntadr[base]];
  left_ = find_wheel(mjcf_names::kLeftWheel);
  right_ = find_wheel(mjcf_names::kRightWheel);
  come_to_rest();
}

Physics::Wheel Physics::find_wheel(const char* name) const {
  const int joint = mj_name2id(model_.get(), mjOBJ_JOINT, name);
  return {model_->jnt_qposadr[joint], mj_name2id(model_.get(), mjOBJ_ACTUATOR, name), 0.0};
}

/// Contacts are soft: the robot sinks into the floor by micrometres before it is at rest.
void Physics::come_to_rest() {
  for (int i = 0; i * model_->opt.timestep < kSettlingTime_s; ++i)
    step({});
  left_.angle_at_start_rad = data_->qpos[left_.position_address];
  right_.angle_at_start_rad = data_->qpos[right_.position_address];
}

void Physics::step(const WheelPair& target_speed_per_s) {
  data_->ctrl[left_.actuator] = target_speed_per_s.left;
  data_->ctrl[right_.actuator] = target_speed_per_s.right;
  mj_step(model_.get(), data_.get());
}

void Physics::put_down(const Se2& world_from_there) {
  // Height and tilt do not change, so that the robot rests on its wheels and casters at once.
  const double turn_rad = angle_difference(world_from_there.theta(), world_from_base().theta());
  double* position = data_->qpos + base_position_address_;
  const Eigen::Quaterniond before{position[3], position[4], position[5], position[6]};
  const Eigen::Quaterniond after =
      Eigen::Quaterniond{Eigen::AngleAxisd{turn_rad, Eigen::Vector3d::UnitZ()}} * before;
  position[0] = world_from_there.x();
  position[1] = world_from_there.y();
  position[3] = after.w();
  position[4] = after.x();
  position[5] = after.y();
  position[6] = after.z();
  std::fill_n(data_->qvel, model_->nv, 0.0);
}

void Physics::displace(const std::string& body, const Eigen::Vector3d& by_m) {
  const int number = mj_name2id(model_.get(), mjOBJ_BODY, body.c_str());
  const int mocap = number < 0 ? -1 : model_->body_mocapid[number];
  if (mocap < 0) throw SimulatorError{"no body that can be displaced: " + body};
  Eigen::Map<Eigen::Vector3d>{data_->mocap_pos + 3 * mocap} = by_m;
  mj_kinematics(model_.get(), data_.get());  // updates the poses for rays and pictures
}

Eigen::Isometry3d Physics::world_from_base_3d_at(double later_s) const {
  // A free joint's velocity: linear in the world, angular about the body's own axes.
  const double* velocity = data_->qvel + base_velocity_address_;
  const Eigen::Vector3d turned_rad = later_s * Eigen::Map<const Eigen::Vector3d>{velocity + 3};
  Eigen::Isometry3d world_from_base = world_from_base_3d();
  world_from_base.translation() += later_s * Eigen::Map<const Eigen::Vector3d>{velocity};
  if (turned_rad.norm() > 0.0)
    world_from_base.rotate(Eigen::AngleAxisd{turned_rad.norm(), turned_rad.normalized()});
  return world_from_base;
}

Eigen::Isometry3d Physics::world_from_base_3d() const {
  // From the free joint's coordinates, because mj_step() leaves body poses one step behind them.
  const double* position = data_->qpos + base_position_address_;
  Eigen::Isometry3d world_from_base = Eigen::Isometry3d::Identity();
  world_from_base.translation() = Eigen::Map<const Eigen::Vector3d>{position};
  world_from_base.linear() =
      Eigen::Quaterniond{position[3], position[4], position[5], position[6]}.toRotationMatrix();
  return world_from_base;
}

Se2 Physics::world_from_base() const {
  const Eigen::Isometry3d world_from_base = world_from_base_3d();
  const Eigen::Vector3d forward = world_from_base.linear().col(0);
  return {world_from_base.translation().head<2>(), std::atan2(forward.y(), forward.x())};
}

WheelPair Physics::wheel_angles() const {
  return {data_->qpos[left_.position_address] - left_.angle_at_start_rad,
          data_->qpos[right_.position_address] - right_.angle_at_start_rad};
}

}  // namespace waymark
