// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/text_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace waymark::viewer {
namespace {

EstimatedPose pose_at_us(std::int64_t time_us) {
  EstimatedPose pose{.time = timestamp_from_us(time_us),
                     .map_from_base = {1.25, -0.5, std::numbers::pi / 2},
                     .health = Health::kDegenerate};
  pose.covariance << 1, 2, 3, 2, 5, 6, 3, 6, 9;
  return pose;
}

TEST(TumText, HasOneLinePerPoseWithExactMicroseconds) {
  const std::vector<EstimatedPose> path{pose_at_us(5), pose_at_us(1'700'000'000'000'001)};
  EXPECT_EQ(tum_text(path),
            "0.000005 1.250000000 -0.500000000 0 0 0 0.707106781187 0.707106781187\n"
            "1700000000.000001 1.250000000 -0.500000000 0 0 0 0.707106781187 0.707106781187\n");
}

TEST(TumText, TimedPosesHaveTheSameFormat) {
  const std::vector<TimedPose> path{{timestamp_from_us(1'500'000), {0, 0, 0}}};
  EXPECT_EQ(tum_text(path),
            "1.500000 0.000000000 0.000000000 0 0 0 0.000000000000 1.000000000000\n");
}

TEST(TumText, TimesBeforeZeroHaveOneSign) {
  const std::vector<TimedPose> path{{timestamp_from_us(-1'500'000), {}}};
  EXPECT_TRUE(tum_text(path).starts_with("-1.500000 "));
}

TEST(CovarianceCsv, ListsTheUpperTriangleAndHealth) {
  EXPECT_EQ(covariance_csv_text(std::vector{pose_at_us(2'000'000)}),
            "t,cxx,cxy,cxt,cyy,cyt,ctt,health\n"
            "2.000000,1.000000000e+00,2.000000000e+00,3.000000000e+00,5.000000000e+00,"
            "6.000000000e+00,9.000000000e+00,3\n");
}

TEST(MarkersCsv, IsSortedByIdAndInstance) {
  Landmark first{.id = 0,
                 .instance = 0,
                 .map_from_marker = {3, 1, -0.5},
                 .sightings = 7,
                 .state = LandmarkState::kMoved};
  first.covariance.diagonal() << 0.0004, 0.0001, 0.01;
  const Landmark second{.id = 4, .instance = 0};
  const Landmark third{.id = 4, .instance = 1};
  EXPECT_EQ(markers_csv_text({third, first, second}),
            "id,instance,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,sightings,state\n"
            "0,0,3.000000,1.000000,-0.500000,0.020000,0.010000,0.100000,7,3\n"
            "4,0,0.000000,0.000000,0.000000,0.000000,0.000000,0.000000,0,0\n"
            "4,1,0.000000,0.000000,0.000000,0.000000,0.000000,0.000000,0,0\n");
}

TEST(MarkersCsv, HasAHeadingWithoutMarkers) {
  EXPECT_EQ(markers_csv_text({}),
            "id,instance,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,sightings,state\n");
}

}  // namespace
}  // namespace waymark::viewer
