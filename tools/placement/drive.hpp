// SPDX-License-Identifier: BSD-3-Clause
// A drive as steps of a quarter of a metre, with what the scans there would show of the pose.
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
  std::size_t scan{0};  ///< at its end, in the poses that the drive was made of
  Se2 map_from_base{};  ///< at its end
  double travel_m{0.0};
  Motion motion{};                                     ///< since the step before
  double scans{0.0};                                   ///< in it; 0: not known
  double speed_mps{0.0};                               ///< 0: not known
  ObservedAxes observed{};                             ///< by one scan; base axes
  Eigen::Vector2d weak_axis{Eigen::Vector2d::Zero()};  ///< see with_weak_axes(); zero: none yet
  std::vector<Eigen::Vector2d> hits{};                 ///< ends of beams, base frame
};

/// Information of one scan about the pose, base axes: its beams against the lines of the walls.
/// Source: the estimator's point-to-line cost (slam/core/registration), without errors.
/// @param hits  where it puts the ends of the beams, base frame.
ObservedAxes predict_scan(const OccupiedWalls& walls, const Se2& map_from_base,
                          const SlamConfig& config, std::vector<Eigen::Vector2d>& hits);

/// @param places  in order of time, not empty; those of a map file have no time (t_s = 0).
std::vector<Step> drive_along(std::span<const ScanPlace> places, const OccupiedWalls& walls,
                              const SlamConfig& config);

}  // namespace waymark::placement
