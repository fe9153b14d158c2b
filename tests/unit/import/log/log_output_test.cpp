// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/log_output.hpp"

#include "common/errors/setup_error.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "import_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::HasSubstr;

ImportedLog small_log(ImportReport& report) {
  CarmenOptions options{};
  options.beams = {-1.0, 0.5};
  options.odometry = CarmenOdometrySource::kOdomLines;
  return read_carmen_log(data_file("small.clf"), options, report);
}

TEST(LogOutput, EventsAreOrderedByTimeAndChannel) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  const auto out = test_folder() / "deeper" / "small.lcm";

  write_imported_log(small_log(report), report, out);

  LogReader reader{out};
  std::string order;
  while (const auto event = reader.next()) {
    order += event->channel + "@" + std::to_string(to_us(event->time)) + " ";
    EXPECT_EQ(event->time, time_of(event->payload));
  }
  EXPECT_EQ(order,
            "ODOMETRY@9900000 LIDAR@10000001 ODOMETRY@10500000 LIDAR@11000000 ODOMETRY@11100000 "
            "LIDAR@12000000 ODOMETRY@12000000 ");
  EXPECT_EQ(reader.skipped_bytes(), 0);
}

TEST(LogOutput, RobotFileIsAConfiguration) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  const auto folder = test_folder();

  write_imported_log(small_log(report), report, folder / "small.lcm");

  const auto config = load_config<RobotOnly>({{folder / "robot.toml"}, {}});
  EXPECT_NEAR(config.robot.lidar.x_m, 0.25, 1e-6);
  EXPECT_EQ(config.robot.lidar.num_beams, 4);
  EXPECT_EQ(config.robot.lidar.range_max_m, 81.83);
  EXPECT_NEAR(config.robot.lidar.rate_hz, 2.0 / 1.999999, 1e-9);
}

TEST(LogOutput, FindingsAreCommentsOfTheRobotFile) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  const ImportedLog log = small_log(report);
  report.note("ranges pile up at 50 m");

  write_imported_log(log, report, test_folder() / "small.lcm");

  EXPECT_THAT(read_file(test_folder() / "robot.toml"),
              HasSubstr("# import: ranges pile up at 50 m\n"));
  EXPECT_EQ(load_config<RobotOnly>({{test_folder() / "robot.toml"}, {}}).robot.lidar.num_beams, 4);
}

TEST(LogOutput, ReferenceIsATumFile) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  ImportedLog log = small_log(report);
  log.reference = {{timestamp_from_us(1'447'367'746'002'196), 0, {1.5, -2.0, radians(180.0)}}};
  const auto folder = test_folder();

  write_imported_log(log, report, folder / "small.lcm");

  EXPECT_EQ(read_file(folder / "reference.tum"),
            "1447367746.002196 1.500000 -2.000000 0 0 0 1.000000000 0.000000000\n");
}

TEST(LogOutput, AnInvalidRobotDescriptionIsRefusedBeforeAnythingIsWritten) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  ImportedLog log = small_log(report);
  log.robot.lidar.range_min_m = 100.0;
  const auto out = test_folder() / "never.lcm";

  EXPECT_THROW(write_imported_log(log, report, out), SetupError);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(LogOutput, WhatSlamWouldRefuseInRobotTomlIsRefused) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  ImportedLog log = small_log(report);
  log.robot.lidar.x_m = 7.0;
  const auto out = test_folder() / "never.lcm";

  EXPECT_THAT([&] { write_imported_log(log, report, out); },
              ::testing::ThrowsMessage<SetupError>(
                  ::testing::AllOf(HasSubstr("robot.toml:"), HasSubstr("robot.lidar.x_m: got 7"))));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(LogOutput, AnotherRobotsFileBesideTheLogIsNotReplaced) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  ImportedLog log = small_log(report);
  const auto out = test_folder() / "small.lcm";
  write_imported_log(log, report, out);
  write_imported_log(log, report, test_folder() / "again.lcm");
  const std::string robot = read_file(test_folder() / "robot.toml");

  log.robot.lidar.x_m = 0.5;
  EXPECT_THROW(write_imported_log(log, report, test_folder() / "other.lcm"), SetupError);
  EXPECT_EQ(read_file(test_folder() / "robot.toml"), robot);
  EXPECT_FALSE(std::filesystem::exists(test_folder() / "other.lcm"));
}

TEST(LogOutput, AnEarlierLogIsNotReplaced) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  const ImportedLog log = small_log(report);
  const auto out = write_file("small.lcm", "an hour of driving");
  try {
    write_imported_log(log, report, out);
    FAIL() << "it was replaced";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.what(), out.string() +
                                ": is there already; an import replaces no log: give --out "
                                "another name, or move it away");
  }
  EXPECT_EQ(read_file(out), "an hour of driving");
  EXPECT_FALSE(std::filesystem::exists(test_folder() / "robot.toml"));
}

TEST(LogOutput, SummaryCountsWhatWasImportedAndSkipped) {
  ImportReport report{"small.clf", AddressUnit::kLine};
  const ImportedLog log = small_log(report);
  report.skip("NaN", 3, "");

  const std::string text = summary(log, report);

  for (const char* part : {"front scans 3", "beams            4", "4 samples", "2.100 s",
                           "1.000 m (odometry)", "3.000 m", "81.830 m", "1, NaN 1"})
    EXPECT_THAT(text, HasSubstr(part));
}

}  // namespace
}  // namespace waymark
