// SPDX-License-Identifier: BSD-3-Clause
// waymark-doctor: exit codes, files, and logs that cannot be used.
#include "common/log/log_file.hpp"
#include "import/log/log_output.hpp"
#include "synthetic_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>
#include <vector>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::filesystem::path test_folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::path{::testing::TempDir()} / "waymark_doctor" / test->name();
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

struct Ended {
  int code{-1};
  std::string out{};
  std::string errors{};
};

Ended doctor(const std::string& arguments) {
  const auto folder = test_folder();
  const std::string command = std::string{WAYMARK_BUILD_DIR} + "/waymark-doctor " + arguments +
                              " >" + (folder / "out").string() + " 2>" +
                              (folder / "errors").string();
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder / "out"),
          read_file(folder / "errors")};
}

/// run.lcm with robot.toml beside it, in an empty folder.
std::string run_of(const DriveFaults& faults) {
  std::filesystem::remove_all(test_folder());
  const DoctorInput input = drive_in_room(faults);
  write_imported_log(input.log, input.report, test_folder() / "run.lcm");
  return (test_folder() / "run.lcm").string();
}

TEST(DoctorProgram, AHealthyRobotGives0AndAFaultyOne1) {
  EXPECT_EQ(doctor(run_of({})).code, 0);
  const Ended mirrored = doctor(run_of({.is_mirrored = true}));
  EXPECT_EQ(mirrored.code, 1);
  EXPECT_THAT(mirrored.out, HasSubstr("FAIL  lidar_mirrored"));
}

TEST(DoctorProgram, WritesARobotFileButReplacesNone) {
  const std::string log = run_of({.base_from_lidar = Se2{-0.2, -0.05, 0.0}});
  const std::string robot = (test_folder() / "found.toml").string();

  const Ended first = doctor(log + " --json --write-robot " + robot);

  EXPECT_EQ(first.code, 1);
  EXPECT_EQ(nlohmann::json::parse(first.out)["checks"][0]["name"], "records");
  EXPECT_NEAR(load_config<RobotOnly>({{robot}, {}}).robot.lidar.x_m, -0.2, 0.02);
  const Ended second = doctor(log + " --write-robot " + robot);
  EXPECT_EQ(second.code, 2) << "it replaces nothing";
  EXPECT_EQ(second.out, "") << "it says so before the analysis";
  const Ended nowhere = doctor(log + " --write-robot " + (test_folder() / "none/a.toml").string());
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_EQ(nowhere.out, "");
  EXPECT_THAT(nowhere.errors, HasSubstr("--write-robot: there is no folder"));
  EXPECT_EQ(doctor(log + " --config " + robot).code, 0) << "its own description is right";
}

TEST(DoctorProgram, LogsThatCannotBeUsedGive2AndASentence) {
  const std::string log = run_of({.duration_s = 5.0});
  std::ofstream{test_folder() / "text"} << "no log of anything\n";
  std::ofstream{test_folder() / "empty"};
  std::ofstream{test_folder() / "no_dictionary.toml"}
      << "[robot.markers]\ndictionary = \"DICT_9X9_5\"\n";
  LogWriter only_odometry{test_folder() / "no_lidar.lcm"};
  only_odometry.write(encode(channels::kOdometry, pose2D_t{}));
  only_odometry.close();
  const auto path = [](const char* name) {
    return (test_folder() / name).string();
  };
  for (const std::string& arguments :
       {std::string{}, path("missing"), path("empty"), path("text"), path("no_lidar.lcm"),
        log + " --lidar-channel NONE", log + " --config " + path("missing.toml"),
        log + " --config " + path("no_dictionary.toml"), log + " --no-such-option",
        log + " --seconds 3", std::string{"--seconds 0"}, log + " --lcm-url udpm://"}) {
    const Ended ended = doctor(arguments);
    EXPECT_EQ(ended.code, 2) << arguments;
    EXPECT_FALSE(ended.errors.empty()) << arguments;
  }
}

TEST(DoctorProgram, AFileOfAnotherKindIsNoLogAndAPartOfALogIsMentioned) {
  const std::string log = run_of({.duration_s = 5.0});
  const std::string robot = (test_folder() / "robot.toml").string();
  std::ofstream{test_folder() / "paper.pdf"} << "%PDF-1.4\n1 0 obj\n<< /Type /Catalog >>\n";
  for (const std::string& file : {robot, (test_folder() / "paper.pdf").string()})
    EXPECT_THAT(doctor(file).errors, HasSubstr(file + ": is no log"));
  EXPECT_THAT(doctor((test_folder() / "none.lcm").string()).errors, Not(HasSubstr(".part")));
  std::filesystem::rename(log, part_path_of(log));
  const Ended unfinished = doctor(log);
  EXPECT_EQ(unfinished.code, 2);
  EXPECT_THAT(unfinished.errors, HasSubstr("but '" + part_path_of(log).string() + "'"));
}

