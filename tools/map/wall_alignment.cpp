// SPDX-License-Identifier: BSD-3-Clause
#include "map/wall_alignment.hpp"

#include "slam/core/grid/occupied_points.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/core/registration/unique_place.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace waymark {
namespace {

constexpr double kStretch_m = 4.0;  // radius of the walls around a place that are matched at once
constexpr double kStretchesEvery_m = 3.0;
constexpr std::size_t kMaxStretches = 24;
constexpr std::size_t kPoints = 250;
constexpr std::size_t kMinPoints = 80;
constexpr double kMinScore = 0.6;  // below 1, as part of the walls may have changed
constexpr UniquePlaceLimits kUnique{.min_score = kMinScore,
                                    .runner_up_share = 0.85,
                                    .min_runner_up = kMinScore,
                                    .apart_m = 0.5,
                                    .apart_rad = 0.3};
constexpr double kAgree_m = 0.3;  // largest difference of the alignments by two stretches
constexpr double kAgree_rad = 0.1;
constexpr std::size_t kMinConsistent = 2;  // consistent stretches
constexpr double kRangeSigma_m = 0.02;     // sigma of points that are rounded to cell centres
const Eigen::Vector3d kFoundSigmas{0.1, 0.1, 0.05};

/// Poses along the trajectory of a map, some metres apart.
std::vector<Se2> places_of(const PoseGraph& graph) {
  std::vector<Se2> places;
  for (const Se2& pose : graph.poses) {
    const bool is_near = std::any_of(places.begin(), places.end(), [&](const Se2& place) {
      return (place.translation() - pose.translation()).norm() < kStretchesEvery_m;
    });
    if (!is_near) places.push_back(pose);
  }
  if (places.size() <= kMaxStretches) return places;
  std::vector<Se2> some;
  for (std::size_t i = 0; i < kMaxStretches; ++i)
    some.push_back(places[i * places.size() / kMaxStretches]);
  return some;
}

Points stretch_at(const Se2& place, const Points& walls) {
  Points points;
  for (const Eigen::Vector2d& wall : walls)
    if ((wall - place.translation()).norm() < kStretch_m) points.push_back(place.inverse() * wall);
  return points;
}

/// a_from_place; nullopt unless the stretch of walls fits at exactly one place.
std::optional<Se2> found_in(const MapSnapshot& a, const CorrelativeField& field,
                            const SearchWindow& window, const Se2& middle, const Points& stretch) {
  const Points some = thinned(stretch, kPoints);
  if (some.size() < kMinPoints) return std::nullopt;
  const auto best = unique_place(field, some, middle, window, kUnique);
  if (!best) return std::nullopt;
  const RangeNoise noise{kRangeSigma_m};
  const ScanMatchConfig config;
  const Eigen::Matrix3d near = kFoundSigmas.cwiseAbs2().asDiagonal();
  const ScanMatch match = match_scan(some, a.walls, best->submap_from_base, near, noise, config);
  if (!match.is_usable(config) || match.observed.is_degenerate) return std::nullopt;
  return match.map_from_base;
}

Se2 mean_of(const std::vector<Se2>& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Se2& pose : poses)
    sum += pose_difference(pose, poses.front());
  sum /= static_cast<double>(poses.size());
  return moved_by(poses.front(), sum);
}

}  // namespace

std::optional<MapAlignment> align_by_walls(const MapSnapshot& a, const MapSnapshot& b) {
  const Points walls_a = occupied_points(a.grid);
  const Points walls_b = occupied_points(b.grid);
  if (walls_a.empty() || walls_b.empty()) return std::nullopt;
  Eigen::Vector2d least = walls_a.front();
  Eigen::Vector2d most = least;
  for (const Eigen::Vector2d& point : walls_a) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  const CorrelativeField field = CorrelativeField::of_map(walls_a);
  const Se2 middle{Eigen::Vector2d{0.5 * (least + most)}, 0.0};
  const SearchWindow window{0.5 * (most - least).maxCoeff() + kStretch_m, std::numbers::pi};

  struct Found {
    Se2 a_from_place{};
    Se2 b_from_place{};

    /// Whether a_from_b by this stretch predicts the pose of the other one.
    bool agrees_with(const Found& other) const {
      const Se2 a_from_b = a_from_place * b_from_place.inverse();
      const Eigen::Vector3d off =
          pose_difference(a_from_b * other.b_from_place, other.a_from_place);
      return off.head<2>().norm() < kAgree_m && std::abs(off.z()) < kAgree_rad;
    }
  };

  std::vector<Found> found;
  for (const Se2& place : places_of(b.graph))
    if (const auto there = found_in(a, field, window, middle, stretch_at(place, walls_b)))
      found.push_back({*there, place});
  std::vector<Found> best;
  for (const Found& one : found) {
    std::vector<Found> consistent;
    std::copy_if(found.begin(), found.end(), std::back_inserter(consistent),
                 [&](const Found& other) { return one.agrees_with(other); });
    if (consistent.size() > best.size()) best = consistent;
  }
  if (best.size() < kMinConsistent) return std::nullopt;
  // Poses are averaged at the centre of the stretches, where rotation errors move them least.
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Found& one : best)
    centre += one.b_from_place.translation() / static_cast<double>(best.size());
  const Se2 b_from_centre{centre, 0.0};
  std::vector<Se2> a_from_centre;
  for (const Found& one : best)
    a_from_centre.push_back(one.a_from_place * one.b_from_place.inverse() * b_from_centre);
  MapAlignment alignment{mean_of(a_from_centre) * b_from_centre.inverse(), best.size(), 0.0};
  for (const Found& one : best) {
    const Eigen::Vector2d off =
        (alignment.a_from_b * one.b_from_place).translation() - one.a_from_place.translation();
    alignment.rms_m += off.squaredNorm() / static_cast<double>(best.size());
  }
  alignment.rms_m = std::sqrt(alignment.rms_m);
  return alignment;
}

}  // namespace waymark
