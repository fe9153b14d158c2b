// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/carmen_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kExact = 1e-12;

template <class Content>
Content parse(const std::string& line, const CarmenBeams& beams = {}) {
  const CarmenLine parsed = parse_carmen_line(line, beams);
  EXPECT_TRUE(std::holds_alternative<Content>(parsed)) << line;
  const auto* content = std::get_if<Content>(&parsed);
  return content == nullptr ? Content{} : *content;
}

std::string flaser(int num_beams, const std::string& keyword = "FLASER") {
  std::string line = keyword + " " + std::to_string(num_beams);
  for (int i = 0; i < num_beams; ++i)
    line += " 2.5";
  return line + " 1 2 0.5 3 4 0.25 100.25 host 0.75";
}

TEST(CarmenLine, OdomIsPoseAndIpcTime) {
  const auto odometry = parse<CarmenOdometry>("ODOM 1.5 -2 0.25 9 8 7 123.5 nohost 4.5\r");

  EXPECT_EQ(odometry.odom_from_base.x(), 1.5);
  EXPECT_EQ(odometry.odom_from_base.y(), -2.0);
  EXPECT_EQ(odometry.odom_from_base.theta(), 0.25);
  EXPECT_EQ(odometry.time_s, 123.5);
}

TEST(CarmenLine, FlaserHasTheLidarsPoseBeforeTheRobots) {
  const auto scan = parse<CarmenScan>(flaser(180));

  EXPECT_EQ(scan.lidar, CarmenLidar::kFront);
  EXPECT_EQ(scan.odom_from_lidar.x(), 1.0);
  EXPECT_EQ(scan.odom_from_lidar.theta(), 0.5);
  EXPECT_EQ(scan.odom_from_base.x(), 3.0);
  EXPECT_EQ(scan.odom_from_base.y(), 4.0);
  EXPECT_EQ(scan.odom_from_base.theta(), 0.25);
  EXPECT_EQ(scan.time_s, 100.25);
  EXPECT_EQ(scan.logger_time_s, 0.75);
  EXPECT_FALSE(scan.range_max_m);
}

TEST(CarmenLine, FlaserHasNoAngles) {
  EXPECT_FALSE(parse<CarmenScan>(flaser(4)).angles);
  EXPECT_EQ(parse<CarmenScan>(flaser(4, "RLASER")).lidar, CarmenLidar::kRear);
}

TEST(CarmenLine, RobotLaserDefinesItsOwnBeams) {
  const auto scan = parse<CarmenScan>(
      "ROBOTLASER1 0 -1.570796 3.141593 1.570796 20 0.01 1 3 1 2 50 2 7 8 "
      "1 2 0.5 3 4 0.25 9 9 9 9 9 100.25 host 0.75");

  EXPECT_THAT(scan.ranges_m, ElementsAre(1.0, 2.0, 50.0));
  EXPECT_EQ(scan.angles->first_rad, -1.570796);
  EXPECT_EQ(scan.angles->step_rad, 1.570796);
  EXPECT_EQ(scan.range_max_m, 20.0);
  EXPECT_EQ(scan.odom_from_lidar.x(), 1.0);
  EXPECT_EQ(scan.odom_from_base.x(), 3.0);
  EXPECT_EQ(scan.time_s, 100.25);
}

TEST(CarmenLine, WithoutResolutionTheFieldOfViewGivesTheStep) {
  const auto scan =
      parse<CarmenScan>("ROBOTLASER1 0 -1 2 0 20 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 host 0");

  EXPECT_EQ(scan.angles->step_rad, 1.0);
}

TEST(CarmenLine, GivenAnglesOverrideAHeaderThatIsWrong) {
  const std::string line = "ROBOTLASER1 0 -1 9 4.5 0 0 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 host 0";
  EXPECT_THAT(parse<LineProblem>(line).kind, "contradictory header");

  const auto scan = parse<CarmenScan>(line, {0.25, 0.5});

  EXPECT_EQ(scan.angles->first_rad, 0.25);
  EXPECT_EQ(scan.angles->step_rad, 0.5);
  EXPECT_FALSE(scan.range_max_m) << "0 is none";
}

