// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/world.hpp"

#include "common/random/random.hpp"
#include "sim/core/random_streams.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace waymark {
namespace {

struct Place {
  Eigen::Vector2d centre_m{0.0, 0.0};
  double yaw_rad{0.0};
  int station{0};  ///< number of the station (spacing_m apart) along its corridor
  Side side{Side::kLeft};
};

/// Distances [m] first_m, first_m + spacing_m, ... up to last_m along a corridor; multiplied, not
/// summed up, so that rounding errors do not accumulate.
std::vector<double> stations(const MarkerLayoutConfig& markers) {
  std::vector<double> stations_m;
  constexpr double kRoundingSlack = 1e-9;
  const double steps = (markers.last_m - markers.first_m) / markers.spacing_m + kRoundingSlack;
  for (int i = 0; i <= steps; ++i)
    stations_m.push_back(markers.first_m + i * markers.spacing_m);
  return stations_m;
}

/// Distance [m] along the corridor of a station's marker on the right wall; nullopt if it has none.
std::optional<double> right_station(const MarkerLayoutConfig& markers, double station_m) {
  if (markers.layout == MarkerLayout::kOpposite) return station_m;
  const double between_m = station_m + 0.5 * markers.spacing_m;
  return between_m <= markers.last_m ? std::optional{between_m} : std::nullopt;
}

Place place_on(const Corridor& corridor, double width_m, Side side, double station_m) {
  const double left = side == Side::kLeft ? 1.0 : -1.0;
  const double y_m = left * (0.5 * width_m - kPlateThickness_m);
  const double yaw_rad = -left * 0.5 * std::numbers::pi;
  const Eigen::Vector2d in_corridor_m{station_m, y_m};
  return {corridor.world_from_corridor * in_corridor_m,
          wrap_angle(corridor.world_from_corridor.theta() + yaw_rad), 0, side};
}

std::vector<Place> places(const WorldConfig& world, const MarkerLayoutConfig& markers,
                          double plate_size_m) {
  std::vector<Place> found;
  if (markers.layout == MarkerLayout::kNone) return found;
  const std::vector<Wall> walls = outline(world);
  const auto add = [&](const Place& place) {
    if (hangs_on_a_wall(walls, place.centre_m, plate_size_m)) found.push_back(place);
  };
  for (const Corridor& corridor : corridors(world)) {
    int index = 0;
    for (const double station_m : stations(markers)) {
      Place left = place_on(corridor, world.width_m, Side::kLeft, station_m);
      left.station = index;
      add(left);
      if (const std::optional<double> right_m = right_station(markers, station_m)) {
        Place right = place_on(corridor, world.width_m, Side::kRight, *right_m);
        right.station = index;
        add(right);
      }
      ++index;
    }
  }
  return found;
}

bool is_kept(const MarkerLayoutConfig& markers, const Place& place, std::size_t number,
             std::int64_t seed) {
  const int shift = place.side == Side::kRight ? markers.keep_every / 2 : 0;
  if ((place.station + shift) % markers.keep_every != 0) return false;
  if (std::count(markers.missing.begin(), markers.missing.end(), static_cast<int>(number)) > 0)
    return false;
  Random random{static_cast<std::uint64_t>(seed), random_streams::kMissingMarkers, number};
  return random.uniform() >= markers.missing_share;
}

/// Distance from a point to a box; 0 inside.
double distance_m(const BoxConfig& box, const Eigen::Vector2d& point_m) {
  const Se2 world_from_box{box.x_m, box.y_m, radians(box.yaw_deg)};
  const Eigen::Vector2d in_box_m = world_from_box.inverse() * point_m;
  const Eigen::Vector2d beyond_m =
      (in_box_m.cwiseAbs() - 0.5 * Eigen::Vector2d{box.length_m, box.width_m}).cwiseMax(0.0);
  return beyond_m.norm();
}

}  // namespace

