// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/place_finder.hpp"

#include "slam/core/localisation/wall_place_finder.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

namespace waymark {
namespace {

struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// A room with an alcove on one side and a partition: no two places look alike.
std::vector<Wall> room() {
  return {{{0.0, 0.0}, {7.0, 0.0}}, {{7.0, 0.0}, {7.0, 3.0}}, {{7.0, 3.0}, {5.0, 3.0}},
          {{5.0, 3.0}, {5.0, 5.0}}, {{5.0, 5.0}, {0.0, 5.0}}, {{0.0, 5.0}, {0.0, 0.0}},
          {{2.0, 0.0}, {2.0, 1.6}}, {{3.4, 5.0}, {3.4, 3.9}}};
}

std::vector<Wall> rectangle() {
  return {{{0.0, 0.0}, {6.0, 0.0}},
          {{6.0, 0.0}, {6.0, 4.0}},
          {{6.0, 4.0}, {0.0, 4.0}},
          {{0.0, 4.0}, {0.0, 0.0}}};
}

std::vector<AnnotatedBeam> scan_of(const std::vector<Wall>& walls, const Se2& map_from_base) {
  std::vector<AnnotatedBeam> beams;
  for (int degree = 0; degree < 360; ++degree) {
    const double bearing_rad = degree * std::numbers::pi / 180.0;
    const double direction_rad = map_from_base.theta() + bearing_rad;
    const Eigen::Vector2d ray{std::cos(direction_rad), std::sin(direction_rad)};
    double range_m = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
      Eigen::Matrix2d columns;
      columns << ray, wall.from - wall.to;
      if (std::abs(columns.determinant()) < 1e-9) continue;
      const Eigen::Vector2d hit = columns.inverse() * (wall.from - map_from_base.translation());
      if (hit.x() > 0.0 && hit.y() >= 0.0 && hit.y() <= 1.0) range_m = std::min(range_m, hit.x());
    }
    AnnotatedBeam annotated;
    annotated.beam.range_m = range_m;
    annotated.beam.end_in_base =
        range_m * Eigen::Vector2d{std::cos(bearing_rad), std::sin(bearing_rad)};
    beams.push_back(annotated);
  }
  return beams;
}

std::shared_ptr<const MapSnapshot> map_of(const std::vector<Wall>& walls) {
  auto map = std::make_shared<MapSnapshot>();
  map->grid.frame = GridFrame::centred_on_map_origin(0.05);
  for (const Wall& wall : walls) {
    const int steps = static_cast<int>((wall.to - wall.from).norm() / 0.01);
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d point = wall.from + (wall.to - wall.from) * i / steps;
      map->grid.occupancy.edit(map->grid.frame.cell_of(point)) = {9, 10};
      map->walls.add(point, 0);
    }
  }
  return map;
}

std::optional<Se2> found_along(WallPlaceFinder& finder, const std::vector<Wall>& walls,
                               const std::vector<Se2>& way) {
  std::optional<Se2> found;
  for (std::size_t i = 0; i < way.size() && !found; ++i) {
    Observation observation;
    observation.beams = scan_of(walls, way[i]);
    if (i > 0) finder.follow(Motion::between(way[i - 1], way[i]));
    found = finder.search(observation, RangeNoise{0.01});
  }
  return found;
}

TEST(WallPlaceFinder, ThreeConsistentScansLocaliseInARoom) {
  const std::vector<Se2> way{{0.8, 2.4, 0.1}, {1.3, 2.45, 0.1}, {1.8, 2.5, 0.1}};
  WallPlaceFinder finder{map_of(room()), {}};
  EXPECT_FALSE(found_along(finder, room(), {way[0], way[1]}));
  WallPlaceFinder another{map_of(room()), {}};
  const auto found = found_along(another, room(), way);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x(), way.back().x(), 0.05);
  EXPECT_NEAR(found->y(), way.back().y(), 0.05);
  EXPECT_NEAR(found->theta(), way.back().theta(), 0.02);
}

// A rectangle is the same when it is turned by half a circle.
TEST(WallPlaceFinder, AScanThatFitsAtTwoPlacesIsIgnored) {
  WallPlaceFinder finder{map_of(rectangle()), {}};
  EXPECT_FALSE(found_along(finder, rectangle(),
                           {{1.0, 1.0, 0.4}, {1.5, 1.2, 0.4}, {2.0, 1.4, 0.4}, {2.5, 1.6, 0.4}}));
}

TEST(WallPlaceFinder, AnEmptyMapGivesNoPose) {
  WallPlaceFinder finder{std::make_shared<MapSnapshot>(), {}};
  EXPECT_FALSE(found_along(finder, room(), {{1, 2, 0}, {1.5, 2, 0}, {2.0, 2, 0}, {2.5, 2, 0}}));
}

