// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/wide_search.hpp"

#include "common/geometry/chi2.hpp"
#include "common/geometry/squared.hpp"
#include "slam/core/registration/correlative_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace waymark {
namespace {

constexpr double kLeastReach_m = 0.5;
constexpr double kReach_rad = 0.6;
constexpr std::size_t kBeams = 120;
constexpr double kUnseen_rad_s = 0.5;     // rate at which the window of turns grows between scans
constexpr double kClearlyMore = 1.05;     // ratio of inliers, found to plain match
constexpr double kFarMore = 2.0;          // the same
constexpr double kManyContradict = 0.06;  // share of all beams
constexpr double kLeavesFarMore = 3.0;    // ratio of unexplained beams, plain to found match
constexpr double kContradictedSigmas = 5.0;
constexpr double kFarFarther = 4.0;  // ratio of distances from odometry, found to plain match
const Eigen::Vector3d kFoundSigmas{0.05, 0.05, 0.03};  // of a search: a cell, a heading step

/// Half the side of the windows.
double reach_m(double driven_m) {
  return std::max(kLeastReach_m, driven_m);
}

/// Mahalanobis distance of a match from the pose predicted by odometry.
double sigmas_from_odometry(const ScanMatch& match, const WideSearch& search) {
  const Eigen::Vector3d off = pose_difference(match.map_from_base, search.by_odometry);
  return std::sqrt(chi2(off, search.odometry_covariance));
}

/// Share of all beams that end in mapped cells but are outliers.
double contradicting_share(const ScanMatch& match) {
  return match.mapped_share * (1.0 - match.inlier_share);
}

double unexplained(const ScanMatch& match, const Points& points) {
  return static_cast<double>(points.size()) - match.inliers;
}

}  // namespace

ScanMatch searched_widely(const ScanMatch& plain, const Points& points, const NdtMap& ndt,
                          const Points& occupied, const WideSearch& search, const UsualFit& usual,
                          const RangeNoise& noise, const ScanMatchConfig& config) {
  const CorrelativeField field{occupied};
  const Points beams = thinned(points, kBeams);
  const Eigen::Matrix3d near = kFoundSigmas.cwiseAbs2().asDiagonal();
  const SearchWindow window{
      reach_m(search.driven_m),
      std::min(std::numbers::pi, kReach_rad + kUnseen_rad_s * search.since_last_s)};
  std::optional<ScanMatch> found;
  std::vector<Se2> guesses = search.without_odometry;
  guesses.push_back(search.by_odometry);
  for (const Se2& guess : guesses) {
    const auto place = field.best(beams, guess, window, search.min_score);
    if (!place) continue;
    const ScanMatch match = match_scan(points, ndt, place->submap_from_base, near, noise, config);
    if (!found || match.inliers > found->inliers) found = match;
  }
  const auto fits_better = [&] {
    if (found->inliers <= kClearlyMore * plain.inliers) return false;
    const double plain_sigmas = sigmas_from_odometry(plain, search);
    if (sigmas_from_odometry(*found, search) >
        std::max(kContradictedSigmas, kFarFarther * plain_sigmas)) {
      const bool shows_few_walls = unexplained(*found, points) > found->inliers;
      if (shows_few_walls && search.contradicts_map(found->map_from_base)) return false;
      // A view of a new place is more likely than wrong odometry.
      if (usual.is_contradicted(plain) && contradicting_share(plain) > kManyContradict &&
          found->inliers > kFarMore * plain.inliers) {
        return true;
      }
      return !usual.is_worse_than_usual(*found) &&
             (usual.is_contradicted(plain) ||
              unexplained(plain, points) > kLeavesFarMore * unexplained(*found, points));
    }
    return usual.is_contradicted(plain) || !usual.is_worse_than_usual(*found) ||
           (usual.is_nearly_usual(*found) &&
            (found->inliers > kFarMore * plain.inliers || plain_sigmas > kContradictedSigmas));
  };
  return found && fits_better() ? *found : plain;
}

double wide_search_reach_m(const Points& points, double driven_m) {
  double farthest_m = 0.0;
  for (const Eigen::Vector2d& point : points)
    farthest_m = std::max(farthest_m, point.norm());
  return farthest_m + reach_m(driven_m);
}

}  // namespace waymark
