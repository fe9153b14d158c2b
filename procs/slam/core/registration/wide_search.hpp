// SPDX-License-Identifier: BSD-3-Clause
// Registration of a scan whose guess may be outside the matcher's basin of convergence.
#pragma once

#include "slam/core/registration/scan_match.hpp"
#include "slam/core/registration/usual_fit.hpp"

#include <functional>
#include <vector>

namespace waymark {

/// Windows around `by_odometry` and around each pose of `without_odometry` are searched.
struct WideSearch {
  Se2 by_odometry{};  ///< map_from_base, as predicted by odometry
  Eigen::Matrix3d odometry_covariance{Eigen::Matrix3d::Identity()};  ///< of by_odometry, map's axes
  /// map_from_base, by hypotheses that do not rely on odometry's newest step.
  std::vector<Se2> without_odometry{};
  double since_last_s{0.0};  ///< time since the last scan, which widens the window of turns
  double driven_m{0.0};      ///< by odometry since the last scan; widens the windows of positions
  double min_score{0.0};     ///< least SearchMatch::score of a place in a window
  /// Share of the beams, 0 to 1, that the map contradicts at a pose, also by its free space.
  std::function<double(const Se2& map_from_base)> misfit{};
};

/// Searches windows for a better match than `plain`. The candidate is the match with the most
/// inliers, of those from the best place in each window. It replaces `plain` if it has 5 % more
/// inliers and
///   - near odometry's prediction: `plain` is contradicted (UsualFit); or the candidate fits as
///     usual; or it fits nearly as usual, and has twice the inliers or odometry contradicts
///     `plain`;
///   - far from that prediction: the candidate fits as usual, and `plain` is contradicted or leaves
///     3 times as many beams unexplained; or `plain` is contradicted, and the candidate has 1.5
///     times its inliers and fits as usual where mapped. In addition, no other heading may fit
///     nearly as well; the map, with its free space, must contradict less of the scan at the
///     candidate than at `plain`; and along the weak direction of a degenerate `plain`, the
///     candidate must have 5 % more inliers on settled walls, too.
/// So `plain` is kept for a view of a new place, where a correct match has few inliers.
///
/// @param points     ends of beams, base frame.
/// @param ndt        map that the scan is matched with.
/// @param occupied   points of that map around the guesses, see wide_search_reach_m().
ScanMatch searched_widely(const ScanMatch& plain, const Points& points, const NdtMap& ndt,
                          const Points& occupied, const WideSearch& search, const UsualFit& usual,
                          const RangeNoise& noise, const ScanMatchConfig& config);

/// Radius around the guesses that `occupied` must cover for a scan with these points.
/// @param driven_m  as in WideSearch.
double wide_search_reach_m(const Points& points, double driven_m);

}  // namespace waymark
