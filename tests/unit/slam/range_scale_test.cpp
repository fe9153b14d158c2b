// SPDX-License-Identifier: BSD-3-Clause
// A LiDAR that measures too far or too short.
#include "slam/core/matching/range_scale.hpp"

#include "property/slam/estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "support/room_with_column.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace waymark {
namespace {

using test::scan_of_room;

const Se2 kPose{-0.5, 0.2, 0.4};
const Eigen::Matrix3d kUncertainty = 4e-4 * Eigen::Matrix3d::Identity();

SurfaceMap room() {
  SurfaceMap map{GridFrame::centred_on_map_origin(0.05)};
  for (const Se2& pose : {Se2{-1.5, -0.6, 0.3}, Se2{-0.8, 0.0, 0.4}, kPose}) {
    for (const AnnotatedBeam& annotated : scan_of_room(pose))
      map.add(pose * annotated.beam.end_in_base);
  }
  return map;
}

std::vector<AnnotatedBeam> longer_by(double share, std::vector<AnnotatedBeam> beams) {
  for (AnnotatedBeam& annotated : beams) {
    Beam& beam = annotated.beam;
    beam.range_m *= 1.0 + share;
    beam.end_in_base = beam.start_in_base + (1.0 + share) * (beam.end_in_base - beam.start_in_base);
  }
  return beams;
}

std::optional<RangeScale> scale_of(const std::vector<AnnotatedBeam>& beams, const SurfaceMap& map,
                                   const Se2& expected) {
  SurfaceFinder walls{map, beams.size()};
  return range_scale(beams, walls, expected, kUncertainty, {});
}

TEST(RangeScale, IsToldTogetherWithThePose) {
  const SurfaceMap map = room();
  const Se2 expected = kPose * Se2{0.01, -0.02, 0.01};
  for (const double share : {-0.06, -0.03, 0.03, 0.06}) {
    const auto scale = scale_of(longer_by(share, scan_of_room(kPose)), map, expected);
    ASSERT_TRUE(scale) << share;
    EXPECT_NEAR(scale->share, share, 0.005);
    EXPECT_TRUE(scale->is_wrong()) << share;
    EXPECT_FALSE(scale->is_right()) << share;
  }
  const auto scale = scale_of(scan_of_room(kPose), map, expected);
  ASSERT_TRUE(scale);
  EXPECT_TRUE(scale->is_right());
  EXPECT_FALSE(scale->is_wrong());
}

TEST(RangeScale, IsNotWrongWhereThePlaceHasChanged) {
  auto beams = scan_of_room(kPose);
  for (std::size_t i = 0; i < beams.size(); i += 3)  // people all around
    beams[i].beam.end_in_base *= 0.9;
  const auto scale = scale_of(beams, room(), kPose);
  ASSERT_TRUE(scale);
  EXPECT_FALSE(scale->is_wrong());
}

TEST(RangeScale, IsNotToldByAnUnknownPlace) {
  const SurfaceMap empty{GridFrame::centred_on_map_origin(0.05)};
  EXPECT_FALSE(scale_of(scan_of_room(kPose), empty, kPose));
}

TEST(RangeScale, IsNotToldByASilentLidar) {
  EXPECT_FALSE(scale_of({}, room(), kPose));
}

// For two metres, so that more and more of what is seen ahead is not mapped yet.
TEST(Waymark, LeavesScansOutWhoseRangesAreWrong) {
  for (const double share : {-0.05, 0.05}) {
    test::SyntheticCorridor corridor = test::short_corridor(1);
    test::SensorLog log = test::drive(corridor);
    int wrong = 0;
    for (LidarScan& scan : log.scans) {
      const double travel_m = corridor.speed_m_s * to_seconds(scan.time - log.scans.front().time);
      if (travel_m < 5.0 || travel_m > 7.0) continue;
      for (double& range_m : scan.ranges_m)
        range_m *= 1.0 + share;
      ++wrong;
    }
    WaymarkEstimator estimator{test::estimator_setup_of(corridor, 1), {}};
    int left_out = 0;
    test::Step last;
    for (const test::Step& step : test::run(estimator, log, test::setup_of(corridor))) {
      left_out += step.estimate.ranges_wrong;
      last = step;
    }
    EXPECT_EQ(left_out, wrong) << share;
    const Se2 error = last.truth.inverse() * last.estimate.map_from_base;
    EXPECT_LT(error.translation().norm(), 0.05) << share;
    EXPECT_LT(std::abs(error.theta()), 0.005) << share;
  }
}

}  // namespace
}  // namespace waymark
