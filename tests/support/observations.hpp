// SPDX-License-Identifier: BSD-3-Clause
// Sensor values of a synthetic drive as an estimator gets them.
#pragma once

#include "slam/core/input/sensor_queue.hpp"
#include "support/synthetic_corridor.hpp"

#include <vector>

namespace waymark::test {

/// Without camera frames.
inline std::vector<Observation> observations_of(const SensorLog& log,
                                                const SyntheticCorridor& corridor) {
  SensorSetup setup;
  setup.lidar = {{corridor.lidar_x_m, 0.0, 0.0}, 0.05, corridor.range_max_m};
  setup.marker_wait = Duration{0};
  SensorQueue queue{setup};
  std::vector<Observation> observations;
  const auto take_ready = [&] {
    while (auto ready = queue.next())
      observations.push_back(std::move(ready->observation));
  };
  auto scan = log.scans.begin();
  for (const OdometrySample& sample : log.odometry) {
    queue.add(sample);
    for (; scan != log.scans.end() && scan->time <= sample.time; ++scan)
      queue.add(*scan);
    take_ready();
  }
  queue.finish();
  take_ready();
  return observations;
}

/// A corridor without camera, scanned from the middle of the base, with perfect odometry.
inline SyntheticCorridor bare_corridor() {
  SyntheticCorridor corridor;
  corridor.wander_rad = 0.0;
  corridor.scale_error = 0.0;
  corridor.turn_scale_error = 0.0;
  corridor.along_noise_per_sqrt_m = 0.0;
  corridor.turn_noise_per_sqrt_m = 0.0;
  corridor.lidar_x_m = 0.0;
  return corridor;
}

}  // namespace waymark::test