// Where a marker is in view that is not in the map, no scan is searched for.
TEST(PlaceFinder, WallsLocaliseAcrossAMarkerThatTheMapDoesNotHave) {
  const std::vector<Se2> way{{0.8, 2.4, 0.1}, {1.3, 2.45, 0.1}, {1.8, 2.5, 0.1}, {2.3, 2.55, 0.1}};
  PlaceFinder finder{map_of(room()), {}};
  std::optional<Se2> found;
  for (std::size_t i = 0; i < way.size() && !found; ++i) {
    Observation observation;
    observation.beams = scan_of(room(), way[i]);
    std::vector<MarkerMeasurement> measurements(i == 1 ? 1 : 0);
    const Motion motion = i == 0 ? Motion{} : Motion::between(way[i - 1], way[i]);
    found = finder.update(motion, observation, measurements, {}, RangeNoise{0.01});
  }
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x(), way.back().x(), 0.05);
}

const Se2 kRobot{0.8, 2.4, 0.1};

MarkerMeasurement sighting(int id, const Se2& map_from_marker) {
  MarkerMeasurement measurement;
  measurement.id = id;
  measurement.base_from_marker = kRobot.inverse() * map_from_marker;
  return measurement;
}

/// The standing robot sights one marker at a time; the map has markers 3 and 7.
bool is_found_after(const std::vector<MarkerMeasurement>& sightings) {
  auto map = std::make_shared<MapSnapshot>(*map_of(room()));
  map->landmarks.push_back({.id = 3, .map_from_marker = {2.0, 1.0, 3.1}, .sightings = 10});
  map->landmarks.push_back({.id = 7, .map_from_marker = {2.5, 5.0, -1.6}, .sightings = 10});
  PlaceFinder finder{map, {}};
  std::optional<Se2> found;
  for (const MarkerMeasurement& seen : sightings) {
    Observation observation;
    observation.beams = scan_of(room(), kRobot);
    found = finder.update({}, observation, std::vector{seen}, {}, RangeNoise{0.01});
  }
  return found.has_value();
}

TEST(PlaceFinder, OneMarkerDecidesAtItsThirdSighting) {
  const MarkerMeasurement seen = sighting(3, {2.0, 1.0, 3.1});
  EXPECT_FALSE(is_found_after({seen, seen}));
  EXPECT_TRUE(is_found_after({seen, seen, seen}));
}

TEST(PlaceFinder, TwoMarkersDecideAtOneSightingOfEach) {
  EXPECT_TRUE(is_found_after({sighting(3, {2.0, 1.0, 3.1}), sighting(7, {2.5, 5.0, -1.6})}));
}

TEST(PlaceFinder, TwoMarkersThatDisagreeDecideNothing) {
  EXPECT_FALSE(is_found_after({sighting(3, {2.0, 1.0, 3.1}), sighting(7, {4.0, 5.0, -1.6})}));
}

/// Sights a marker of the map once, where it is not.
std::optional<Se2> found_after_a_misread_id(const Se2& map_from_marker) {
  std::vector<Se2> way;
  for (int i = 0; i < 6; ++i)
    way.emplace_back(0.8 + 0.5 * i, 2.4 + 0.05 * i, 0.1);
  auto map = std::make_shared<MapSnapshot>(*map_of(room()));
  map->landmarks.push_back({.id = 7, .map_from_marker = map_from_marker, .sightings = 10});
  PlaceFinder finder{map, {}};
  std::optional<Se2> found;
  for (std::size_t i = 0; i < way.size() && !found; ++i) {
    Observation observation;
    observation.beams = scan_of(room(), way[i]);
    std::vector<MarkerMeasurement> measurements(i == 0 ? 1 : 0);
    for (MarkerMeasurement& misread : measurements) {
      misread.id = 7;
      misread.base_from_marker = {2.0, 0.0, std::numbers::pi};
    }
    const Motion motion = i == 0 ? Motion{} : Motion::between(way[i - 1], way[i]);
    found = finder.update(motion, observation, measurements, {}, RangeNoise{0.01});
    if (found) {
      EXPECT_NEAR(found->x(), way[i].x(), 0.05);
      EXPECT_NEAR(found->y(), way[i].y(), 0.05);
    }
  }
  return found;
}

TEST(PlaceFinder, WallsLocaliseAfterAMisreadIdWhosePlaceContradictsThem) {
  EXPECT_TRUE(found_after_a_misread_id({3.4, 4.2, 0.0}));
}

TEST(PlaceFinder, WallsLocaliseAfterAMisreadIdWhosePlaceIsOutsideTheMap) {
  EXPECT_TRUE(found_after_a_misread_id({40.0, 40.0, 0.0}));
}

}  // namespace
}  // namespace waymark