double clearance_m(const std::vector<Wall>& walls, const std::vector<BoxConfig>& boxes,
                   const Eigen::Vector2d& point_m) {
  double nearest_m = clearance_m(walls, point_m);
  for (const BoxConfig& box : boxes)
    nearest_m = std::min(nearest_m, distance_m(box, point_m));
  return nearest_m;
}

std::optional<MarkerPlate> plate_near(const std::vector<Wall>& walls,
                                      const Eigen::Vector2d& point_m, double plate_size_m) {
  constexpr double kReach_m = 0.5;
  const double half_m = 0.5 * plate_size_m;
  std::optional<MarkerPlate> nearest;
  double nearest_m = kReach_m;
  for (const Wall& wall : walls) {
    if (wall.length_m() < plate_size_m) continue;
    const double along_m =
        std::clamp(wall.along().dot(point_m - wall.from_m), half_m, wall.length_m() - half_m);
    const Eigen::Vector2d centre_m =
        wall.from_m + along_m * wall.along() - kPlateThickness_m * wall.outward();
    const double away_m = (centre_m - point_m).norm();
    if (away_m > nearest_m) continue;
    nearest_m = away_m;
    nearest.emplace();
    nearest->centre_m.head<2>() = centre_m;
    nearest->yaw_rad = std::atan2(-wall.outward().y(), -wall.outward().x());
  }
  return nearest;
}

bool hangs_on_a_wall(const std::vector<Wall>& walls, const Eigen::Vector2d& centre_m,
                     double plate_size_m) {
  constexpr double kRoundingSlack_m = 1e-9;
  const double half_m = 0.5 * plate_size_m - kRoundingSlack_m;
  return std::any_of(walls.begin(), walls.end(), [&](const Wall& wall) {
    const Eigen::Vector2d offset_m = centre_m - wall.from_m;
    const double along_m = wall.along().dot(offset_m);
    const double in_front_m = -wall.outward().dot(offset_m);
    return std::abs(in_front_m - kPlateThickness_m) < kRoundingSlack_m && along_m >= half_m &&
           along_m <= wall.length_m() - half_m;
  });
}

std::size_t place_count(const WorldConfig& world, const MarkerLayoutConfig& markers,
                        double plate_size_m) {
  return places(world, markers, plate_size_m).size();
}

std::vector<int> marker_ids(const MarkerLayoutConfig& markers, std::size_t num_places) {
  if (markers.ids.size() == 1) return std::vector<int>(num_places, markers.ids.front());
  if (!markers.ids.empty()) return markers.ids;
  std::vector<int> ids(num_places);
  for (std::size_t i = 0; i < ids.size(); ++i)
    ids[i] = markers.first_id + static_cast<int>(i);
  return ids;
}

World build_world(const WorldConfig& world, const MarkerLayoutConfig& markers, double plate_size_m,
                  std::int64_t seed) {
  World built;
  built.ceiling_height_m = world.wall_height_m;
  built.walls = outline(world);
  built.boxes = world.boxes;

  const std::vector<Place> all_places = places(world, markers, plate_size_m);
  const std::vector<int> ids = marker_ids(markers, all_places.size());
  std::map<int, int> instances;
  for (std::size_t i = 0; i < all_places.size(); ++i) {
    const Place& place = all_places[i];
    if (!is_kept(markers, place, i, seed)) continue;
    for (const MarkerMoveConfig& move : markers.moved) {
      if (move.place == static_cast<int>(i))
        built.moves.push_back({built.markers.size(), move.when, {move.dx_m, move.dy_m}});
    }
    built.markers.push_back({ids.at(i),
                             instances[ids.at(i)]++,
                             {place.centre_m.x(), place.centre_m.y(), markers.centre_height_m},
                             place.yaw_rad});
  }
  for (const MarkerAddConfig& added : markers.added) {
    auto plate = plate_near(built.walls, {added.x_m, added.y_m}, plate_size_m);
    if (!plate) continue;  // Scenario::check() refuses such a scenario
    plate->id = added.id;
    plate->instance = instances[added.id]++;
    plate->centre_m.z() = markers.centre_height_m;
    built.markers.push_back(*plate);
  }
  return built;
}

}  // namespace waymark
