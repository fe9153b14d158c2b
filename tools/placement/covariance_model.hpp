// SPDX-License-Identifier: BSD-3-Clause
// How well the pose would be known while driving, with given markers: the covariances that the
// estimator `waymark` shows, from its own factors on measurements without errors.
#pragma once

#include "placement/drive.hpp"
#include "placement/view_model.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace waymark::placement {

/// A marker as it would be seen from the end of a step.
struct Sighting {
  std::size_t step{0};
  MarkerView view{};
};

using Sightings = std::vector<Sighting>;  ///< of one marker, in order of steps

/// From which steps a marker is seen: in the image, large enough, and with nothing before it.
Sightings sightings_along(std::span<const Step> steps, const Se2& map_from_marker,
                          const OccupiedWalls& walls, const ViewModel& views);

class CovarianceModel {
 public:
  /// @param steps   kept; must outlive the model.
  /// @param config  odometry noise, calibration sigmas and the estimator's settings.
  CovarianceModel(std::span<const Step> steps, const SlamConfig& config);

  /// Covariance of (x, y, theta) at the end of each step as it is known there, map frame.
  /// O(steps * unknowns^2): unknowns are the markers and some poses behind.
  std::vector<Eigen::Matrix3d> predict(std::span<const Sightings* const> markers) const;

  /// Standard deviation of the position along each step's weak axis; the largest of any direction
  /// before there is one [m].
  std::vector<double> sigmas_m(std::span<const Eigen::Matrix3d> covariances) const;

 private:
  std::span<const Step> steps_;
  SlamConfig config_;
  EstimatorSetup setup_;
};

/// Of a position: along a unit axis, or of the worst direction where the axis is zero [m].
double sigma_along(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& axis);

}  // namespace waymark::placement
