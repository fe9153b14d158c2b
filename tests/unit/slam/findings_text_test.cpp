// SPDX-License-Identifier: BSD-3-Clause
#include "slam/findings_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using testing::HasSubstr;

SensorStatistics as_described() {
  SensorStatistics statistics;
  statistics.observations = 1000;
  statistics.scans = 1000;
  statistics.range_sigma_m = 0.011;
  statistics.described_range_sigma_m = 0.01;
  return statistics;
}

TEST(FindingsText, ARobotAsDescribedHasNoFindings) {
  const auto nothing = reportable_findings(as_described(), 0);
  EXPECT_TRUE(nothing.empty());
  EXPECT_EQ(sentence_of(nothing), "nothing");
}

TEST(FindingsText, DeviationsAreReportedWithNumbers) {
  SensorStatistics statistics = as_described();
  statistics.odometry_along = 5.7;
  statistics.range_sigma_m = 0.041;
  statistics.odometry_stuck = 20;
  const auto found = reportable_findings(statistics, 40);
  const std::string sentence = sentence_of(found);
  EXPECT_THAT(sentence, HasSubstr("5.7 times as noisy along the path"));
  EXPECT_THAT(sentence, HasSubstr("scatter by 0.041 m"));
  EXPECT_THAT(sentence, HasSubstr("stood still while the robot moved for 2.0 %"));
  EXPECT_THAT(sentence, HasSubstr("3.8 % of the scans repeat"));
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[1].name, "odometry_stuck");
  EXPECT_EQ(found[1].value, 20.0);
  EXPECT_EQ(found[1].share, 0.02);
}

TEST(FindingsText, AMountingThatIsNotAsDescribedIsReportedWithItsError) {
  SensorStatistics statistics = as_described();
  statistics.miscalibrated = {{OdometryTerm::kLidarYaw, 0.0873, 0.001},
                              {OdometryTerm::kScale, -0.12, 0.004}};
  const auto found = reportable_findings(statistics, 0);
  EXPECT_EQ(sentence_of(found),
            "LiDAR yaw: +0.0873 +- 0.001 rad from the description; "
            "odometry's distances: -12 +- 0.4 % from the description");
  EXPECT_EQ(found.front().name, "calibration_lidar_yaw_rad");
}

TEST(FindingsText, TheScaleOfTurnsIsNotReportedWhereTurnsAreMostlyNoise) {
  SensorStatistics statistics = as_described();
  statistics.miscalibrated = {{OdometryTerm::kTurnScale, -0.12, 0.004}};
  EXPECT_EQ(reportable_findings(statistics, 0).size(), 1U);
  statistics.odometry_turn = 4.0;
  const auto found = reportable_findings(statistics, 0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().name, "odometry_turn_noise_scale");
}

TEST(FindingsText, AFewScansThatDoNotFitAreNotReported) {
  SensorStatistics statistics = as_described();
  statistics.scans_refuted = 5;
  EXPECT_TRUE(reportable_findings(statistics, 0).empty());
  statistics.scans_refuted = 50;
  EXPECT_FALSE(reportable_findings(statistics, 0).empty());
  statistics = as_described();
  statistics.loaded_map.scans = 100;
  statistics.loaded_map.contradicting = 4;
  EXPECT_TRUE(reportable_findings(statistics, 0).empty());
  statistics.loaded_map.contradicting = 6;
  EXPECT_FALSE(reportable_findings(statistics, 0).empty());
}

TEST(FindingsText, AMapMostOfWhoseMarkersHangElsewhereIsReported) {
  SensorStatistics statistics = as_described();
  statistics.loaded_map.markers_in_place = 4;
  statistics.loaded_map.markers_moved = 4;
  EXPECT_TRUE(reportable_findings(statistics, 0).empty());
  statistics.loaded_map.markers_moved = 5;
  const auto found = reportable_findings(statistics, 0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().text.substr(0, 18), "5 of 9 sighted mar");
}

}  // namespace
}  // namespace waymark
