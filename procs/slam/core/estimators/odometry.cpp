// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/odometry.hpp"

#include "common/geometry/se2.hpp"

namespace waymark {
namespace {

/// Covariance of a pose after a motion, map frame; first order.
Eigen::Matrix3d propagate(const Eigen::Matrix3d& covariance, const Se2& map_from_start,
                          const Motion& motion, const MotionNoise& noise) {
  const Eigen::Vector2d step = map_from_start.rotation() * motion.start_from_end.translation();
  Eigen::Matrix3d added = Eigen::Matrix3d::Zero();
  const double length_m = step.norm();
  if (length_m > 0.0 && !noise.rotation_only) {
    const Eigen::Vector2d along = step / length_m;
    added.topLeftCorner<2, 2>() = noise.along_per_sqrt_m * noise.along_per_sqrt_m *
                                  motion.distance_m * along * along.transpose();
  }
  added(2, 2) = noise.turn_per_sqrt_m * noise.turn_per_sqrt_m * motion.distance_m +
                noise.turn_per_sqrt_rad * noise.turn_per_sqrt_rad * motion.turn_rad;
  return at_end_of_lever(covariance, step) + added;
}

}  // namespace

OdometryEstimator::OdometryEstimator(const EstimatorSetup& setup)
    : setup_{setup}, mapper_{setup.grid} {}

Estimate OdometryEstimator::update(const Observation& observation) {
  covariance_ = propagate(covariance_, map_from_base_, observation.motion, setup_.motion);
  map_from_base_before_ = map_from_base_;
  map_from_base_ = map_from_base_ * observation.motion.start_from_end;
  since_mapping_ = since_mapping_.then(observation.motion);
  const bool is_update = !has_started_ || setup_.gate.is_open(since_mapping_);
  if (is_update) {
    mapper_.insert(observation, map_from_base_, covariance_);
    since_mapping_ = {};
    has_started_ = true;
  }

  Estimate estimate = describe_observation(observation, map_from_base_, setup_.range_sigma_m);
  estimate.covariance = covariance_;
  estimate.health = Health::kDegenerate;  // nothing ever corrects dead reckoning
  estimate.weak_axis_source = WeakAxisSource::kOdometry;
  estimate.updated = is_update;
  return estimate;
}

std::vector<PublishedParticle> OdometryEstimator::particles() const {
  return {{map_from_base_, map_from_base_before_, 1.0}};
}

}  // namespace waymark
