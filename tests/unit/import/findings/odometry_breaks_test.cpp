// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/odometry_breaks.hpp"

#include "synthetic_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kExact = 1e-9;

/// Two drives of 20 steps with a stop of 20 steps in between.
ImportedLog drive_with_stop() {
  std::vector<Se2> steps;
  for (int i = 0; i < 60; ++i)
    steps.push_back(i / 20 == 1 ? Se2{} : Se2{0.05, 0.0, 0.01});
  return drive(steps, CountedAs::kDriven);
}

struct Repaired {
  ImportedLog log{};
  ImportReport report{"log", AddressUnit::kLine};
};

Repaired repair(ImportedLog log) {
  Repaired repaired{std::move(log)};
  repair_odometry_breaks(repaired.log, repaired.report);
  return repaired;
}

/// Delays all records from scan `first` on.
void delay(ImportedLog& log, std::size_t first, Duration later) {
  for (std::size_t i = first; i < log.scans.size(); ++i) {
    auto message = decode<planar_lidar_t>(log.scans[i].message.payload).message.value();
    message.utime += later.count();
    log.scans[i].message = encode(channels::kLidar, message);
    log.scans[i].time += later;
    log.scans[i].last_beam_time += later;
    log.odometry[i].time += later;
  }
}

void begin_anew(ImportedLog& log, std::size_t first) {
  const Se2 old_from_new = log.odometry[first].pose;
  for (std::size_t i = first; i < log.odometry.size(); ++i)
    log.odometry[i].pose = Se2{7.0, 3.0, 2.0} * old_from_new.inverse() * log.odometry[i].pose;
}

double way_m(const ImportedLog& log) {
  return path_length_m(log.odometry);
}

TEST(OdometryBreaks, OdometryWithoutBreaksIsUnchanged) {
  const ImportedLog log = drive_with_stop();
  const Repaired repaired = repair(log);
  EXPECT_THAT(repaired.report.notes(), IsEmpty());
  EXPECT_EQ(way_m(repaired.log), way_m(log));
}

TEST(OdometryBreaks, AResetAfterAPauseIsJoinedAndIsNoClockSeam) {
  ImportedLog log = drive_with_stop();
  begin_anew(log, 30);
  delay(log, 30, std::chrono::minutes{12});

  const Repaired repaired = repair(log);

  EXPECT_NEAR(way_m(repaired.log), way_m(drive_with_stop()), kExact);
  EXPECT_THAT(repaired.report.notes(), Contains(HasSubstr("odometry begins anew at")));
  EXPECT_THAT(repaired.report.notes(), Contains(HasSubstr("the longest of 12.0 min")));
  for (std::size_t i = 1; i < repaired.log.odometry.size(); ++i)
    EXPECT_LE(repaired.log.odometry[i].time - repaired.log.odometry[i - 1].time,
              std::chrono::minutes{5});
}

TEST(OdometryBreaks, MotionDuringAGapInABareCorridorIsKept) {
  const auto way_of_drive_with_gap = [](Walls walls) {
    const std::vector<Se2> steps(60, Se2{0.05, 0.0, 0.0});
    ImportedLog log = drive(steps, CountedAs::kDriven, walls);
    for (std::size_t i = 30; i < log.odometry.size(); ++i)
      log.odometry[i].pose = Se2{2.0, 0.0, 0.0} * log.odometry[i].pose;
    delay(log, 30, std::chrono::seconds{10});
    return way_m(repair(log).log);
  };
  EXPECT_NEAR(way_of_drive_with_gap(Walls::kCorridor), 5.0, kExact);
  // The scans show that the robot stood.
  EXPECT_NEAR(way_of_drive_with_gap(Walls::kRoom), 2.95, kExact);
}

