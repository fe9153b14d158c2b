// SPDX-License-Identifier: BSD-3-Clause
// The limits and remedies of single checks, on inputs without a drive.
#include "doctor/checks.hpp"

#include "doctor/verdict.hpp"
#include "synthetic_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace waymark {
namespace {

using ::testing::HasSubstr;

/// A scan every 100 ms, without those that are missing.
DoctorInput input_with_scans(int count, const std::vector<int>& missing = {}) {
  DoctorInput input = described_input("log");
  for (int i = 0; i < count; ++i) {
    if (std::ranges::find(missing, i) != missing.end()) continue;
    const Timestamp time = timestamp_from_us(10'000'000 + 100'000 * i);
    input.log.scans.push_back({.time = time, .last_beam_time = time, .at = i});
  }
  return input;
}

Verdict verdict_with_lost_scans(std::size_t num_lost) {
  return check_scans_fit(input_with_scans(100).log, {.num_lost = num_lost}).verdict;
}

std::optional<TurnComparison> turns(double ratio, double ratio_sigma, double late_s = 0.0,
                                    double late_sigma_s = 0.001) {
  return TurnComparison{{ratio, ratio_sigma}, {late_s, late_sigma_s}, 20.0};
}

TEST(DoctorsVerdict, ADeviationCountsOnlyBeyondThreeSigmas) {
  constexpr DeviationLimits kLimits{0.01, 0.05};
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(verdict_of(sign * 0.009, 0.0, kLimits), Verdict::kPass);
    EXPECT_EQ(verdict_of(sign * 0.02, 0.0, kLimits), Verdict::kWarn);
    EXPECT_EQ(verdict_of(sign * 0.02, 0.004, kLimits), Verdict::kPass);
    EXPECT_EQ(verdict_of(sign * 0.06, 0.0, kLimits), Verdict::kFail);
    EXPECT_EQ(verdict_of(sign * 0.06, 0.004, kLimits), Verdict::kWarn);
  }
  EXPECT_TRUE(is_known({7.0, 0.016}, kLimits));
  EXPECT_FALSE(is_known({7.0, 0.017}, kLimits));
}

TEST(DoctorsChecks, MissingScansAreCountedFromTheGapsAndJudgedByTheirShare) {
  const Check complete = check_lidar_drops(input_with_scans(200));
  EXPECT_EQ(complete.verdict, Verdict::kPass);
  EXPECT_EQ(complete.value, 0.0);

  const Check few = check_lidar_drops(input_with_scans(200, {50, 51, 52, 120}));
  EXPECT_EQ(few.verdict, Verdict::kWarn);
  EXPECT_NEAR(few.value.value(), 2.0, 1e-9);
  EXPECT_THAT(few.finding, HasSubstr("196 are there, usually every 100.0 ms, longest gap 0.40 s"));

  std::vector<int> every_fifth;
  for (int i = 2; i < 200; i += 5)
    every_fifth.push_back(i);
  const Check many = check_lidar_drops(input_with_scans(200, every_fifth));
  EXPECT_EQ(many.verdict, Verdict::kFail);
  EXPECT_NEAR(many.value.value(), 20.0, 1e-9);

  EXPECT_EQ(check_lidar_drops(input_with_scans(9)).verdict, Verdict::kUnchecked);
}

TEST(DoctorsChecks, UnusableRecordsWarnAndMoreThanATenthOfAllRecordsFails) {
  DoctorInput input = input_with_scans(90);
  EXPECT_EQ(check_records(input).verdict, Verdict::kPass);
  for (int i = 0; i < 9; ++i)
    input.report.skip("negative range", i, "");
  EXPECT_EQ(check_records(input).verdict, Verdict::kWarn);
  EXPECT_EQ(check_records(input).value, 9.0);
  EXPECT_THAT(check_records(input).finding, HasSubstr("(9.1 %), negative range 9"));
  for (int i = 0; i < 3; ++i)
    input.report.skip("negative range", i, "");
  EXPECT_EQ(check_records(input).verdict, Verdict::kFail);
}

TEST(DoctorsChecks, AMessageLargerThanADatagramFails) {
  DoctorInput input = described_input("log");
  EXPECT_EQ(check_traffic(input).verdict, Verdict::kUnchecked);
  input.recorded_s = 10.0;
  input.channels["LIDAR"] = {100, 150'000, 1'500, 0.0, 10.0};
  input.channels["CAMERA"] = {10, 650'000, 65'000, 0.0, 10.0};
  const Check fits = check_traffic(input);
  EXPECT_EQ(fits.verdict, Verdict::kPass);
  EXPECT_NEAR(fits.value.value(), 80.0, 1e-9) << "kB/s";
  EXPECT_THAT(fits.finding, HasSubstr("80.0 kB/s: CAMERA 65.0 kB/s, LIDAR 15.0 kB/s"));
  input.channels["CAMERA"].largest_bytes = 65'001;
  EXPECT_EQ(check_traffic(input).verdict, Verdict::kFail);
  EXPECT_THAT(check_traffic(input).finding, HasSubstr("CAMERA has messages of 65001 bytes"));
}

TEST(DoctorsChecks, ACodeForNoReturnFailsOnlyIfTheDescriptionTakesItForAWall) {
  DoctorInput input = described_input("log");
  RobotConfig robot = *input.described;
  EXPECT_EQ(check_no_return(input, robot).verdict, Verdict::kPass);

  input.log.no_return_codes_m = {8.0, 8.2};
  input.log.robot.lidar.range_max_m = 7.9;
  input.described->lidar.range_max_m = 7.0;
  robot = *input.described;
  EXPECT_EQ(check_no_return(input, robot).verdict, Verdict::kPass);
  EXPECT_EQ(robot.lidar.range_max_m, 7.0);

  input.described->lidar.range_max_m = 12.0;
  robot = *input.described;
  const Check wrong = check_no_return(input, robot);
  EXPECT_EQ(wrong.verdict, Verdict::kFail);
  EXPECT_EQ(wrong.value, 8.0);
  EXPECT_THAT(wrong.finding, HasSubstr("pile up at 8.00 m (and up to 8.20 m)"));
  EXPECT_EQ(robot.lidar.range_max_m, 7.9);

  input.described.reset();
  EXPECT_EQ(check_no_return(input, robot).verdict, Verdict::kWarn);
}

TEST(DoctorsChecks, RangeNoiseOfTwiceTheDescribedOneOrHalfOfItIsAWarning) {
  DoctorInput input = described_input("log");
  const auto check_with = [&](double measured_m) {
    input.log.robot.lidar.range_sigma_m = measured_m;
    RobotConfig robot{};
    robot.lidar.range_sigma_m = 0.01;
    const Check check = check_range_noise(input, robot);
    EXPECT_EQ(robot.lidar.range_sigma_m, check.verdict == Verdict::kWarn ? measured_m : 0.01);
    return check.verdict;
  };
  EXPECT_EQ(check_with(0.019), Verdict::kPass);
  EXPECT_EQ(check_with(0.021), Verdict::kWarn);
  EXPECT_EQ(check_with(0.0051), Verdict::kPass);
  EXPECT_EQ(check_with(0.0049), Verdict::kWarn);
  input.noise_is_estimated = false;
  EXPECT_EQ(check_with(0.01), Verdict::kUnchecked);
}

TEST(DoctorsChecks, ScansThatDoNotFitTheOneBeforeAreJudgedByTheirShare) {
  EXPECT_EQ(verdict_with_lost_scans(2), Verdict::kPass);
  EXPECT_EQ(verdict_with_lost_scans(3), Verdict::kWarn);
  EXPECT_EQ(verdict_with_lost_scans(20), Verdict::kWarn);
  EXPECT_EQ(verdict_with_lost_scans(21), Verdict::kFail);
  const ImportedLog log = input_with_scans(40).log;
  EXPECT_EQ(check_scans_fit(log, {.num_lost = 2}).value, 5.0);
  EXPECT_THAT(check_scans_fit(log, {.num_lost = 2}).finding, HasSubstr("5.0 % of the scans"));
  EXPECT_EQ(check_scans_fit(input_with_scans(29).log, {}).verdict, Verdict::kUnchecked);
}

TEST(DoctorsChecks, OppositeTurnsMeanAMirroredLidarUnlessTheyAreUncertain) {
  RobotConfig robot{};
  EXPECT_EQ(check_mirror(turns(0.9, 0.1), robot).verdict, Verdict::kPass);
  EXPECT_EQ(check_mirror(turns(-0.2, 0.1), robot).verdict, Verdict::kUnchecked);
  EXPECT_EQ(check_mirror(std::nullopt, robot).verdict, Verdict::kUnchecked);
  EXPECT_FALSE(robot.lidar.mirrored);
  const Check mirrored = check_mirror(turns(-0.9, 0.1), robot);
  EXPECT_EQ(mirrored.verdict, Verdict::kFail);
  EXPECT_THAT(mirrored.remedy, HasSubstr("robot.lidar.mirrored = true"));
  EXPECT_TRUE(robot.lidar.mirrored);
  check_mirror(turns(-0.9, 0.1), robot);
  EXPECT_FALSE(robot.lidar.mirrored) << "a description that is wrong the other way";
  EXPECT_EQ(check_turn_scale(turns(-1.0, 0.001)).verdict, Verdict::kPass) << "only mirrored";
}

TEST(DoctorsChecks, ATurnScaleThatIsNoneGivesNoRemedy) {
  const Check unrelated = check_turn_scale(turns(0.005, 0.003));
  EXPECT_EQ(unrelated.verdict, Verdict::kUnchecked);
  EXPECT_THAT(unrelated.finding, HasSubstr("nothing to do with each other"));
  EXPECT_EQ(check_turn_scale(turns(0.5, 0.01)).verdict, Verdict::kFail);
}

TEST(DoctorsChecks, ATimeOffsetIsAddedToTheDescribedOne) {
  RobotConfig robot{};
  robot.lidar.late_s = 0.05;
  const DoctorInput input = described_input("log");
  const Check behind = check_time_offset(input, turns(1.0, 0.01, 0.03), robot);
  EXPECT_EQ(behind.verdict, Verdict::kWarn);
  EXPECT_NEAR(robot.lidar.late_s, 0.08, 1e-12);
  EXPECT_NEAR(behind.value.value(), 80.0, 1e-9);
  EXPECT_THAT(behind.finding, HasSubstr("80 +- 1 ms behind odometry's, described is 50 ms"));
  EXPECT_THAT(behind.remedy, HasSubstr("robot.lidar.late_s = 0.0800"));

  robot.lidar.late_s = 0.05;
  const Check ahead = check_time_offset(input, turns(1.0, 0.01, -0.2), robot);
  EXPECT_EQ(ahead.verdict, Verdict::kFail);
  EXPECT_NEAR(robot.lidar.late_s, -0.15, 1e-12);
  EXPECT_THAT(ahead.finding, HasSubstr("150 +- 1 ms ahead of odometry's"));

  const auto uncertain = turns(1.0, 0.01, 0.2, 0.04);
  EXPECT_EQ(check_time_offset(input, uncertain, robot).verdict, Verdict::kUnchecked);
  EXPECT_EQ(usable_lateness_s(*uncertain), 0.0);
  EXPECT_EQ(usable_lateness_s(*turns(1.0, 0.01, 0.2)), 0.2);
}

TEST(DoctorsChecks, AMountingThatNothingDescribesIsWrittenButContradictsNothing) {
  DoctorInput input = described_input("log");
  const HandEye found{.x_m = {0.5, 0.001}, .y_m = {0.001, 0.001}, .yaw_rad = {0.0, 0.1}};
  const auto verdicts_with = [&](Mounting mounting, RobotConfig& robot) {
    input.mounting = mounting;
    input.log.robot.lidar.x_m = input.log.robot.lidar.y_m = 0.0;
    robot.lidar.x_m = robot.lidar.y_m = 0.0;
    std::vector<Verdict> verdicts;
    for (const Check& check : check_mounting(input, found, robot))
      verdicts.push_back(check.verdict);
    return verdicts;
  };
  RobotConfig robot{};
  EXPECT_EQ(verdicts_with(Mounting::kDescribed, robot),
            (std::vector{Verdict::kFail, Verdict::kPass, Verdict::kUnchecked}));
  EXPECT_EQ(robot.lidar.x_m, 0.5);
  EXPECT_EQ(verdicts_with(Mounting::kUnknown, robot),
            (std::vector{Verdict::kWarn, Verdict::kPass, Verdict::kUnchecked}));
  EXPECT_EQ(robot.lidar.x_m, 0.5);
  EXPECT_EQ(robot.lidar.y_m, 0.0) << "within three sigmas";
}

}  // namespace
}  // namespace waymark
