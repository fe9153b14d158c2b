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
  double error{0.0};  ///< relative: measured range / range in the map - 1
  double sigma{0.0};  ///< standard deviation of `error`
};

/// Fits the scale of ranges together with the pose; walls on opposite sides make it observable.
/// @param origin_in_base    where the beams start.
/// @param guess             map_from_base.
/// @param guess_covariance  of (x, y, theta), map's axes.
RangeScale fit_range_scale(std::span<const Eigen::Vector2d> points_in_base,
                           const Eigen::Vector2d& origin_in_base, const NdtMap& map,
                           const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                           const RangeNoise& noise);

/// Decides whether an estimated scale error is real. At a wrong pose a scan may fit the map at a
/// wrong scale by chance; a real error begins between two scans, wherever the robot is. So an error
/// is accepted if the scan has it relative to the last scan that fitted the map unscaled, too, or
/// if an equal error has been accepted since that scan.
class RangeScaleMonitor {
 public:
  explicit RangeScaleMonitor(double cell_spacing_m) : cell_spacing_m_{cell_spacing_m} {}

  /// Notes a scan that fits the map unscaled.
  void note_unscaled(const Points& points_in_base, const Se2& map_from_base);

  /// Whether the scale error at which the newest scan fits the map is real. If so, it counts as
  /// accepted.
  /// @param covariance  of (x, y, theta) of map_from_base, map's axes.
  bool try_accept(double error, const Points& points_in_base, const Eigen::Vector2d& origin_in_base,
                  const Se2& map_from_base, const Eigen::Matrix3d& covariance,
                  const RangeNoise& noise);

 private:
  double cell_spacing_m_;
  Points unscaled_in_base_{};  ///< the last scan that fitted unscaled
  Se2 map_from_unscaled_{};
  std::optional<double> error_{};  ///< last error accepted since the unscaled scan
};

}  // namespace waymark