TEST(OdometryBreaks, AResetToZeroAfterAPauseInABareCorridorIsFound) {
  constexpr std::size_t kNewBeginning = 30;
  std::vector<Se2> steps(60, Se2{0.05, 0.0, 0.0});
  steps[kNewBeginning - 1] = Se2{};
  ImportedLog log = drive(steps, CountedAs::kDriven, Walls::kCorridor);
  const Se2 old_from_new = log.odometry[kNewBeginning].pose;
  for (std::size_t i = kNewBeginning; i < log.odometry.size(); ++i)
    log.odometry[i].pose = old_from_new.inverse() * log.odometry[i].pose;
  delay(log, kNewBeginning, std::chrono::hours{24});

  const Repaired repaired = repair(log);

  EXPECT_NEAR(way_m(repaired.log), 59 * 0.05, kExact);
  EXPECT_THAT(repaired.report.notes(), Contains(HasSubstr("odometry begins anew at")));
}

TEST(OdometryBreaks, AResetWhileDrivingIsJoinedAtTheLastVelocity) {
  ImportedLog log = drive_with_stop();
  begin_anew(log, 50);

  const Repaired repaired = repair(log);

  EXPECT_NEAR(way_m(repaired.log), way_m(drive_with_stop()), 0.01);
}

TEST(OdometryBreaks, ASinglePoseElsewhereIsInterpolated) {
  ImportedLog log = drive_with_stop();
  log.odometry[10].pose = Se2{-9.0, 4.0, 0.0};

  const Repaired repaired = repair(log);

  EXPECT_NEAR(way_m(repaired.log), way_m(drive_with_stop()), 1e-4);
  EXPECT_THAT(repaired.report.notes(), Contains(HasSubstr("1 single poses")));
}

TEST(OdometryBreaks, OdometryThatIs0UntilItStartsIsJoinedWhereTheRobotStands) {
  std::vector<Se2> steps(60);
  std::fill(steps.begin() + 30, steps.end(), Se2{0.05, 0.0, 0.0});
  ImportedLog log = drive(steps, CountedAs::kDriven);
  for (std::size_t i = 0; i < log.odometry.size(); ++i)
    log.odometry[i].pose = i < 20 ? Se2{} : Se2{5.0, 5.0, 1.0} * log.odometry[i].pose;

  const Repaired repaired = repair(log);

  EXPECT_NEAR(way_m(repaired.log), 1.5, kExact);
  EXPECT_THAT(repaired.report.notes(), Contains(HasSubstr("odometry is 0 for the first 4.0 s")));
}

TEST(OdometryBreaks, ScansOfMotionBeforeOdometryStartsAreLeftOut) {
  ImportedLog log = drive_with_stop();
  for (std::size_t i = 0; i < log.odometry.size(); ++i)
    log.odometry[i].pose = i < 15 ? Se2{} : Se2{5.0, 5.0, 1.0} * log.odometry[i].pose;

  const Repaired repaired = repair(log);

  EXPECT_EQ(repaired.report.num_skipped(), 15);
  EXPECT_THAT(repaired.log.scans, SizeIs(61 - 15));
  EXPECT_EQ(repaired.log.odometry.front().time, repaired.log.scans.front().time);
}

TEST(OdometryBreaks, AGapInWhichTheRobotIsMovedIsReported) {
  ImportedLog log = drive(std::vector<Se2>(60, Se2{0.05, 0.0, 0.0}), CountedAs::kDriven);
  const Se2 held = log.odometry[20].pose;
  const Se2 moved = log.odometry[50].pose;
  log.scans.erase(log.scans.begin() + 21, log.scans.begin() + 50);
  log.odometry.erase(log.odometry.begin() + 21, log.odometry.begin() + 50);
  for (std::size_t i = 21; i < log.odometry.size(); ++i)
    log.odometry[i].pose = held * moved.inverse() * log.odometry[i].pose;

  EXPECT_THAT(repair(log).report.notes(), Contains(HasSubstr("the robot was moved meanwhile")));
}

}  // namespace
}  // namespace waymark
