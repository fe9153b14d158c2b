// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/standing_odometry.hpp"

#include "import/findings/findings.hpp"
#include "synthetic_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

ImportedLog with_one_pose(ImportedLog log) {
  for (ImportedPose& sample : log.odometry)
    sample.pose = Se2{1.0, 2.0, 0.5};
  return log;
}

std::vector<std::string> notes_of(ImportedLog log) {
  ImportReport report{"log", AddressUnit::kLine};
  examine(log, ReversedOdometry::kReport, report);
  return report.notes();
}

TEST(StandingOdometry, IsFoundWhenTheScansChange) {
  const ImportedLog log = with_one_pose(drive(to_and_fro(), CountedAs::kDriven));

  EXPECT_GT(change_of_scans_while_standing_m(log).value_or(0.0), 0.2);
  EXPECT_THAT(notes_of(log), Contains(HasSubstr("odometry says nothing: all 61 poses are equal")));
}

TEST(StandingOdometry, ARobotThatMovesOrReallyStandsIsNotReported) {
  const ImportedLog moving = drive(to_and_fro(), CountedAs::kDriven);
  EXPECT_FALSE(change_of_scans_while_standing_m(moving));
  EXPECT_THAT(notes_of(moving), Not(Contains(HasSubstr("odometry says nothing"))));
  EXPECT_FALSE(change_of_scans_while_standing_m(drive(std::vector<Se2>(60), CountedAs::kDriven)));
}

}  // namespace
}  // namespace waymark
