// SPDX-License-Identifier: BSD-3-Clause
// Logs with intact lines of unusual meaning: other units, other times, two LiDARs.
#include "common/errors/setup_error.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "import_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

/// One scan of a drive, at 5 Hz.
struct Line {
  double x_m{0.0};
  double heading{0.0};
  double lidar_yaw_rad{0.0};
  std::string times{};
};

std::string text_of(const Line& line) {
  return fmt::format("FLASER 4 1 2 3 4 {} 0 {} {} 0 {}{}\n", line.x_m,
                     line.heading + line.lidar_yaw_rad, line.x_m, line.heading, line.times);
}

/// Forty scans; `change` modifies each by its number.
std::string forty(const std::function<void(int, Line&)>& change) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    Line line{0.1 * i, 0.0, 0.0, fmt::format(" {:.1f} host {:.1f}", 100.0 + 0.2 * i, 0.2 * i)};
    change(i, line);
    text += text_of(line);
  }
  return text;
}

struct ReadLog {
  ImportedLog log{};
  ImportReport report{"log.clf", AddressUnit::kLine};
};

ReadLog read_lines(const std::string& text, CarmenOptions options = {}) {
  options.beams = {-1.0, 0.5};
  ReadLog result{};
  result.log = read_carmen_log(write_file("log.clf", text), options, result.report);
  return result;
}

std::string with_times(const std::function<std::string(double)>& times_at) {
  return forty([&](int i, Line& line) { line.times = times_at(0.2 * i); });
}

TEST(OddLines, OlderLoggersWithoutHostOrWithOneTimeAreRead) {
  const auto no_host =
      read_lines(with_times([](double t) { return fmt::format(" {:.1f} {:.1f}", 100.0 + t, t); }));
  EXPECT_THAT(no_host.log.scans, SizeIs(40));
  EXPECT_EQ(to_us(no_host.log.scans[1].time), 100'200'000);
  EXPECT_THAT(no_host.report.notes(), Contains(HasSubstr("no ipc_hostname")));
  const auto one =
      read_lines(with_times([](double t) { return fmt::format(" {:.1f}", 100.0 + t); }));
  EXPECT_EQ(to_us(one.log.scans[39].time), 107'800'000);
}

TEST(OddLines, ALineThatIsCutOffInItsTimesIsLeftOut) {
  const auto read = read_lines(forty([](int i, Line& line) {
    if (i == 39) line.times = " 10";
  }));
  EXPECT_THAT(read.log.scans, SizeIs(39));
  EXPECT_EQ(read.report.skipped_by_kind().at("missing field"), 1);
}

TEST(OddLines, LinesWithoutTimesNeedAPeriod) {
  const std::string text = with_times([](double) { return ""; });
  EXPECT_THAT([&] { read_lines(text); }, ThrowsMessage<SetupError>(HasSubstr("--scan-period-s")));
  const auto read = read_lines(text, {.scan_period_s = 0.25});
  EXPECT_THAT(read.log.scans, SizeIs(40));
  EXPECT_EQ(to_us(read.log.scans[4].time), 1'000'000);
}

