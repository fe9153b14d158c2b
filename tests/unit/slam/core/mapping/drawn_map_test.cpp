// SPDX-License-Identifier: BSD-3-Clause
// A map that follows the poses of its scans.
#include "slam/core/mapping/drawn_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace waymark {
namespace {

Observation scan_of_a_circle(double radius_m) {
  Observation observation;
  for (int beam = 0; beam < 90; ++beam) {
    const double angle_rad = 0.07 * beam;
    AnnotatedBeam annotated;
    annotated.beam.end_in_base =
        radius_m * Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)};
    annotated.beam.range_m = radius_m;
    observation.beams.push_back(annotated);
  }
  MarkerSighting sighting;
  sighting.id = 4;
  sighting.size_m = 0.4;
  sighting.base_from_marker = {radius_m, 0.0, 3.0};
  observation.sightings.push_back(sighting);
  return observation;
}

std::vector<Se2> straight_path(std::size_t scans) {
  std::vector<Se2> poses;
  for (std::size_t i = 0; i < scans; ++i)
    poses.push_back({0.15 * static_cast<double>(i), 0.01 * static_cast<double>(i), 0.02});
  return poses;
}

GridMap empty_map() {
  return {GridFrame::centred_on_map_origin(0.05), {}, {}};
}

void expect_equal_maps(const GridMap& one, const GridMap& other) {
  int different = 0;
  for (int x = -200; x < 600; ++x) {
    for (int y = -200; y < 200; ++y) {
      different += one.occupancy[{x, y}] != other.occupancy[{x, y}];
      different += one.markers[{x, y}].most_supported() != other.markers[{x, y}].most_supported();
    }
  }
  EXPECT_EQ(different, 0);
}

TEST(DrawnMap, RedrawingForNewPosesEqualsDrawingAlongThem) {
  DrawnMap map{MapperConfig{}, empty_map()};
  std::vector<Se2> poses = straight_path(60);
  for (std::size_t i = 0; i < poses.size(); ++i)
    map.add(scan_of_a_circle(2.0 + 0.01 * static_cast<double>(i)), poses[i]);
  for (Se2& pose : poses)
    pose = Se2{1.0, -0.5, 0.2} * pose;
  const auto pose_of = [&](std::size_t scan) {
    return poses[scan];
  };
  map.note_poses_changed();
  for (std::size_t i = 0; i < poses.size(); ++i)
    map.redraw_some(pose_of);
  expect_equal_maps(map.map(), map.drawn_along(pose_of));
}

TEST(DrawnMap, ScansThatMoveByLessThanACellAreNotRedrawn) {
  DrawnMap map{MapperConfig{}, empty_map()};
  const std::vector<Se2> poses = straight_path(10);
  for (const Se2& pose : poses)
    map.add(scan_of_a_circle(2.0), pose);
  const GridMap before = map.map();
  map.note_poses_changed();
  for (int i = 0; i < 10; ++i)
    map.redraw_some([&](std::size_t scan) { return Se2{0.01, 0.0, 0.0} * poses[scan]; });
  expect_equal_maps(map.map(), before);
}

/// Where a robot comes by again and again, the map holds what the archive holds.
TEST(DrawnMap, ScansThatTheArchiveHasEmptiedAreNotInTheMap) {
  DrawnMap map{MapperConfig{}, empty_map()};
  const Se2 here{0.05, 0.05, 0.1};
  for (std::size_t i = 0; i < 2 * ScanArchive::kScansPerPlace; ++i)
    map.add(scan_of_a_circle(2.0), here);
  expect_equal_maps(map.map(), map.drawn_along([&](std::size_t) { return here; }));
  const CellIndex wall = map.map().frame.cell_of(here * Eigen::Vector2d{2.0, 0.0});
  EXPECT_EQ(map.map().occupancy[wall].hits, ScanArchive::kScansPerPlace);
}

}  // namespace
}  // namespace waymark
