// SPDX-License-Identifier: BSD-3-Clause
// Scans in a room that looks different from every pose.
#pragma once

#include "common/random/random.hpp"
#include "slam/core/scan/observation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

namespace waymark::test {

/// Range from inside a room of 6 m x 4 m with a column, in the map frame.
inline double range_in_room(const Eigen::Vector2d& from, double direction_rad) {
  const Eigen::Vector2d ray{std::cos(direction_rad), std::sin(direction_rad)};
  double range_m = 100.0;
  if (ray.x() > 1e-9) range_m = std::min(range_m, (3.0 - from.x()) / ray.x());
  if (ray.x() < -1e-9) range_m = std::min(range_m, (-3.0 - from.x()) / ray.x());
  if (ray.y() > 1e-9) range_m = std::min(range_m, (2.0 - from.y()) / ray.y());
  if (ray.y() < -1e-9) range_m = std::min(range_m, (-2.0 - from.y()) / ray.y());
  const Eigen::Vector2d to_column = Eigen::Vector2d{1.5, 0.7} - from;
  const double ahead_m = ray.dot(to_column);
  const double beside_m = std::abs(ray.x() * to_column.y() - ray.y() * to_column.x());
  if (ahead_m > 0.0 && beside_m < 0.2)
    range_m = std::min(range_m, ahead_m - std::sqrt(0.04 - beside_m * beside_m));
  return range_m;
}

/// A scan of 360 beams with noise of 1 cm.
inline std::vector<AnnotatedBeam> scan_of_room(const Se2& map_from_base) {
  std::vector<AnnotatedBeam> beams;
  Random random{3};
  for (int i = 0; i < 360; ++i) {
    const double bearing_rad = i * std::numbers::pi / 180.0;
    AnnotatedBeam annotated;
    annotated.beam.range_m =
        range_in_room(map_from_base.translation(), map_from_base.theta() + bearing_rad) +
        0.01 * random.normal();
    annotated.beam.end_in_base =
        annotated.beam.range_m * Eigen::Vector2d{std::cos(bearing_rad), std::sin(bearing_rad)};
    beams.push_back(annotated);
  }
  return beams;
}

/// Twelve observations 0.2 s apart. Odometry measures the same step each time, and the robot moves
/// by it, except once, when it is pushed instead.
/// @param handle  called with each observation, and whether the push came before it.
/// @return the last pose relative to the first.
template <class Handle>
Se2 drive_through_room(const Motion& step, int pushed_at, const Se2& push, Handle&& handle) {
  const Se2 start{-1.5, -0.6, 0.3};
  Se2 map_from_base = start;
  Observation observation;
  for (int i = 0; i < 12; ++i) {
    if (i > 0) {
      observation.motion = step;
      map_from_base = map_from_base * (i == pushed_at ? push : step.start_from_end);
    }
    observation.time += std::chrono::milliseconds{200};
    observation.beams = scan_of_room(map_from_base);
    handle(observation, i == pushed_at);
  }
  return start.inverse() * map_from_base;
}

}  // namespace waymark::test
