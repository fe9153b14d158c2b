// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/wall_place_finder.hpp"

#include "common/geometry/se2.hpp"
#include "slam/core/grid/occupied_points.hpp"
#include "slam/core/registration/unique_place.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace waymark {
namespace {

constexpr double kSearchEvery_m = 0.4;
constexpr int kConsistentScans = 3;  // in a row, to decide
constexpr std::size_t kBeams = 150;
constexpr std::size_t kMinBeams = 60;
constexpr UniquePlaceLimits kUnique{
    .min_score = 0.7, .runner_up_share = 0.8, .apart_m = 0.5, .apart_rad = 0.3};
constexpr double kAgree_m = 0.2;  // between a match and the candidate
constexpr double kAgree_rad = 0.1;
constexpr double kMinInliers = 0.8;                  // share of the mapped beams
constexpr double kMinMappedShare = 0.8;              // share of all beams
const Eigen::Vector3d kPlaceSigmas{0.1, 0.1, 0.05};  // of the search's best place [m, m, rad]

}  // namespace

WallPlaceFinder::WallPlaceFinder(std::shared_ptr<const MapSnapshot> map,
                                 const ScanMatchConfig& scan)
    : map_{std::move(map)}, scan_{scan} {
  const Points walls = occupied_points(map_->grid);
  if (walls.empty()) return;
  Eigen::Vector2d least = walls.front();
  Eigen::Vector2d most = least;
  for (const Eigen::Vector2d& wall : walls) {
    least = least.cwiseMin(wall);
    most = most.cwiseMax(wall);
  }
  field_ = CorrelativeField::of_map(walls);
  middle_ = {Eigen::Vector2d{0.5 * (least + most)}, 0.0};
  window_ = {0.5 * (most - least).maxCoeff(), std::numbers::pi};
}

void WallPlaceFinder::follow(const Motion& motion) {
  if (candidate_) candidate_ = *candidate_ * motion.start_from_end;
  since_search_m_ += motion.distance_m;
}

std::optional<Se2> WallPlaceFinder::search(const Observation& observation,
                                           const RangeNoise& noise) {
  if (!field_ || observation.beams.size() < kMinBeams || since_search_m_ < kSearchEvery_m)
    return std::nullopt;
  since_search_m_ = 0.0;
  const auto there = found(thinned(points_of(observation), kBeams), noise);
  if (!there) return std::nullopt;
  const Eigen::Vector3d off = candidate_ ? pose_difference(*there, *candidate_)
                                         : Eigen::Vector3d::Constant(std::numbers::pi);
  const bool agrees = off.head<2>().norm() < kAgree_m && std::abs(off.z()) < kAgree_rad;
  num_consistent_ = agrees ? num_consistent_ + 1 : 1;
  candidate_ = there;
  return num_consistent_ >= kConsistentScans ? there : std::nullopt;
}

std::optional<Se2> WallPlaceFinder::found(const Points& points, const RangeNoise& noise) const {
  const auto best = unique_place(*field_, points, middle_, window_, kUnique);
  if (!best) return std::nullopt;
  const Eigen::Matrix3d near = kPlaceSigmas.cwiseAbs2().asDiagonal();
  const ScanMatch match =
      match_scan(points, map_->walls, best->submap_from_base, near, noise, scan_);
  const bool fits = match.is_usable(scan_) && match.inlier_share >= kMinInliers &&
                    match.mapped_share >= kMinMappedShare && !match.observed.is_degenerate;
  return fits ? std::optional{match.map_from_base} : std::nullopt;
}

}  // namespace waymark
