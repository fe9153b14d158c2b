// SPDX-License-Identifier: BSD-3-Clause
// Divides a drive into steps of 0.25 m, with the information that scans give there.
#pragma once

#include "placement/occupied_walls.hpp"
#include "slam/core/motion/motion.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/slam_config.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace waymark::placement {

/// A pose at which the LiDAR was read.
struct ScanPlace {
  double t_s{0.0};
  Se2 map_from_base{};
};

struct Step {
  std::size_t scan{0};      ///< index into drive_along()'s `places`, at the end of the step
  Se2 map_from_base{};      ///< at the end of the step
  double travel_m{0.0};     ///< length of the path up to the end of the step
  Motion motion{};          ///< during the step
  double scans{0.0};        ///< number of scans in the step; 0: unknown
  double speed_mps{0.0};    ///< mean; 0: unknown
  ObservedAxes observed{};  ///< information of one scan at the end; base axes
  /// Unit direction (map) that the walls do not observe, or last did not; zero: none so far.
  Eigen::Vector2d weak_axis{Eigen::Vector2d::Zero()};
  std::vector<Eigen::Vector2d> hits{};  ///< ends of beams, base frame
};

/// Information of one scan about the pose, base axes, by the estimator's point-to-line cost
/// (slam/core/registration) at measurements without errors.
/// @param hits  output: ends of the beams, base frame.
ObservedAxes predict_scan(const OccupiedWalls& walls, const Se2& map_from_base,
                          const SlamConfig& config, std::vector<Eigen::Vector2d>& hits);

/// @param places  in order of time, not empty; those of a map file have no time (t_s = 0).
std::vector<Step> drive_along(std::span<const ScanPlace> places, const OccupiedWalls& walls,
                              const SlamConfig& config);

}  // namespace waymark::placement
