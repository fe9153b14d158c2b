// SPDX-License-Identifier: BSD-3-Clause
#include "export/pose_pairing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::exporting {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// The base drives along x at 1 m/s by odometry; in the map it is 5 m ahead of that.
viewer::TimedPose odometry_at(double time_s) {
  return {Timestamp{duration_from_seconds(time_s)}, {time_s, 0.0, 0.0}};
}

viewer::TimedPose estimate_at(double time_s) {
  return {Timestamp{duration_from_seconds(time_s)}, {time_s + 5.0, 0.0, 0.0}};
}

void expect_map_5_m_ahead(const std::vector<PosePair>& pairs) {
  for (const PosePair& pair : pairs)
    EXPECT_NEAR(pair.map_from_base.x() - pair.frame_from_base.x(), 5.0, 1e-9)
        << to_seconds(pair.time);
}

/// 50 Hz of odometry and 10 Hz of estimates between its stamps, each in the order of time.
void drive(PosePairing& pairing, double from_s, double to_s) {
  const int first = static_cast<int>(std::lround(50 * from_s));
  const int last = static_cast<int>(std::lround(50 * to_s));
  for (int i = first; i < last; ++i) {
    pairing.add_pose(odometry_at(0.02 * i));
    if (i % 5 == 0) pairing.add_estimate(estimate_at(0.02 * i + 0.007));
  }
}

TEST(PosePairing, AnEstimateWaitsForTheNextPoseOfTheOtherChannel) {
  PosePairing pairing;
  drive(pairing, 0.0, 2.0);
  pairing.finish();
  const auto pairs = pairing.take_pairs();
  EXPECT_THAT(pairs, SizeIs(20));
  expect_map_5_m_ahead(pairs);
  EXPECT_THAT(pairing.take_poses(), SizeIs(100));
  EXPECT_EQ(pairing.num_unpaired(), 0);
}

TEST(PosePairing, AnEstimateMayComeLate) {
  PosePairing pairing;
  drive(pairing, 0.0, 1.0);
  pairing.take_pairs();
  pairing.add_estimate(estimate_at(0.505));
  const auto pairs = pairing.take_pairs();
  EXPECT_THAT(pairs, SizeIs(1));
  expect_map_5_m_ahead(pairs);
}

TEST(PosePairing, EstimatesOutsideThePosesAndInGapsAreCounted) {
  PosePairing pairing;
  pairing.add_estimate(estimate_at(0.5));  // before the first pose
  drive(pairing, 1.0, 2.0);
  pairing.add_estimate(estimate_at(3.0));  // in a gap
  pairing.add_pose(odometry_at(4.0));
  pairing.add_estimate(estimate_at(5.0));  // after the last pose
  pairing.finish();
  EXPECT_THAT(pairing.take_pairs(), SizeIs(10));
  EXPECT_EQ(pairing.num_unpaired(), 3);
}

TEST(PosePairing, AForgottenEstimateIsNotPaired) {
  PosePairing pairing;
  pairing.add_pose(odometry_at(0.0));
  pairing.add_estimate(estimate_at(0.01));
  pairing.forget_estimates();
  pairing.add_pose(odometry_at(0.02));
  pairing.finish();
  EXPECT_THAT(pairing.take_pairs(), IsEmpty());
}

TEST(PosePairing, ASingleWrongStampLosesOnlyItsOwnPose) {
  for (const double wrong_s : {3600.0, 30.0, 0.5, -0.5, -3600.0}) {
    SCOPED_TRACE(wrong_s);
    PosePairing pairing;
    drive(pairing, 0.0, 2.0);
    viewer::TimedPose wrong = odometry_at(2.0);
    wrong.time += duration_from_seconds(wrong_s);
    pairing.add_pose(wrong);
    drive(pairing, 2.02, 4.0);
    pairing.finish();
    const auto pairs = pairing.take_pairs();
    EXPECT_THAT(pairs, SizeIs(39));  // the drive lacks the estimate at 2 s
    expect_map_5_m_ahead(pairs);
    EXPECT_THAT(pairing.take_poses(), SizeIs(199));
    EXPECT_EQ(pairing.num_dropped_poses(), 1);
    EXPECT_EQ(pairing.num_unpaired(), 0);
  }
}

TEST(PosePairing, PairingContinuesAfterTheClockWasSet) {
  for (const double later_s : {3600.0, -3600.0}) {
    SCOPED_TRACE(later_s);
    PosePairing pairing;
    drive(pairing, 7200.0, 7202.0);
    drive(pairing, 7202.0 + later_s, 7204.0 + later_s);
    pairing.finish();
    const auto pairs = pairing.take_pairs();
    expect_map_5_m_ahead(pairs);
    EXPECT_GE(pairs.size(), 35U);  // of 40: it takes 20 poses to see that the clock was set back
    EXPECT_LE(pairing.num_dropped_poses(), 20);
  }
}

}  // namespace
}  // namespace waymark::exporting
