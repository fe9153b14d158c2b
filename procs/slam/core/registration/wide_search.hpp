// SPDX-License-Identifier: BSD-3-Clause
// Registration of a scan whose guess may be off by more than plain matching can find.
#pragma once

#include "slam/core/registration/scan_match.hpp"
#include "slam/core/registration/usual_fit.hpp"

#include <vector>

namespace waymark {

struct WideSearch {
  Se2 by_odometry{};  ///< map_from_base; windows about it and the others are searched
  Eigen::Matrix3d odometry_covariance{Eigen::Matrix3d::Identity()};  ///< of it, map's axes
  std::vector<Se2> without_odometry{};                               ///< map_from_base
  double since_last_s{0.0};  ///< scan: the longer, the more the robot may have turned
  double min_score{0.0};     ///< of a place (SearchMatch)
};

/// The plain match, or the one with the most inliers of those that begin at the best places in the
/// windows. The plain match is left if the map contradicts it, for a place where the scan fits as
/// well as others do, or for one where it fits nearly as well and has twice the inliers: a view of
/// a new place has few of them where it is right. A plain match that odometry contradicts is no
/// likelier than another place: one with more inliers is enough, if the scan fits nearly as well as
/// others do.
///
/// @param points     ends of beams, base frame.
/// @param ndt        what the scan is matched with,
/// @param occupied   and its points around the guesses.
ScanMatch searched_widely(const ScanMatch& plain, const Points& points, const NdtMap& ndt,
                          const Points& occupied, const WideSearch& search, const UsualFit& usual,
                          const RangeNoise& noise, const ScanMatchConfig& config);

/// That `occupied` has to reach from the guesses on, for a scan of these points.
double wide_search_reach_m(const Points& points);

}  // namespace waymark
