// SPDX-License-Identifier: BSD-3-Clause
// The paper's method: particles weighted by marker ids on beams and cells; the best draws the map.
#pragma once

#include "slam/core/estimators/estimator.hpp"
#include "slam/core/resampling/particle_set.hpp"
#include "slam/core/weighting/marker_score.hpp"

#include <cstdint>

namespace waymark {

struct MarkerMatchingConfig {
  int particles{200};
  double resample_threshold{0.5};
  MatchingRewards rewards{};
  double sighting_sigma_m{kSightingSigma_m};
  double lost_agreement{0.25};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

class MarkerMatchingEstimator final : public Estimator {
 public:
  MarkerMatchingEstimator(const EstimatorSetup& setup, const MarkerMatchingConfig& config);

  Estimate update(const Observation& observation) override;

  const GridMap& map() const override { return mapper_.map(); }

  std::vector<Landmark> landmarks() const override { return mapper_.landmarks().landmarks(); }

  std::vector<PublishedParticle> particles() const override;

 private:
  struct State {
    Se2 map_from_base{};
    Se2 previous_map_from_base{};
  };

  void propagate();
  void weigh(const Observation& observation);
  Estimate estimate(const Observation& observation) const;

  EstimatorSetup setup_;
  MarkerMatchingConfig config_;
  ParticleSet<State> particles_;
  Mapper mapper_;
  Motion since_update_{};
  std::uint64_t updates_{0};

  // Of the last update:
  Se2 best_{};  ///< map_from_base of the particle with the highest weight
  Eigen::Matrix3d covariance_{Eigen::Matrix3d::Zero()};
  double effective_particles_{1.0};
  double wall_agreement_{1.0};     ///< of the best particle's beams with the mapped walls
  bool saw_known_markers_{false};  ///< known markers were in view
};

}  // namespace waymark
