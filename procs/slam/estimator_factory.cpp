// SPDX-License-Identifier: BSD-3-Clause
#include "slam/estimator_factory.hpp"

#include "slam/core/estimators/gmapping.hpp"
#include "slam/core/estimators/odometry.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <utility>

namespace waymark {

std::unique_ptr<Estimator> make_estimator(const SlamConfig& config,
                                          std::shared_ptr<const MapSnapshot> loaded_map,
                                          std::vector<SurveyedMarker> survey) {
  EstimatorSetup setup = estimator_setup(config);
  setup.loaded_map = std::move(loaded_map);
  setup.survey = std::move(survey);
  switch (config.slam.estimator) {
    case EstimatorName::kOdometry:
      return std::make_unique<OdometryEstimator>(setup);
    case EstimatorName::kGmapping:
      return std::make_unique<GmappingEstimator>(setup, config.slam.gmapping);
    case EstimatorName::kMarkerMatching:
      return std::make_unique<MarkerMatchingEstimator>(setup, config.slam.marker_matching);
    case EstimatorName::kWaymark:
      return std::make_unique<WaymarkEstimator>(setup, config.slam.waymark);
  }
  return nullptr;
}

}  // namespace waymark
