// SPDX-License-Identifier: BSD-3-Clause
#include "placement/placement.hpp"

#include "common/geometry/median.hpp"
#include "common/markers/marker_dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace waymark::placement {
namespace {

constexpr double kMargin = 0.85;         // factor on the target, for errors of the model
constexpr double kQuietModules = 2.0;    // on each side, as on printed marker sheets
constexpr double kSpacing_m = 0.5;       // between candidate places along a wall
constexpr double kSignificant_m = 1e-3;  // smaller sigmas are not compared with those of the run
constexpr double kMatters = 0.9;  // a limit is reported if sigma without it is below this share

/// Ids of the dictionary (or of robot.markers.ids) that no marker of the map has, ascending.
std::vector<int> free_ids(const MarkerConfig& markers, int dictionary_size,
                          std::span<const MappedMarker> hung) {
  std::vector<int> ids = markers.ids;
  if (ids.empty()) {
    ids.resize(static_cast<std::size_t>(dictionary_size));
    std::iota(ids.begin(), ids.end(), 0);
  }
  std::set<int> used;
  for (const MappedMarker& marker : hung)
    used.insert(marker.id);
  std::erase_if(ids, [&](int id) { return used.contains(id); });
  std::sort(ids.begin(), ids.end());
  return ids;
}

void compare_with_run(const PlacementInput& input, Placement& placement) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < placement.steps.size(); ++i) {
    const Step& step = placement.steps[i];
    const auto* shown = evaluate::covariance_at(input.covariances, input.places[step.scan].t_s);
    if (shown == nullptr) continue;
    const double sigma_m = sigma_along(shown->covariance, step.weak_axis);
    if (sigma_m > placement.worst_run_m.value_or(0.0)) {
      placement.worst_run_m = sigma_m;
      placement.worst_run_at = i;
    }
    if (sigma_m > kSignificant_m) ratios.push_back(placement.advice.now_m[i] / sigma_m);
  }
  if (ratios.empty()) return;
  placement.model_over_run = upper_median(std::move(ratios));
}

/// The worst sigma with markers everywhere, for another configuration.
double with_all(const SlamConfig& config, const Placement& placement,
                std::span<const Sightings> hung, std::span<const WallPlace> places,
                std::span<const Sightings> at_places) {
  const CovarianceModel model{placement.steps, config};
  return worst(model.sigmas_m(model.predict(hung_and(hung, at_places, everywhere(places)))));
}

}  // namespace

double Placement::worst_now_m() const {
  return worst(advice.now_m);
}

double Placement::worst_then_m() const {
  return worst(advice.then_m);
}

double Placement::reachable_m() const {
  return std::max(target_m, advice.everywhere_m);
}

Placement place_markers(const PlacementInput& input, double target_m, const Report& report) {
  const MarkerConfig& described = input.config.robot.markers;
  const auto dictionary = find_dictionary(described.dictionary);
  if (!dictionary) throw SetupError{"robot.markers.dictionary: unknown: " + described.dictionary};
  const int modules = modules_per_side(*dictionary);
  const double plate_m = described.size_m * (1.0 + 2.0 * kQuietModules / modules);

  Placement placement;
  placement.target_m = target_m;
  const OccupiedWalls walls{input.image};
  placement.steps = drive_along(input.places, walls, input.config);
  const double camera_m = input.config.robot.camera.base_from_camera().translation().z();
  const ViewModel views{input.config, modules, input.marker_height_m.value_or(camera_m)};
  const CovarianceModel model{placement.steps, input.config};

  std::vector<Se2> poses;
  std::vector<Sightings> hung;
  for (const MappedMarker& marker : input.markers) {
    poses.push_back(marker.map_from_marker);
    hung.push_back(sightings_along(placement.steps, marker.map_from_marker, walls, views));
  }
  const std::vector<WallPlace> places = free_wall_places(
      placement.steps, walls, poses, plate_m, input.config.robot.lidar.range_max_m, kSpacing_m);
  std::vector<Sightings> at_places;
  for (const WallPlace& place : places)
    at_places.push_back(sightings_along(placement.steps, place.map_from_marker, walls, views));
  report(fmt::format("{} steps, {} free places", placement.steps.size(), places.size()));
  const std::vector<int> ids = free_ids(described, size_of(*dictionary), input.markers);
  placement.free_places = places.size();
  placement.free_ids = ids.size();

  const auto advise_for = [&](double sigma_m) {
    return advise(model, placement.steps, hung, places, at_places, plate_m, sigma_m, ids.size(),
                  report);
  };
  // Plan with a margin, unless the target is met already or cannot be met with the margin.
  placement.now = model.predict(hung_and(hung, {}, {}));
  const bool is_met_now = worst(model.sigmas_m(placement.now)) <= target_m;
  placement.advice = advise_for(is_met_now ? target_m : kMargin * target_m);
  if (!is_met_now && placement.worst_then_m() > kMargin * target_m)
    placement.advice = advise_for(target_m);
  for (std::size_t i = 0; i < placement.advice.chosen.size(); ++i)
    placement.markers.push_back(
        {places[placement.advice.chosen[i]], ids[i], placement.advice.worst_after_m[i]});
  placement.stretches = stretches_above(placement.advice.now_m, target_m);
  for (const Eigen::Matrix3d& covariance : placement.now)
    placement.across_m =
        std::max(placement.across_m, sigma_along(covariance, Eigen::Vector2d::Zero()));
  compare_with_run(input, placement);
  if (placement.is_met()) return placement;

  SlamConfig exact = input.config;
  exact.robot.camera.focal_sigma = 0.0;
  const double without_focal_m = with_all(exact, placement, hung, places, at_places);
  if (without_focal_m < kMatters * placement.reachable_m())
    placement.limits.push_back(
        {fmt::format("the camera's scale: robot.camera.focal_sigma = {}, along a bare corridor all "
                     "is scaled by it; calibrate the camera, or survey two markers",
                     input.config.robot.camera.focal_sigma),
         without_focal_m});
  return placement;
}

}  // namespace waymark::placement
