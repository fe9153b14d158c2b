// SPDX-License-Identifier: BSD-3-Clause
// The corrections by robot.lidar.mirrored and both late_s, which waymark-doctor measures.
#include "common/robot/described_sensors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;

TEST(DescribedSensors, AMirroredLidarsAnglesAreNegated) {
  const LidarScan scan{.time = Timestamp{milliseconds{1000}},
                       .ranges_m = {1.0, 2.0, 3.0},
                       .angles_rad = {-0.5, 0.0, 0.7},
                       .beam_time_offsets = {milliseconds{0}, milliseconds{1}, milliseconds{2}}};
  LidarConfig lidar;
  EXPECT_EQ(as_described(scan, lidar).angles_rad, scan.angles_rad);
  lidar.mirrored = true;
  const LidarScan described = as_described(scan, lidar);
  EXPECT_THAT(described.angles_rad, ElementsAre(0.5, 0.0, -0.7));
  EXPECT_EQ(described.ranges_m, scan.ranges_m);
  EXPECT_EQ(described.beam_time_offsets, scan.beam_time_offsets);
  EXPECT_EQ(described.time, scan.time);
}

TEST(DescribedSensors, ConfiguredDelaysAreSubtractedFromStamps) {
  LidarConfig lidar;
  lidar.late_s = 0.03;
  CameraConfig camera;
  camera.late_s = -0.02;  // stamped too early
  const Timestamp stamp{milliseconds{1000}};
  EXPECT_EQ(as_described(LidarScan{.time = stamp}, lidar).time, Timestamp{milliseconds{970}});
  EXPECT_EQ(as_described(MarkerDetections{.time = stamp}, camera).time,
            Timestamp{milliseconds{1020}});
}

}  // namespace
}  // namespace waymark
