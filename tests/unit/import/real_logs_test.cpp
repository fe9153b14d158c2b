// SPDX-License-Identifier: BSD-3-Clause
// Real logs, which are third-party data and lie outside the project; skipped where they are absent.
#include "common/messages/convert.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "import/mbot/mbot_reader.hpp"
#include "import_files.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

std::optional<std::filesystem::path> real_log(const std::string& name) {
  const std::filesystem::path beside = std::filesystem::path{WAYMARK_SOURCE_DIR} / "../shared";
  for (const std::filesystem::path& folder : {beside, std::filesystem::path{"/work/shared"}}) {
    const auto file = folder / "data/logs" / name;
    if (std::filesystem::exists(file)) return file;
  }
  return std::nullopt;
}

TEST(RealLogs, Fr079) {
  const auto file = real_log("fr079.clf.gz");
  if (!file) GTEST_SKIP() << "shared/data/logs/fr079.clf.gz is not on this machine";
  ImportReport report{*file, AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(*file, {}, report);

  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_EQ(log.contents, "ODOM 4934, front scans 4791");
  ASSERT_EQ(log.scans.size(), 4791U);
  EXPECT_EQ(log.odometry.size(), 4791U);
  EXPECT_EQ(to_us(log.scans.front().time), 1'211'726'113);
  EXPECT_EQ(to_us(log.scans.back().time), 2'272'975'997);
  const LidarScan scan =
      to_scan(decode<planar_lidar_t>(log.scans.front().message.payload).message.value());
  ASSERT_EQ(scan.ranges_m.size(), 360U);
  EXPECT_NEAR(scan.ranges_m[0], 1.65, 1e-6);
  EXPECT_NEAR(scan.ranges_m[9], 6.94, 1e-6);
  EXPECT_TRUE(std::isinf(scan.ranges_m[25])) << "81.91 in the log";
  EXPECT_NEAR(scan.angles_rad.front(), radians(-90.0), 1e-6);
  EXPECT_NEAR(scan.angles_rad.back(), radians(89.5), 1e-5);
  EXPECT_NEAR(path_length_m(log.odometry), 392.9, 0.1);
}

TEST(RealLogs, Fr079WithOdomLines) {
  const auto file = real_log("fr079.clf.gz");
  if (!file) GTEST_SKIP() << "shared/data/logs/fr079.clf.gz is not on this machine";
  ImportReport report{*file, AddressUnit::kLine};
  CarmenOptions options{};
  options.odometry = CarmenOdometrySource::kOdomLines;

  EXPECT_EQ(read_carmen_log(*file, options, report).odometry.size(), 4934U);
  EXPECT_EQ(report.num_skipped(), 0);
}

TEST(RealLogs, MbotConvex) {
  const auto file = real_log("mbot_convex.lcm");
  if (!file) GTEST_SKIP() << "shared/data/logs/mbot_convex.lcm is not on this machine";
  ImportReport report{*file, AddressUnit::kByte};
  MbotOptions options{};
  options.encoder_channel = "MAEBOT_ENCODERS";
  options.reference_channel = "SLAM_POSE";

  const ImportedLog log = read_mbot_log(*file, options, report);

  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_EQ(log.scans.size(), 459U);
  EXPECT_EQ(log.odometry.size(), 3423U)
      << "3422 readings, and the first pose held to the first scan";
  EXPECT_EQ(log.reference.size(), 457U);
  EXPECT_NEAR(path_length_m(log.reference), 6.158, 0.001);
  // The same ticks summed up by an independent script.
  EXPECT_NEAR(log.odometry.back().pose.x(), -0.33794, 1e-4);
  EXPECT_NEAR(log.odometry.back().pose.y(), -0.23350, 1e-4);
  EXPECT_NEAR(angle_difference(log.odometry.back().pose.theta(), 16.08762), 0.0, 1e-4);
}

}  // namespace
}  // namespace waymark
