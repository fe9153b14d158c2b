// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/carmen_reader.hpp"

#include "common/errors/setup_error.hpp"
#include "common/messages/codec.hpp"
#include "import_files.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr CarmenBeams kFourBeams{-1.0, 0.5};

CarmenOptions four_beams() {
  CarmenOptions options{};
  options.beams = kFourBeams;
  return options;
}

planar_lidar_t lidar_message(const ImportedScan& scan) {
  return decode<planar_lidar_t>(scan.message.payload).message.value();
}

ImportedLog read_text(const std::string& text, const CarmenOptions& options = four_beams()) {
  const auto file = write_file("log.clf", text);
  ImportReport report{file, AddressUnit::kLine};
  return read_carmen_log(file, options, report);
}

TEST(CarmenReader, ReadsTheHandMadeLog) {
  ImportReport report{"small.clf", AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(data_file("small.clf"), four_beams(), report);

  EXPECT_EQ(report.num_skipped(), 0);
  ASSERT_THAT(log.scans, SizeIs(3));
  EXPECT_EQ(to_us(log.scans[0].time), 10'000'001);
  const planar_lidar_t first = lidar_message(log.scans[0]);
  EXPECT_EQ(first.utime, 10'000'001);
  EXPECT_EQ(first.rad0, -1.0F);
  EXPECT_EQ(first.radstep, 0.5F);
  EXPECT_EQ(first.ranges[0], 1.0F);
  EXPECT_EQ(first.ranges[1], 2.0F);
  EXPECT_EQ(first.ranges[2], kInfinity) << "81.91 m = no return";
  EXPECT_TRUE(std::isnan(first.ranges[3])) << "0 m is no distance";
  EXPECT_EQ(lidar_message(log.scans[1]).ranges[2], kInfinity) << "the other codes, too";
  EXPECT_EQ(log.scans[1].longest_range_m, 3.0);
}

TEST(CarmenReader, AnUnusualNumberOfBeamsNeedsItsAnglesWhereNoWallShowsThem) {
  try {
    read_text("FLASER 4 1 1 1 1 0 0 0 0 0 0 1 host 1\n", {});
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), HasSubstr("4 beams"));
    EXPECT_THAT(error.what(), HasSubstr("--first-angle-deg and --angle-step-deg"));
  }
}

TEST(CarmenReader, WithAnAngleStepOnlyTheMiddleBeamPointsAhead) {
  CarmenOptions options{};
  options.beams.angle_step_rad = 0.5;

  const ImportedLog log = read_text("FLASER 5 1 1 1 1 1 0 0 0 0 0 0 1 host 1\n", options);

  EXPECT_NEAR(lidar_message(log.scans[0]).rad0, -1.0, 0.01) << "on whole degrees";
}

TEST(CarmenReader, OdometryComesFromTheScansLines) {
  ImportReport report{"small.clf", AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(data_file("small.clf"), four_beams(), report);

  ASSERT_THAT(log.odometry, SizeIs(3));
  EXPECT_EQ(log.odometry[1].time, log.scans[1].time);
  EXPECT_EQ(log.odometry[1].pose.x(), 1.0) << "the base, not the LiDAR";
  EXPECT_DOUBLE_EQ(path_length_m(log.odometry), 1.0);
}

TEST(CarmenReader, OdometryMayComeFromOdomLines) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  CarmenOptions options = four_beams();
  options.odometry = CarmenOdometrySource::kOdomLines;

  const ImportedLog log = read_carmen_log(data_file("small.clf"), options, report);

  ASSERT_THAT(log.odometry, SizeIs(4)) << "3 lines, and the last pose held to the last scan";
  EXPECT_EQ(to_us(log.odometry[0].time), 9'900'000);
  EXPECT_EQ(to_us(log.odometry[3].time), 12'000'000);
  EXPECT_EQ(log.odometry[3].pose.theta(), log.odometry[2].pose.theta());
  EXPECT_THAT(report.notes(), ::testing::Contains(HasSubstr("0.900 s before the last scan")));
}

