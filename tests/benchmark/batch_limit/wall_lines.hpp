// SPDX-License-Identifier: BSD-3-Clause
// The straight walls in one scan, each as a line with the uncertainty that the beams leave.
#pragma once

#include "slam/core/scan/annotated_scan.hpp"

#include <Eigen/Core>

#include <cmath>
#include <span>
#include <vector>

namespace waymark::benchmark {

/// Where a beam ended on a wall, base frame, and how certain that is across the wall.
struct WallPoint {
  Eigen::Vector2d end{Eigen::Vector2d::Zero()};
  double weight{0.0};  ///< 1 / variance across the wall [1/m^2]
};

/// Base frame. The errors of offset and direction are independent at `middle`.
struct LineOfScan {
  Eigen::Vector2d middle{Eigen::Vector2d::Zero()};  ///< weighted mean of the beams' ends
  double normal_rad{0.0};                           ///< direction of the normal, towards the robot
  double sigma_m{0.0};                              ///< of the offset along the normal
  double sigma_rad{0.0};                            ///< infinite for a single point
  std::vector<WallPoint> points{};                  ///< of its beams, along the wall

  Eigen::Vector2d normal() const { return {std::cos(normal_rad), std::sin(normal_rad)}; }

  /// What those of the points that are `from` <= place < `to` say by themselves; one at least.
  LineOfScan part(std::size_t from, std::size_t to) const;
};

struct LineNoise {
  double range_sigma_m{0.01};
  double surface_sigma_m{0.002};  ///< roughness of walls
  double range_max_m{3.5};        ///< of the LiDAR
};

/// Lines that grow along the sweep from where neighbouring beams are straight.
/// The range noise counts as far as it lies across the wall.
std::vector<LineOfScan> wall_lines(std::span<const AnnotatedBeam> beams, const LineNoise& noise);

}  // namespace waymark::benchmark
