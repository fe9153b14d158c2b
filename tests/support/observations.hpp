// SPDX-License-Identifier: BSD-3-Clause
// Sensor values of a synthetic drive as an estimator gets them.
#pragma once

#include "slam/core/input/sensor_queue.hpp"
#include "support/synthetic_corridor.hpp"

#include <utility>
#include <vector>

namespace waymark::test {

/// Feeds a drive to the queue in order of time, as sensors do.
/// @param handle  called with each SensorQueue::Ready.
template <class Handle>
void feed(SensorQueue& queue, const SensorLog& log, Handle&& handle) {
  auto scan = log.scans.begin();
  auto frame = log.frames.begin();
  for (const OdometrySample& sample : log.odometry) {
    queue.add(sample);
    for (; frame != log.frames.end() && frame->time <= sample.time; ++frame)
      queue.add(*frame);
    for (; scan != log.scans.end() && scan->time <= sample.time; ++scan)
      queue.add(*scan);
    while (auto ready = queue.next())
      handle(std::move(*ready));
  }
}

/// The observations of a drive without its camera frames.
inline std::vector<Observation> observations_of(SensorLog log, const SyntheticCorridor& corridor) {
  SensorSetup setup;
  setup.lidar = {{corridor.lidar_x_m, 0.0, 0.0}, 0.05, corridor.range_max_m};
  setup.preprocessing.marker_wait_s = 0.0;
  SensorQueue queue{setup};
  std::vector<Observation> observations;
  const auto keep = [&](SensorQueue::Ready ready) {
    observations.push_back(std::move(ready.observation));
  };
  log.frames.clear();
  feed(queue, log, keep);
  queue.finish();
  while (auto ready = queue.next())
    keep(std::move(*ready));
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
