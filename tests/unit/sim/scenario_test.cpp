// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/scenario.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace waymark {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string error_of(const std::vector<std::string>& overrides) {
  try {
    load_config<Scenario>({{}, overrides});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Scenario, DefaultsAreValid) {
  EXPECT_EQ(error_of({}), "no error");
}

TEST(Scenario, AllShippedFilesAreValid) {
  const std::filesystem::path folder =
      std::filesystem::path{WAYMARK_SOURCE_DIR} / "deploy" / "scenarios";
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{folder}) {
    if (entry.is_directory()) continue;
    EXPECT_NO_THROW(load_config<Scenario>({{entry.path()}, {}})) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(Scenario, TheShippedDefaultCorridorIsTheDefault) {
  const std::filesystem::path file =
      std::filesystem::path{WAYMARK_SOURCE_DIR} / "deploy/scenarios/corridor.toml";
  Scenario shipped = load_config<Scenario>({{file}, {}});
  shipped.expect = {};  // the default scenario has no expectations
  EXPECT_EQ(dump_config(shipped), dump_config(Scenario{}));
}

TEST(Scenario, EveryHardScenarioHasExpectations) {
  const std::filesystem::path folder =
      std::filesystem::path{WAYMARK_SOURCE_DIR} / "deploy" / "scenarios" / "hard";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    const auto scenario = load_config<Scenario>({{entry.path()}, {}});
    EXPECT_GT(scenario.expect.ate_origin_m + scenario.expect.found_again_s, 0.0) << entry.path();
    EXPECT_EQ(scenario.expect.estimator, "waymark");
    ++count;
  }
  EXPECT_GE(count, 40);
}

TEST(Scenario, ACorridorShorterThanTheRobotIsOneError) {
  const std::string error = error_of({"world.length_m=0.2"});
  EXPECT_THAT(error, HasSubstr("world.length_m: got 0.2, expected more than the robot's length"));
  EXPECT_THAT(error, Not(HasSubstr("\n")));
}

TEST(Scenario, MarkersMustHangInsideTheWalls) {
  EXPECT_THAT(error_of({"markers.last_m=49.9"}), HasSubstr("within the walls"));
  EXPECT_THAT(error_of({"markers.first_m=0.1"}), HasSubstr("within the walls"));
  EXPECT_THAT(error_of({"markers.spacing_m=0.5"}), HasSubstr("markers.spacing_m"));
  EXPECT_THAT(error_of({"markers.centre_height_m=0.2"}), HasSubstr("markers.centre_height_m"));
  EXPECT_EQ(error_of({"markers.layout=none", "markers.last_m=99"}), "no error");
}

TEST(Scenario, MarkerIdsMustBeInTheDictionaryAndAsManyAsMarkers) {
  EXPECT_THAT(error_of({"markers.first_id=240"}),
              HasSubstr("markers.first_id: marker id 250 is not in DICT_6X6_250"));
  EXPECT_THAT(error_of({"robot.markers.dictionary=DICT_9X9"}), HasSubstr("got 'DICT_9X9'"));
  EXPECT_THAT(error_of({"markers.ids=[1, 2]"}), HasSubstr("expected one for each of the 24"));
}

TEST(Scenario, AddedMarkersNeedFreeWallBehindThem) {
  EXPECT_EQ(error_of({"markers.added=[{id=99, x_m=50.0, y_m=0.2}]"}), "no error");
  EXPECT_EQ(error_of({"markers.layout=none", "markers.added=[{id=9, x_m=9.0, y_m=0.9}]"}),
            "no error");
  EXPECT_THAT(error_of({"markers.added=[{id=99, x_m=30.0, y_m=0.0}]"}),
              HasSubstr("no wall with room for a plate of"));
  EXPECT_THAT(error_of({"markers.added=[{id=99, x_m=4.5, y_m=1.0}]"}),
              HasSubstr("markers.added[0]: another marker hangs there"));
  EXPECT_THAT(error_of({"world.layout=L", "markers.added=[{id=99, x_m=48.0, y_m=7.0}]"}),
              HasSubstr("markers.added[0]: another marker hangs there"));
  EXPECT_THAT(error_of({"markers.added=[{id=250, x_m=50.0}]"}),
              HasSubstr("marker id 250 is not in DICT_6X6_250"));
}

TEST(Scenario, TheRouteMustKeepClearOfTheWalls) {
  EXPECT_THAT(error_of({"route.start_x_m=0.05"}), HasSubstr("route.start"));
  EXPECT_THAT(error_of({"route.start_y_m=1.0"}), HasSubstr("route.start"));
  EXPECT_THAT(error_of({"route.end_x_m=51"}), HasSubstr("route.end_x_m"));
}

