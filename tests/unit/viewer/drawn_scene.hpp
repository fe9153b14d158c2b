// SPDX-License-Identifier: BSD-3-Clause
// Scenes for the painters: small drawn maps, and a corridor as in the default world.
#pragma once

#include "common/random/random.hpp"
#include "viewer/core/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace waymark::viewer {

constexpr double kCell_m = 0.05;

/// One line per row of cells, highest y first: '#' occupied, '.' free, ' ' unknown, a digit = an
/// occupied cell with that marker id.
inline GridMap drawn_map(const std::vector<std::string>& picture) {
  GridMap map;
  const int rows = static_cast<int>(picture.size());
  const int columns = rows == 0 ? 0 : static_cast<int>(picture.front().size());
  map.occupancy_percent = cv::Mat_<schar>(rows, columns, schar{-1});
  map.marker_ids = cv::Mat_<short>(rows, columns, short{-1});
  map.resolution_m = kCell_m;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const char sign =
          picture[static_cast<std::size_t>(rows - 1 - row)][static_cast<std::size_t>(column)];
      if (sign == ' ') continue;
      map.occupancy_percent(row, column) = sign == '.' ? schar{0} : schar{100};
      if (sign >= '0' && sign <= '9') map.marker_ids(row, column) = static_cast<short>(sign - '0');
    }
  }
  return map;
}

/// A whole map as tiles of 64 cells; the lower left corner of tile (0, 0) is the map's.
inline void put_cells(TiledMap& tiles, const GridMap& map) {
  constexpr int kSide = 64;
  const TileLayout layout{map.origin_m.x(), map.origin_m.y(), map.resolution_m, kSide};
  const cv::Rect all{{0, 0}, map.occupancy_percent.size()};
  for (int bottom = 0; bottom < all.height; bottom += kSide) {
    for (int left = 0; left < all.width; left += kSide) {
      std::vector<std::int8_t> occupancy;
      std::vector<std::int16_t> ids;
      for (int row = bottom; row < bottom + kSide; ++row) {
        for (int column = left; column < left + kSide; ++column) {
          const bool is_inside = all.contains({column, row});
          occupancy.push_back(is_inside ? map.occupancy_percent(row, column) : schar{-1});
          ids.push_back(is_inside ? map.marker_ids(row, column) : short{-1});
        }
      }
      tiles.put(layout, Timestamp{}, {left / kSide, bottom / kSide, occupancy, ids});
    }
  }
}

/// Rectangular room seen from inside: its walls run along the given inner faces.
inline GridMap room(double left_m, double bottom_m, double right_m, double top_m) {
  GridMap map;
  map.resolution_m = kCell_m;
  map.origin_m = {left_m - 2 * kCell_m, bottom_m - 2 * kCell_m};
  const int columns = static_cast<int>(std::lround((right_m - left_m) / kCell_m)) + 4;
  const int rows = static_cast<int>(std::lround((top_m - bottom_m) / kCell_m)) + 4;
  map.occupancy_percent = cv::Mat_<schar>(rows, columns, schar{3});
  map.marker_ids = cv::Mat_<short>(rows, columns, short{-1});
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int rim = std::min({row, column, rows - 1 - row, columns - 1 - column});
      if (rim == 0) map.occupancy_percent(row, column) = -1;
      if (rim == 1) map.occupancy_percent(row, column) = 96;
    }
  }
  return map;
}

inline void mark_cells(GridMap& map, const Se2& map_from_marker, int id) {
  for (int row = 0; row < map.marker_ids.rows; ++row) {
    for (int column = 0; column < map.marker_ids.cols; ++column) {
      const Eigen::Vector2d offset = map.cell_centre_m(row, column) - map_from_marker.translation();
      const bool is_wall = map.occupancy_percent(row, column) > 50;
      if (is_wall && std::abs(offset.x()) < 0.2 && std::abs(offset.y()) < 0.08)
        map.marker_ids(row, column) = static_cast<short>(id);
    }
  }
}

/// A straight corridor along x as in the default world, driven from 1 m behind its start to 1 m
/// before its end; the map starts at the robot's start. Truth, estimate and odometry drift apart.
inline Scene corridor_scene(double length_m, std::uint64_t seed = 1) {
  Scene scene;
  scene.title = "marker_matching";
  GridMap map = room(-1.0, -1.0, length_m - 1.0, 1.0);
  const double half_turn = std::numbers::pi / 2;
  int id = 0;
  for (double x_m = 3.0; x_m < length_m - 1.0; x_m += 4.0) {
    for (const double side : {1.0, -1.0}) {
      Landmark landmark{.id = id++,
                        .map_from_marker = {x_m, side * 1.02, -side * half_turn},
                        .sightings = 40,
                        .state = LandmarkState::kConfirmed};
      landmark.covariance.diagonal() << 4e-4, 1e-4, 1e-3;
      mark_cells(map, landmark.map_from_marker, landmark.id);
      scene.landmarks.push_back(landmark);
    }
  }
  put_cells(scene.map, map);

  Random random{seed};
  constexpr Duration kScanPeriod{200'000};
  const int count = static_cast<int>((length_m - 2.0) / 0.02);
  Se2 odom_from_base{};
  for (int i = 0; i < count; ++i) {
    const double x_m = 0.02 * i;
    const Timestamp time{i * kScanPeriod};
    EstimatedPose pose{
        .time = time,
        .map_from_base = {x_m + 0.01 * std::sin(x_m), 0.03 * std::sin(0.7 * x_m), 0.0},
        .health = i < 20 ? Health::kInitialising : Health::kTracking};
    const double phase = std::fmod(x_m, 4.0);
    if (phase > 1.5 && phase < 2.4 && x_m > 20 && x_m < 35) pose.health = Health::kDegenerate;
    pose.covariance.diagonal() << std::pow(0.01 + 0.015 * phase, 2), 4e-5, 1e-5;
    scene.estimates.push_back(pose);
    scene.truth.push_back({time, {x_m + 1.0, 0.0, 0.0}});
    scene.odometry.push_back({time, odom_from_base});
    odom_from_base = odom_from_base * Se2{0.0202, 0.0, random.normal(0.00004, 0.0012)};
  }
  for (int i = 0; i < 100 && count > 0; ++i) {
    scene.particles.emplace_back(length_m - 2.0 + random.normal(0, 0.05), random.normal(0, 0.02),
                                 0.0);
  }
  return scene;
}

/// A scan in a corridor with two markers ahead.
inline AnnotatedScan corridor_scan() {
  AnnotatedScan scan{.time = Timestamp{Duration{31'400'000}}};
  for (int i = 0; i < 360; ++i) {
    const double angle = radians(i);
    const double range_m = 1.0 / std::max(std::abs(std::sin(angle)), 1e-9);
    const double x_m = range_m * std::cos(angle);
    scan.angles_rad.push_back(angle);
    scan.ranges_m.push_back(range_m > 3.5 ? std::numeric_limits<double>::infinity() : range_m);
    scan.marker_ids.push_back(x_m > 1.9 && x_m < 2.3 ? (std::sin(angle) > 0 ? 4 : 5) : kNoMarker);
  }
  return scan;
}

}  // namespace waymark::viewer
