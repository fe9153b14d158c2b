// SPDX-License-Identifier: BSD-3-Clause
#include "common/random/random.hpp"
#include "slam/core/scan/annotated_scan.hpp"
#include "slam/core/scan/observability.hpp"
#include "support/synthetic_corridor.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <numeric>

namespace waymark {
namespace {

using test::SyntheticCorridor;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const SyntheticCorridor kCorridor{};
const LidarSetup kLidar{Se2{kCorridor.lidar_x_m, 0.0, 0.0}, 0.12, 3.5};
const CameraView kView{Se2{kCorridor.camera_x_m, 0.0, 0.0}, 0.44, -0.44, 0.3, 3.2};

MarkerSighting sighting_of(int id, double x_m, const Se2& world_from_base) {
  const test::SyntheticMarker marker{id, {x_m, 1.0}, -0.5 * std::numbers::pi};
  return *sight_marker(test::detection_of(marker, world_from_base, kCorridor), {}, Se2{}, 0.4);
}

std::vector<Beam> beams_from(const Se2& world_from_base) {
  return beams_of(test::scan_from(kCorridor, world_from_base, {}), kLidar, OdometryBuffer{});
}

TEST(Beams, KeepOnlyReturnsWithinRange) {
  const LidarScan scan{
      {}, {kInfinity, kNan, 0.05, 1.0, 3.6, 0.0, -1.0}, std::vector<double>(7, 0.0), {}};
  const auto beams = beams_of(scan, {Se2{0.1, 0.0, 0.0}, 0.12, 3.5}, OdometryBuffer{});
  ASSERT_EQ(beams.size(), 1U);
  EXPECT_EQ(beams[0].index, 3);
  EXPECT_NEAR(beams[0].end_in_base.x(), 1.1, 1e-12);
  EXPECT_NEAR(beams[0].start_in_base.x(), 0.1, 1e-12);
}

TEST(Beams, MotionDuringASweepIsCompensated) {
  // The robot turns at 1 rad/s; every beam looks at the same point, 1 m ahead of its first pose.
  OdometryBuffer odometry;
  odometry.add({timestamp_from_us(0), Se2{}});
  odometry.add({timestamp_from_us(200'000), Se2{0.0, 0.0, 0.2}});
  LidarScan scan{timestamp_from_us(0), {}, {}, {}};
  for (int i = 0; i <= 4; ++i) {
    scan.ranges_m.push_back(1.0);
    scan.angles_rad.push_back(-0.05 * i);
    scan.beam_time_offsets.push_back(Duration{50'000 * i});
  }
  for (const Beam& beam : beams_of(scan, {Se2{}, 0.12, 3.5}, odometry))
    EXPECT_TRUE(beam.end_in_base.isApprox(Eigen::Vector2d{1.0, 0.0}, 1e-9)) << beam.index;
}

TEST(Beams, AScanIsStampedAtTheMiddleOfItsSweep) {
  LidarScan scan{timestamp_from_us(900'000), {1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}, {}};
  EXPECT_EQ(at_middle_of_sweep(scan).time, scan.time) << "all beams at once";
  scan.beam_time_offsets = {Duration{-200'000}, Duration{-150'000}, Duration{0}};
  const LidarScan middle = at_middle_of_sweep(scan);
  EXPECT_EQ(middle.time, timestamp_from_us(800'000));
  EXPECT_EQ(middle.ranges_m, scan.ranges_m);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(middle.time + middle.beam_time_offsets[i], scan.time + scan.beam_time_offsets[i]);
}

// While a sweep is measured, the error of odometry is a random walk: the mean over the beams is off
// by as much as the end of a random walk of length mean_sweep().distance_m.
TEST(Beams, TheMeanSweepHasTheNoiseOfItsBeams) {
  constexpr int kSteps = 200;
  constexpr int kWalks = 4000;
  for (const int stamp : {0, kSteps / 2, kSteps}) {
    OdometryBuffer odometry;
    LidarScan scan{timestamp_from_us(1000 * stamp), {}, {}, {}};
    for (int i = 0; i <= kSteps; ++i) {
      odometry.add({timestamp_from_us(1000 * i), Se2{1e-4 * i, 0.0, 2e-4 * i}});
      scan.beam_time_offsets.emplace_back(1000 * (i - stamp));
    }
    const MeanSweep mean = mean_sweep(scan, odometry);
    EXPECT_NEAR(mean.turn_rad, 2.0 * mean.distance_m, 1e-6) << stamp;

    Random random{4, static_cast<std::uint64_t>(stamp)};
    double squares = 0.0;
    for (int walk = 0; walk < kWalks; ++walk) {
      std::vector<double> at{0.0};
      for (int i = 0; i < kSteps; ++i)
        at.push_back(at.back() + 0.01 * random.normal());  // variance 1 per metre
      const double sum = std::accumulate(at.begin(), at.end(), 0.0);
      const double off = sum / static_cast<double>(at.size()) - at[static_cast<std::size_t>(stamp)];
      squares += off * off / kWalks;
    }
    EXPECT_NEAR(squares / mean.distance_m, 1.0, 0.1) << stamp;
  }
}

TEST(Beams, WithoutTimesPerBeamTheMeanSweepIsZero) {
  const MeanSweep none =
      mean_sweep(test::scan_from(kCorridor, {5.0, 0.0, 0.0}, {}), OdometryBuffer{});
  EXPECT_EQ(none.distance_m, 0.0);
  EXPECT_EQ(none.turn_rad, 0.0);
}

TEST(MarkerSighting, IsTheSegmentBetweenTheVerticalEdges) {
  const MarkerSighting sighting = sighting_of(3, 7.5, Se2{5.0, 0.0, 0.0});
  EXPECT_TRUE(sighting.base_from_marker.translation().isApprox(Eigen::Vector2d{2.5, 1.0}, 1e-9));
  // Seen from the middle of the corridor, the right edge of a marker on the left wall is further.
  EXPECT_TRUE(sighting.point_at(0.2).isApprox(Eigen::Vector2d{2.7, 1.0}, 1e-9));
}

TEST(MarkerSighting, IsTransformedToTheTimeOfTheScan) {
  const test::SyntheticMarker marker{1, {7.5, 1.0}, -0.5 * std::numbers::pi};
  const Se2 at_frame{5.0, 0.1, 0.02};
  const Se2 at_scan{5.05, 0.11, -0.01};
  const auto sighting = sight_marker(test::detection_of(marker, at_frame, kCorridor), {},
                                     at_scan.inverse() * at_frame, 0.4);
  EXPECT_TRUE((at_scan * sighting->base_from_marker.translation())
                  .isApprox(Eigen::Vector2d{7.5, 1.0}, 1e-9));
}

TEST(MarkerSighting, MarkersOnTheFloorAndImpossibleOnesAreRefused) {
  MarkerDetection on_floor;
  EXPECT_FALSE(sight_marker(on_floor, {}, Se2{}, 0.4));  // z axis up

  const test::SyntheticMarker marker{1, {7.5, 1.0}, -0.5 * std::numbers::pi};
  MarkerDetection far_away = test::detection_of(marker, Se2{5.0, 0.0, 0.0}, kCorridor);
  far_away.base_from_marker.translation().x() = 1e30;
  EXPECT_FALSE(sight_marker(far_away, {}, Se2{}, 0.4));

  MarkerDetection impossible = test::detection_of(marker, Se2{5.0, 0.0, 0.0}, kCorridor);
  impossible.covariance_in_base(0, 0) = -1.0;
  EXPECT_FALSE(sight_marker(impossible, {}, Se2{}, 0.4));
}

TEST(Annotate, BeamsOnTheMarkerCarryItsIdAlsoWhenItIsZero) {
  const Se2 world_from_base{5.0, 0.0, 0.0};
  const auto beams = beams_from(world_from_base);
  const std::vector sightings{sighting_of(0, 7.5, world_from_base)};

  const auto annotated = annotate(beams, sightings, &kView, 0.08);

  int on_marker = 0;
  for (const AnnotatedBeam& beam : annotated) {
    const Eigen::Vector2d end = world_from_base * beam.beam.end_in_base;
    if (end.y() > 0.99 && std::abs(end.x() - 7.5) < 0.2) {
      EXPECT_EQ(beam.marker_id, 0);
      EXPECT_EQ(beam.label, BeamLabel::kMarker);
      ++on_marker;
    }
    if (std::abs(end.x() - 7.5) > 0.3 || end.y() < 0.0) {
      EXPECT_EQ(beam.marker_id, kNoMarker);
    }
  }
  EXPECT_GE(on_marker, 2);
}

TEST(Annotate, BeamsAreLabelledUnmarkedOnlyInTheCamerasView) {
  const auto beams = beams_from(Se2{5.0, 0.0, 0.0});
  for (const AnnotatedBeam& beam : annotate(beams, {}, &kView, 0.08)) {
    const bool is_ahead = beam.beam.end_in_base.x() > 2.4 && beam.beam.end_in_base.x() < 3.0;
    const bool is_aside = beam.beam.end_in_base.x() < 1.8;
    if (is_ahead || is_aside) {
      EXPECT_EQ(beam.label, is_ahead ? BeamLabel::kUnmarked : BeamLabel::kOutOfView);
    }
  }
  for (const AnnotatedBeam& beam : annotate(beams, {}, nullptr, 0.08))
    EXPECT_EQ(beam.label, BeamLabel::kOutOfView);
}

TEST(Observability, ABareCorridorIsDegenerateAlongItsAxis) {
  const auto beams = annotate(beams_from(Se2{20.0, 0.2, 0.1}), {}, nullptr, 0.08);
  const Observability walls = observability_of(beams, Se2{20.0, 0.2, 0.1}, 0.01);
  EXPECT_TRUE(walls.is_degenerate);
  EXPECT_NEAR(std::abs(walls.weak_direction.x()), 1.0, 1e-3);

  const Se2 moved = walls.without_weak_part(Se2{3.0, 0.5, 0.2}, Se2{1.0, 0.0, 0.0});
  EXPECT_NEAR(moved.x(), 1.0, 2e-3);
  EXPECT_NEAR(moved.y(), 0.5, 2e-3);
  EXPECT_EQ(moved.theta(), 0.2);
}

TEST(Observability, AnEndWallObservesTheAxis) {
  const auto beams = annotate(beams_from(Se2{48.5, 0.0, 0.0}), {}, nullptr, 0.08);
  EXPECT_FALSE(observability_of(beams, Se2{48.5, 0.0, 0.0}, 0.01).is_degenerate);
}

/// Share of the beams that lie on a surface.
double surface_share(std::span<const AnnotatedBeam> beams) {
  int on_surface = 0;
  for (std::size_t i = 0; i < beams.size(); ++i)
    on_surface += surface_normal(beams, static_cast<int>(i)).has_value();
  return on_surface / static_cast<double>(beams.size());
}

TEST(Observability, FewBeamsOfARandomScanLieOnASurface) {
  auto beams = annotate(beams_from(Se2{20.0, 0.2, 0.1}), {}, nullptr, 0.08);
  EXPECT_GT(surface_share(beams), 0.5);
  Random random{3};
  for (AnnotatedBeam& annotated : beams) {
    Beam& beam = annotated.beam;
    beam.end_in_base = beam.start_in_base + random.uniform(0.1, 3.5) / beam.range_m *
                                                (beam.end_in_base - beam.start_in_base);
  }
  EXPECT_LT(surface_share(beams), 0.1);
}

}  // namespace
}  // namespace waymark
