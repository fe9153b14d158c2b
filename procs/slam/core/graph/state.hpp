// SPDX-License-Identifier: BSD-3-Clause
// The unknowns of the graph.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/motion/odometry_errors.hpp"
#include "slam/core/motion/pose_sequence.hpp"

#include <Eigen/Core>

#include <compare>
#include <cstddef>
#include <vector>

namespace waymark {

/// Systematic errors: those of odometry and of the LiDAR's mounting (OdometryErrors), then those of
/// the camera: yaw of its mounting [rad], focal length (relative), and standoff of the markers from
/// their walls [m]. Names: kCalibrationTerms.
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

/// Values of all unknowns; poses in the map frame.
struct State {
  PoseSequence keyframes{};      ///< map_from_base
  std::vector<Se2> landmarks{};  ///< map_from_marker
  Calibration calibration{Calibration::Zero()};

  /// Needs a keyframe or a landmark.
  const Se2& pose(const Variable& variable) const {
    return variable.kind == VariableKind::kKeyframe ? keyframes[variable.index]
                                                    : landmarks[variable.index];
  }

  /// Applies a step. Poses step in their own frames, along arcs: relative information, such as the
  /// prior of the window, stays valid when all poses turn together.
  void retract(const Variable& variable, const Eigen::Ref<const Eigen::VectorXd>& step);
};

}  // namespace waymark
