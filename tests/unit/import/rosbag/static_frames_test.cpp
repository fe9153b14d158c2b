// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/static_frames.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace waymark {
namespace {

constexpr auto kStatic = TransformSource::kStatic;
constexpr auto kRepeated = TransformSource::kRepeated;

RosTransform transform(const std::string& parent, const std::string& child, double x_m,
                       double yaw_rad = 0.0) {
  RosTransform result{.parent = parent, .child = child};
  result.parent_from_child.translate(Eigen::Vector3d{x_m, 0.0, 0.0});
  result.parent_from_child.rotate(Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()});
  return result;
}

/// x of the laser in the frame of the base [m]; nullopt if it is not fixed there.
std::optional<double> laser_x_m(const StaticFrames& frames) {
  const auto base_from_laser = frames.find("base", "laser");
  if (!base_from_laser) return std::nullopt;
  return base_from_laser->translation().x();
}

TEST(StaticFrames, ARepeatedTransformIsFixedAsLongAsItsMessagesAgree) {
  StaticFrames frames;
  frames.add(transform("base", "laser", 0.2), kRepeated);
  frames.add(transform("base", "laser", 0.2), kRepeated);
  EXPECT_EQ(laser_x_m(frames), 0.2);
  frames.add(transform("base", "laser", 0.21), kRepeated);
  EXPECT_EQ(laser_x_m(frames), std::nullopt) << "it moves";
  frames.add(transform("base", "laser", 0.2), kRepeated);
  EXPECT_EQ(laser_x_m(frames), std::nullopt) << "it has moved";
}

TEST(StaticFrames, AChildThatChangesItsParentIsNotFixed) {
  StaticFrames frames;
  frames.add(transform("base", "laser", 0.2), kRepeated);
  frames.add(transform("arm", "laser", 0.2), kRepeated);
  EXPECT_EQ(laser_x_m(frames), std::nullopt);
}

TEST(StaticFrames, AStaticTransformOverridesRepeatedOnesWhateverTheOrder) {
  StaticFrames last;
  for (const double x_m : {0.2, 0.3})
    last.add(transform("base", "laser", x_m), kRepeated);
  last.add(transform("base", "laser", 0.5), kStatic);
  EXPECT_EQ(laser_x_m(last), 0.5);

  StaticFrames first;
  first.add(transform("base", "laser", 0.5), kStatic);
  for (const double x_m : {0.2, 0.3})
    first.add(transform("base", "laser", x_m), kRepeated);
  EXPECT_EQ(laser_x_m(first), 0.5);
}

TEST(StaticFrames, OfTwoStaticTransformsTheLaterCounts) {
  StaticFrames frames;
  frames.add(transform("base", "laser", 0.5), kStatic);
  frames.add(transform("base", "laser", 0.6), kStatic);
  EXPECT_EQ(laser_x_m(frames), 0.6);
}

TEST(StaticFrames, AChainIsFollowedUpAndDownTheTree) {
  StaticFrames frames;
  frames.add(transform("footprint", "base", 0.1, std::numbers::pi / 2), kStatic);
  frames.add(transform("footprint", "/mast", 0.5), kStatic);
  frames.add(transform("/mast", "laser", 1.0), kStatic);
  // The laser is 1.4 m ahead of the base's origin; the base looks to the left.
  const auto base_from_laser = frames.find("/base", "laser");
  ASSERT_TRUE(base_from_laser);
  EXPECT_NEAR(base_from_laser->translation().x(), 0.0, 1e-12);
  EXPECT_NEAR(base_from_laser->translation().y(), -1.4, 1e-12);
}

TEST(StaticFrames, FramesOfDifferentTreesAndCyclesHaveNoTransform) {
  StaticFrames frames;
  frames.add(transform("base", "laser", 0.2), kStatic);
  EXPECT_FALSE(frames.find("base", "camera"));
  frames.add(transform("a", "b", 0.1), kStatic);
  frames.add(transform("b", "a", 0.1), kStatic);
  EXPECT_FALSE(frames.find("base", "a")) << "a cycle, of a damaged bag";
}

}  // namespace
}  // namespace waymark
