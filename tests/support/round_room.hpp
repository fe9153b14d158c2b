// SPDX-License-Identifier: BSD-3-Clause
// A round room about the map's origin, seen from its middle.
#pragma once

#include "slam/core/mapping/insert_scan.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace waymark::test {

/// Beams in all directions to a round wall about the robot.
inline std::vector<AnnotatedBeam> in_a_round_room(double radius_m) {
  std::vector<AnnotatedBeam> beams;
  for (int i = 0; i < 360; ++i) {
    const double angle_rad = i * std::numbers::pi / 180.0;
    AnnotatedBeam annotated;
    annotated.beam.end_in_base =
        radius_m * Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)};
    annotated.beam.range_m = radius_m;
    beams.push_back(annotated);
  }
  return beams;
}

inline GridMap map_of_a_round_room(double radius_m) {
  GridMap map{GridFrame::centred_on_map_origin(0.05), {}, {}};
  for (int scan = 0; scan < 20; ++scan)
    insert_beams(in_a_round_room(radius_m), {}, map);
  return map;
}

}  // namespace waymark::test
