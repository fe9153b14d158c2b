// SPDX-License-Identifier: BSD-3-Clause
// The best trajectory that the data allow: all measurements of a drive at once, by least squares.
#pragma once

#include "batch_limit/association.hpp"

#include <string>

namespace waymark::benchmark {

struct BatchModel {
  OdometryNoise odometry{};
  SightingNoise sightings{};
  double same_marker_within_m{0.0};  ///< sightings of an id further apart are of different markers
  double straight_over_m{1.0};       ///< walls may bend from one such piece to the next
};

struct BatchSolution {
  Scene scene{};  ///< moved to the minimum
  OdometryErrors odometry_errors{OdometryErrors::Zero()};
  Eigen::Vector2d camera_errors{Eigen::Vector2d::Zero()};  ///< yaw [rad], focal length (relative)
  double standoff_m{0.0};                                  ///< of all markers before their walls
  double chi2{0.0};
  std::size_t residuals{0};
  bool has_converged{false};
  std::string report{};  ///< Ceres', one line
};

/// Poses, odometry's and camera's systematic errors, walls and markers that fit best.
/// Source: Ceres Solver; noise models and derivatives by errors are those of the estimator.
BatchSolution solve(std::span<const Stop> stops, const BatchModel& model);

}  // namespace waymark::benchmark
