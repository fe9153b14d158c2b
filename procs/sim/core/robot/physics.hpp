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

/// MuJoCo refuses a model, or the physics or the renderer fails: with what it says.
class SimulatorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Turning speeds of the driven wheels, or the angles they have turned by.
struct WheelPair {
  double left_rad{0.0};
  double right_rad{0.0};
};

/// Owns one MuJoCo model with its state. At construction the robot has come to rest on its wheels.
class Physics {
 public:
  /// @throws SimulatorError when the model cannot be compiled.
  explicit Physics(const std::string& mjcf);

  /// One time step; the wheels follow the target speeds [rad/s] as their motors can.
  void step(const WheelPair& target_speed_per_s);

  /// Lifts the robot and puts it down elsewhere, standing; the wheels do not turn.
  void put_down(const Se2& world_from_there);

  /// Moves a body of its own (see mjcf.hpp) to so far from where the model has it.
  void displace(const std::string& body, const Eigen::Vector3d& by_m);

  /// Planar pose of the base: position between the wheels, heading.
  Se2 world_from_base() const;
  /// The same with height and tilt.
  Eigen::Isometry3d world_from_base_3d() const;
  /// The same a moment later or earlier, if the velocity stays as it is.
  Eigen::Isometry3d world_from_base_3d_at(double later_s) const;
  /// Joint angles since construction; they grow beyond a turn.
  WheelPair wheel_angles() const;

  const mjModel& model() const { return *model_; }

  /// For rays and pictures; the poses of what does not move in it are always current.
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

/// Makes MuJoCo report errors and warnings as SimulatorError; by default it waits for a key and
/// writes files into the working directory.
void report_mujoco_errors_as_exceptions();

}  // namespace waymark