TEST(Scenario, WhereTheRobotTurnsItNeedsMoreRoomThanWhereItDrives) {
  const auto along_the_wall_at = [](double y_m) {
    return error_of(
        {fmt::format("route.waypoints=[{{x_m=3.0, y_m={}}}, {{x_m=3.0, y_m=0.0}}]", y_m),
         "markers.layout=none"});
  };
  EXPECT_EQ(along_the_wall_at(0.80), "no error");
  EXPECT_THAT(
      along_the_wall_at(0.83),
      HasSubstr("route.waypoints: (3.00, 0.83) is 0.17 m from a wall or box, expected 0.20"));
  EXPECT_EQ(error_of({"route.start_y_m=0.7", "route.waypoints=[{x_m=9.0, y_m=0.83}]"}), "no error");
}

TEST(Scenario, WidelySpacedWheelsNeedMoreRoom) {
  const std::string beside_the_wall = "route.start_y_m=0.75";
  EXPECT_EQ(error_of({beside_the_wall}), "no error");
  EXPECT_THAT(error_of({beside_the_wall, "robot.base.wheel_separation_m=0.6"}),
              HasSubstr("expected 0.32 m of room"));
  EXPECT_THAT(error_of({"world.width_m=0.5", "robot.base.wheel_separation_m=0.6"}),
              HasSubstr("world.width_m"));
}

TEST(Scenario, RouteAndKidnapTargetsMustBeClearOfWallsAndBoxes) {
  EXPECT_THAT(error_of({"world.boxes=[{x_m=20.0, y_m=0.3}]"}), HasSubstr("from a wall or box"));
  EXPECT_THAT(error_of({"world.layout=L", "kidnaps=[{at_m=3.0, to_x_m=20.0, to_y_m=10.0}]"}),
              HasSubstr("outside of the walls"));
  EXPECT_THAT(error_of({"kidnaps=[{at_m=3.0, to_x_m=60.0}]"}), HasSubstr("kidnaps[0]"));
}

TEST(Scenario, ImpossibleEventsAreErrors) {
  EXPECT_THAT(error_of({"kidnaps=[{to_x_m=9.0}]"}), HasSubstr("expected an at_s or at_m"));
  EXPECT_THAT(error_of({"markers.missing=[24]"}), HasSubstr("there is no place 24"));
  EXPECT_THAT(error_of({"markers.missing=[3]", "markers.moved=[{place=3, at_m=5.0, dx_m=1.0}]"}),
              HasSubstr("no marker that could be moved"));
  EXPECT_THAT(error_of({"markers.moved=[{place=3, at_m=5.0, dy_m=1.0}]"}),
              HasSubstr("would not hang on its wall"));
  EXPECT_THAT(error_of({"faults=[{kind='delayed'}]"}), HasSubstr("expected a delay_s above 0"));
  EXPECT_THAT(error_of({"faults=[{from_s=3.0, to_s=2.0}]"}), HasSubstr("ends before it begins"));
  EXPECT_THAT(error_of({"faults=[{wheel='left'}]"}), HasSubstr("a wheel can only"));
}

TEST(Scenario, EventsByDistanceNeedARoute) {
  const auto by_command = [](const std::string& event) {
    return error_of({"route.source=command", "route.duration_s=60", event});
  };
  EXPECT_EQ(by_command("faults=[{from_s=12.0, to_s=80.0}]"), "no error");
  EXPECT_THAT(by_command("faults=[{from_m=1.0}]"), HasSubstr("command has no route"));
  EXPECT_THAT(by_command("faults=[{to_m=1.0}]"), HasSubstr("command has no route"));
  EXPECT_THAT(by_command("kidnaps=[{at_m=1.0, to_x_m=20.0}]"), HasSubstr("command has no route"));
}

TEST(Scenario, ConfiguredOdometryScalesAreRefusedWhileTheSeedDrawsThem) {
  EXPECT_THAT(error_of({"odometry_errors.scale=0.05"}),
              HasSubstr("odometry_errors.scale: got 0.05, which odometry_errors.draw_from_seed"));
  EXPECT_THAT(error_of({"odometry_errors.heading_scale=0.1"}), HasSubstr("heading_scale: got 0.1"));
  EXPECT_EQ(error_of({"odometry_errors.scale=0.05", "odometry_errors.draw_from_seed=false"}),
            "no error");
}

TEST(Scenario, WallsMustNotReachIntoRecesses) {
  EXPECT_THAT(error_of({"world.openings=[{centre_m=6.0, width_m=1.0, depth_m=0.5}, {centre_m=7.05, "
                        "width_m=1.0, depth_m=0.5}]"}),
              HasSubstr("world.wall_thickness_m: got 0.1, by which a wall reaches"));
}

TEST(Scenario, SensorsMustFitThePhysicsSteps) {
  EXPECT_THAT(error_of({"robot.camera.rate_hz=7"}), HasSubstr("robot.camera.rate_hz"));
  EXPECT_THAT(error_of({"run.tick_s=0.0123"}), HasSubstr("run.tick_s"));
}

TEST(Scenario, CommandsNeedADelayBeyondTheLockstepWindowAndADuration) {
  EXPECT_THAT(
      error_of({"route.source=command", "route.duration_s=5", "route.command_delay_ticks=2"}),
      HasSubstr("route.command_delay_ticks"));
  EXPECT_THAT(error_of({"route.source=command"}), HasSubstr("route.duration_s"));
}

}  // namespace
}  // namespace waymark
