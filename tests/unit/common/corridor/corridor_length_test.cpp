// SPDX-License-Identifier: BSD-3-Clause
#include "common/corridor/corridor_length.hpp"

#include "common/geometry/angle.hpp"
#include "support/drawn_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::corridor {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kExact = 1e-9;

TEST(CorridorLength, AStraightMapIsMeasuredInWholePixels) {
  for (const int length_px : {200, 992, 1000, 1001, 4000}) {
    const CorridorLength measured =
        measure_corridor(draw({length_px + 20, 61, length_px + 0.0}, straight_shape(7, 30, 0)));
    EXPECT_NEAR(measured.length_px, length_px, kExact);
    EXPECT_NEAR(measured.length_m, length_px * 0.05, kExact);
    EXPECT_EQ(measured.method, LengthMethod::kStraight);
    EXPECT_THAT(measured.flags, IsEmpty());
    EXPECT_NEAR(measured.width_px, 39.0, 1.0);
  }
}

TEST(CorridorLength, AVerticalCorridorHasTheSameLength) {
  const Drawing drawing{61, 1020, 1000};
  EXPECT_NEAR(measure_corridor(draw(drawing, straight_shape(30, 5, M_PI / 2))).length_px, 1000.0,
              kExact);
}

TEST(CorridorLength, TurningTheMapChangesNothing) {
  for (const double turn_deg : {0.05, 1.0, 3.5, 10.0, 27.0, 45.0, 80.0, -3.5}) {
    const double turn = radians(turn_deg);
    const double x0 = turn_deg < 0 ? 60 : 60 + 60 * std::sin(turn);
    const double y0 = turn_deg < 0 ? 60 - 1000 * std::sin(turn) : 60;
    const CorridorLength measured =
        measure_corridor(draw({1200, 1200, 1000}, straight_shape(x0, y0, turn)));
    EXPECT_NEAR(measured.length_px, 1000.0, 1.0) << turn_deg;
    EXPECT_EQ(measured.method, LengthMethod::kStraight) << turn_deg;
    EXPECT_THAT(measured.flags, IsEmpty()) << turn_deg;
  }
}

TEST(CorridorLength, TwoHundredMetresRotated) {
  const auto map = draw({3000, 3000, 4000}, straight_shape(60, 60, radians(45)));
  EXPECT_NEAR(measure_corridor(map).length_px, 4000.0, 1.0);
}

TEST(CorridorLength, ABentMapIsMeasuredAlongItsArc) {
  for (const double turn_deg : {5.0, 15.0, 40.0, 80.0}) {
    const double radius_px = 1000.0 / radians(turn_deg);
    const auto map = draw({1200, 900, 1000}, arc_shape(60, 400, -radians(turn_deg / 2), radius_px));
    const CorridorLength measured = measure_corridor(map);
    EXPECT_NEAR(measured.length_px, 1000.0, 1.0) << turn_deg;
    EXPECT_EQ(measured.method, LengthMethod::kMedial) << turn_deg;
    EXPECT_THAT(measured.flags, ElementsAre("curved")) << turn_deg;
  }
}

TEST(CorridorLength, ANegligibleBendIsMeasuredAsStraight) {
  const auto map = draw({1200, 900, 1000}, arc_shape(60, 400, -radians(1), 1000.0 / radians(2)));
  const CorridorLength measured = measure_corridor(map);
  EXPECT_NEAR(measured.length_px, 1000.0, 1.0);
  EXPECT_EQ(measured.method, LengthMethod::kStraight);
}

TEST(CorridorLength, AnSBendIsMeasuredAlongItsArcs) {
  for (const double turn_deg : {5.0, 15.0, 40.0}) {
    const double radius_px = 500.0 / radians(turn_deg);
    const auto map = draw({1200, 900, 1000}, s_shape(60, 300, 0, radius_px, 500));
    const CorridorLength measured = measure_corridor(map);
    EXPECT_NEAR(measured.length_px, 1000.0, 1.0) << turn_deg;
    EXPECT_THAT(measured.flags, ElementsAre("curved")) << turn_deg;
  }
}

TEST(CorridorLength, AnyCorridorIsMeasuredToAPixelAndWithoutBias) {
  Random random{5};
  constexpr int kCorridors = 30;
  double sum_px = 0.0;
  for (int i = 0; i < kCorridors; ++i) {
    Drawing drawing{720, 720, random.uniform(180, 600), random.uniform(10, 25)};
    drawing.holes = random.uniform(0, 0.3);
    drawing.specks = random.uniform(0, 0.02);
    const double turn = random.uniform(0, M_PI / 2);
    const double bend = i % 2 == 0 ? 0.0 : random.uniform(0.05, 0.6);
    const double x0 = 50 + 40 * random.uniform();
    const double y0 = 50 + 40 * random.uniform();
    const Shape shape = bend == 0.0 ? straight_shape(x0, y0, turn)
                                    : arc_shape(x0, y0, turn * 0.5, drawing.length_px / bend);
    const double error_px = measure_corridor(draw(drawing, shape)).length_px - drawing.length_px;
    EXPECT_LE(std::abs(error_px), 1.0) << i;
    sum_px += error_px;
  }
  EXPECT_LE(std::abs(sum_px / kCorridors), 0.3);
}

