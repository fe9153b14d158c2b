// SPDX-License-Identifier: BSD-3-Clause
// Real logs, which are third-party data outside the project; their README states the expected
// properties. Skipped where they are absent.
#include "import/carmen/carmen_reader.hpp"
#include "import/findings/findings.hpp"
#include "import/findings/reversed_odometry.hpp"
#include "import/mbot/mbot_reader.hpp"
#include "import_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace waymark {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kSickSigma_m =
    0.01;  // one sigma of the LMS 200's data sheet: 5 mm, rounded to 1 cm

std::optional<std::filesystem::path> real_log(const std::string& name) {
  const char* data = std::getenv("WAYMARK_DATA");
  const std::filesystem::path beside = std::filesystem::path{WAYMARK_SOURCE_DIR} / "../shared/data";
  for (const std::filesystem::path& folder : {std::filesystem::path{data != nullptr ? data : ""},
                                              beside, std::filesystem::path{"/work/shared/data"}}) {
    const auto file = folder / "logs" / name;
    if (std::filesystem::exists(file)) return file;
  }
  return std::nullopt;
}

/// The log with all findings, as the program makes it.
struct Found {
  ImportedLog log{};
  ImportReport report{"", AddressUnit::kLine};
};

/// Checks that no fault is reported which none of these logs has.
void expect_no_false_finding(const ImportReport& report) {
  for (const char* finding : {"further to the", "distances are about", "moved meanwhile", "anew",
                              "jumps away", "clock was set", "two LiDARs", "pairs of one time",
                              "out of order in time", "is 0 for the first"})
    EXPECT_THAT(report.notes(), Not(Contains(HasSubstr(finding))));
}

Found import_carmen(const std::filesystem::path& file, const CarmenOptions& options = {}) {
  Found found{{}, {file, AddressUnit::kLine}};
  found.log = read_carmen_log(file, options, found.report);
  examine(found.log, ReversedOdometry::kReport, found.report);
  expect_no_false_finding(found.report);
  return found;
}

