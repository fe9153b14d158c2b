// SPDX-License-Identifier: BSD-3-Clause
// Dead reckoning, the control in comparisons: draws the map along the odometry.
#pragma once

#include "slam/core/estimators/estimator.hpp"

namespace waymark {

class OdometryEstimator final : public Estimator {
 public:
  explicit OdometryEstimator(const EstimatorSetup& setup);

  Estimate update(const Observation& observation) override;

  const GridMap& map() const override { return mapper_.map(); }

  std::vector<Landmark> landmarks() const override { return mapper_.landmarks().landmarks(); }

  std::vector<PublishedParticle> particles() const override;

 private:
  EstimatorSetup setup_;
  Mapper mapper_;
  Se2 map_from_base_{};
  Se2 map_from_base_before_{};
  Eigen::Matrix3d covariance_{Eigen::Matrix3d::Zero()};
  Motion since_mapping_{};
  bool has_started_{false};
};

}  // namespace waymark