TEST(OddLines, TimesInMillisecondsAreNamedAndRead) {
  const auto in_ms = [](double start_s) {
    return with_times(
        [=](double t) { return fmt::format(" {:.0f} host {:.0f}", 1e3 * (start_s + t), 1e3 * t); });
  };
  EXPECT_THAT([&] { read_lines(in_ms(1e9)); },
              ThrowsMessage<SetupError>(HasSubstr("--time-unit ms")));
  EXPECT_THAT(read_lines(in_ms(5.0)).report.notes(), Contains(HasSubstr("--time-unit ms")));
  const auto read = read_lines(in_ms(1e9), {.units = {.time_s = 1e-3}});
  EXPECT_EQ(read.log.scans[1].time - read.log.scans[0].time, Duration{200'000});
}

TEST(OddLines, AClockThatIsSetBackCostsNoScan) {
  const auto read = read_lines(forty([](int i, Line& line) {
    const double t = 5000.0 + 0.2 * i - (i < 25 ? 0.0 : 3600.0);
    line.times = fmt::format(" {:.1f} host {:.1f}", t, t);
  }));
  EXPECT_THAT(read.log.scans, SizeIs(40));
  EXPECT_EQ(read.report.num_skipped(), 0);
  EXPECT_EQ(read.log.scans[25].time - read.log.scans[24].time, Duration{200'000});
  EXPECT_THAT(read.report.notes(),
              Contains(HasSubstr("the clock was set back by 3600.0 s at line 26")));
}

TEST(OddLines, LinesInAnotherOrderAreSorted) {
  const auto read = read_lines(forty([](int i, Line& line) {
    const double t = 0.2 * (39 - i);
    line.times = fmt::format(" {:.1f} host {:.1f}", 100.0 + t, t);
  }));
  EXPECT_THAT(read.log.scans, SizeIs(40));
  EXPECT_EQ(read.log.odometry.front().pose.x(), 0.1 * 39);
  EXPECT_THAT(read.report.notes(), Contains(HasSubstr("all were sorted by time")));
}

TEST(OddLines, HeadingsInDegreesAreRefusedUnlessTheirUnitIsGiven) {
  std::string text;
  double x_m = 0.0;
  double y_m = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double heading_deg = 2.0 * i;
    text += fmt::format("FLASER 4 1 2 3 4 {0} {1} {2} {0} {1} {2} {3:.1f} host {3:.1f}\n", x_m, y_m,
                        heading_deg, 0.2 * i);
    x_m += 0.1 * std::cos(radians(heading_deg + 1.0));
    y_m += 0.1 * std::sin(radians(heading_deg + 1.0));
  }
  EXPECT_THAT([&] { read_lines(text); },
              ThrowsMessage<SetupError>(HasSubstr("--heading-unit deg")));
  const auto read = read_lines(text, {.units = {.odometry_rad = radians(1.0)}});
  EXPECT_NEAR(read.log.odometry[45].pose.theta(), radians(90.0), 1e-9);
}

TEST(OddLines, OfTwoLidarsUnderOneKeywordOneIsImported) {
  const auto read = read_lines(forty([](int i, Line& line) {
    line.x_m = 0.1 * (i / 2);
    line.lidar_yaw_rad = i % 2 == 0 ? 0.0 : 3.0;
  }));
  EXPECT_THAT(read.log.scans, SizeIs(20));
  EXPECT_EQ(read.log.robot.lidar.yaw_rad, 0.0);
  EXPECT_THAT(read.report.notes(), Contains(HasSubstr("two LiDARs under one keyword")));
}

TEST(OddLines, OdometryIsThatOfTheOdomLinesWhereTheScansHaveNone) {
  std::string text = forty([](int, Line& line) { line.x_m = 0.0; });
  for (int i = 0; i < 40; ++i)
    text +=
        fmt::format("ODOM {} 0 0 0 0 0 {:.1f} host {:.1f}\n", 0.1 * i, 100.0 + 0.2 * i, 0.2 * i);
  const auto read = read_lines(text);
  EXPECT_NEAR(path_length_m(read.log.odometry), 3.9, 1e-9);
  EXPECT_THAT(read.report.notes(), Contains(HasSubstr("ODOM lines does: the latter is taken")));
  const auto laser = read_lines(text, {.odometry = CarmenOdometrySource::kLaserLines});
  EXPECT_EQ(path_length_m(laser.log.odometry), 0.0);
}

TEST(OddLines, OdomLinesThatAreAskedForAndNotThereAreAnError) {
  const CarmenOptions odom{.odometry = CarmenOdometrySource::kOdomLines};
  const auto no_odom = ThrowsMessage<SetupError>(HasSubstr("the log has no ODOM line"));
  const std::string scans = forty([](int, Line&) {});
  EXPECT_THAT([&] { read_lines(scans, odom); }, no_odom);
  EXPECT_THAT([&] { read_lines(scans + "ODOM 9 0 0 0 0 0\n", odom); }, no_odom);

  const auto read = read_lines(scans + "ODOM 9 0 0 0 0 0\nODOM 9 0 0 0 0 0\n");
  EXPECT_THAT(read.report.notes(),
              Contains(HasSubstr("2 ODOM lines have no times, the first is line 41")));
}

/// Scans of a corridor 1.8 m wide, in whole centimetres.
std::string corridor_in_cm(const std::string& start, const std::string& end) {
  std::string text;
  for (int i = 0; i < 40; ++i)
    text +=
        fmt::format("{} 90 95 110 8191 {} {} 0 0 {} 0 0{} {:.1f} h {:.1f}\n", start, end, 0.1 * i,
                    0.1 * i, end.empty() ? "" : " 0 0 0 0 0", 100.0 + 0.2 * i, 0.2 * i);
  return text;
}

TEST(OddLines, RangesInWholeNumbersAreRefusedEvenIfPlausibleAsMetres) {
  EXPECT_THAT([] { read_lines(corridor_in_cm("FLASER 4", "")); },
              ThrowsMessage<SetupError>(
                  AllOf(HasSubstr("whole numbers, up to 8191"), HasSubstr("--range-unit"))));
  EXPECT_THAT(read_lines(corridor_in_cm("FLASER 4", ""), {.range_unit_m = 0.01}).log.scans,
              SizeIs(40));
}

TEST(OddLines, TheMaximumRangeHasTheRangesUnitUnlessItWouldBeTooShort) {
  for (const char* limit : {"4000", "40"}) {
    const std::string text =
        corridor_in_cm(fmt::format("ROBOTLASER1 0 -1 1.5 0.5 {} 0 0 4", limit), "0");
    const auto read = read_lines(text, {.range_unit_m = 0.01});
    EXPECT_NEAR(read.log.robot.lidar.range_max_m, 40.0, 1e-9) << limit;
  }
}

TEST(OddLines, EachNumberOfBeamsHasItsOwnAngles) {
  std::string text;
  for (int i = 0; i < 30; ++i) {
    const int num_beams = i % 3 == 0 ? 361 : i % 3 == 1 ? 181 : 180;
    std::vector<double> ranges_m;
    for (int beam = 0; beam < num_beams; ++beam)
      ranges_m.push_back(beam % 2 == 0 ? 2.0 : 1.95);
    text += fmt::format("FLASER {} {} {} 0 0 {} 0 0 {} h {}\n", num_beams, fmt::join(ranges_m, " "),
                        0.1 * i, 0.1 * i, 1.0 + i, i);
  }
  ImportReport report{"log.clf", AddressUnit::kLine};
  const ImportedLog log = read_carmen_log(write_file("log.clf", text), {}, report);
  ASSERT_THAT(log.scans, SizeIs(30));
  EXPECT_NEAR(degrees(scan_of(log.scans[0]).angles_rad.back()), 90.0, 1e-3) << "361 beams";
  EXPECT_NEAR(degrees(scan_of(log.scans[1]).angles_rad.back()), 90.0, 1e-3) << "181 beams";
  EXPECT_NEAR(degrees(scan_of(log.scans[2]).angles_rad.back()), 89.0, 1e-3) << "180 beams";
}

TEST(OddLines, ForRawLinesOfAnyLidarThereIsAdvice) {
  EXPECT_THAT([] { read_lines("RAWLASER3 0 0\n"); },
              ThrowsMessage<SetupError>(HasSubstr("write them as ROBOTLASER1")));
}

TEST(OddLines, AFolderIsNamedAsSuch) {
  ImportReport report{"log", AddressUnit::kLine};
  EXPECT_THAT([&] { read_carmen_log(test_folder(), {}, report); },
              ThrowsMessage<SetupError>(HasSubstr("is a folder")));
  EXPECT_THAT([&] { read_carmen_log("/dev/null", {}, report); },
              ThrowsMessage<SetupError>(HasSubstr("is no regular file")));
}

TEST(OddLines, ArchivesAreNamedWithWhatUnpacksThem) {
  EXPECT_THAT(
      [] { read_lines("PK\x03\x04 and so on"); },
      ThrowsMessage<SetupError>(HasSubstr("is a zip archive; unpack it first (unzip log.clf)")));
  EXPECT_THAT(
      [] {
        read_lines(
            "\xFD"
            "7zXZ and so on");
      },
      ThrowsMessage<SetupError>(HasSubstr("compressed by xz; unpack it first (unxz log.clf)")));
}

}  // namespace
}  // namespace waymark
