// SPDX-License-Identifier: BSD-3-Clause
#include "slam/last_pose.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace waymark {
namespace {

namespace fs = std::filesystem;

TEST(LastPose, IsReadAsItWasWritten) {
  const fs::path folder = fs::path{::testing::TempDir()} / ("last_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  EXPECT_FALSE(read_last_pose(folder));
  const LastPose last{timestamp_from_us(123'456'789),
                      {-5, 7},
                      {1.25, -2.5, 3.0},
                      {0.1, 0.2, 0.3},
                      {7.0, 8.0, -1.0}};
  write_last_pose(folder, last);
  const auto read = read_last_pose(folder);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->time, last.time);
  EXPECT_EQ(read->map_ids, last.map_ids);
  EXPECT_EQ(read->map_from_base.x(), 1.25);
  EXPECT_EQ(read->sigmas, last.sigmas);
  EXPECT_EQ(read->odom_from_base.theta(), -1.0);
  fs::remove_all(folder);
}

TEST(LastPose, IsUsedOnlyWhereMapAndOdometryFit) {
  const LastPose last{
      timestamp_from_us(100'000'000), {6, 7}, {10.0, 0.0, 0.0}, {0.1, 0.1, 0.01}, {20.0, 1.0, 0.5}};
  const auto at = [](double time_s) {
    return timestamp_from_us(static_cast<std::int64_t>(1e6 * time_s));
  };
  const Se2 driven_on = last.odom_from_base * Se2{1.0, 0.0, 0.0};
  const Resumption resumed = resume(last, 7, at(102.0), driven_on);
  ASSERT_TRUE(resumed.start);
  EXPECT_NEAR(resumed.start->x_m, 11.0, 1e-9);
  EXPECT_GT(resumed.start->sigma_m, 0.1);
  EXPECT_TRUE(resumed.start->is_certain);
  EXPECT_FALSE(resume(last, 8, at(102.0), driven_on).start);  // another map
  EXPECT_FALSE(resume(last, 7, at(99.0), driven_on).start);   // the clock went back
  EXPECT_FALSE(resume(last, 7, at(102.0), Se2{}).start);      // odometry began anew
  EXPECT_FALSE(resume(last, 7, at(100'000.0), driven_on).start);
  const Resumption in_the_morning = resume(last, 7, at(100'000.0), last.odom_from_base);
  ASSERT_TRUE(in_the_morning.start);  // it stood all night
  EXPECT_FALSE(in_the_morning.start->is_certain);
}

}  // namespace
}  // namespace waymark
