// SPDX-License-Identifier: BSD-3-Clause
// Registration of a scan whose guess may be outside the matcher's basin of convergence.
#pragma once

#include "slam/core/registration/scan_match.hpp"
#include "slam/core/registration/usual_fit.hpp"

#include <functional>
#include <vector>

namespace waymark {

struct WideSearch {
  Se2 by_odometry{};  ///< map_from_base; windows about it and `without_odometry` are searched
  Eigen::Matrix3d odometry_covariance{Eigen::Matrix3d::Identity()};  ///< of by_odometry, map's axes
  std::vector<Se2> without_odometry{};                               ///< map_from_base
  double since_last_s{0.0};  ///< time since the last scan, which widens the window of turns
  double driven_m{0.0};      ///< by odometry since the last scan; widens the windows of positions
  double min_score{0.0};     ///< least SearchMatch::score
  /// Whether the map, including its free space, contradicts the scan at a pose.
  std::function<bool(const Se2& map_from_base)> contradicts_map{};
};

/// Matches the scan from the best place of each window, and compares the match with the most
/// inliers, the found one, with the plain match. The found match replaces it if it has more
/// inliers, and
///   - the map contradicts the plain match, or
///   - the found match fits as well as usual, or
///   - it fits nearly as well as usual, and either has twice the inliers or odometry contradicts
///     the plain match.
/// A found match that odometry contradicts much more than the plain one must fit as well as usual
/// and, if the map does not contradict the plain match, leave a third of its unexplained beams at
/// most; or have 1.5 times the inliers of a contradicted plain match, and fit as well as usual
/// where there are mapped walls. The scan must not fit nearly as well at another heading in or
/// around the windows, since rooms look alike; and if the found match explains less than half of
/// the scan, the map's free space must not contradict the rest. These conditions keep the plain
/// match for a view of a new place, where a correct match has few inliers.
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
