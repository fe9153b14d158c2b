// SPDX-License-Identifier: BSD-3-Clause
// Scans with ranges of a wrong scale, in a room of 6 m x 4 m and in one that is larger by 5 %.
#include "slam/core/estimators/scan_registration.hpp"

#include "common/random/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

constexpr double kLarger = 1.05;
constexpr double kSigma_m = 0.01;
const Se2 kInRoom{0.2, 0.1, 0.0};
const Se2 kInLargerRoom{30.0, 0.0, 0.0};  // at the same place in it

/// Walls of a room of `scale` times 6 m x 4 m, from a pose near its centre.
Points room(double scale, std::uint64_t seed) {
  Random random{seed};
  Points points;
  const auto add = [&](double x, double y) {
    const Eigen::Vector2d noise{random.normal(0.0, kSigma_m), random.normal(0.0, kSigma_m)};
    points.emplace_back(scale * (kInRoom.inverse() * Eigen::Vector2d{x, y}) + noise);
  };
  for (double x = -3.0; x <= 3.0; x += 0.04)
    for (const double y : {-2.0, 2.0})
      add(x, y);
  for (double y = -1.96; y < 2.0; y += 0.04)
    for (const double x : {-3.0, 3.0})
      add(x, y);
  return points;
}

Observation scan_of(const Points& ends_in_base) {
  Observation observation;
  for (const Eigen::Vector2d& end : ends_in_base) {
    AnnotatedBeam annotated;
    annotated.beam.end_in_base = end;
    annotated.beam.range_m = end.norm();
    observation.beams.push_back(annotated);
  }
  return observation;
}

class RegistrationInRooms : public ::testing::Test {
 protected:
  RegistrationInRooms() {
    for (std::uint64_t i = 0; i < 12; ++i) {
      submap_.insert(room(1.0, i), kInRoom);
      submap_.add(room(kLarger, i), kInLargerRoom);
    }
    for (std::uint64_t i = 0; i < 100; ++i) {
      const Observation usual = scan_of(room(1.0, 100 + i));
      ScanAtPrediction scan = matched(usual, kInRoom);
      EXPECT_FALSE(registration_.with_right_scale(usual, maps_, scan));
      registration_.note_fit(scan.matched->match);
      registration_.note_keyframe(scan.matched->match);
    }
  }

  ScanAtPrediction matched(const Observation& observation, const Se2& predicted) const {
    ScanAtPrediction scan{points_of(observation)};
    scan.expected = {predicted, Eigen::Vector3d{0.02, 0.02, 0.01}.cwiseAbs2().asDiagonal()};
    scan.searched = scan.expected;
    scan.map_from_last = predicted;
    registration_.match(observation, maps_, scan);
    return scan;
  }

  SensorStatistics statistics() const {
    SensorStatistics statistics;
    registration_.report(statistics);
    return statistics;
  }

  GridMap grid_{GridFrame::centred_on_map_origin(0.05), {}, {}};
  Submap submap_{0.25, 0};
  MapsForScan maps_{grid_, &submap_};
  ScanRegistration registration_{WaymarkConfig{}, kSigma_m};
};

TEST_F(RegistrationInRooms, AScaleThatHasChangedSinceTheLastScanIsCorrected) {
  const Observation measured = scan_of(room(kLarger, 99));
  ScanAtPrediction scan = matched(measured, kInRoom);
  const auto corrected = registration_.with_right_scale(measured, maps_, scan);
  ASSERT_TRUE(corrected);
  EXPECT_TRUE(registration_.is_rescaled());
  EXPECT_NEAR(corrected->beams[0].beam.range_m, measured.beams[0].beam.range_m / kLarger, 0.02);
  EXPECT_LT(pose_difference(scan.matched->map_from_base(), kInRoom).norm(), 0.02);
  EXPECT_EQ(statistics().scans_rescaled, 1);
  EXPECT_NEAR(statistics().range_scale_error, kLarger - 1.0, 0.005);
}

/// The prediction is wrong: the robot is still in the other room.
TEST_F(RegistrationInRooms, AScaleThatTheLastScanContradictsIsNotBelieved) {
  const Observation measured = scan_of(room(1.0, 99));
  ScanAtPrediction scan = matched(measured, kInLargerRoom);
  EXPECT_TRUE(registration_.usual_fit().is_contradicted(scan.matched->match));
  EXPECT_FALSE(registration_.with_right_scale(measured, maps_, scan));
  EXPECT_FALSE(registration_.is_rescaled());
  EXPECT_EQ(statistics().scans_rescaled, 0);
}

TEST_F(RegistrationInRooms, ARefutedMatchIsCountedAndTeachesNothing) {
  const SensorStatistics before = statistics();
  ScanMatch match;
  match.num_mapped = 100;
  match.inlier_share = 0.1;
  match.num_scattered = 100;
  match.range_scatter_m = 1.0;
  registration_.note_fit(match);
  EXPECT_EQ(statistics().scans, before.scans + 1);
  EXPECT_EQ(statistics().scans_refuted, before.scans_refuted + 1);
  EXPECT_EQ(statistics().range_sigma_m, before.range_sigma_m);
}

}  // namespace
}  // namespace waymark
