// SPDX-License-Identifier: BSD-3-Clause
// An estimator on a synthetic drive, beside the truth.
#pragma once

#include "slam/core/estimators/estimator.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/input/sensor_queue.hpp"
#include "support/observations.hpp"
#include "support/synthetic_corridor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark::test {

inline SensorSetup setup_of(const SyntheticCorridor& corridor) {
  SensorSetup setup;
  setup.lidar = {Se2{corridor.lidar_x_m, 0.0, 0.0}, 0.12, corridor.range_max_m};
  setup.camera.base_from_camera = {corridor.camera_x_m, 0.0, 0.0};
  setup.marker_size_m = corridor.marker_size_m;
  return setup;
}

inline EstimatorSetup estimator_setup_of(const SyntheticCorridor& corridor, std::uint64_t seed) {
  EstimatorSetup setup;
  setup.seed = seed;
  setup.range_sigma_m = corridor.range_sigma_m;
  setup.range_max_m = corridor.range_max_m;
  setup.camera = setup_of(corridor).camera;
  return setup;
}

/// Sigmas of a camera as accurate as the simulated one; markers hang as usual.
inline SightingNoise exact_camera() {
  return {.calibration = {0.0005, 0.0001, 0.003}, .bearing_rad = 0.00003, .position_m = 0.0001};
}

struct Step {
  Estimate estimate{};
  Se2 truth{};  ///< base in the frame of its first pose
};

inline std::vector<Step> run(Estimator& estimator, const SensorLog& log, const SensorSetup& setup) {
  SensorQueue queue{setup};
  std::vector<Step> steps;
  feed(queue, log, [&](const SensorQueue::Ready& ready) {
    const auto truth =
        std::lower_bound(log.truth.begin(), log.truth.end(), ready.observation.time,
                         [](const TruePose& pose, Timestamp time) { return pose.time < time; });
    steps.push_back({estimator.update(ready.observation),
                     log.truth.front().world_from_base.inverse() * truth->world_from_base});
  });
  return steps;
}

inline std::vector<Step> run_waymark(const SensorLog& log, const SyntheticCorridor& corridor) {
  WaymarkEstimator estimator{estimator_setup_of(corridor, 1), {}};
  return run(estimator, log, setup_of(corridor));
}

inline double along_rmse_m(const std::vector<Step>& steps) {
  double sum = 0.0;
  for (const Step& step : steps)
    sum += std::pow(step.estimate.map_from_base.x() - step.truth.x(), 2);
  return std::sqrt(sum / static_cast<double>(steps.size()));
}

inline SyntheticCorridor short_corridor(std::uint64_t seed) {
  SyntheticCorridor corridor;
  corridor.seed = seed;
  corridor.length_m = 14.0;
  corridor.drive_m = 12.0;
  corridor.speed_m_s = 0.2;
  corridor.scale_error = seed % 2 == 0 ? -0.02 : 0.02;
  corridor.markers = opposite_markers(corridor);
  return corridor;
}

inline SyntheticCorridor corridor_with_markers(std::uint64_t seed) {
  SyntheticCorridor corridor = short_corridor(seed);
  corridor.markers = opposite_markers(corridor, 2.0, 2.0);
  return corridor;
}

}  // namespace waymark::test
