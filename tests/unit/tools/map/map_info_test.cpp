// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_commands.hpp"
#include "slam/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace waymark {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(MapInfo, ACalibrationErrorThatRoundsToZeroHasNoMinusSign) {
  MapSnapshot map;
  map.grid.frame = GridFrame::centred_on_map_origin(0.05);
  map.calibration.mean.setConstant(-1e-9);
  map.calibration.mean[0] = -0.0123;
  const auto file = std::filesystem::path{::testing::TempDir()} / "waymark_map_info.map.lcm";
  write_map_file(file, map, {"6x6_250", 0.4});
  const std::string info = map_info(file, false);
  std::filesystem::remove(file);
  EXPECT_THAT(info, HasSubstr("odometry's distances -1.2300 +- "));
  EXPECT_THAT(info, HasSubstr("LiDAR yaw +0.0000 +- "));
  EXPECT_THAT(info, Not(HasSubstr("-0.0000")));
}

}  // namespace
}  // namespace waymark
