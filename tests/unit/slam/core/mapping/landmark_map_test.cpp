// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/landmark_map.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

MarkerSighting sighting(int id, double x_m, double sigma_m = 0.01) {
  MarkerSighting sighting;
  sighting.id = id;
  sighting.size_m = 0.4;
  sighting.base_from_marker = {x_m, 1.0, -1.5};
  sighting.covariance_in_base =
      Eigen::Vector3d{sigma_m * sigma_m, sigma_m * sigma_m, 1e-4}.asDiagonal();
  return sighting;
}

TEST(LandmarkMap, EqualIdsThatLieApartAreInstances) {
  LandmarkMap map{1.0};
  map.add(sighting(5, 2.0), Se2{}, Eigen::Matrix3d::Zero());
  map.add(sighting(5, 2.1), Se2{}, Eigen::Matrix3d::Zero());
  map.add(sighting(5, 2.0), Se2{8.0, 0.0, 0.0}, Eigen::Matrix3d::Zero());
  map.add(sighting(0, 2.0), Se2{}, Eigen::Matrix3d::Zero());

  const auto landmarks = map.landmarks();

  ASSERT_EQ(landmarks.size(), 3U);
  EXPECT_EQ(landmarks[0].id, 0);
  EXPECT_EQ(landmarks[1].id, 5);
  EXPECT_EQ(landmarks[1].instance, 0);
  EXPECT_EQ(landmarks[1].sightings, 2);
  EXPECT_NEAR(landmarks[1].map_from_marker.x(), 2.05, 1e-9);
  EXPECT_EQ(landmarks[2].instance, 1);
  EXPECT_NEAR(landmarks[2].map_from_marker.x(), 10.0, 1e-9);
}

TEST(LandmarkMap, PreciseSightingsHaveMoreWeight) {
  LandmarkMap map{1.0};
  map.add(sighting(1, 2.0, 0.1), Se2{}, Eigen::Matrix3d::Zero());
  map.add(sighting(1, 2.2, 0.01), Se2{}, Eigen::Matrix3d::Zero());
  EXPECT_NEAR(map.landmarks()[0].map_from_marker.x(), 2.2, 0.005);
}

TEST(LandmarkMap, TheErrorOfTheRobotsPoseDoesNotAverageOut) {
  LandmarkMap map{1.0};
  const Eigen::Matrix3d pose_covariance = Eigen::Vector3d{0.04, 0.01, 0.0}.asDiagonal();
  for (int i = 0; i < 100; ++i)
    map.add(sighting(1, 2.0), Se2{}, pose_covariance);
  EXPECT_NEAR(map.landmarks()[0].covariance(0, 0), 0.04, 0.001);
  EXPECT_NEAR(map.landmarks()[0].covariance(1, 1), 0.01, 0.001);
}

TEST(LandmarkMap, HeadingVarianceCountsWithTheSquaredDistanceOfTheMarker) {
  LandmarkMap map{1.0};
  const Eigen::Matrix3d pose_covariance = Eigen::Vector3d{0.0, 0.0, 0.01}.asDiagonal();
  map.add(sighting(1, 3.0, 0.0), Se2{}, pose_covariance);
  EXPECT_NEAR(map.landmarks()[0].covariance(1, 1), 9.0 * 0.01, 1e-4);
}

TEST(LandmarkMap, AFloodOfIdsIsBounded) {
  LandmarkMap map{1.0};
  for (int id = 0; id < 10000; ++id)
    map.add(sighting(id, 2.0), Se2{}, Eigen::Matrix3d::Zero());
  EXPECT_LE(map.landmarks().size(), 4096U);
}

}  // namespace
}  // namespace waymark