TEST(CarmenLine, ParametersSayWhereTheLidarsAreMounted) {
  const auto front = parse<CarmenMounting>("PARAM robot_frontlaser_offset -0.04 107.5 host 107.5");
  EXPECT_EQ(front.lidar, CarmenLidar::kFront);
  EXPECT_EQ(front.what, CarmenMounting::What::kForward);
  EXPECT_EQ(front.value, -0.04);
  const auto rear = parse<CarmenMounting>("PARAM robot_rearlaser_angular_offset 3.14 nohost 0");
  EXPECT_EQ(rear.lidar, CarmenLidar::kRear);
  EXPECT_EQ(rear.what, CarmenMounting::What::kAngle);
  EXPECT_EQ(parse<CarmenMounting>("PARAM robot_frontlaser_side_offset 0.1 h 0").what,
            CarmenMounting::What::kSideward);
  EXPECT_THAT(parse<LineProblem>("PARAM robot_frontlaser_offset ten h 0").kind, "not a number");
  EXPECT_THAT(parse<LineProblem>("PARAM robot_frontlaser_offset 11 h 0").kind,
              "number out of range");
  EXPECT_EQ(parse<CarmenOther>("RAWLASER1 0").keyword, "RAWLASER1");
}

TEST(CarmenLine, OtherSensorsCommentsAndBlankLinesAreIgnored) {
  for (const char* line : {"", "  \r", "# FLASER", "  # FLASER", "PARAM a b c", "NMEAGGA 1 2",
                           "PARAM robot_frontlaser_use yes"})
    parse<CarmenOther>(line);
}

TEST(CarmenLine, KeywordsOfFurtherLidarsAndOfArmsAreKnown) {
  for (const char* keyword : {"ROBOTLASER3", "ROBOTLASER4", "ROBOTLASER5", "ARM"})
    EXPECT_EQ(parse<CarmenOther>(std::string{keyword} + " 0 1 2").keyword, keyword);
}

TEST(CarmenLine, UtmCoordinatesAreRead) {
  EXPECT_EQ(parse<CarmenOdometry>("ODOM 500000 5400000 0 0 0 0 1 h 1").odom_from_base.y(), 5.4e6);
}

struct BadLine {
  std::string line;
  std::string kind;
  std::string detail;
};

TEST(CarmenLine, AnInvalidRangeInvalidatesItsBeamOnly) {
  const auto scan = parse<CarmenScan>("FLASER 3 1 NaN -0.5 0 0 0 0 0 0 1 host 0", {0.0, 0.1});
  EXPECT_EQ(scan.num_no_ranges, 2);
  EXPECT_EQ(scan.ranges_m[0], 1.0);
  EXPECT_TRUE(std::isnan(scan.ranges_m[1]));
  EXPECT_TRUE(std::isnan(scan.ranges_m[2]));
}

TEST(CarmenLine, BadLinesAreExplained) {
  const std::string tail = " 0 0 0 0 0 0 1 host 0";
  const std::vector<BadLine> lines{
      {"FLASER", "missing field", "the number of ranges"},
      {"FLASER 2 1", "missing field", "range 1 of 2"},
      {"FLASER 2 1 1 0 0 0 0 0 0 1 host", "missing field", "logger_timestamp"},
      {"FLASER -1" + tail, "number out of range", "-1"},
      {"FLASER 2000000000 1" + tail, "number out of range", "2000000000"},
      {"FLASER 1.5 1" + tail, "not a number", "1.5"},
      {"FLASER 2 1 1e" + tail, "not a number", "range 1 of 2"},
      {"FLASER 2 1 1e999" + tail, "not a number", "1e999"},
      {"FLASER 2 1 1 5" + tail, "not a number", "host"},
      {"FLASER 2 1 1" + tail + " 3", "surplus fields", "3"},
      {"FLASER 2 1 1 0 0 0 0 0 0 -1 host 0", "bad time", "-1"},
      {"FLASER 2 1 1 0 0 0 1e9 0 0 1 host 0", "number out of range", "odometry pose"},
      {"FLASER 2 1 1 0 0 0 inf 0 0 1 host 0", "not finite", "odometry pose"},
      {"ROBOTLASER1 0 -1 2 0.1 20 0 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 host 0",
       "contradictory header", "3 beams"},
      {"ROBOTLASER1 0 -1 9 4.5 20 0 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 host 0",
       "contradictory header", "field of view 9"},
      {"\x01\x02\xff", "unknown line", "???"},
  };
  for (const BadLine& bad : lines) {
    const bool has_header = bad.line.starts_with("ROBOTLASER");
    const auto problem =
        parse<LineProblem>(bad.line, has_header ? CarmenBeams{} : CarmenBeams{0.0, 0.1});
    EXPECT_EQ(problem.kind, bad.kind) << bad.line;
    EXPECT_THAT(problem.detail, HasSubstr(bad.detail)) << bad.line;
  }
}

}  // namespace
}  // namespace waymark
