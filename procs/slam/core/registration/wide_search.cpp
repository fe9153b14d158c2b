// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/wide_search.hpp"

#include "common/geometry/chi2.hpp"
#include "slam/core/registration/correlative_search.hpp"
#include "slam/core/registration/unique_place.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace waymark {
namespace {

constexpr double kMinReach_m = 0.5;
constexpr double kReach_rad = 0.6;
constexpr std::size_t kBeams = 120;
constexpr double kUnseen_rad_s = 0.5;  // rate at which the window of turns grows between scans
// Ratios of inliers, found to plain match, that the found match needs:
constexpr double kClearlyMore = 1.05;  // in any case
constexpr double kMuchMore = 1.5;  // if odometry contradicts it, and it fits as usual where mapped
constexpr double kFarMore = 2.0;   // if odometry agrees with it, and it fits nearly as usual
constexpr double kLeavesFarMore = 3.0;  // ratio of unexplained beams, plain to found match
constexpr double kContradictedSigmas = 5.0;
constexpr double kFarFarther = 4.0;  // ratio of distances from odometry, found to plain match
// Ratio of scores and of inliers, other to found place, above which the found place is ambiguous.
// On thinned logs of fr079 and aces it was higher at wrong places, and lower at most right ones.
constexpr double kNearlyAsWell = 0.8;
constexpr double kSameHeading_rad = 0.1;                // 3 sigmas of a search
const Eigen::Vector3d kSearchSigmas{0.05, 0.05, 0.03};  // of a search: a cell, a heading step

/// Half the side of the windows.
double reach_m(double driven_m) {
  return std::max(kMinReach_m, driven_m);
}

/// Mahalanobis distance of a match from the pose predicted by odometry.
double sigmas_from_odometry(const ScanMatch& match, const WideSearch& search) {
  const Eigen::Vector3d off = pose_difference(match.map_from_base, search.by_odometry);
  return std::sqrt(chi2(off, search.odometry_covariance));
}

double unexplained(const ScanMatch& match, const Points& points) {
  return static_cast<double>(points.size()) - match.inliers;
}

bool is_same_place(const Eigen::Vector3d& apart) {
  return apart.head<2>().norm() < kOtherPlace_m && std::abs(apart.z()) < kOtherPlace_rad;
}

SearchWindow window_of(const WideSearch& search) {
  return {reach_m(search.driven_m),
          std::min(std::numbers::pi, kReach_rad + kUnseen_rad_s * search.since_last_s)};
}

/// Matches of one scan at the places that correlative searches find.
class PlaceSearch {
 public:
  /// Keeps references to `points` and `ndt`.
  PlaceSearch(const Points& points, const NdtMap& ndt, const Points& occupied,
              const SearchWindow& window, const RangeNoise& noise, const ScanMatchConfig& config)
      : points_{points},
        ndt_{ndt},
        field_{occupied},
        beams_{thinned(points, kBeams)},
        window_{window},
        noise_{noise},
        config_{config} {}

  /// The match with the most inliers, of those from the best place of each guess's window.
  std::optional<ScanMatch> best(std::span<const Se2> guesses, double min_score) const {
    std::optional<ScanMatch> best;
    for (const Se2& guess : guesses) {
      const auto place = field_.best(beams_, guess, window_, min_score);
      if (!place) continue;
      const ScanMatch match = match_at(*place);
      if (!best || match.inliers > best->inliers) best = match;
    }
    return best;
  }

