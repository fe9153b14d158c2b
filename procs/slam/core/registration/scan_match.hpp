// SPDX-License-Identifier: BSD-3-Clause
// Registration of a scan in an NDT map.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/registration/ndt_map.hpp"
#include "slam/core/registration/points.hpp"
#include "slam/core/registration/range_noise.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace waymark {

class Fields;

struct ScanMatchConfig {
  double cell_spacing_m{0.25};
  double kernel_sigmas{3.0};
  double roughness_m{0.003};
  double weak_share{0.01};
  int min_inliers{8};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// Information about a pose, with unobserved directions removed.
struct ObservedAxes {
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};     ///< degenerate: 0 along weak_direction
  Eigen::Vector2d weak_direction{Eigen::Vector2d::Zero()};  ///< unit
  bool is_degenerate{false};

  /// Whether a shift (not zero) is nearly parallel to the unobserved direction.
  bool is_along_weak(const Eigen::Vector2d& shift) const;

  /// Removes the information along `direction` (unit), which becomes the weak one. Precondition:
  /// not degenerate, and information > 0.
  void drop_information_along(const Eigen::Vector2d& direction);
};

/// Removes the information that noise of the walls' normals leaks into an unobserved direction
/// (Zhang, Kaess, Singh 2016). Frame: that of the information, origin at the robot.
/// @param weak_share  share of the strongest direction's information below which a direction is
///                    unobserved.
ObservedAxes observed_axes(const Eigen::Matrix3d& information, double weak_share);

struct ScanMatch {
  /// Nearly the optimum of the scan alone; along unobserved axes, the guess.
  Se2 map_from_base{};
  ObservedAxes observed{};      ///< information about (x, y, theta), map's axes
  double inlier_share{0.0};     ///< inliers / num_mapped
  double mapped_share{0.0};     ///< num_mapped / all beams
  int num_mapped{0};            ///< beams that ended in a cell with a distribution
  int inliers{0};               ///< mapped beams with a robust weight of at least a quarter
  int settled_inliers{0};       ///< of those, the ones on walls that many keyframes observed
  double range_scatter_m{0.0};  ///< standard deviation of ranges about the walls they end on
  int num_scattered{0};         ///< beams that range_scatter_m was computed from
  /// For keyframes first_keyframe, first_keyframe + 1, ...: their share in the cells of the
  /// inliers; sums to 1.
  int first_keyframe{0};
  std::vector<double> keyframe_shares{};

  bool is_usable(const ScanMatchConfig& config) const {
    return inliers >= config.min_inliers && observed.information(2, 2) > 0.0;
  }
};

/// Gauss-Newton on robust point-to-distribution distances, from coarse to fine.
/// @param points_in_base   ends of beams.
/// @param guess            map_from_base.
/// @param guess_covariance of (x, y, theta), map's axes. It determines the scale at which the
///                         descent begins; its effect on the result is small in observed
///                         directions.
/// @param coarse           the same walls in larger cells, the smallest first: the descent begins
///                         in them if the guess may be off by more than half of their spacing.
ScanMatch match_scan(std::span<const Eigen::Vector2d> points_in_base, const NdtMap& map,
                     const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                     const RangeNoise& noise, const ScanMatchConfig& config,
                     std::span<const NdtMap> coarse = {});

/// Moves a degenerate match along its weak direction to where walls that many keyframes observed
/// fit best, in between that and the guess, with a little information there: unlike somebody who
/// walks beside the robot, such walls stand still, and door frames far away add up over many scans.
/// Unchanged if they tell hardly anything. The match stays degenerate.
/// @param match             from match_scan() with the other arguments.
/// @param guess_covariance  as given to match_scan(): how far the guess is believed.
ScanMatch with_settled_walls(ScanMatch match, std::span<const Eigen::Vector2d> points_in_base,
                             const NdtMap& map, const Eigen::Matrix3d& guess_covariance,
                             const RangeNoise& noise, const ScanMatchConfig& config);

}  // namespace waymark
