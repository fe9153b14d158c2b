// SPDX-License-Identifier: BSD-3-Clause
#include "slam/findings_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using testing::HasSubstr;

Findings as_described() {
  Findings findings;
  findings.observations = 1000;
  findings.scans = 1000;
  findings.range_sigma_m = 0.011;
  findings.described_range_sigma_m = 0.01;
  return findings;
}

TEST(FindingsText, ARobotAsDescribedHasNoFindings) {
  const auto nothing = worth_saying(as_described(), 0);
  EXPECT_TRUE(nothing.empty());
  EXPECT_EQ(sentence_of(nothing), "nothing");
}

TEST(FindingsText, DeviationsAreReportedWithNumbers) {
  Findings findings = as_described();
  findings.odometry_along = 5.7;
  findings.range_sigma_m = 0.041;
  findings.odometry_stuck = 20;
  const auto found = worth_saying(findings, 40);
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
  Findings findings = as_described();
  findings.miscalibrated = {{OdometryTerm::kLidarYaw, 0.0873, 0.001},
                            {OdometryTerm::kScale, -0.12, 0.004}};
  const auto found = worth_saying(findings, 0);
  EXPECT_EQ(sentence_of(found),
            "LiDAR yaw: +0.0873 +- 0.001 rad from the description; "
            "odometry's distances: -12 +- 0.4 % from the description");
  EXPECT_EQ(found.front().name, "calibration_lidar_yaw_rad");
}

TEST(FindingsText, AFewScansThatDoNotFitAreNotReported) {
  Findings findings = as_described();
  findings.scans_refuted = 5;
  EXPECT_TRUE(worth_saying(findings, 0).empty());
  findings.scans_refuted = 50;
  EXPECT_FALSE(worth_saying(findings, 0).empty());
  findings = as_described();
  findings.scans_in_loaded_map = 100;
  findings.scans_contradict_loaded_map = 4;
  EXPECT_TRUE(worth_saying(findings, 0).empty());
  findings.scans_contradict_loaded_map = 6;
  EXPECT_FALSE(worth_saying(findings, 0).empty());
}

}  // namespace
}  // namespace waymark
