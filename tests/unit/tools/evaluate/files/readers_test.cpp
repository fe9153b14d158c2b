// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/angle.hpp"
#include "evaluate/files/map_image.hpp"
#include "evaluate/files/tum.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kExact = 1e-12;
constexpr const char* kYaml =
    "image: map.pgm\nresolution: 0.05\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

std::string map_error(const std::string& yaml, const std::string& pgm) {
  const TemporaryFolder folder;
  folder.file("map.pgm", pgm);
  try {
    read_map(folder.file("map.yaml", yaml));
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no error";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(ReadMap, TheFirstRowOfTheImageIsTheTopOfTheMap) {
  const TemporaryFolder folder;
  folder.file("map.pgm",
              std::string{"P5\n# made by hand\n3 2\n255\n"} + "\xfe\xcd\x01" + "\x02\xfe\xfe");

  const MapImage map = read_map(folder.file("map.yaml", kYaml));

  EXPECT_EQ(map.resolution_m, 0.05);
  EXPECT_THAT(map.cells, ElementsAre(Cell::kOccupied, Cell::kFree, Cell::kFree, Cell::kFree,
                                     Cell::kUnknown, Cell::kOccupied));
  EXPECT_EQ(map.at(2, 1), Cell::kOccupied);
  EXPECT_EQ(map.at(3, 1), Cell::kUnknown);
  EXPECT_EQ(map.at(0, -1), Cell::kUnknown);
}

TEST(ReadMap, NegateSwapsBlackAndWhite) {
  const TemporaryFolder folder;
  folder.file("map.pgm", std::string{"P5 2 1 255\n"} + "\xfe\x01");
  const MapImage map = read_map(folder.file("map.yaml", replaced(kYaml, "negate: 0", "negate: 1")));
  EXPECT_THAT(map.cells, ElementsAre(Cell::kOccupied, Cell::kFree));
}

TEST(ReadMap, OccupancyAtAThresholdIsUnknown) {
  const TemporaryFolder folder;
  folder.file("map.pgm", std::string{"P5 2 1 255\n"} + "\xff" + std::string(1, '\0'));
  const std::string widest =
      replaced(replaced(kYaml, "occupied_thresh: 0.65", "occupied_thresh: 1"), "free_thresh: 0.196",
               "free_thresh: 0");
  const MapImage map = read_map(folder.file("map.yaml", widest));
  EXPECT_THAT(map.cells, ElementsAre(Cell::kUnknown, Cell::kUnknown));
}

TEST(ReadMap, ErrorsAreNamed) {
  const std::string pgm = "P5 1 1 255\nx";
  EXPECT_THAT(map_error(replaced(kYaml, "resolution: 0.05\n", ""), pgm),
              HasSubstr("map.yaml: key 'resolution' is missing"));
  EXPECT_THAT(map_error(replaced(kYaml, "0.05", "wide"), pgm),
              HasSubstr("map.yaml: resolution: got 'wide', expected a finite number"));
  EXPECT_THAT(map_error(replaced(kYaml, "0.05", "-0.05"), pgm), HasSubstr("above 0"));
  EXPECT_THAT(map_error(replaced(kYaml, "0.05", "nan"), pgm), HasSubstr("finite"));
  EXPECT_THAT(map_error(replaced(kYaml, "0.65", "0.1"), pgm), HasSubstr("free_thresh"));
  EXPECT_THAT(map_error("just text", pgm), HasSubstr("map.yaml:1: got 'just text'"));
  EXPECT_THAT(map_error(kYaml, "P2 1 1 255\n0"), HasSubstr("map.pgm: not a binary 8-bit PGM"));
  EXPECT_THAT(map_error(kYaml, "P5 9999999999 9999999999 255\n"), HasSubstr("not a binary"));
  EXPECT_THAT(map_error(kYaml, "P5 0 1 255\nx"), HasSubstr("not a binary"));
  EXPECT_THAT(map_error(kYaml, "P5 1 0 255\nx"), HasSubstr("not a binary"));
  EXPECT_THAT(map_error(kYaml, "P5 1 1 0\nx"), HasSubstr("not a binary"));
  EXPECT_THAT(map_error(kYaml, "P5 10 10 255\nabc"), HasSubstr("truncated: 3 of 100 pixels"));
  EXPECT_THAT(map_error(kYaml, "P5 10 10 255"), HasSubstr("truncated: 0 of 100 pixels"));
  EXPECT_THAT(map_error(kYaml, ""), HasSubstr("not a binary"));
  EXPECT_THAT(map_error(replaced(kYaml, "map.pgm", "other.pgm"), pgm),
              HasSubstr("other.pgm: cannot be read"));
}

TEST(ReadTum, YawIsThatOfTheQuaternion) {
  const TemporaryFolder folder;
  SkippedLines skipped;
  const Trajectory trajectory =
      read_tum(folder.file("a.tum",
                           "# t x y z qx qy qz qw\n1 2 3 0.1 0 0 0.5 0.8660254037844386\r\n\n"
                           "2,2,3,0,0,0,-1,0\n"),
               skipped);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].t_s, 1.0);
  EXPECT_EQ(trajectory[0].parent_from_base.x(), 2.0);
  EXPECT_NEAR(trajectory[0].parent_from_base.theta(), radians(60), kExact);
  EXPECT_NEAR(std::abs(trajectory[1].parent_from_base.theta()), radians(180), kExact);
  EXPECT_THAT(skipped, IsEmpty());
}

