// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/loaded_map.hpp"

#include "slam/core/grid/occupied_points.hpp"
#include "slam/core/localisation/map_fit.hpp"

#include <utility>

namespace waymark {
namespace {

constexpr std::int64_t kScansToDecide = 10;  // before the pose can be refuted
constexpr std::int64_t kScansKept = 20;  // about so many vote: earlier ones may have looked alike

}  // namespace

LoadedMap::LoadedMap(std::shared_ptr<const MapSnapshot> map)
    : map_{std::move(map)},
      wall_points_{occupied_points(map_->grid)},
      coarse_{map_->walls.spacing_m()},
      wall_changes_{map_} {
  for (const Eigen::Vector2d& point : wall_points_)
    coarse_.add(point);
}

Points LoadedMap::wall_points_near(const Eigen::Vector2d& place, double within_m) const {
  Points near;
  for (const Eigen::Vector2d& point : wall_points_)
    if ((point - place).norm() < within_m) near.push_back(point);
  return near;
}

ScanMatch LoadedMap::match(const Points& points_in_base, const Se2& guess,
                           const Eigen::Matrix3d& guess_covariance, const RangeNoise& noise,
                           const ScanMatchConfig& config) const {
  return match_scan(points_in_base, map_->walls, guess, guess_covariance, noise, config,
                    coarse_.levels());
}

void LoadedMap::trust(PlaceTrust place_trust) {
  place_trust_ = place_trust;
  was_confirmed_ |= is_confirmed();
}

void LoadedMap::compare(const Observation& observation, const Se2& map_from_base, bool fits_walls,
                        const MarkerBook::KnownMarkers& markers) {
  const MapFit scan = fit_in_map(map_->grid, observation.beams, map_from_base);
  if (fits_walls && !is_confirmed() && !scan.is_refuted()) trust(PlaceTrust::kFitsWalls);
  fit_.markers_in_place = markers.in_place;
  fit_.markers_moved = markers.moved;
  if (!scan.is_decisive()) return;
  if (votes_.decisive >= kScansKept) {
    votes_.decisive /= 2;
    votes_.refuting /= 2;
  }
  ++fit_.scans;
  ++votes_.decisive;
  if (scan.is_contradicted()) ++fit_.contradicting;
  if (!scan.is_refuted()) return;
  ++fit_.refuting;
  ++votes_.refuting;
}

bool LoadedMap::is_pose_refuted() const {
  return place_trust_ != PlaceTrust::kKnown && votes_.decisive >= kScansToDecide &&
         2 * votes_.refuting > votes_.decisive;
}

}  // namespace waymark
