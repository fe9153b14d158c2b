// SPDX-License-Identifier: BSD-3-Clause
// Ids that were read wrongly, and markers that hang where others do.
#include "slam/core/landmark/misreading.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace waymark {
namespace {

const Se2 kMapFromBase{10.0, 0.2, 0.1};
const Se2 kMapFromMarker{12.0, 1.0, -0.5 * std::numbers::pi};

Landmark known_marker() {
  Landmark known;
  known.id = 8;
  known.map_from_marker = kMapFromMarker;
  known.sightings = 20;
  return known;
}

MarkerMeasurement sighting_of(int id, const Se2& map_from_marker) {
  MarkerMeasurement measurement;
  measurement.id = id;
  measurement.size_m = 0.4;
  measurement.base_from_marker = kMapFromBase.inverse() * map_from_marker;
  return measurement;
}

bool is_misread(const MarkerMeasurement& measurement, const Landmark& known) {
  return is_misread(measurement, kMapFromBase, std::span{&known, 1});
}

TEST(Misreading, IsAnotherIdInThePlaceOfAKnownMarker) {
  EXPECT_TRUE(is_misread(sighting_of(23, kMapFromMarker), known_marker()));
  EXPECT_FALSE(is_misread(sighting_of(8, kMapFromMarker), known_marker()));
}

TEST(Misreading, IsNoneBesideAKnownMarkerNorBehindItsWall) {
  const Se2 beside{12.3, 1.0, kMapFromMarker.theta()};
  EXPECT_FALSE(is_misread(sighting_of(23, beside), known_marker()));
  const Se2 behind{12.0, 1.05, 0.5 * std::numbers::pi};
  EXPECT_FALSE(is_misread(sighting_of(23, behind), known_marker()));
}

TEST(Misreading, IsNoneOnABoardOfSmallMarkers) {
  const Se2 beside{12.05, 1.0, kMapFromMarker.theta()};
  MarkerMeasurement small = sighting_of(23, beside);
  EXPECT_TRUE(is_misread(small, known_marker()));
  small.size_m = 0.04;
  EXPECT_FALSE(is_misread(small, known_marker()));
}

TEST(Misreading, IsNoneWhereTheKnownMarkerMayBeAMistakeOrIsGone) {
  Landmark seen_once = known_marker();
  seen_once.sightings = 1;
  EXPECT_FALSE(is_misread(sighting_of(23, kMapFromMarker), seen_once));
  Landmark taken_down = known_marker();
  taken_down.misses = 5;
  EXPECT_FALSE(is_misread(sighting_of(23, kMapFromMarker), taken_down));
}

}  // namespace
}  // namespace waymark