TEST(ReadTum, YawIsThatOfTheXAxisOfARobotThatIsTilted) {
  const TemporaryFolder folder;
  const Eigen::Quaterniond turned{Eigen::AngleAxisd{0.7, Eigen::Vector3d::UnitZ()} *
                                  Eigen::AngleAxisd{0.3, Eigen::Vector3d::UnitY()} *
                                  Eigen::AngleAxisd{0.4, Eigen::Vector3d::UnitX()}};
  SkippedLines skipped;
  const Trajectory trajectory =
      read_tum(folder.file("a.tum", fmt::format("1 0 0 0 {} {} {} {}\n", turned.x(), turned.y(),
                                                turned.z(), turned.w())),
               skipped);
  EXPECT_NEAR(trajectory.at(0).parent_from_base.theta(), 0.7, kExact);
}

TEST(ReadTum, BadLinesAreNamedAndLeftOut) {
  const TemporaryFolder folder;
  SkippedLines skipped;
  const Trajectory trajectory = read_tum(folder.file("a.tum",
                                                     "1 0 0 0 0 0 0 1\n"
                                                     "2 0 0 0 0 0 1\n"
                                                     "3 nan 0 0 0 0 0 1\n"
                                                     "1 0 0 0 0 0 0 1\n"
                                                     "4 0 0 0 0 0 0 0\n"
                                                     "5 0 0 0 0 0 0 1x\n"
                                                     "6 9 0 0 0 0 0 1\n"),
                                         skipped);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[1].parent_from_base.x(), 9.0);
  EXPECT_THAT(skipped, ElementsAre(HasSubstr("a.tum:2: got '2 0 0 0 0 0 1', expected 8"),
                                   HasSubstr("a.tum:3: got '3 nan"),
                                   HasSubstr("a.tum:4: time 1.000000 does not advance"),
                                   HasSubstr("a.tum:5: the quaternion"), HasSubstr("a.tum:6:")));
}

TEST(ReadTum, NoPoseIsAnError) {
  const TemporaryFolder folder;
  SkippedLines skipped;
  EXPECT_THROW(read_tum(folder.file("a.tum", "# nothing\n"), skipped), SetupError);
  EXPECT_THROW(read_tum(folder.path() / "none.tum", skipped), SetupError);
  EXPECT_THROW(read_tum(folder.path(), skipped), SetupError);
}

TEST(PoseAt, LiesBetweenTheNeighboursAndTurnsTheShortWay) {
  const Trajectory trajectory{{10.0, Se2{0, 0, radians(170)}}, {12.0, Se2{4, 2, radians(-170)}}};
  const auto middle = pose_at(trajectory, 10.5);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x(), 1.0, kExact);
  EXPECT_NEAR(middle->y(), 0.5, kExact);
  EXPECT_NEAR(middle->theta(), radians(175), kExact);
  EXPECT_EQ(pose_at(trajectory, 12.0)->x(), 4.0);
  EXPECT_EQ(pose_at(trajectory, 12.000001)->x(), 4.0);  // within the rounding of a file
  EXPECT_FALSE(pose_at(trajectory, 9.999));
  EXPECT_FALSE(pose_at(trajectory, 12.001));
}

TEST(ReadCsv, ColumnsAreFoundByName) {
  const TemporaryFolder folder;
  SkippedLines skipped;
  const CsvTable table =
      read_csv(folder.file("a.csv", "b,extra,a\n1,2,3\nx,2,3\n4,5\n6,7,8\n"), {"a", "b"}, skipped);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.at(table.rows[1], "a"), 8.0);
  EXPECT_EQ(table.at(table.rows[1], "b"), 6.0);
  EXPECT_THAT(skipped, ElementsAre(HasSubstr("a.csv:3"), HasSubstr("a.csv:4")));
  EXPECT_THROW(read_csv(folder.file("b.csv", "a\n1\n"), {"a", "b"}, skipped), SetupError);
  EXPECT_THROW(read_csv(folder.file("c.csv", ""), {"a"}, skipped), SetupError);
}

}  // namespace
}  // namespace waymark::evaluate
