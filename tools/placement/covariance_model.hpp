// SPDX-License-Identifier: BSD-3-Clause
// Predicts the covariance of the pose during a drive with given markers, as the estimator `waymark`
// would report it: its own factors, linearised at measurements without errors.
#pragma once

#include "placement/drive.hpp"
#include "placement/view_model.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace waymark::placement {

/// View of a marker from the pose at the end of a step.
struct Sighting {
  std::size_t step{0};
  MarkerView view{};
};

using Sightings = std::vector<Sighting>;  ///< of one marker, ascending steps

/// The steps from which a marker is seen: in the image, large enough, and not occluded by walls.
Sightings sightings_along(std::span<const Step> steps, const Se2& map_from_marker,
                          const OccupiedWalls& walls, const ViewModel& views);

class CovarianceModel {
 public:
  /// @param steps   not copied; must outlive the model.
  /// @param config  odometry noise, calibration sigmas and the estimator's settings.
  CovarianceModel(std::span<const Step> steps, const SlamConfig& config);

  /// Covariance of (x, y, theta) at the end of each step, given the measurements up to there; map
  /// frame. O(steps * unknowns^2); unknowns are the markers and some past poses.
  std::vector<Eigen::Matrix3d> predict(std::span<const Sightings* const> markers) const;

  /// Standard deviation of the position along each step's weak axis; before there is one, that of
  /// the worst direction [m].
  std::vector<double> sigmas_m(std::span<const Eigen::Matrix3d> covariances) const;

 private:
  std::span<const Step> steps_;
  SlamConfig config_;
  EstimatorSetup setup_;
};

/// Standard deviation of the position along a unit axis; of the worst direction if it is zero [m].
double sigma_along(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& axis);

}  // namespace waymark::placement
