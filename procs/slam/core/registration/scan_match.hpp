// SPDX-License-Identifier: BSD-3-Clause
// Where a scan fits into a map of normal distributions.
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
  double information_share{0.5};
  double roughness_m{0.003};
  double weak_share{0.01};
  int min_inliers{8};

  /// What they are, in words: core_fields.cpp.
  void describe(Fields& fields);
};

/// Information about a pose, and which directions it leaves open.
struct ObservedAxes {
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};     ///< nothing along weak_direction
  Eigen::Vector2d weak_direction{Eigen::Vector2d::Zero()};  ///< unit
  bool is_degenerate{false};
};

/// Of a beam's information, where so many beams of the scan, itself included, end on one surface:
/// 1 for each of a few, and less for each of many, since they err together.
double independent_share(int beams);

/// Cuts off what noise of the walls' normals has leaked into a direction that they do not show
/// (Zhang, Kaess, Singh 2016). Frame: that of the information, origin at the robot.
/// @param lasting     the part about (x, y) that surfaces hold that last: what moves shows nothing.
/// @param weak_share  of the strongest direction's information, below which one is not shown.
ObservedAxes observed_axes(const Eigen::Matrix3d& information, const Eigen::Matrix2d& lasting,
                           double weak_share);

struct ScanMatch {
  /// Where the scan alone would put the base: along unobserved axes, where the guess was.
  Se2 map_from_base{};
  ObservedAxes observed{};      ///< information about (x, y, theta), map's axes
  double inlier_share{0.0};     ///< of the beams that ended on something mapped
  double mapped_share{0.0};     ///< of all beams
  int num_mapped{0};            ///< beams that ended on something mapped
  int inliers{0};               ///< of these
  double range_scatter_m{0.0};  ///< of ranges about the lines that they end on (one sigma)
  int num_scattered{0};         ///< beams that show it
  /// For keyframes first_keyframe, first_keyframe + 1, ...: their share in the surfaces that the
  /// inliers lie on; sums to 1.
  int first_keyframe{0};
  std::vector<double> keyframe_shares{};

  bool is_usable(const ScanMatchConfig& config) const {
    return inliers >= config.min_inliers && observed.information(2, 2) > 0.0;
  }
};

/// Gauss-Newton on robust point-to-distribution distances, from coarse to fine.
/// @param points_in_base   ends of beams.
/// @param guess            map_from_base.
/// @param guess_covariance of (x, y, theta), map's axes: how far the optimum may be. Only the way
///                         there depends on it, and where the scan is silent, the result.
/// @param coarse           the same walls in larger cells, the smallest first: where the guess may
///                         be off by more than a cell of `map` reaches, the way begins there.
ScanMatch match_scan(std::span<const Eigen::Vector2d> points_in_base, const NdtMap& map,
                     const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                     const RangeNoise& noise, const ScanMatchConfig& config,
                     std::span<const NdtMap> coarse = {});

}  // namespace waymark