TEST(RealLogs, RebuiltFr079IsReadWholeWithRepairedSigns) {
  const auto file = real_log("fr079.clf.gz");
  if (!file) GTEST_SKIP() << "shared/data/logs/fr079.clf.gz is not on this machine";

  const auto [log, report] = import_carmen(*file);

  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_EQ(log.contents, "ODOM 4934, front scans 4791");
  ASSERT_EQ(log.scans.size(), 4791U);
  EXPECT_EQ(log.odometry.size(), 4791U);
  EXPECT_EQ(to_us(log.scans.front().time), 1'211'726'113);
  EXPECT_EQ(to_us(log.scans.back().time), 2'272'975'997);
  const LidarScan scan = scan_of(log.scans.front());
  ASSERT_EQ(scan.ranges_m.size(), 360U);
  EXPECT_NEAR(scan.ranges_m[0], 1.65, 1e-6);
  EXPECT_NEAR(scan.ranges_m[9], 6.94, 1e-6);
  EXPECT_TRUE(std::isinf(scan.ranges_m[25])) << "81.91 in the log";
  EXPECT_NEAR(scan.angles_rad.front(), radians(-90.0), 1e-6);
  EXPECT_NEAR(scan.angles_rad.back(), radians(89.5), 1e-5);
  EXPECT_NEAR(path_length_m(log.odometry), 392.9, 0.1);
  EXPECT_THAT(report.notes(), Contains(HasSubstr("pile up at 81.91 m")));
  EXPECT_THAT(report.notes(), Contains(HasSubstr("does not say where the LiDAR sits")))
      << "the rebuilding lost it";
  EXPECT_THAT(report.notes(), Not(Contains(HasSubstr("backing up")))) << "signs were repaired";
  EXPECT_LT(log.robot.lidar.range_sigma_m, kSickSigma_m);
}

TEST(RealLogs, RebuiltFr079IsReadWithItsOdomLines) {
  const auto file = real_log("fr079.clf.gz");
  if (!file) GTEST_SKIP() << "shared/data/logs/fr079.clf.gz is not on this machine";
  CarmenOptions options{};
  options.odometry = CarmenOdometrySource::kOdomLines;

  const auto [log, report] = import_carmen(*file, options);

  EXPECT_EQ(log.odometry.size(), 4934U);
  EXPECT_EQ(report.num_skipped(), 0);
}

TEST(RealLogs, Fr079AsItWasPublishedCountsBackingUpAsForward) {
  const auto file = real_log("fr079_original.clf.bz2");
  if (!file) GTEST_SKIP() << "shared/data/logs/fr079_original.clf.bz2 is not on this machine";

  const auto [log, report] = import_carmen(*file);

  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_EQ(log.scans.size(), 4934U);
  EXPECT_NEAR(log.robot.lidar.x_m, -0.04, 1e-3);
  EXPECT_THAT(report.notes(), Contains(HasSubstr("pile up at 81.91 m")));
  EXPECT_THAT(report.notes(), Contains(HasSubstr("odometry counts backing up as driving forward")));
  const std::vector<ReversedStep> steps = find_reversed_steps(log);
  double distance_m = 0.0;
  for (const ReversedStep& step : steps)
    distance_m += step.distance_m;
  EXPECT_NEAR(static_cast<double>(steps.size()), 168.0, 17.0);
  EXPECT_NEAR(distance_m, 10.1, 0.5);
}

TEST(RealLogs, AcesWritesFiftyMetresForNoReturn) {
  const auto file = real_log("aces.clf.bz2");
  if (!file) GTEST_SKIP() << "shared/data/logs/aces.clf.bz2 is not on this machine";

  const auto [log, report] = import_carmen(*file);

  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_EQ(log.scans.size(), 7374U);
  EXPECT_EQ(log.robot.lidar.range_max_m, 50.0);
  EXPECT_THAT(report.notes(),
              Contains(HasSubstr("pile up at 50.00 m, and none is longer (11139 of")));
  EXPECT_THAT(report.notes(), Contains(HasSubstr("taken from the PARAM lines: x 0.000 m")));
  EXPECT_THAT(report.notes(), Not(Contains(HasSubstr("backing up"))));
  EXPECT_GT(log.robot.lidar.range_sigma_m, 0.05 / std::sqrt(12.0)) << "written in steps of 5 cm";
  EXPECT_LT(log.robot.lidar.range_sigma_m, 0.03);
}

TEST(RealLogs, CsailIsReadWholeWithItsNoReturnCode) {
  const auto file = real_log("csail.clf.bz2");
  if (!file) GTEST_SKIP() << "shared/data/logs/csail.clf.bz2 is not on this machine";

  const auto [log, report] = import_carmen(*file);

  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_EQ(log.scans.size(), 1988U);
  EXPECT_EQ(log.robot.lidar.num_beams, 361);
  EXPECT_THAT(report.notes(), Contains(HasSubstr("pile up at 81.91 m")));
  EXPECT_THAT(report.notes(), Not(Contains(HasSubstr("backing up"))));
  EXPECT_LT(log.robot.lidar.range_sigma_m, kSickSigma_m);
}

TEST(RealLogs, MbotConvexGivesScansWheelOdometryAndReference) {
  const auto file = real_log("mbot_convex.lcm");
  if (!file) GTEST_SKIP() << "shared/data/logs/mbot_convex.lcm is not on this machine";
  ImportReport report{*file, AddressUnit::kByte};
  MbotOptions options{};
  options.reference_channel = "SLAM_POSE";

  ImportedLog log = read_mbot_log(*file, options, report);
  examine(log, ReversedOdometry::kReport, report);

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
  EXPECT_THAT(report.notes(), Contains(HasSubstr("encoder ticks of MAEBOT_ENCODERS")));
  EXPECT_THAT(report.notes(), Contains(HasSubstr("ranges of 0 m")));
  EXPECT_THAT(report.notes(), Not(Contains(HasSubstr("pile up"))));
  EXPECT_THAT(report.notes(), Not(Contains(HasSubstr("backing up"))));
}

}  // namespace
}  // namespace waymark
