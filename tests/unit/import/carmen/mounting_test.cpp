// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/mounting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using What = CarmenMounting::What;

constexpr CarmenLidar kFront = CarmenLidar::kFront;
constexpr CarmenLidar kRear = CarmenLidar::kRear;

/// A hundred lines with the same pose, but the first three garbled.
std::vector<Se2> lines(const Se2& base_from_lidar) {
  std::vector<Se2> poses(100, base_from_lidar);
  poses[0] = {90.0, 0.0, 1.0};
  poses[1] = {0.0, -70.0, 2.0};
  poses[2] = {5.0, 5.0, -1.0};
  return poses;
}

struct Found {
  Se2 mounting;
  std::vector<std::string> notes;
};

Found find(const std::vector<Se2>& poses, const std::vector<CarmenMounting>& parameters,
           CarmenLidar lidar = kFront) {
  ImportReport report{"log", AddressUnit::kLine};
  const Se2 mounting = find_mounting(poses, parameters, lidar, report);
  return {mounting, report.notes()};
}

void expect_is(const Se2& pose, double x_m, double y_m, double yaw_rad) {
  EXPECT_NEAR(pose.x(), x_m, 1e-9);
  EXPECT_NEAR(pose.y(), y_m, 1e-9);
  EXPECT_NEAR(pose.theta(), yaw_rad, 1e-9);
}

TEST(Mounting, IsThatOfTheMajorityOfLines) {
  const auto [mounting, notes] = find(lines({0.2, -0.1, 0.3}), {});
  expect_is(mounting, 0.2, -0.1, 0.3);
  EXPECT_THAT(notes, IsEmpty());
}

TEST(Mounting, YawsAroundHalfATurnAreAveraged) {
  std::vector<Se2> poses;
  for (int i = 0; i < 100; ++i)
    poses.emplace_back(0.1, 0.0, wrap_angle(radians(180.0) + (i % 2 == 0 ? 1e-4 : -1e-4)));
  const auto [mounting, notes] = find(poses, {});
  EXPECT_NEAR(angle_difference(mounting.theta(), radians(180.0)), 0.0, 2e-4);
  EXPECT_THAT(notes, IsEmpty());
}

TEST(Mounting, ComesFromParametersWhereTheLinesHaveNone) {
  const std::vector<CarmenMounting> parameters{{kFront, What::kForward, -0.04},
                                               {kFront, What::kSideward, 0.01},
                                               {kFront, What::kAngle, 0.02},
                                               {kRear, What::kForward, -0.5}};
  for (const std::vector<Se2>& poses :
       {lines({}), std::vector<Se2>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}) {
    const auto [mounting, notes] = find(poses, parameters);
    expect_is(mounting, -0.04, 0.01, 0.02);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("taken from the PARAM lines: x -0.040 m")));
  }
  expect_is(find(lines({}), parameters, kRear).mounting, -0.5, 0.0, 0.0);
}

TEST(Mounting, TheLastValueOfARepeatedParameterCounts) {
  expect_is(
      find(lines({}), {{kFront, What::kForward, 0.1}, {kFront, What::kForward, 0.2}}).mounting, 0.2,
      0.0, 0.0);
}

TEST(Mounting, LinesThatContradictTheParametersWinWithANote) {
  const auto [mounting, notes] = find(lines({0.2, 0, 0}), {{kFront, What::kForward, 0.1}});
  expect_is(mounting, 0.2, 0.0, 0.0);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("the PARAM lines x 0.100 m")));
  EXPECT_THAT(find(lines({0.2, 0, 0}), {{kFront, What::kForward, 0.205}}).notes, IsEmpty());
}

TEST(Mounting, AnUnknownMountingIsTheOriginWithANote) {
  EXPECT_THAT(find(lines({}), {}).notes, ElementsAre(HasSubstr("are equal")));
  const auto [mounting, notes] = find({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {});
  expect_is(mounting, 0.0, 0.0, 0.0);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("changing amount")));
}

}  // namespace
}  // namespace waymark
