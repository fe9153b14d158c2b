// SPDX-License-Identifier: BSD-3-Clause
// The moving robot: MuJoCo's model and state, driven by wheel speeds.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace waymark {

/// An error of MuJoCo or OpenGL, with its message, or a robot that does not arrive in time.
class SimulatorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A value per driven wheel: angle [rad] or speed [rad/s].
struct WheelPair {
  double left{0.0};
  double right{0.0};
};

/// Owns one MuJoCo model with its state. After construction the robot stands still on its wheels.
class Physics {
 public:
  /// @throws SimulatorError when the model cannot be compiled.
  explicit Physics(const std::string& mjcf);

  /// One time step; the wheels follow the target speeds [rad/s] within the torque of their motors.
  void step(const WheelPair& target_speed_per_s);

  /// Places the robot at a pose, at rest; the wheel angles do not change.
  void put_down(const Se2& world_from_there);

  /// Places a movable body (see body_of() in mjcf.hpp) at an offset from its original position.
  void displace(const std::string& body, const Eigen::Vector3d& by_m);

  /// Planar pose of the base: position between the wheels, heading.
  Se2 world_from_base() const;
  /// Pose of the base with height and tilt.
  Eigen::Isometry3d world_from_base_3d() const;
  /// The pose of the base at now + later_s (which may be negative), extrapolated at its present
  /// velocity.
  Eigen::Isometry3d world_from_base_3d_at(double later_s) const;
  /// Angles [rad] by which the wheels have turned since construction; not wrapped.
  WheelPair wheel_angles() const;

  const mjModel& model() const { return *model_; }

  /// MuJoCo's state, for ray casting and rendering. Body poses in it lag behind the joint
  /// coordinates: by one step after step(), and until the next step() after put_down().
  mjData& data() { return *data_; }

  const mjData& data() const { return *data_; }

 private:
  struct DeleteModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };

  struct DeleteData {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  struct Wheel {
    int position_address{0};
    int actuator{0};
    double angle_at_start_rad{0.0};
  };

  Wheel find_wheel(const char* name) const;
  void come_to_rest();

  std::unique_ptr<mjModel, DeleteModel> model_;
  std::unique_ptr<mjData, DeleteData> data_;
  int base_position_address_{0};
  int base_velocity_address_{0};
  Wheel left_{};
  Wheel right_{};
};

/// Makes MuJoCo throw SimulatorError on errors and warnings; by default it waits for a key and
/// writes files into the working directory.
void report_mujoco_errors_as_exceptions();

}  // namespace waymark
