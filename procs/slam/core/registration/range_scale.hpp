// SPDX-License-Identifier: BSD-3-Clause
// Scale of a LiDAR's ranges relative to a map.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/registration/ndt_map.hpp"
#include "slam/core/registration/points.hpp"
#include "slam/core/registration/range_noise.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>

namespace waymark {

struct RangeScale {
  double share{0.0};  ///< by which the ranges are longer than in the map, relative
  double sigma{0.0};  ///< its standard deviation
};

/// Fits the scale of ranges together with the pose; it is observable by walls on opposite sides.
/// @param origin_in_base    of the beams.
/// @param guess             map_from_base.
/// @param guess_covariance  of (x, y, theta), map's axes.
RangeScale fit_range_scale(std::span<const Eigen::Vector2d> points_in_base,
                           const Eigen::Vector2d& origin_in_base, const NdtMap& map,
                           const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                           const RangeNoise& noise);

/// Tells ranges whose scale has changed from scans that were matched at a wrong place, where they
/// fit at another scale by chance: the scale of a LiDAR changes from one scan to the next, wherever
/// the robot is. So a scale is believed if the scan has it, too, relative to the last scan that
/// fitted the map unscaled, or if the same scale has been believed since that scan.
class RangeScaleMonitor {
 public:
  explicit RangeScaleMonitor(double cell_spacing_m) : cell_spacing_m_{cell_spacing_m} {}

  /// Notes a scan that fits the map unscaled.
  void note_unscaled(const Points& points_in_base, const Se2& map_from_base);

  /// Whether to believe the scale at which the newest scan fits the map; remembers it if so.
  /// @param covariance  of (x, y, theta) of map_from_base, map's axes.
  bool believes(double share, const Points& points_in_base, const Eigen::Vector2d& origin_in_base,
                const Se2& map_from_base, const Eigen::Matrix3d& covariance,
                const RangeNoise& noise);

 private:
  double cell_spacing_m_;
  Points unscaled_in_base_{};  ///< the last scan that fitted unscaled
  Se2 map_from_unscaled_{};
  std::optional<double> share_{};  ///< last one believed since the unscaled scan
};

}  // namespace waymark
