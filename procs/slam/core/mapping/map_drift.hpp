// SPDX-License-Identifier: BSD-3-Clause
// How far the map has drifted from where it began, place by place.
#pragma once

#include "slam/core/proposal/pose_information.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <map>
#include <span>
#include <utility>

namespace waymark {

/// A pose that has been drawn is exact for its particle, and what is mapped from there shares its
/// error. A few particles, drawn again and again, do not remember how large such errors may have
/// grown: this does. Each square metre keeps the covariance that the robot's pose had when it was
/// first seen. Where known walls are seen again, the robot may be off from them by what has come
/// since only, and is off from the origin by what they are.
/// Covariances are of (x, y, theta) of the robot, map frame: the map's error as a rigid motion.
class MapDrift {
 public:
  /// The robot has moved: an error of the heading turns into one of the position.
  void move(const Se2& map_from_base);

  /// What has come since the walls that a scan shows were mapped. It is taken from the drift: it
  /// now belongs to the pose, where matching can tell it.
  /// @param weak  unit, map frame: each wall counts for this direction, and for the others, as far
  /// as it can tell them.
  Eigen::Matrix3d release(std::span<const AnnotatedBeam> beams, const Eigen::Vector2d& weak);

  /// What the pose has lost by drawing.
  void take(const Eigen::Matrix3d& drawn) { now_ += drawn; }

  /// A scan is mapped: what had not been seen yet drifts with the robot.
  void map(std::span<const AnnotatedBeam> beams);

  /// Of what is being mapped.
  const Eigen::Matrix3d& now() const { return now_; }

 private:
  struct Region {
    Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
    Eigen::Vector2d robot{Eigen::Vector2d::Zero()};  ///< from where it was first seen
  };

  const Region* region_at(const Eigen::Vector2d& place_in_map) const;

  Se2 map_from_base_{};
  Eigen::Matrix3d now_{Eigen::Matrix3d::Zero()};
  std::map<std::pair<int, int>, Region> regions_{};
};

/// The part of a symmetric matrix with positive eigenvalues.
Eigen::Matrix3d positive_part(const Eigen::Matrix3d& symmetric);

}  // namespace waymark
