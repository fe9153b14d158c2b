// SPDX-License-Identifier: BSD-3-Clause
#include "common/config/config.hpp"

#include "common/robot/robot_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace waymark {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Shelf {
  int books{1};
  int vases{2};

  void describe(Fields& fields) {
    fields.field("books", books, kNotNegative, "how many");
    fields.field("vases", vases, kNotNegative, "how many");
  }
};

struct Room {
  std::vector<Shelf> shelves{};
  int chairs{4};

  void describe(Fields& fields) {
    fields.list("shelves", shelves, "along the walls");
    fields.field("chairs", chairs, kNotNegative, "how many");
  }
};

std::string error_of(const ConfigSources& sources) {
  try {
    load_config<RobotOnly>(sources);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

std::filesystem::path file_with(const std::string& text) {
  // A folder per test: ctest runs them at the same time.
  const auto folder = std::filesystem::path{::testing::TempDir()} /
                      ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::filesystem::create_directories(folder);
  const auto path = folder / "config_test.toml";
  std::ofstream{path} << text;
  return path;
}

TEST(Config, DefaultsAreUsedWithoutASource) {
  EXPECT_EQ(load_config<RobotOnly>({}).robot.lidar.num_beams, 360);
}

TEST(Config, LaterSourcesWin) {
  const auto file = file_with("[robot.lidar]\nnum_beams = 90\nrate_hz = 7\n");

  const auto config = load_config<RobotOnly>({{file}, {"robot.lidar.num_beams=12"}});

  EXPECT_EQ(config.robot.lidar.num_beams, 12);
  EXPECT_EQ(config.robot.lidar.rate_hz, 7.0);
}

TEST(Config, ALaterListReplacesAnEarlierOne) {
  const auto file = file_with("[[shelves]]\nbooks = 30\nvases = 0\n[[shelves]]\nbooks = 40\n");

  const auto config = load_config<Room>({{file}, {"shelves=[{books = 50}]"}});

  ASSERT_EQ(config.shelves.size(), 1U);
  EXPECT_EQ(config.shelves[0].books, 50);
  EXPECT_EQ(config.shelves[0].vases, Shelf{}.vases);
}

TEST(Config, AListIsKeptWhenALaterSourceOmitsIt) {
  const auto file = file_with("[[shelves]]\nbooks = 30\n");

  const auto config = load_config<Room>({{file}, {"chairs=2"}});

  ASSERT_EQ(config.shelves.size(), 1U);
  EXPECT_EQ(config.shelves[0].books, 30);
}

TEST(Config, AllProblemsAreReportedWithTheirLines) {
  const auto file =
      file_with("[robot.lidar]\nnum_beam = 90\nrate_hz = \"fast\"\nrange_sigma_m = -1\n");

  const std::string error = error_of({{file}, {}});

  EXPECT_THAT(error,
              HasSubstr("config_test.toml:2: robot.lidar.num_beam: unknown key; did you mean "
                        "robot.lidar.num_beams?"));
  EXPECT_THAT(error,
              HasSubstr("config_test.toml:3: robot.lidar.rate_hz: got 'fast', expected a number"));
  EXPECT_THAT(
      error,
      HasSubstr(
          "config_test.toml:4: robot.lidar.range_sigma_m: got -1, expected a number above 0"));
}

TEST(Config, NumbersAreShownAsTheyWereWritten) {
  EXPECT_THAT(error_of({{}, {"robot.lidar.range_sigma_m=-0.4"}}), HasSubstr("got -0.4, expected"));
}

TEST(Config, SyntaxErrorsAndMissingFilesAreNamed) {
  EXPECT_THAT(error_of({{file_with("[robot\n")}, {}}), HasSubstr("config_test.toml:1: not TOML"));
  EXPECT_THAT(error_of({{file_with("[\x01")}, {}}), HasSubstr("config_test.toml:1: not TOML"));
  EXPECT_THAT(error_of({{file_with("\u00e9 = 1\n")}, {}}),
              HasSubstr("config_test.toml:1: not TOML"));
  EXPECT_THAT(error_of({{"/no/such.toml"}, {}}),
              HasSubstr("/no/such.toml: cannot be read: there is no such file"));
  EXPECT_THAT(error_of({{::testing::TempDir()}, {}}), HasSubstr("cannot be read: it is a folder"));
}

// Not even root can examine a link to itself, and other users cannot examine a file in a folder
// without permission.
TEST(Config, AFileThatCannotBeExaminedIsNamed) {
  const std::filesystem::path link = file_with("").parent_path() / "link.toml";
  std::filesystem::remove(link);
  std::filesystem::create_symlink(link, link);
  EXPECT_THAT(error_of({{link}, {}}), HasSubstr("link.toml: cannot be read: no permission"));
}

TEST(Config, OnePartOfAConfigurationMayBeReadWithoutTheOthers) {
  const auto file = file_with("[other]\nkey = 1\n[robot.base]\nwheel_radius_m = 0.1\n");
  EXPECT_EQ(load_part<RobotOnly>(file).robot.base.wheel_radius_m, 0.1);
  const auto wrong = file_with("[other]\nkey = 1\n[robot.base]\nwheel_radius_m = 'a'\n");
  EXPECT_THROW(load_part<RobotOnly>(wrong), ConfigError);
}

TEST(Config, BareWordsOnTheCommandLineAreStrings) {
  const auto config = load_config<RobotOnly>({{}, {"robot.markers.dictionary=DICT_4X4_50"}});
  EXPECT_EQ(config.robot.markers.dictionary, "DICT_4X4_50");
}

TEST(Config, OverridesWithoutValueAreRefused) {
  EXPECT_THAT(error_of({{}, {"robot.lidar.num_beams"}}), HasSubstr("expected key=value"));
}

TEST(Config, ChecksAcrossFieldsRunOnTheResult) {
  EXPECT_THAT(error_of({{}, {"robot.lidar.range_min_m=4"}}),
              HasSubstr("must be below range_max_m"));
}

enum class Heating { kStove, kCentral };

struct House {
  Heating heating{Heating::kCentral};
  int radiators{4};
  Shelf wood{};

  void describe(Fields& fields) {
    fields.choice("heating", heating, {{"stove", Heating::kStove}, {"central", Heating::kCentral}},
                  "with what");
    fields.when(heating == Heating::kCentral, "only heating = central uses it",
                [&] { fields.field("radiators", radiators, kNotNegative, "how many"); });
    fields.when(heating == Heating::kStove, "only heating = stove uses it",
                [&] { fields.section("wood", wood); });
  }
};

std::string house_error_of(const ConfigSources& sources) {
  try {
    load_config<House>(sources);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Config, AKeyThatTheOtherSettingsDoNotUseIsAnError) {
  const auto file = file_with("[wood]\nbooks = 2\n");
  EXPECT_THAT(house_error_of({{file}, {}}),
              HasSubstr("config_test.toml:2: wood.books: only heating = stove uses it"));
  EXPECT_EQ(house_error_of({{}, {"radiators=2", "heating=stove"}}),
            "--set radiators=2: radiators: only heating = central uses it");
  EXPECT_EQ(house_error_of({{file}, {"heating=stove"}}), "no error");
  EXPECT_EQ(house_error_of({{}, {"radiators=2"}}), "no error");
}

TEST(Config, ADumpLeavesOutUnusedKeys) {
  House house{};
  EXPECT_THAT(dump_config(house), HasSubstr("radiators = 4"));
  EXPECT_THAT(dump_config(house), Not(HasSubstr("wood")));
  house.heating = Heating::kStove;
  EXPECT_THAT(dump_config(house), Not(HasSubstr("radiators")));
  EXPECT_EQ(house_error_of({{file_with(dump_config(house))}, {}}), "no error");
}

TEST(Config, TheValueOfOneKeyCanBeQueried) {
  const Room room{.shelves = {{.books = 3, .vases = 5}}};
  EXPECT_EQ(config_value(room, "chairs"), "4");
  EXPECT_EQ(config_value(room, "shelves[0].vases"), "5");
  EXPECT_EQ(config_value(House{}, "heating"), "central") << "bare, not in quotes";
  EXPECT_THROW(config_value(House{}, "wood.books"), ConfigError) << "nothing uses it";
  try {
    config_value(room, "chair");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "chair: unknown key; did you mean chairs?");
  }
}

TEST(Config, ProblemsAcrossFieldsHaveTheirLines) {
  const auto file = file_with("[robot.lidar]\nrange_max_m = 3\nrange_min_m = 4\n");
  EXPECT_THAT(error_of({{file}, {}}),
              HasSubstr("config_test.toml:3: robot.lidar.range_min_m: must be below"));
  EXPECT_THAT(error_of({{file}, {"robot.lidar.range_min_m=5"}}),
              HasSubstr("--set robot.lidar.range_min_m=5: robot.lidar.range_min_m: must be below"));
}

struct Hut {
  Shelf shelf{};
  int doors{1};

  void describe(Fields& fields) {
    fields.section("shelf", shelf);
    fields.field("doors", doors, kNotNegative, "how many");
  }
};

struct Village {
  std::vector<Hut> huts{};
  int wells{1};

  void describe(Fields& fields) {
    fields.list("huts", huts, "of all people");
    fields.field("wells", wells, kNotNegative, "how many");
  }
};

TEST(Config, ADumpReadsBackWhereValuesAreDescribedAfterTables) {
  const Village village{.huts = {{.doors = 2}, {.shelf = {.books = 7}}}, .wells = 3};
  const std::string text = dump_config(village);
  EXPECT_EQ(dump_config(load_config<Village>({{file_with(text)}, {}})), text);
  EXPECT_THAT(text, HasSubstr("wells = 3"));
}

TEST(Config, ADumpReadsBackAsTheSame) {
  RobotOnly config{};
  config.robot.lidar.num_beams = 17;
  config.robot.camera.fx_px = 0.1 + 530.2;
  config.robot.markers.dictionary = "a \"quoted\" \\ name, \u00e9, \x01\x7f";
  config.robot.markers.ids = {0, 3};

  const auto again = load_config<RobotOnly>({{file_with(dump_config(config))}, {}});

  EXPECT_EQ(dump_config(again), dump_config(config));
  EXPECT_EQ(again.robot.camera.fx_px, config.robot.camera.fx_px);
}

}  // namespace
}  // namespace waymark
