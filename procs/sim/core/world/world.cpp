// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/world.hpp"

#include <cmath>
#include <map>
#include <numbers>

namespace waymark {
namespace {

enum class Side { kLeft, kRight };

struct Place {
  double station_m{0.0};
  Side side{Side::kLeft};
};

/// Stations first, first + spacing, ... up to last; computed, not accumulated.
std::vector<double> stations(const MarkerLayoutConfig& markers) {
  std::vector<double> stations_m;
  constexpr double kRoundingSlack = 1e-9;
  const double steps = (markers.last_m - markers.first_m) / markers.spacing_m + kRoundingSlack;
  for (int i = 0; i <= steps; ++i)
    stations_m.push_back(markers.first_m + i * markers.spacing_m);
  return stations_m;
}

std::vector<Place> places(const MarkerLayoutConfig& markers) {
  std::vector<Place> found;
  switch (markers.layout) {
    case MarkerLayout::kNone:
      break;
    case MarkerLayout::kOpposite:
      for (const double station_m : stations(markers)) {
        found.push_back({station_m, Side::kLeft});
        found.push_back({station_m, Side::kRight});
      }
      break;
    case MarkerLayout::kStaggered:
      for (const double station_m : stations(markers)) {
        found.push_back({station_m, Side::kLeft});
        const double between_m = station_m + 0.5 * markers.spacing_m;
        if (between_m <= markers.last_m) found.push_back({between_m, Side::kRight});
      }
      break;
  }
  return found;
}

}  // namespace

void WorldConfig::describe(Fields& fields) {
  fields.field("length_m", length_m, {0.1, 1000.0}, "corridor length between the end walls");
  fields.field("width_m", width_m, {0.1, 100.0}, "corridor width between the side walls");
  fields.field("wall_height_m", wall_height_m, {0.3, 20.0}, "height of walls and ceiling");
  fields.field("wall_thickness_m", wall_thickness_m, {0.01, 10.0}, "thickness of every wall");
}

void MarkerLayoutConfig::describe(Fields& fields) {
  fields.choice("layout", layout,
                {{"opposite", MarkerLayout::kOpposite},
                 {"staggered", MarkerLayout::kStaggered},
                 {"none", MarkerLayout::kNone}},
                "pairs facing each other, or the right wall's shifted by half the spacing");
  fields.field("first_m", first_m, kNotNegative, "x of the first station");
  fields.field("spacing_m", spacing_m, {0.1, 1000.0}, "from station to station");
  fields.field("last_m", last_m, kNotNegative, "no marker beyond this x");
  fields.field("centre_height_m", centre_height_m, kPositive, "centre of the black square");
  fields.field("quiet_zone_modules", quiet_zone_modules, {0.0, 10.0},
               "white border around the black square, in marker modules");
  fields.field("blank", blank, "plain white plates: the same world without information");
  fields.field("first_id", first_id, {0, 100000}, "id of the first marker, the next have the next");
  fields.field("ids", ids, {0, 100000},
               "id of every marker by station, left wall before right wall; [] = from first_id on");
}

std::size_t marker_count(const MarkerLayoutConfig& markers) {
  return places(markers).size();
}

std::vector<int> marker_ids(const MarkerLayoutConfig& markers) {
  if (!markers.ids.empty()) return markers.ids;
  std::vector<int> ids(marker_count(markers));
  for (std::size_t i = 0; i < ids.size(); ++i)
    ids[i] = markers.first_id + static_cast<int>(i);
  return ids;
}

World straight_corridor(const WorldConfig& world, const MarkerLayoutConfig& markers) {
  const double length = world.length_m;
  const double half_width = 0.5 * world.width_m;
  const auto wall = [&world](WallKind kind, Eigen::Vector2d from_m, Eigen::Vector2d to_m) {
    return Wall{kind, from_m, to_m, world.wall_height_m, world.wall_thickness_m};
  };

  World built;
  built.ceiling_height_m = world.wall_height_m;
  built.walls = {wall(WallKind::kSide, {0.0, -half_width}, {length, -half_width}),
                 wall(WallKind::kEnd, {length, -half_width}, {length, half_width}),
                 wall(WallKind::kSide, {length, half_width}, {0.0, half_width}),
                 wall(WallKind::kEnd, {0.0, half_width}, {0.0, -half_width})};

  const std::vector<Place> all_places = places(markers);
  const std::vector<int> ids = marker_ids(markers);
  std::map<int, int> instances;
  for (std::size_t i = 0; i < all_places.size(); ++i) {
    const bool left = all_places[i].side == Side::kLeft;
    const double y_m = (left ? 1.0 : -1.0) * (half_width - kPlateThickness_m);
    const double yaw_rad = (left ? -0.5 : 0.5) * std::numbers::pi;
    built.markers.push_back({ids.at(i),
                             instances[ids.at(i)]++,
                             {all_places[i].station_m, y_m, markers.centre_height_m},
                             yaw_rad});
  }
  return built;
}

}  // namespace waymark