  /// None if the scan fits nearly as well at another heading or, if `found` is degenerate, at
  /// another position that is not along the weak direction; `found` if `plain` is there. Otherwise
  /// another position with the same heading takes from `found` the information along the line
  /// between both.
  std::optional<ScanMatch> if_unambiguous(ScanMatch found, const ScanMatch& plain) const {
    const Se2& pose = found.map_from_base;
    const SearchWindow around{2.0 * window_.half_width_m,
                              std::min(std::numbers::pi, 2.0 * window_.half_turn_rad)};
    const auto other = field_.best_apart_from(pose, kOtherPlace_m, kOtherPlace_rad, beams_, pose,
                                              around, kNearlyAsWell * field_.score(beams_, pose));
    if (!other) return found;
    const ScanMatch there = match_at(*other);
    if (there.inliers < kNearlyAsWell * found.inliers) return found;
    if (is_same_place(pose_difference(there.map_from_base, plain.map_from_base))) return found;
    const Eigen::Vector3d apart = pose_difference(there.map_from_base, pose);
    if (std::abs(apart.z()) > kSameHeading_rad) return std::nullopt;
    const Eigen::Vector2d shift = apart.head<2>();
    if (is_same_place(apart) || found.observed.is_along_weak(shift)) return found;
    if (found.observed.is_degenerate) return std::nullopt;
    found.observed.drop_information_along(shift.normalized());
    return found;
  }

 private:
  ScanMatch match_at(const SearchMatch& place) const {
    return match_scan(points_, ndt_, place.submap_from_base, kSearchSigmas.cwiseAbs2().asDiagonal(),
                      noise_, config_);
  }

  const Points& points_;
  const NdtMap& ndt_;
  CorrelativeField field_;
  Points beams_;
  SearchWindow window_;
  RangeNoise noise_;
  ScanMatchConfig config_;
};

/// Whether a match that odometry contradicts much more explains so much more of the scan that
/// odometry must be wrong; otherwise a view of a new place is more likely.
bool refutes_odometry(const ScanMatch& found, const ScanMatch& plain, const Points& points,
                      const WideSearch& search, const UsualFit& usual) {
  const bool has_much_more = usual.is_contradicted(plain) &&
                             found.inliers > kMuchMore * plain.inliers &&
                             usual.is_as_usual_where_mapped(found);
  const bool explains_more =
      has_much_more || (!usual.is_worse_than_usual(found) &&
                        (usual.is_contradicted(plain) ||
                         unexplained(plain, points) > kLeavesFarMore * unexplained(found, points)));
  // Along a corridor, people in the map may fit people who are elsewhere now.
  const Eigen::Vector2d shift =
      found.map_from_base.translation() - plain.map_from_base.translation();
  const bool is_unsettled = plain.observed.is_along_weak(shift) &&
                            found.settled_inliers <= kClearlyMore * plain.settled_inliers;
  return explains_more && !is_unsettled &&
         search.misfit(found.map_from_base) < search.misfit(plain.map_from_base);
}

}  // namespace

ScanMatch searched_widely(const ScanMatch& plain, const Points& points, const NdtMap& ndt,
                          const Points& occupied, const WideSearch& search, const UsualFit& usual,
                          const RangeNoise& noise, const ScanMatchConfig& config) {
  const PlaceSearch places{points, ndt, occupied, window_of(search), noise, config};
  std::vector<Se2> guesses = search.without_odometry;
  guesses.push_back(search.by_odometry);
  std::optional<ScanMatch> found = places.best(guesses, search.min_score);
  if (!found || found->inliers <= kClearlyMore * plain.inliers) return plain;
  const double plain_sigmas = sigmas_from_odometry(plain, search);
  const bool is_far = sigmas_from_odometry(*found, search) >
                      std::max(kContradictedSigmas, kFarFarther * plain_sigmas);
  if (is_far) {
    if (!refutes_odometry(*found, plain, points, search, usual)) return plain;
    return places.if_unambiguous(*found, plain).value_or(plain);
  }
  const bool fits_better =
      usual.is_contradicted(plain) || !usual.is_worse_than_usual(*found) ||
      (usual.is_nearly_usual(*found) &&
       (found->inliers > kFarMore * plain.inliers || plain_sigmas > kContradictedSigmas));
  return fits_better ? *found : plain;
}

double wide_search_reach_m(const Points& points, double driven_m) {
  double farthest_m = 0.0;
  for (const Eigen::Vector2d& point : points)
    farthest_m = std::max(farthest_m, point.norm());
  return farthest_m + reach_m(driven_m);
}

}  // namespace waymark
