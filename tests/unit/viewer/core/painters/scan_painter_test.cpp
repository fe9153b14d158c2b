// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/painters/scan_painter.hpp"

#include "unit/viewer/found_on_picture.hpp"
#include "viewer/core/drawing/palette.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace waymark::viewer {
namespace {

constexpr int kSize_px = 700;
constexpr double kLeft_rad = 0.5 * std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct BeamOfScan {
  double angle_rad{0.0};
  double range_m{0.0};
  int marker_id{kNoMarker};
};

cv::Mat painted(const std::vector<BeamOfScan>& beams) {
  AnnotatedScan scan{.time = Timestamp{Duration{31'400'000}}};
  for (const BeamOfScan& beam : beams) {
    scan.angles_rad.push_back(beam.angle_rad);
    scan.ranges_m.push_back(beam.range_m);
    scan.marker_ids.push_back(beam.marker_id);
  }
  return paint_scan(scan, kSize_px);
}

/// Where the only beam of that range ends on the picture.
cv::Point2d end_of_beam(double angle_rad, double range_m) {
  const auto ends = spots_of_colour(painted({{angle_rad, range_m}}), palette::kOccupied);
  EXPECT_EQ(ends.size(), 1U);
  return ends.empty() ? cv::Point2d{} : ends.front();
}

TEST(PaintScan, BeamsAreDrawnToScaleWithAheadUpAndLeftOnTheLeft) {
  const cv::Mat picture = painted({{0.0, 4.0}, {kLeft_rad, 2.0}, {-kLeft_rad, 1.0}});

  auto ends = spots_of_colour(picture, palette::kOccupied);  // from the top
  ASSERT_EQ(ends.size(), 3U);
  const cv::Point2d ahead = ends[0];
  const cv::Point2d left = ends[1].x < ends[2].x ? ends[1] : ends[2];
  const cv::Point2d right = ends[1].x < ends[2].x ? ends[2] : ends[1];
  const double px_per_m = (right.x - left.x) / 3.0;
  EXPECT_NEAR(left.y, right.y, 1.0);
  EXPECT_NEAR(ahead.x, left.x + 2.0 * px_per_m, 1.0);
  EXPECT_NEAR(ahead.y, left.y - 4.0 * px_per_m, 1.0);
}

TEST(PaintScan, TheLongestBeamNearlyFillsThePictureWhateverItsRange) {
  const cv::Point2d near_end = end_of_beam(0.0, 1.5);
  EXPECT_GT(near_end.y, 50.0);
  EXPECT_LT(near_end.y, 0.2 * kSize_px);
  for (const double range_m : {4.0, 30.0})
    EXPECT_NEAR(end_of_beam(0.0, range_m).y, near_end.y, 1.0) << range_m;
  EXPECT_GT(end_of_beam(0.0, 0.5).y, near_end.y + 100.0) << "less than 1 m is drawn small";
}

TEST(PaintScan, RingsAreAtWholeMetresAndInALargeRoomAtEveryFifth) {
  const auto num_rings = [](double reach_m) {
    // The beam leads to the left; the rings are counted straight ahead of the robot.
    const cv::Mat picture = painted({{kLeft_rad, reach_m}});
    const cv::Mat ahead = picture.rowRange(60, kSize_px / 2).col(kSize_px / 2);
    return spots_of_colour(ahead, palette::kHairline).size();
  };
  EXPECT_EQ(num_rings(4.2), 4U);
  EXPECT_EQ(num_rings(12.0), 12U);
  EXPECT_EQ(num_rings(12.1), 2U);
  EXPECT_EQ(num_rings(21.0), 4U);
}

TEST(PaintScan, TheCaptionCountsTheBeamsWithAReturnAndThoseOnMarkers) {
  const cv::Mat picture = painted(
      {{0.0, 4.0}, {0.1, 3.0, 7}, {0.2, 3.0, 0}, {0.3, kInfinity, 7}, {0.4, std::nan(""), 7}});
  const Font font{.height_px = 18.0, .colour = palette::kInk};
  EXPECT_TRUE(shows_text(picture, "scan at 31.4 s: 3 beams, 2 on markers", font));
}

TEST(PaintScan, AMarkersNumberStandsOnceBeyondTheEndsOfItsBeams) {
  const cv::Point2d end = end_of_beam(kLeft_rad, 4.0);
  const cv::Mat picture =
      painted({{kLeft_rad - 0.02, 4.0, 7}, {kLeft_rad, 4.0, 7}, {kLeft_rad + 0.02, 4.0, 7}});

  const cv::Rect beams_and_number = box_of_colour(picture, colour_of_id(7));
  EXPECT_LT(beams_and_number.x, end.x - 60.0);
  EXPECT_GE(beams_and_number.x, 0);
  EXPECT_LT(beams_and_number.br().x, kSize_px / 2);
  EXPECT_NEAR(beams_and_number.y + 0.5 * beams_and_number.height, end.y, 2.0);
}

TEST(PaintScan, ABeamOnAMarkerIsNotHiddenByOthers) {
  const cv::Mat picture = painted({{0.0, 4.0, 7}, {0.0, 4.0}});
  EXPECT_TRUE(spots_of_colour(picture, palette::kOccupied).empty());
}

}  // namespace
}  // namespace waymark::viewer