TEST(DoctorProgram, SensorsOnClocksThatAreDaysApartAreNamedWithTheDistance) {
  const std::string log = run_of({.duration_s = 20.0});
  constexpr std::int64_t kDays_us = 3 * std::int64_t{86'400'000'000};
  LogWriter apart{test_folder() / "apart.lcm"};    // recorded by the stamps
  LogWriter logged{test_folder() / "logged.lcm"};  // with the times of arrival
  LogReader reader{log};
  while (auto event = reader.next()) {
    if (event->channel == channels::kOdometry.name) {
      pose2D_t odometry = *decode<pose2D_t>(event->payload).message;
      odometry.utime += kDays_us;
      const Timestamp arrival = event->time;
      *event = encode(channels::kOdometry, odometry);
      apart.write(*event);
      event->time = arrival;
    } else {
      apart.write(*event);
    }
    logged.write(*event);
  }
  apart.close();
  logged.close();
  const Ended by_stamps = doctor((test_folder() / "apart.lcm").string());
  EXPECT_EQ(by_stamps.code, 2);
  EXPECT_THAT(by_stamps.errors,
              AllOf(HasSubstr("no scan has odometry at its time"), HasSubstr("(3.0 days) later"),
                    HasSubstr("stamp both with one clock")));
  const Ended by_arrival = doctor((test_folder() / "logged.lcm").string());
  EXPECT_EQ(by_arrival.code, 1);
  EXPECT_THAT(by_arrival.out, HasSubstr("LIDAR are 259200.0 s earlier than those of ODOMETRY"));
}

TEST(DoctorInput, TheMessagesOfEachChannelAreCounted) {
  const std::string log = run_of({.duration_s = 3.0});
  std::map<std::string, std::vector<std::int64_t>> sizes_bytes;
  LogReader reader{log};
  while (const auto event = reader.next())
    sizes_bytes[event->channel].push_back(std::ssize(event->payload));

  const DoctorInput input = read_input(log, {}, {});

  EXPECT_NEAR(input.recorded_s, 3.0, 0.1);
  ASSERT_EQ(input.channels.size(), sizes_bytes.size());
  for (const auto& [channel, sizes] : sizes_bytes) {
    const ChannelTraffic& traffic = input.channels.at(channel);
    EXPECT_EQ(traffic.messages, std::ssize(sizes)) << channel;
    EXPECT_EQ(traffic.bytes, std::accumulate(sizes.begin(), sizes.end(), std::int64_t{0}));
    EXPECT_EQ(traffic.largest_bytes, std::ranges::max(sizes));
    EXPECT_NEAR(traffic.first_s, 0.0, 0.1);
    EXPECT_NEAR(traffic.last_s, 3.0, 0.2);
  }
}

TEST(DoctorProgram, WithoutOdometryTheErrorAsksForItOrForTheChannelThatTheUserNamed) {
  const std::string log = run_of({.duration_s = 2.0});
  for (const std::string option : {"--odometry-channel", "--encoder-channel"}) {
    const Ended named = doctor(log + " " + option + " NONE");
    EXPECT_THAT(named.errors, HasSubstr("there is no channel NONE"));
    EXPECT_THAT(named.errors, Not(HasSubstr("the log has no ODOMETRY")));
  }
  LogWriter only_lidar{test_folder() / "no_odometry.lcm"};
  LogReader reader{log};
  while (const auto event = reader.next())
    if (event->channel == channels::kLidar.name) only_lidar.write(*event);
  only_lidar.close();
  EXPECT_THAT(doctor((test_folder() / "no_odometry.lcm").string()).errors,
              HasSubstr("the log has no ODOMETRY, but LIDAR"));
}

TEST(DoctorProgram, ASensorThatStopsForGoodIsNamedButAStepOfTheClockIsNot) {
  const std::string log = run_of({});
  constexpr std::int64_t kStep_us = 3'600'000'000;
  LogWriter dead{test_folder() / "dead.lcm"};
  LogWriter stepped{test_folder() / "stepped.lcm"};
  std::optional<Timestamp> start;
  LogReader reader{log};
  while (auto event = reader.next()) {
    const bool is_first = !start;
    if (!start) start = event->time;
    const double t_s = to_seconds(event->time - *start);
    if (event->channel != channels::kLidar.name || t_s < 60.0) dead.write(*event);
    if (!is_first) event->time = timestamp_from_us(to_us(event->time) + kStep_us);
    stepped.write(*event);
  }
  dead.close();
  stepped.close();

  const Ended ended = doctor((test_folder() / "dead.lcm").string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.out, HasSubstr("FAIL  lidar_drops"));
  EXPECT_THAT(ended.out, HasSubstr("none in the last 30."));
  EXPECT_EQ(doctor((test_folder() / "stepped.lcm").string()).code, 0);
}

TEST(DoctorProgram, ADamagedLogIsNamedAndTheRestIsUsed) {
  const std::string log = run_of({});
  const std::string bytes = read_file(log);
  std::ofstream{test_folder() / "cut.lcm", std::ios::binary}
      << bytes.substr(0, bytes.size() / 2) + "garbage" + bytes.substr(bytes.size() / 2);

  const Ended ended = doctor((test_folder() / "cut.lcm").string());

  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, HasSubstr("WARN  records"));
}

}  // namespace
}  // namespace waymark