TEST(CarmenReader, TheLidarsMountingIsItsPoseRelativeToTheRobots) {
  ImportReport report{"small.clf", AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(data_file("small.clf"), four_beams(), report);

  EXPECT_NEAR(log.robot.lidar.x_m, 0.25, 1e-6);
  EXPECT_NEAR(log.robot.lidar.y_m, 0.0, 1e-6);
  EXPECT_NEAR(log.robot.lidar.yaw_rad, 0.0, 1e-6);
  EXPECT_EQ(log.robot.lidar.num_beams, 4);
  EXPECT_EQ(log.robot.lidar.range_max_m, 81.83);
}

TEST(CarmenReader, ACorrectedLogHasNoMounting) {
  const auto file = write_file("corrected.clf",
                               "FLASER 4 1 1 1 1 5 0 0 0 0 0 1 h 0\n"
                               "FLASER 4 1 1 1 1 7 1 0 0 0 0 2 h 0\n");
  ImportReport report{file, AddressUnit::kLine};
  CarmenOptions options = four_beams();
  options.mounting.y_m = 0.5;

  const ImportedLog log = read_carmen_log(file, options, report);

  EXPECT_EQ(log.robot.lidar.x_m, 0.0);
  EXPECT_EQ(log.robot.lidar.y_m, 0.5) << "given by the user";
  EXPECT_THAT(report.notes(), ElementsAre(HasSubstr("changing amount")));
}

std::string scan_line(int num_beams, double time_s, double logger_time_s = 0.0) {
  std::vector<double> ranges_m;
  for (int i = 0; i < num_beams; ++i)
    ranges_m.push_back(i % 2 == 0 ? 2.0 : 1.95);  // equal ranges would be a code for "no return"
  return fmt::format("FLASER {} {} 0 0 0 0 0 0 {:.6f} host {:.6f}\n", num_beams,
                     fmt::join(ranges_m, " "), time_s, logger_time_s);
}

TEST(CarmenReader, MountingComesFromParametersWhereTheLinesHaveNone) {
  const std::string parameter = "PARAM robot_frontlaser_offset -0.04 1 host 0\n";
  EXPECT_EQ(read_text(parameter + scan_line(180, 1) + scan_line(180, 2)).robot.lidar.x_m, -0.04);
  EXPECT_EQ(read_text(scan_line(180, 1) + scan_line(180, 2)).robot.lidar.x_m, 0.0);
}

TEST(CarmenReader, AlternatingNumbersOfBeamsLoseNoScan) {
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += scan_line(180 + i % 2, 1.0 + i);
  const auto file = write_file("log.clf", text + scan_line(360, 30.0));
  ImportReport report{file, AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(file, {}, report);

  EXPECT_THAT(log.scans, SizeIs(20));
  EXPECT_EQ(log.robot.lidar.num_beams, 181);
  EXPECT_EQ(report.skipped_by_kind().at("changed beam count"), 1) << "a single one is garbled";
  EXPECT_THAT(report.notes(),
              ::testing::Contains(HasSubstr("180 (in 10 scans), 181 (in 10 scans)")));
}

TEST(CarmenReader, BurstsAndSlightDisorderLoseNoScan) {
  std::string text;
  for (int i = 0; i < 30; ++i)
    text += scan_line(180, 1.0 + i - i % 3) + scan_line(180, 0.9 + i - i % 3);
  const auto file = write_file("log.clf", text);
  ImportReport report{file, AddressUnit::kLine};
  CarmenOptions options{};
  options.stamps = CarmenStamps::kIpc;

  const ImportedLog log = read_carmen_log(file, options, report);

  EXPECT_THAT(log.scans, SizeIs(60));
  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_THAT(report.notes(), ::testing::Contains(HasSubstr("40 scans have the stamp of others")));
  EXPECT_THAT(report.notes(), ::testing::Contains(HasSubstr("put in order")));
}

TEST(CarmenReader, LoggerTimesAreUsedWhereIpcTimesStandStill) {
  std::string text;
  for (int i = 0; i < 10; ++i)
    text += scan_line(180, 7.0, 0.5 + i);

  const ImportedLog log = read_text(text);

  ASSERT_THAT(log.scans, SizeIs(10));
  EXPECT_EQ(to_us(log.scans[3].time), 3'500'000);
}

TEST(CarmenReader, TheRearLidarIsReadOnRequest) {
  CarmenOptions options = four_beams();
  options.lidar = CarmenLidar::kRear;

  const ImportedLog log = read_text(
      "FLASER 4 1 1 1 1 0 0 0 0 0 0 1 h 0\nRLASER 4 2 2 2 2 0 0 0 0 0 0 1.5 h 0\n", options);

  ASSERT_THAT(log.scans, SizeIs(1));
  EXPECT_EQ(lidar_message(log.scans[0]).ranges[0], 2.0F);
  EXPECT_DOUBLE_EQ(log.robot.lidar.yaw_rad, std::numbers::pi);
}

TEST(CarmenReader, TheMaximumRangeComesFromTheLineUnlessConfigured) {
  const std::string line =
      "ROBOTLASER1 0 0 2 1 20 0 0 3 1 19 20 0 0 0 0 0 0 0 0 0 0 0 0 1 host 0\n";
  EXPECT_EQ(read_text(line).robot.lidar.range_max_m, 20.0);
  EXPECT_EQ(lidar_message(read_text(line).scans[0]).ranges[2], kInfinity);

  CarmenOptions options{};
  options.range_max_m = 10.0;
  EXPECT_EQ(lidar_message(read_text(line, options).scans[0]).ranges[1], kInfinity);
}

TEST(CarmenReader, AGzipFileIsReadLikeThePlainLog) {
  const auto file = test_folder() / "small.clf.gz";
  const std::string text = read_file(data_file("small.clf"));
  gzFile gz = gzopen(file.c_str(), "wb");
  gzwrite(gz, text.data(), static_cast<unsigned>(text.size()));
  gzclose(gz);
  ImportReport report{file, AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(file, four_beams(), report);

  EXPECT_THAT(log.scans, SizeIs(3));
  EXPECT_EQ(report.num_skipped(), 0);
}

std::filesystem::path write_bzip2(const std::string& name, const std::string& text) {
  const auto file = test_folder() / name;
  BZFILE* bz = BZ2_bzopen(file.c_str(), "wb");
  std::string bytes = text;
  BZ2_bzwrite(bz, bytes.data(), static_cast<int>(bytes.size()));
  BZ2_bzclose(bz);
  return file;
}

TEST(CarmenReader, ABzip2FileOfSeveralStreamsIsReadWhole) {
  const std::string stream =
      read_file(write_bzip2("small.clf.bz2", read_file(data_file("small.clf"))));
  const std::string second =
      read_file(write_bzip2("second.bz2", "FLASER 4 1 1 1 1 0 0 0 0 0 0 99 host 0\n"));
  const auto file = write_file("both.clf", stream + second);
  ImportReport report{file, AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(file, four_beams(), report);

  EXPECT_THAT(log.scans, SizeIs(4));
  EXPECT_EQ(report.num_skipped(), 0);
}

TEST(CarmenReader, ATruncatedBzip2FileIsReadUpToTheDamageWhichIsReported) {
  const std::string stream =
      read_file(write_bzip2("small.clf.bz2", read_file(data_file("small.clf"))));
  const auto file = write_file("cut.clf.bz2", stream + stream.substr(0, stream.size() / 2));
  ImportReport report{file, AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(file, four_beams(), report);

  EXPECT_THAT(log.scans, SizeIs(3));
  EXPECT_EQ(report.skipped_by_kind().at("damaged file"), 1);
}

TEST(CarmenReader, TheCompleteLinesOfACutOffGzipFileAreRead) {
  const auto file = test_folder() / "whole.clf.gz";
  gzFile gz = gzopen(file.c_str(), "wb0");  // "stored": text lines keep their positions
  for (int second = 1; second <= 100; ++second) {
    const std::string line =
        "FLASER 4 1 1 1 1 0 0 0 0 0 0 " + std::to_string(second) + ".5 host 0\n";
    gzwrite(gz, line.data(), static_cast<unsigned>(line.size()));
  }
  gzclose(gz);
  const std::string bytes = read_file(file);
  const auto cut = write_file("cut.clf.gz", bytes.substr(0, bytes.size() / 2));
  ImportReport report{cut, AddressUnit::kLine};

  const ImportedLog log = read_carmen_log(cut, four_beams(), report);

  EXPECT_THAT(log.scans, SizeIs(::testing::AllOf(::testing::Ge(45U), ::testing::Le(55U))));
  EXPECT_EQ(report.skipped_by_kind().at("damaged file"), 1);
}

TEST(CarmenReader, BadLinesAreNamedCountedAndLeftOut) {
  ImportReport report{"bad.clf", AddressUnit::kLine};
  CarmenOptions options = four_beams();

  const ImportedLog log = read_carmen_log(data_file("bad.clf"), options, report);

  std::vector<std::int64_t> good_lines;
  for (const ImportedScan& scan : log.scans)
    good_lines.push_back(scan.at);
  // Of lines 7 (2 s) and 8 (1.5 s) one has to go.
  EXPECT_THAT(good_lines, ElementsAre(1, 4, 5, ::testing::AnyOf(7, 8), 9, 14));
  EXPECT_EQ(report.num_skipped(), 8);
  EXPECT_EQ(report.skipped_by_kind().at("changed beam count"), 1);
  EXPECT_EQ(report.skipped_by_kind().at("time out of order"), 1);
  EXPECT_THAT(report.messages(),
              ::testing::Contains("bad.clf:3: skipped: not a number: range 1 of 4 is \"x\""));
}

TEST(CarmenReader, RangesThatAreNotInMetresAreRefusedUnlessTheirUnitIsGiven) {
  std::string text;
  for (int i = 1; i <= 3; ++i)
    text += "FLASER 4 412 390 380 512 0 0 0 0 0 0 " + std::to_string(i) + " h 0\n";
  const auto file = write_file("log.clf", text);
  ImportReport report{file, AddressUnit::kLine};
  CarmenOptions options = four_beams();
  EXPECT_THROW(read_carmen_log(file, options, report), SetupError);
  options.range_unit_m = 0.01;
  EXPECT_NEAR(scan_of(read_carmen_log(file, options, report).scans.front()).ranges_m[0], 4.12,
              1e-5);
}

TEST(CarmenReader, ATimeOfAnotherYearLosesItsOwnScanOnly) {
  std::string text = "FLASER 4 1 1 1 1 0 0 0 0 0 0 0 h 0\n";
  for (int i = 1; i <= 5; ++i)
    text += "FLASER 4 1 1 1 1 0 0 0 0 0 0 100000000" + std::to_string(i) + " h 0\n";
  const auto file = write_file("log.clf", text);
  ImportReport report{file, AddressUnit::kLine};
  EXPECT_THAT(read_carmen_log(file, four_beams(), report).scans, SizeIs(5));
  EXPECT_EQ(report.skipped_by_kind().at("bad time"), 1);
}

TEST(CarmenReader, AssumedAnglesAreReported) {
  const auto file = write_file("log.clf", scan_line(180, 1.0) + scan_line(180, 2.0));
  ImportReport report{file, AddressUnit::kLine};
  read_carmen_log(file, {}, report);
  EXPECT_THAT(report.notes(), ::testing::Contains(HasSubstr("180 beams of 1 degrees from -90")));
}

TEST(CarmenReader, OnlyTheFirstTenOfAKindAreNamed) {
  std::string text = "FLASER 4 1 1 1 1 0 0 0 0 0 0 1 h 0\n";
  for (int i = 0; i < 25; ++i)
    text += "garbage\n";
  const auto file = write_file("log.clf", text);
  ImportReport report{file, AddressUnit::kLine};

  read_carmen_log(file, four_beams(), report);

  EXPECT_EQ(report.num_skipped(), 25);
  EXPECT_THAT(report.messages(), SizeIs(11));
  EXPECT_THAT(report.messages().back(), HasSubstr("only counted"));
}

TEST(CarmenReader, WithoutScansThereIsAClearSentence) {
  EXPECT_THROW(read_text(""), SetupError);
  EXPECT_THROW(read_text("\n"), SetupError);
  EXPECT_THROW(read_text("ODOM 0 0 0 0 0 0 1 h 0\n"), SetupError);
  EXPECT_THROW(read_text(scan_line(180, 1.0) + scan_line(180, 1.0)), SetupError) << "no times";
  ImportReport report{"none.clf", AddressUnit::kLine};
  EXPECT_THROW(read_carmen_log("/nowhere/none.clf", {}, report), SetupError);
  try {
    read_text("RLASER 4 1 1 1 1 0 0 0 0 0 0 1 h 0\n");
    ADD_FAILURE() << "a log without front scans was accepted";
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(),
                 "no LiDAR scan could be read; the log holds rear scans 1: give --lidar rear");
  }
}

}  // namespace
}  // namespace waymark
