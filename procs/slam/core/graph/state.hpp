// SPDX-License-Identifier: BSD-3-Clause
// The unknowns of the graph.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/motion/odometry_errors.hpp"

#include <Eigen/Core>

#include <compare>
#include <cstddef>
#include <deque>
#include <initializer_list>
#include <vector>

namespace waymark {

/// What odometry and camera get wrong in the same way all the time. Odometry: scale of distances,
/// drift [rad/m], scale of turns, LiDAR ahead of the wheels' axis [m] (OdometryErrors). Camera: yaw
/// of its mounting [rad], focal length (relative), standoff of the markers from their walls [m].
inline constexpr Eigen::Index kOdometryTerms = OdometryErrors::SizeAtCompileTime;
inline constexpr Eigen::Index kCameraTerms = 3;
inline constexpr Eigen::Index kCalibrationSize = kOdometryTerms + kCameraTerms;
using Calibration = Eigen::Matrix<double, kCalibrationSize, 1>;

inline OdometryErrors odometry_part(const Calibration& calibration) {
  return calibration.head<kOdometryTerms>();
}

inline Eigen::Vector3d camera_part(const Calibration& calibration) {
  return calibration.tail<kCameraTerms>();
}

enum class VariableKind { kCalibration, kKeyframe, kLandmark };

struct Variable {
  VariableKind kind{VariableKind::kCalibration};
  std::size_t index{0};

  auto operator<=>(const Variable&) const = default;

  Eigen::Index size() const { return kind == VariableKind::kCalibration ? kCalibrationSize : 3; }
};

/// Poses by their number; the oldest ones may be forgotten, and the others keep their numbers.
class PoseSequence {
 public:
  PoseSequence() = default;

  PoseSequence(std::initializer_list<Se2> poses) : poses_{poses} {}

  std::size_t size() const { return first_ + poses_.size(); }

  bool empty() const { return size() == 0; }

  /// @param index  of one that is not forgotten.
  Se2& operator[](std::size_t index) { return poses_[index - first_]; }

  const Se2& operator[](std::size_t index) const { return poses_[index - first_]; }

  Se2& back() { return poses_.back(); }

  const Se2& back() const { return poses_.back(); }

  void push_back(const Se2& pose) { poses_.push_back(pose); }

  void forget_before(std::size_t index) {
    for (; first_ < index; ++first_)
      poses_.pop_front();
  }

 private:
  std::size_t first_{0};  ///< that is not forgotten
  std::deque<Se2> poses_{};
};

/// Map frame. Poses move by additive (x, y, theta).
struct State {
  PoseSequence keyframes{};      ///< map_from_base
  std::vector<Se2> landmarks{};  ///< map_from_marker
  Calibration calibration{Calibration::Zero()};

  void retract(const Variable& variable, const Eigen::Ref<const Eigen::VectorXd>& step);
};

/// (x, y, theta) of one pose minus those of another.
inline Eigen::Vector3d pose_difference(const Se2& to, const Se2& from) {
  return {to.x() - from.x(), to.y() - from.y(), angle_difference(to.theta(), from.theta())};
}

/// Covariance or information of (x, y, theta) in axes that are turned by `rotation`.
inline Eigen::Matrix3d in_axes(const Eigen::Matrix2d& rotation, const Eigen::Matrix3d& matrix) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotation;
  return turn * matrix * turn.transpose();
}

}  // namespace waymark
