// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/edge_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

const CameraModel kCamera{CameraConfig{}};  // no distortion: ideal pixels are raw pixels

/// 12 x 10 pixels whose grey level is 10 u + v.
cv::Mat slope() {
  cv::Mat image(10, 12, CV_8UC1);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(10 * u + v);
  return image;
}

/// Mean grey level of that picture along a line.
std::optional<double> mean_along(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px) {
  constexpr double kInside_px = 2.0;
  Side side{from_px, to_px};
  const Eigen::Vector2d outwards_px = kInside_px * side.outward();
  side.start_px += outwards_px;
  side.end_px += outwards_px;
  return mean_brightness_inside(slope(), kCamera, side, kInside_px);
}

/// A profile from -2 px to 2 px in steps of 1 px.
EdgeProfile profile_of(const std::vector<double>& brightness) {
  return {.reach_px = 2.0, .brightness = brightness};
}

TEST(MeanBrightness, IsReadBetweenPixelsUpToTheRimOfTheImage) {
  constexpr double kRounding = 1e-9;
  EXPECT_NEAR(mean_along({3.25, 2.0}, {3.25, 6.0}).value(), 36.5, kRounding);
  EXPECT_NEAR(mean_along({2.0, 3.25}, {6.0, 3.25}).value(), 43.25, kRounding);
  EXPECT_NEAR(mean_along({0.25, 2.0}, {0.25, 6.0}).value(), 6.5, kRounding) << "first column";
  EXPECT_NEAR(mean_along({2.0, 0.25}, {6.0, 0.25}).value(), 40.25, kRounding) << "first row";
  EXPECT_NEAR(mean_along({10.75, 2.0}, {10.75, 6.0}).value(), 111.5, kRounding) << "last column";
  EXPECT_NEAR(mean_along({2.0, 8.75}, {6.0, 8.75}).value(), 48.75, kRounding) << "last row";
}

TEST(MeanBrightness, IsUnknownOutsideTheImage) {
  EXPECT_FALSE(mean_along({-0.25, 2.0}, {-0.25, 6.0}));
  EXPECT_FALSE(mean_along({2.0, -0.25}, {6.0, -0.25}));
  EXPECT_FALSE(mean_along({11.25, 2.0}, {11.25, 6.0}));
  EXPECT_FALSE(mean_along({2.0, 9.25}, {6.0, 9.25}));
  EXPECT_FALSE(mean_along({2.0, 8.0}, {2.0, 12.0})) << "its end";
}

TEST(EdgeProfile, IsLinearBetweenItsSamplesAndConstantBeyondThem) {
  const EdgeProfile profile = profile_of({10, 20, 40, 80, 90});
  EXPECT_EQ(profile.step_px(), 1.0);
  EXPECT_DOUBLE_EQ(profile.at(-2.0), 10.0);
  EXPECT_DOUBLE_EQ(profile.at(-0.25), 35.0);
  EXPECT_DOUBLE_EQ(profile.at(0.0), 40.0);
  EXPECT_DOUBLE_EQ(profile.at(2.0), 90.0);
  EXPECT_DOUBLE_EQ(profile.at(-7.0), 10.0);
  EXPECT_DOUBLE_EQ(profile.at(7.0), 90.0);
}

TEST(EdgeProfile, TheRiseNearestToTheSideIsItsCrossing) {
  EXPECT_DOUBLE_EQ(profile_of({10, 20, 40, 80, 90}).crossing_px(50).value(), 0.25);
  EXPECT_DOUBLE_EQ(profile_of({0, 100, 0, 0, 100}).crossing_px(50).value(), -1.5);
  EXPECT_DOUBLE_EQ(profile_of({0, 100, 0, 100, 0}).crossing_px(25).value(), 0.25);
  EXPECT_DOUBLE_EQ(profile_of({50, 60, 60, 60, 60}).crossing_px(50).value(), -2.0);
  EXPECT_FALSE(profile_of({90, 80, 40, 20, 10}).crossing_px(50)) << "it falls";
  EXPECT_FALSE(profile_of({10, 20, 30, 40, 50}).crossing_px(50)) << "it does not exceed it";
}

TEST(EdgeProfile, TheEdgeIsWhereAnIdealStepHasTheSameMeanLevel) {
  EdgeProfile profile = profile_of({0, 0, 0, 100, 100});
  EXPECT_NEAR(profile.edge_px({0.0, 100.0}, 1.0).value(), 0.5, 1e-9);
  EXPECT_FALSE(profile.edge_px({100.0, 100.0}, 1.0)) << "no contrast";
  profile.brightness = {100, 80, 60, 40, 20};
  EXPECT_FALSE(profile.edge_px({0.0, 100.0}, 1.0)) << "there is none";
}

/// White above v = 20, black below, in 60 x 40 pixels.
cv::Mat horizontal_edge() {
  cv::Mat image(40, 60, CV_8UC1, cv::Scalar{20});
  image.rowRange(0, 20).setTo(220);
  return image;
}

TEST(SampleProfiles, AreSpreadAlongTheSideAwayFromItsCornersAndReadTheLevelsOnBothOfItsSides) {
  const Side side{{10.0, 19.5}, {40.0, 19.5}};
  const auto profiles = sample_profiles(horizontal_edge(), kCamera, side, 4.0, 6.0);
  ASSERT_GE(profiles.size(), 25U);
  EXPECT_LE(profiles.size(), 30U);
  EXPECT_NEAR(profiles.front().along_px, 2.0, 1e-9);
  EXPECT_NEAR(profiles.back().along_px, 28.0, 1e-9);
  for (const EdgeProfile& profile : profiles) {
    EXPECT_EQ(profile.white, 220.0);
    EXPECT_EQ(profile.black, 20.0);
    EXPECT_FALSE(profile.is_white_behind);
    EXPECT_NEAR(profile.edge_px({profile.black, profile.white}, 2.0).value(), 0.0, 1e-6);
  }
}

TEST(SampleProfiles, ThoseThatWouldLeaveTheImageAreLeftOut) {
  const auto count = [](const Side& side) {
    return sample_profiles(horizontal_edge(), kCamera, side, 4.0, 6.0).size();
  };
  EXPECT_GT(count({{-15.0, 19.5}, {15.0, 19.5}}), 10U);
  EXPECT_LT(count({{-15.0, 19.5}, {15.0, 19.5}}), 16U);
  EXPECT_EQ(count({{10.0, 3.0}, {40.0, 3.0}}), 0U) << "the quiet zone is outside";
}

TEST(SampleProfiles, AWhiteBitBehindTheBorderIsSeen) {
  cv::Mat image = horizontal_edge();
  image(cv::Rect{25, 26, 35, 6}).setTo(220);  // bits behind a border of 6 px, on the right
  const auto profiles = sample_profiles(image, kCamera, {{10.0, 19.5}, {40.0, 19.5}}, 4.0, 6.0);
  ASSERT_GE(profiles.size(), 25U);
  for (const EdgeProfile& profile : profiles) {
    if (std::abs(profile.along_px - 15.0) < 1.0) continue;  // at the edge of the bit
    EXPECT_EQ(profile.is_white_behind, profile.along_px > 15.0) << profile.along_px;
  }
}

}  // namespace
}  // namespace waymark