TEST(CorridorLength, FalseCellsAndHolesDoNotMatter) {
  for (const double share : {0.01, 0.03, 0.05}) {
    Drawing drawing{1020, 61, 1000};
    drawing.specks = share;
    drawing.holes = 6 * share;
    const CorridorLength straight = measure_corridor(draw(drawing, straight_shape(7, 30, 0)));
    EXPECT_NEAR(straight.length_px, 1000.0, kExact) << share;
    EXPECT_THAT(straight.flags, IsEmpty()) << share;

    drawing.width_px = drawing.height_px = 1100;
    const CorridorLength turned =
        measure_corridor(draw(drawing, straight_shape(60, 60, radians(33))));
    EXPECT_NEAR(turned.length_px, 1000.0, 1.0) << share;
    const CorridorLength bent =
        measure_corridor(draw(drawing, arc_shape(60, 400, -radians(10), 1000.0 / radians(20))));
    EXPECT_NEAR(bent.length_px, 1000.0, 1.0) << share;
  }
}

TEST(CorridorLength, ThickWallsAreMeasuredAtTheirInnermostCells) {
  for (const double thickness_px : {2.0, 3.0}) {
    Drawing drawing{1020, 80, 1000};
    drawing.thickness_px = thickness_px;
    EXPECT_NEAR(measure_corridor(draw(drawing, straight_shape(9, 30, 0))).length_px, 1000.0,
                kExact);
  }
}

TEST(CorridorLength, AMissingEndWallGivesTheExtentOfFreeSpace) {
  Drawing drawing{1020, 61, 1000};
  drawing.has_end = false;
  const CorridorLength no_end = measure_corridor(draw(drawing, straight_shape(7, 30, 0)));
  EXPECT_NEAR(no_end.length_px, 999.5, kExact);  // last free cell's centre at 999
  EXPECT_THAT(no_end.flags, ElementsAre("end_wall_missing"));

  drawing.has_start = false;
  const CorridorLength neither = measure_corridor(draw(drawing, straight_shape(7, 30, 0)));
  EXPECT_NEAR(neither.length_px, 999.0, kExact);  // 999 free cells
  EXPECT_THAT(neither.flags, ElementsAre("start_wall_missing", "end_wall_missing"));

  drawing.has_end = true;
  const auto turned =
      draw({1200, 1200, 1000, 20.0, 1.0, false, true}, straight_shape(60, 60, radians(30)));
  const CorridorLength no_start = measure_corridor(turned);
  EXPECT_NEAR(no_start.length_px, 999.5, 1.0);
  EXPECT_THAT(no_start.flags, ElementsAre("start_wall_missing"));
}

TEST(CorridorLength, ADoorwayInASideWallDoesNotMatter) {
  MapImage map = draw({1020, 121, 1000}, straight_shape(7, 60, 0));
  for (int y = 75; y < 115; ++y) {
    for (int x = 600; x < 640; ++x)
      map.cells[static_cast<std::size_t>(y) * 1020 + x] = Cell::kFree;
  }
  const CorridorLength measured = measure_corridor(map);
  EXPECT_NEAR(measured.length_px, 1000.0, 1e-3);
  EXPECT_THAT(measured.flags, IsEmpty());
}

TEST(CorridorLength, AShortMapSaysThatItsAxisIsDoubtful) {
  const CorridorLength measured = measure_corridor(draw({100, 61, 70}, straight_shape(7, 30, 0)));
  EXPECT_THAT(measured.flags, Contains("not_elongated"));
}

TEST(CorridorLength, AnEmptyMapIsAnError) {
  MapImage map{100, 100, 0.05, std::vector<Cell>(10000, Cell::kUnknown)};
  EXPECT_THROW(measure_corridor(map), NotACorridor);
  map.cells[5] = Cell::kFree;
  EXPECT_THROW(measure_corridor(map), NotACorridor);
  map.cells.assign(10000, Cell::kOccupied);
  EXPECT_THROW(measure_corridor(map), NotACorridor);
}

TEST(CorridorLength, AccuracyFollowsThePapersFormula) {
  EXPECT_NEAR(accuracy_percent(49.6, 50.0), 99.2, kExact);
  EXPECT_NEAR(accuracy_percent(50.4, 50.0), 99.2, kExact);
  EXPECT_NEAR(accuracy_percent(20.7, 50.0), 41.4, kExact);
}

}  // namespace
}  // namespace waymark::corridor
